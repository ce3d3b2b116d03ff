"""As a falls to 0 the attractors become normal modes of the sliding chain, at the edge U' ≥ 0: against closed forms."""

import numpy as np
import pytest

from burridge_knopoff import Chain, Model, law_of
from burridge_knopoff.model.model import ChainState
from burridge_knopoff.motion.rotation import rotation_number
from burridge_knopoff.running.settings import Settings
from burridge_knopoff.running.simulation import run

V = 0.1
#: U_2/U_1 of the fast symmetric mode is −(1 + √3), its frequency √(3 + √3).
FAST = 1.0 + np.sqrt(3.0)


def mean_modulus(first: float, second: float) -> float:
    """Return the mean of sqrt(first² sin² + second² cos²) over a turn, by equidistant points."""
    phase = np.linspace(0.0, 2.0 * np.pi, 100_000, endpoint=False)
    return float(np.hypot(first * np.sin(phase), second * np.cos(phase)).mean())


def modes(ends: float, fast: float) -> ChainState:
    """Return a state of uniform sliding with the antisymmetric and the fast symmetric mode on it.

    ends, fast : amplitude of U_1' − v in each of the two; both are at their turning point
    """
    antisymmetric, symmetric = ends / np.sqrt(2.0), fast / np.sqrt(3.0 + np.sqrt(3.0))
    position = antisymmetric * np.array([1.0, 0.0, -1.0]) + symmetric * np.array([1.0, -FAST, 1.0])
    return ChainState(position, np.full(3, V), np.zeros(3, dtype=bool))


# The amplitudes at which the blocks just touch U' = 0: the end blocks alone; the middle block and the end blocks.
MODES = {"branch 2": (V, 0.0), "branch 1": (V - V / FAST, V / FAST)}


def test_the_modes_are_those_of_the_chain() -> None:
    """K (1, 0, −1) = 2 (1, 0, −1), and (1, 1 ∓ √3, 1) belongs to 3 ± √3."""
    matrix = Chain(3).stiffness
    for mode, square in (((1, 0, -1), 2.0), *(((1, -1 + s, 1), 3 - s) for s in (np.sqrt(3.0), -np.sqrt(3.0)))):
        np.testing.assert_allclose(matrix @ np.array(mode), square * np.array(mode), atol=1e-14)


@pytest.mark.parametrize("law", ["linearized", "nonlinear"])
@pytest.mark.parametrize(("branch", "limit"), [("branch 2", 0.17197), ("branch 1", 0.10902)])
def test_the_mean_distance_tends_to_that_of_the_modes(branch: str, limit: float, law: str) -> None:
    ends, fast = MODES[branch]
    closed_form = mean_modulus(2.0 * ends, np.sqrt(2.0) * ends)
    assert closed_form == pytest.approx(limit, abs=5e-6)
    found, friction = [], np.array([0.0005, 0.001, 0.002])
    for a in friction:
        model = Model(Chain(3), law_of(law, a), V)
        settings = Settings(
            transient=10.0 / a, window=20.0 / a, sampling=1.0 / a, trajectory=0.0, events="none", lyapunov_exponents=0
        )
        found.append(run(model, modes(ends, fast), settings).mean_distance)
    # Blocks that grow by less from touch to touch stick for less time: ⟨J⟩ comes down to that of the modes.
    first, second, third = found
    extrapolated = 2.0 * first - second
    assert closed_form < first < second < third < 1.05 * closed_form
    assert extrapolated == pytest.approx(closed_form, rel=0.01 if branch == "branch 1" else 1e-4)


def test_the_frequencies_tend_to_those_of_the_modes() -> None:
    """sqrt(2/(3 + √3)) = 0.650, the ratio at which the end blocks oscillate on branch 1."""
    a = 0.0005
    model = Model(Chain(3), law_of("linearized", a), V)
    number, error = rotation_number(model, modes(*MODES["branch 1"]), 10.0 / a)
    assert error < 1e-4
    assert number == pytest.approx(np.sqrt(2.0 / (3.0 + np.sqrt(3.0))), abs=1e-4)
