"""Detuned end blocks without synchrony: one frequency with unequal masses, a stable phase, and the mode of both."""

import numpy as np
import pytest
from scipy.linalg import eigh

from burridge_knopoff import ChainState, Model
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.motion.settings import MotionSettings
from burridge_knopoff.running.runner import Runner
from burridge_knopoff.summaries.detuning import DetunedMotion, detuned_motion
from burridge_knopoff.summaries.one_frequency import has_one_frequency


def frequencies_of_branch_1(law: str, a: float, detuning: float) -> DetunedMotion:
    model = Model(law, a=a)
    return detuned_motion(model, Runner(model).state_after(model.begin(PAPER_STATES["plus"]), 3000.0), detuning, 3)


def attracts(motion: DetunedMotion) -> bool:
    return bool(motion.exponent[2] < -3.0 * motion.exponent_error[2])


@pytest.mark.parametrize(("law", "a"), [("linearized", 0.03), ("linearized", 0.06), ("nonlinear", 0.08)])
@pytest.mark.parametrize("detuning", [0.1, 0.3])
def test_the_end_blocks_keep_one_frequency_with_unequal_masses(law: str, a: float, detuning: float) -> None:
    """Alone, the heavier block would be slower by 5 or 12 %: two frequencies would differ by 0.01 or more."""
    motion = frequencies_of_branch_1(law, a, detuning)
    assert motion.frequency[2] == pytest.approx(motion.frequency[0], abs=1e-8)
    assert motion.frequency[1] > 1.5 * motion.frequency[0]
    assert (motion.frequency_error < 1e-5).all()
    assert attracts(motion)


@pytest.mark.parametrize("detuning", [0.1, 0.3])
def test_blocks_moved_by_springs_alone_keep_one_frequency_but_are_not_locked(detuning: float) -> None:
    """At a = 0 friction is constant: small oscillations about sliding are those of the springs, without any locking."""
    model = Model("linearized", a=0.0)
    antiphase = ChainState(np.array([0.05, 0.0, -0.05]), np.full(3, model.v), np.zeros(3, bool))
    motion = detuned_motion(model, antiphase, detuning, 3)
    masses = 1.0 + np.array([0.0, 0.0, detuning])
    squares, shapes = eigh(model.chain.stiffness, np.diag(masses))
    # The mode with the largest part of the initial displacement, in the norm of the masses.
    largest = np.abs(shapes.T @ (masses * antiphase.position)).argmax()
    assert motion.frequency[[0, 2]] == pytest.approx(np.sqrt(squares[largest]) / (2.0 * np.pi), abs=1e-9)
    assert not attracts(motion)
    assert (np.abs(motion.exponent) < 1e-3).all()
    # The longest window tells these exponents from those of a phase that is locked weakly.
    assert 3.0 * motion.exponent_error[2] < MotionSettings().zero_exponent
    ratio = shapes[2, largest] / shapes[0, largest]
    assert motion.end_ratio == pytest.approx(abs(ratio), abs=1e-6)
    assert motion.end_phase == pytest.approx(180.0 if ratio < 0.0 else 0.0, abs=1e-4)
    assert motion.mode_share[largest] == pytest.approx(1.0, abs=1e-9)


def test_a_weakly_stable_phase_is_resolved_by_a_longer_window() -> None:
    """Branch 2 at a = 0.0925: a window of 4000 gives −8.5e-4 ± 4.1e-4, one of 512,000 −7.69e-4 ± 1.2e-5."""
    model = Model("nonlinear", a=0.0925)
    start = ChainState(np.array([0.0618, 0.0135, -0.0271]), np.array([0.1925, 0.1088, 0.0417]), np.zeros(3, bool))
    motion = detuned_motion(model, start, 0.3, 3)
    assert attracts(motion)
    assert motion.exponent[2] == pytest.approx(-7.69e-4, abs=3.0 * motion.exponent_error[2])
    assert motion.exponent_error[2] < 2.5e-4
    assert motion.frequency == pytest.approx(0.21019957, abs=1e-8)


