"""Locking of the end blocks of branch 1: one frequency with unequal masses, and phases that attract."""

import numpy as np
import pytest
from scipy.linalg import eigh

from burridge_knopoff import Chain, ChainState, Model, law_of
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.running.runner import Runner
from burridge_knopoff.summaries.detuning import DetunedMotion, detuned_motion


def frequencies_of_branch_1(law: str, a: float, detuning: float) -> DetunedMotion:
    model = Model(Chain(3), law_of(law, a))
    return detuned_motion(model, Runner(model).state_after(model.begin(PAPER_STATES["plus"]), 3000.0), detuning, 3)


def attracts(found: DetunedMotion) -> bool:
    return bool(found.exponent[2] < -3.0 * found.exponent_error[2])


@pytest.mark.parametrize(("law", "a"), [("linearized", 0.03), ("linearized", 0.06), ("nonlinear", 0.08)])
@pytest.mark.parametrize("detuning", [0.1, 0.3])
def test_the_end_blocks_stay_locked_with_unequal_masses(law: str, a: float, detuning: float) -> None:
    """Alone, the heavier block would be slower by 5 or 12 %: unlocked frequencies would differ by 0.01 or more."""
    found = frequencies_of_branch_1(law, a, detuning)
    assert found.frequency[2] == pytest.approx(found.frequency[0], abs=1e-8)
    assert found.frequency[1] > 1.5 * found.frequency[0]
    assert (found.frequency_error < 1e-5).all()
    assert attracts(found)


@pytest.mark.parametrize("detuning", [0.1, 0.3])
def test_blocks_moved_by_springs_alone_keep_one_frequency_but_are_not_locked(detuning: float) -> None:
    """At a = 0 friction is constant: small oscillations about sliding are those of the springs, without any locking."""
    model = Model(Chain(3), law_of("linearized", 0.0))
    antiphase = ChainState(np.array([0.05, 0.0, -0.05]), np.full(3, model.v), np.zeros(3, bool))
    found = detuned_motion(model, antiphase, detuning, 3)
    masses = 1.0 + np.array([0.0, 0.0, detuning])
    squares, shapes = eigh(model.chain.stiffness, np.diag(masses))
    # The mode with the largest part of the initial displacement, in the norm of the masses.
    largest = np.abs(shapes.T @ (masses * antiphase.position)).argmax()
    assert found.frequency[[0, 2]] == pytest.approx(np.sqrt(squares[largest]) / (2.0 * np.pi), abs=1e-9)
    assert not attracts(found)
    assert (np.abs(found.exponent) < 1e-3).all()


def test_beyond_the_range_of_locking_they_have_two_frequencies() -> None:
    """An independent integrator gives 0.2036 and 0.1467."""
    found = frequencies_of_branch_1("linearized", 0.06, 0.8)
    assert found.frequency[[0, 2]] == pytest.approx([0.2036, 0.1467], abs=1e-4)


def test_at_equal_masses_their_frequencies_are_equal_by_symmetry() -> None:
    found = frequencies_of_branch_1("linearized", 0.06, 0.0)
    assert found.frequency[0] == pytest.approx(found.frequency[2], abs=1e-8)
