"""As a falls to 0 the attractors become normal modes of the sliding chain with min U' = 0: compared with closed forms.

Averaged amplitude equations decide which of them attract: see docs/attractors.md.
"""

import numpy as np
import pytest

from burridge_knopoff import Chain, Model
from burridge_knopoff.model.model import ChainState
from burridge_knopoff.motion.rotation import rotation_number
from burridge_knopoff.running.settings import Settings
from burridge_knopoff.running.simulation import run
from tests.attractors.averaged import (
    BRANCH_1,
    BRANCH_2,
    FAST,
    SYNCHRONY,
    WEIGHT,
    V,
    averaged_amplitudes,
    compare_random_state,
    simulated_amplitudes,
    vertices,
)


def mean_modulus(first: float, second: float) -> float:
    """Return the mean of sqrt(first² sin² + second² cos²) over a period, by equidistant points."""
    phase = np.linspace(0.0, 2.0 * np.pi, 100_000, endpoint=False)
    return float(np.hypot(first * np.sin(phase), second * np.cos(phase)).mean())


def modes(ends: float, fast: float) -> ChainState:
    """Return a state of uniform sliding with the antisymmetric and the fast symmetric mode on it.

    ends, fast : amplitude of U_1' − v in each of the two; both are at their turning point
    """
    antisymmetric, symmetric = ends / np.sqrt(2.0), fast / np.sqrt(3.0 + np.sqrt(3.0))
    position = antisymmetric * np.array([1.0, 0.0, -1.0]) + symmetric * np.array([1.0, -FAST, 1.0])
    return ChainState(position, np.full(3, V), np.zeros(3, dtype=bool))


# The amplitudes at which the minimum of U' is 0: for the end blocks alone; for the middle block and the end blocks.
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
    distances, friction = [], np.array([0.0005, 0.001, 0.002])
    for a in friction:
        model = Model(law, a=a, v=V)
        settings = Settings(
            transient=10.0 / a, window=20.0 / a, sampling=1.0 / a, trajectory=0.0, events="none", lyapunov_exponents=0
        )
        distances.append(run(model, modes(ends, fast), settings).mean_distance)
    # The less the modes grow between two sticks, the shorter the sticks: ⟨J⟩ approaches that of the modes.
    first, second, third = distances
    extrapolated = 2.0 * first - second
    assert closed_form < first < second < third < 1.05 * closed_form
    assert extrapolated == pytest.approx(closed_form, rel=0.01 if branch == "branch 1" else 1e-4)


def test_the_frequencies_tend_to_those_of_the_modes() -> None:
    """sqrt(2/(3 + √3)) = 0.650, the ratio at which the end blocks oscillate on branch 1."""
    a = 0.0005
    model = Model("linearized", a=a, v=V)
    number, error = rotation_number(model, modes(*MODES["branch 1"]), 10.0 / a)
    assert error < 1e-4
    assert number == pytest.approx(np.sqrt(2.0 / (3.0 + np.sqrt(3.0))), abs=1e-4)


def test_energy_has_a_maximum_at_three_vertices() -> None:
    """Along an edge ½ Σ N A² is convex: it decreases to both sides only if it decreases at once."""
    corners = vertices()
    maxima = []
    for faces, vertex in corners.items():
        edges = [other - vertex for adjacent, other in corners.items() if len(set(faces) & set(adjacent)) == 2]
        assert len(edges) == 3
        slopes = [(WEIGHT * vertex) @ edge for edge in edges]
        if max(slopes) < -1e-9:
            maxima.append(vertex)
    expected = sorted([SYNCHRONY.tolist(), BRANCH_2.tolist(), BRANCH_1.tolist()])
    np.testing.assert_allclose(sorted(vertex.tolist() for vertex in maxima), expected, atol=1e-12)
    energies = sorted(float(WEIGHT @ vertex**2) for vertex in corners.values())
    root = np.sqrt(3.0)
    np.testing.assert_allclose(energies, [0, 3 - root, 2, 9 - 4 * root, 9 - 4 * root, 6 - 2 * root], atol=1e-12)


@pytest.mark.parametrize(
    ("start", "end"),
    [
        ((0.5, 0.3, 0.15), SYNCHRONY),
        ((0.6, 0.1, 0.05), SYNCHRONY),
        ((0.866, 0.001, 0.133), SYNCHRONY),
        ((0.3, 0.3, 0.25), BRANCH_1),
        ((0.05, 0.4, 0.3), BRANCH_1),
        ((0.2, 0.7, 0.02), BRANCH_2),
    ],
)
def test_amplitudes_follow_the_averaged_equations(start: tuple[float, ...], end: np.ndarray) -> None:
    times = np.array([500.0, 1000.0, 2000.0, 4000.0, 8000.0])
    expected, simulated = (of(np.array(start), 0.001, times) for of in (averaged_amplitudes, simulated_amplitudes))
    np.testing.assert_allclose(expected[-1], end, atol=2e-3)
    np.testing.assert_allclose(simulated[-1], end, atol=0.02)
    assert np.abs(simulated - expected).max() < 0.1


@pytest.mark.slow
def test_most_random_states_follow_the_averaged_equations() -> None:
    """Of 1000 states, 81 % differ by less than 0.1 v and 95 % by less than 0.2 v; 99 % reach the same vertex."""
    differences, same = zip(*map(compare_random_state, range(24)), strict=True)
    assert sum(same) >= 22
    assert 14 <= np.sum(np.less(differences, 0.1)) <= 23
    assert np.sum(np.less(differences, 0.2)) >= 20
    # Near a boundary between basins a state leaves a slow edge earlier or later: no bound holds for all.
    assert max(differences) > 0.1
