"""Capture radii of constructed sets, and of fixed points of maps whose basins are known."""

from dataclasses import replace

import numpy as np
import pytest

from burridge_knopoff import ChainState, Model, MotionKind, SearchSettings
from burridge_knopoff.attractors import slow_set
from burridge_knopoff.attractors.attractor import perturb, required_returns
from burridge_knopoff.attractors.capture_radius import Capture, embedded_orbits
from burridge_knopoff.attractors.labels import label
from burridge_knopoff.attractors.slow_set import sample_slow_set
from tests.maps import TWO_WELLS, MapModel, rows_of
from tests.motion.stand_in import ASYMMETRIC, at, section, stand_in

MODEL = Model("linearized", a=0.08, v=0.2)
SETTINGS = SearchSettings(transient=100.0, window=70.0, time_limit=900.0, seed=3, perturbations=10)
CHAOS = {"kind": MotionKind.CHAOTIC, "spacing": 0.1}


def test_how_close_a_perturbed_trajectory_has_to_come_back():
    assert Capture().recovery_distance(at(0.0).motion, 0.5) == 0.05
    assert Capture().recovery_distance(at(0.0, spacing=0.02).motion, 0.5) == 0.06


@pytest.mark.parametrize(
    ("wide", "place", "expected"),
    [
        (CHAOS, 0.3, [1]),  # within three spacings
        (CHAOS, 0.31, []),
        ({"slow": True, "spacing": 0.1}, 0.3, [1]),
        ({"spacing": 0.1}, 0.0, []),
    ],
)
def test_which_periodic_orbits_are_embedded_in_a_set(wide, place, expected):
    attractors = [at(0.0, **wide), at(place, spacing=1e-6), at(place, spacing=1.1e-6)]
    assert embedded_orbits(attractors, 0, 1e-6) == expected
    assert embedded_orbits(attractors, 1, 1e-6) == []


def test_radii_are_bounded_by_the_distances_to_other_attractors():
    """The scale is that of v = 0.2: twice that of the paper."""
    points = [at(place, radius=1.0) for place in (0.0, 0.05, 9.0)]
    near = Capture().bound_radii(MODEL, [*points, at(-9.0, radius=0.01)], 1e-6)
    assert [item.radius for item in near] == pytest.approx([0.4 * 0.05, 0.4 * 0.05, 0.04, 0.01])
    assert {item.patience for item in near} == {0.0}
    # Chaos with an embedded orbit keeps its radius and gets a patience; the orbit keeps its radius too.
    chaos, orbit = at(0.0, radius=1.0, **CHAOS), at(0.05, radius=1.0, spacing=1e-7, close_returns=20)
    for attractors in ([chaos, orbit], [orbit, chaos]):
        features = {
            (item.radius, item.close_returns, item.patience) for item in Capture().bound_radii(MODEL, attractors, 1e-6)
        }
        # The radius of chaos is the spacing of its returns, which are far apart.
        assert features == {(0.1, 8, 10_000.0), (0.04, 20, 0.0)}


def point(x, radius, **features):
    """Return a fixed point of a map."""
    returns = rows_of(np.array([x]))
    return stand_in(returns=returns, mirror_returns=returns, radius=radius, **features)


def radius_of(model, attractors, least=1e-5):
    return Capture().find_radius(model, attractors, 0, least, 1e-6, SETTINGS)


@pytest.mark.parametrize(("first", "expected"), [(0.3, 0.3), (0.4, 0.4), (0.8, 0.4), (1.6, 0.4)])
def test_the_radius_is_that_from_which_all_perturbations_come_back(maps, first, expected):
    """The well is 0.447 above the point that separates the basins; radii are halved."""
    model = TWO_WELLS.at(0.7)
    _, middle, well = np.sort(np.roots([-1.0, 0.0, 1.0, -0.3]).real)
    assert well - middle == pytest.approx(0.447, abs=1e-3)
    assert radius_of(model, [point(well, first)]) == pytest.approx(expected)
    # A smaller radius than the least is not tried.
    assert radius_of(model, [point(well, first)], least=0.5) == 0.0


@pytest.mark.parametrize(("multiplier", "comes_back"), [(0.99, True), (0.999, False), (1.0, False), (1.01, False)])
def test_perturbations_have_to_come_ten_times_closer(maps, multiplier, comes_back):
    """Within the time limit of 900 iterations: 0.999^900 = 0.4."""
    model = MapModel(lambda x, a: a * x, lambda x, a: a + 0.0 * x, multiplier)
    assert radius_of(model, [point(0.0, 0.04)]) == (0.04 if comes_back else 0.0)


