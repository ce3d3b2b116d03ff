"""One frequency of the end blocks of branch 1 with unequal masses, up to some detuning."""

import numpy as np
import pytest
from scipy.linalg import eigvalsh

from burridge_knopoff import Chain, ChainState, Model, law_of
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.running.runner import Runner
from burridge_knopoff.summaries.detuning import WINDOW, detuned_motion


def of_branch_1(law: str, a: float, detuning: float) -> tuple[np.ndarray, float]:
    model = Model(Chain(3), law_of(law, a))
    return detuned_motion(model, Runner(model).after(model.begin(PAPER_STATES["plus"]), 3000.0), detuning)


@pytest.mark.parametrize(("law", "a"), [("linearized", 0.03), ("linearized", 0.06), ("nonlinear", 0.08)])
@pytest.mark.parametrize("detuning", [0.1, 0.3])
def test_the_end_blocks_keep_one_frequency_with_unequal_masses(law: str, a: float, detuning: float) -> None:
    """Alone, the heavier block would be slower by 5 or 12 %: without locking the two would part by 0.01 or more."""
    frequency, correlation = of_branch_1(law, a, detuning)
    assert abs(frequency[2] - frequency[0]) < 1e-5
    assert correlation < -0.5
    assert frequency[1] > 1.5 * frequency[0]


@pytest.mark.parametrize("detuning", [0.1, 0.3])
def test_so_do_blocks_that_the_springs_alone_move(detuning: float) -> None:
    """At a = 0 friction is constant: small oscillations about sliding are those of the springs, without any locking."""
    model = Model(Chain(3), law_of("linearized", 0.0))
    antiphase = ChainState(model.sliding_offset + np.array([0.05, 0.0, -0.05]), np.full(3, model.v), np.zeros(3, bool))
    frequency, _ = detuned_motion(model, antiphase, detuning)
    masses = np.diag([1.0, 1.0, 1.0 + detuning])
    modes = np.sqrt(eigvalsh(model.chain.stiffness, masses)) / (2.0 * np.pi)
    assert frequency[0] == pytest.approx(frequency[2], abs=1e-6)
    assert np.abs(modes - frequency[0]).min() < 1e-4


def test_beyond_the_range_of_locking_they_have_two_frequencies() -> None:
    """By an independent integrator 0.2036 and 0.1467."""
    frequency, correlation = of_branch_1("linearized", 0.06, 0.8)
    assert frequency[[0, 2]] == pytest.approx([0.2036, 0.1467], abs=0.5 / WINDOW)
    assert correlation > 0.0


def test_at_equal_masses_their_frequencies_are_equal_by_symmetry() -> None:
    frequency, _ = of_branch_1("linearized", 0.06, 0.0)
    assert frequency[0] == pytest.approx(frequency[2], abs=1e-7)