def antiphase(law: str, a: float) -> tuple[Model, ChainState]:
    model = Model(law, a=a)
    state = ChainState(np.array([0.07, 0.0, -0.07]), np.full(3, model.v), np.zeros(3, bool))
    return model, Runner(model).state_after(state, 3000.0)


@pytest.mark.parametrize("law", ["linearized", "nonlinear"])
@pytest.mark.parametrize("branch", [1, 2])
def test_as_a_vanishes_the_motion_is_that_of_the_mode_of_unequal_masses(law: str, branch: int) -> None:
    """Ratio, phase and frequency tend to those of the mode with a; so would not those of two locked oscillators."""
    deviations = []
    for a in (0.02, 0.005):
        model, start = antiphase(law, a)
        if branch == 1:
            model = model.at(a=0.03)
            start = Runner(model).state_after(model.begin(PAPER_STATES["plus"]), 3000.0)
            for step in np.linspace(0.03, a, 4):
                model = model.at(a=step)
                start = Runner(model).state_after(start, 3000.0)
        motion = detuned_motion(model, start, 0.3, 3)
        assert has_one_frequency(motion.frequency)
        squares, shapes = eigh(model.chain.stiffness, np.diag([1.0, 1.0, 1.3]))
        mode, ratio = np.sqrt(squares[1]) / (2.0 * np.pi), shapes[2, 1] / shapes[0, 1]
        assert ratio == pytest.approx(-0.569, abs=1e-3)
        assert motion.mode_share.argmax() == 1
        deviations.append(
            (motion.frequency[0] - mode, motion.end_ratio + ratio, motion.end_phase - 180.0, motion.mode_share[1] - 1.0)
        )
    first, second = np.abs(deviations)
    assert (first < (1e-3, 0.02, 6.0, 2e-3)).all()
    assert (second < 0.6 * first).all()


@pytest.mark.parametrize("branch", [1, 2])
def test_the_phase_does_not_drift_towards_an_edge(branch: int) -> None:
    """Of locked oscillators it shifts by up to 90° where locking ends, here between 50 and 80 % more mass."""
    model, state = antiphase("linearized", 0.06)
    if branch == 1:
        state = Runner(model).state_after(model.begin(PAPER_STATES["plus"]), 3000.0)
    shifts, ratios = [], []
    for detuning in (0.1, 0.3, 0.5):
        motion = detuned_motion(model, state, detuning, 3)
        state = motion.final
        assert has_one_frequency(motion.frequency)
        assert motion.mode_share.max() > 0.99
        shifts.append(abs(motion.end_phase - 180.0))
        ratios.append(motion.end_ratio)
    assert max(shifts) < 12.0
    assert shifts[2] <= max(shifts[:2])
    assert ratios[2] < ratios[1] < ratios[0] < 0.9


def test_at_large_detunings_they_have_two_frequencies() -> None:
    """An independent integrator gives 0.2036 and 0.1467."""
    motion = frequencies_of_branch_1("linearized", 0.06, 0.8)
    assert motion.frequency[[0, 2]] == pytest.approx([0.2036, 0.1467], abs=1e-4)


def test_at_equal_masses_their_frequencies_are_equal_by_symmetry() -> None:
    motion = frequencies_of_branch_1("linearized", 0.06, 0.0)
    assert motion.frequency[0] == pytest.approx(motion.frequency[2], abs=1e-8)


def test_a_motion_that_does_not_complete_has_no_frequencies(monkeypatch: pytest.MonkeyPatch) -> None:
    """The motion after the end of such a run has not settled."""
    model = Model("linearized", a=0.05)
    monkeypatch.setattr("burridge_knopoff.running.runner.STEP_LIMIT", 500)
    motion = detuned_motion(model, model.begin(PAPER_STATES["plus"]), 0.1, 3)
    for values in (motion.frequency, motion.frequency_error, motion.exponent, motion.mode_share):
        assert values.shape == (3,)
        assert np.isnan(values).all()
    assert np.isnan([motion.end_ratio, motion.end_phase]).all()