def test_the_smallest_radius_scales_with_the_velocity(maps):
    class Fast(MapModel):
        scale = 2.0

    model = Fast(lambda x, a: a * x, lambda x, a: a + 0.0 * x, 0.5)
    assert radius_of(model, [point(0.0, 0.04)], least=0.0199) == 0.04
    assert radius_of(model, [point(0.0, 0.04)], least=0.0201) == 0.0


@pytest.mark.parametrize(("features", "radius"), [(CHAOS, 0.04), ({}, 0.0)], ids=str)
def test_a_trajectory_that_reaches_an_embedded_orbit_has_come_back(maps, features, radius):
    """All trajectories reach the orbit at 0; only chaos whose returns are as far apart has it within it."""
    model = MapModel(lambda x, a: a * x, lambda x, a: a + 0.0 * x, 0.5)
    assert radius_of(model, [point(0.25, 0.04, patience=2000.0, **features), point(0.0, 0.04)]) == radius


def test_a_perturbation_changes_positions_and_velocities_of_slipping_blocks():
    start = ChainState(np.array([1.0, 2.0, 3.0]), np.array([0.0, 0.5, 0.01]), np.array([True, False, False]))
    change = np.random.default_rng(7).uniform(-0.1, 0.1, 6)
    state = perturb(start, 0.1, np.random.default_rng(7))
    assert state.position.tolist() == (start.position + change[:3]).tolist()
    assert state.velocity.tolist() == [0.0, 0.5 + change[4], max(0.01 + change[5], 0.0)]
    assert state.stuck.tolist() == [True, False, False]
    backward = [perturb(start, 0.1, np.random.default_rng(seed)).velocity[2] for seed in range(20)]
    assert min(backward) == 0.0 < max(backward)


def test_a_perturbation_does_not_reverse_a_slip():
    """Under a symmetric contact blocks slip backward as well."""
    start = ChainState(np.zeros(2), np.array([-0.05, 0.05]), np.zeros(2, dtype=bool))
    velocities = np.array([perturb(start, 0.1, np.random.default_rng(seed)).velocity for seed in range(40)])
    assert velocities[:, 0].max() == 0.0 > velocities[:, 0].min() > -0.15
    assert velocities[:, 1].min() == 0.0 < velocities[:, 1].max() < 0.15
    assert len(np.unique(velocities[:, 0])) > 20


@pytest.mark.parametrize(
    ("length", "spacing", "expected"), [(3, 0.0, 8), (4, 0.0, 8), (5, 0.0, 10), (5, 0.1, 8), (150, 0.0, 200)]
)
def test_capture_requires_two_periods_of_an_orbit(length, spacing, expected):
    orbit = np.tile(np.random.default_rng(1).uniform(size=(length, 6)), (-(-600 // length), 1))
    # Within ten tolerances.
    orbit[::2] += 9e-6
    assert required_returns(section(orbit, orbit, spacing, 0.0), 1e-6) == expected


def test_a_slow_set_is_sampled_by_perturbed_states(script_answers):
    clouds = [section(np.full((1, 6), float(n)), np.full((1, 6), float(-n)), 0.0, 0.0) for n in range(1, 13)]
    clouds[4] = None
    # Some states have left for another motion: the middle block stops less often, or another block has the returns.
    clouds[6] = replace(clouds[6], stop_count=np.array([10, 18, 10]))
    clouds[8], clouds[10] = replace(clouds[8], block=2), replace(clouds[10], mirror_block=3)
    calls = script_answers(slow_set, "visit", clouds)
    motion = sample_slow_set(MODEL, at(1.0).motion, SETTINGS)
    numbers = [n for n in range(1, 13) if n not in (5, 7, 9, 11)]
    assert motion.returns[:, 0].tolist() == [*numbers, 1.0]
    assert motion.mirror_returns[:, 0].tolist() == [*(-n for n in numbers), 1.0]
    assert {(transient, window) for _, _, transient, window, *_ in calls} == {(30.0, 70.0)}
    # Perturbations of up to five resolutions, at the scale 2, in all directions.
    sizes = np.abs([start.position - 1.0 for _, start, *_ in calls])
    assert 0.009 < sizes.max() <= 0.01


def test_without_attractors_no_state_reaches_one():
    reached, times = label(MODEL, [], [None, None], 10.0)
    assert (reached.tolist(), times.tolist()) == ([-1, -1], [0.0, 0.0])
    assert label(MODEL, [stand_in(ASYMMETRIC)], [], 10.0)[0].shape == (0,)
