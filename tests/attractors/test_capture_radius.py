"""Capture radii of constructed sets, with scripted results of the perturbed trajectories."""

from dataclasses import replace

import numpy as np
import pytest

from burridge_knopoff import Chain, ChainState, Model, MotionKind, SearchSettings, law_of
from burridge_knopoff.attractors import capture_radius as radius
from burridge_knopoff.attractors import slow_set
from burridge_knopoff.attractors.attractor import perturb, required_returns
from burridge_knopoff.attractors.capture_radius import Capture, embedded_orbits
from burridge_knopoff.attractors.labels import label
from burridge_knopoff.attractors.slow_set import sample_slow_set
from tests.motion.stand_in import ASYMMETRIC, at, section, stand_in

MODEL = Model(Chain(3), law_of("linearized", 0.08), 0.2)
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


@pytest.fixture
def capture(monkeypatch):
    """Return a function that determines a radius with scripted labels for each group of perturbed trajectories."""

    def captures(listed, index, reached, least=1e-5):
        calls, left = [], iter(reached)

        def label(_, attractors, starts, time_limit, *__):
            assert time_limit == 900.0
            calls.append((len(starts), [item.radius for item in attractors], attractors[index].patience))
            return np.array((next(left) * 4)[: len(starts)]), None

        monkeypatch.setattr(radius, "label", label)
        monkeypatch.setattr(radius, "perturb", lambda start, size, generator: (start, size))
        monkeypatch.setattr(radius, "advance", lambda model, starts, time: [*starts, time])
        size = Capture().find_radius(MODEL, listed, index, least, 1e-6, SETTINGS)
        assert len(calls) == len(reached)
        return size, calls

    return captures


def test_a_radius_is_accepted_if_all_perturbed_trajectories_come_back(capture):
    attractors = [at(0.0, radius=0.04), at(9.0, radius=0.001)]
    size, calls = capture(attractors, 0, [[0], [0]])
    assert size == 0.04
    # Four of ten trajectories are followed first; each has to come back to a tenth of the distance.
    assert calls == [(count, [pytest.approx(0.004), 0.001], 0.0) for count in (4, 6)]
    assert capture(attractors, 0, [[0], [0, 0, 0, -1], [0], [0]])[0] == 0.02
    assert capture(attractors, 0, [[1], [1]], least=0.01)[0] == 0.0
    # The smallest radius scales with v: a factor of 2.
    assert capture(attractors, 0, [[1], [0], [0]], least=0.01)[0] == 0.02
    assert capture(attractors, 0, [[1]], least=0.0101)[0] == 0.0


def test_a_trajectory_that_reaches_an_embedded_orbit_has_come_back(capture):
    attractors = [at(0.0, radius=0.04, patience=2000.0, **CHAOS), at(0.05, radius=0.04)]
    size, calls = capture(attractors, 0, [[0, 1], [1]])
    assert size == 0.04
    # Its returns are too far apart to show that a trajectory comes closer: it is labelled later.
    assert calls[0] == (5, [0.04, 0.04], 0.0)
    assert capture(attractors, 1, [[0]], least=0.015)[0] == 0.0


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
