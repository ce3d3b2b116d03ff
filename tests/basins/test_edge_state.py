"""Edge states: known saddle orbits, their multipliers from another integrator, lifetimes, and crossings."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import binomtest

from burridge_knopoff import (
    ContinuationSettings,
    EdgeSettings,
    InitialState,
    Model,
    MotionKind,
    Symmetry,
    edge_state,
    find_attractors,
    follow,
    label_states,
    limit_cycle,
    synchronized_orbit,
)
from burridge_knopoff.basins.edge_state import _leads_back
from burridge_knopoff.basins.edge_tracking import EdgeTrack
from burridge_knopoff.periodic_orbits.flow import OrbitError, flow
from burridge_knopoff.periodic_orbits.known_orbits import KnownOrbits
from tests.conftest import quick_first
from tests.refused import refused
from tests.scipy_flow import model_events

FEW = EdgeSettings(samples=100)


def coexisting(law, a, samples=24, starts=()):
    """Return a model and the attractors that sampled and given states reach."""
    model = Model(law, a=a)
    return model, find_attractors(model, samples=samples, transient=1000, window=1000, starts=starts)[0]


def is_periodic(attractor):
    return attractor.motion.kind == MotionKind.PERIODIC and attractor.motion.period < 100.0


def stops_of_first(orbit):
    """Return the states at the stops of the first block in a period, shape (stops, 6), sorted by the first position."""
    values = flow(orbit.model, orbit.reference, orbit.period).log.events.values()
    states = values[(values[:, 0] == 1) & (values[:, 1] == 0), 2:]
    return states[np.argsort(states[:, 0])]


def check_same(orbit, other):
    """Require that two orbits are the same, whatever their reference states."""
    assert orbit.stop_counts == other.stop_counts
    assert orbit.period == pytest.approx(other.period, rel=0, abs=1e-9)
    assert stops_of_first(orbit) == pytest.approx(stops_of_first(other), rel=0, abs=1e-9)


@pytest.fixture(scope="module")
def between_mirror_images():
    """Return the edge state between the two sides of a mirror pair, near the loss of synchrony, and the pair."""
    model, attractors = coexisting("nonlinear", 0.1)
    first, second = (item for item in attractors if item.symmetry == Symmetry.ASYMMETRIC)
    states = first.motion.state(), second.motion.state()
    return edge_state(model, *states, attractors, FEW, time_limit=20_000), attractors


def test_the_edge_state_between_mirror_images_is_the_synchronized_orbit(between_mirror_images):
    edge, _ = between_mirror_images
    assert (edge.kind, edge.symmetry) == (MotionKind.SYNCHRONIZED, Symmetry.SYNCHRONIZED)
    check_same(edge.orbit, synchronized_orbit(edge.model))
    assert edge.mean_distance == pytest.approx(0.0, abs=1e-12)


@pytest.mark.slow
def test_attractors_are_searched_for_if_none_are_given(between_mirror_images):
    edge, attractors = between_mirror_images
    states = [item.motion.state() for item in attractors if item.symmetry == Symmetry.ASYMMETRIC]
    check_same(edge_state(edge.model, *states, settings=FEW, time_limit=20_000).orbit, edge.orbit)


def test_multipliers_agree_with_another_integrator(between_mirror_images):
    """The others are 0, for perturbations that vanish at a stop, and 1, for that along the flow."""
    edge, _ = between_mirror_images
    orbit, step = edge.orbit, 1e-5
    start = orbit.reference
    columns = []
    for k in range(6):
        ends = []
        for side in (step, -step):
            vector = start.vector()
            vector[k] += side
            moved = replace(start, position=vector[:3], velocity=vector[3:])
            ends.append(model_events(edge.model, moved, orbit.period)[1])
        columns.append((ends[0] - ends[1]) / (2.0 * step))
    expected = np.sort(np.abs(np.linalg.eigvals(np.array(columns).T)))[::-1]
    assert not start.stuck.any()
    assert expected[1] == pytest.approx(1.0, abs=1e-6)
    moduli = np.abs(edge.multiplier)
    assert moduli[:2] == pytest.approx(np.delete(expected, 1)[:2], abs=1e-6)
    assert (moduli > 1.0).sum() == 1


def test_exponents_along_the_boundary_are_those_of_the_orbit(between_mirror_images):
    edge, _ = between_mirror_images
    rates = np.log(np.abs(edge.multiplier[:2])) / edge.orbit.period
    assert edge.exponent == pytest.approx([rates[0], 0.0, rates[1]], abs=0.01)
    assert edge.exponent[:2] == pytest.approx([rates[0], 0.0], abs=4.0 * edge.exponent_error[:2].max())
    assert edge.lifetime == pytest.approx(1.0 / rates[0])


def test_each_side_leads_to_one_of_the_two(between_mirror_images):
    edge, attractors = between_mirror_images
    assert sorted(map(len, edge.sides)) == [1, 1]
    (first,), (second,) = edge.sides
    assert attractors[first].partner == second
    assert edge.reached_count.sum(axis=1).tolist() == [100, 100]
    assert not edge.has_crossing
    assert edge.crossing_count.tolist() == [0, 0]
    interval = binomtest(0, 200).proportion_ci(0.95, "wilson")
    assert edge.crossing_share == pytest.approx((0.0, interval.low, interval.high), abs=1e-12)


def test_states_exactly_between_mirror_images_reach_neither(between_mirror_images):
    """The mean of a state and its mirror image stays symmetric and reaches no attractor, so it is ignored."""
    edge, attractors = between_mirror_images
    state = next(item for item in attractors if item.symmetry == Symmetry.ASYMMETRIC).motion.state()
    other = edge_state(edge.model, state, state.mirrored(), attractors, FEW, time_limit=5000)
    check_same(other.orbit, edge.orbit)


@pytest.mark.parametrize(
    ("a", "start", "stops", "saddle_stops", "crosses"),
    quick_first(
        [
            (0.23, InitialState("near", (-0.707, -0.645, -0.74), (0.0, 0.04, 0.043)), (1, 2, 1), (1, 1, 1), False),
            # Stable and unstable orbits are born together at a grazing.
            (0.1535, None, (8, 8, 5), (8, 8, 4), True),
        ],
        1,
    ),
)
def test_the_saddle_is_the_orbit_with_which_the_attractor_is_born(a, start, stops, saddle_stops, crosses):
    """Continued downward, the stable orbit becomes the saddle beyond a turning point."""
    model, attractors = coexisting("linearized", a, 60, [start] if start else [])
    orbits = {k: limit_cycle(model, item.motion.state()) for k, item in enumerate(attractors) if is_periodic(item)}
    index = next(k for k, orbit in orbits.items() if orbit.stop_counts == stops)
    branch = follow(
        orbits[index], (0.15, a), ContinuationSettings(largest_step=2e-3, max_orbits=400), upward=False, parameter="a"
    )
    assert (branch[0].multipliers.unstable_count, branch[-1].multipliers.unstable_count) == (0, 1)
    # The last orbit lies beyond a.
    saddle = KnownOrbits(branch[-2].orbit).at(a)
    assert saddle.stop_counts == saddle_stops
    other = next(k for k, item in enumerate(attractors) if k != index and item.partner == k)
    edge = edge_state(model, *(attractors[k].motion.state() for k in (index, other)), attractors, FEW)
    check_same(edge.orbit, saddle)
    assert (edge.kind, edge.symmetry) == (MotionKind.PERIODIC, Symmetry.ASYMMETRIC)
    assert edge.has_crossing == crosses


@pytest.mark.slow
def test_a_third_basin_may_lie_between_two():
    """The segment between the torus and the antiphase motion passes through the basin of synchrony."""
    model, attractors = coexisting("linearized", 0.05, 60)
    third, first, second = sorted(range(3), key=lambda k: attractors[k].motion.mean_distance)
    edge = edge_state(model, *(attractors[k].motion.state() for k in (first, second)), attractors, FEW)
    assert edge.sides == ({first}, {third})
    assert (edge.kind, edge.orbit) == (MotionKind.QUASIPERIODIC, None)
    assert edge.exponent[0] > 10.0 * np.abs(edge.exponent[1:]).max()
    assert edge.lifetime == pytest.approx(1.0 / edge.exponent[0])


@pytest.fixture(scope="module")
def near_loss():
    """Return the three attractors at a = 0.0425, in the order of ⟨J⟩, and the model."""
    model, attractors = coexisting("linearized", 0.0425, 60)
    order = sorted(range(3), key=lambda k: attractors[k].motion.mean_distance)
    return model, attractors, order


@pytest.mark.slow
def test_a_torus_on_a_fractal_boundary(near_loss):
    """Of 10 000 states displaced to either side, 2.0 and 2.6 % reach the attractor of the other side."""
    model, attractors, order = near_loss
    first, second = order[:2]
    edge = edge_state(model, *(attractors[k].motion.state() for k in (first, second)), attractors)
    assert (edge.kind, edge.symmetry, edge.has_crossing) == (MotionKind.QUASIPERIODIC, Symmetry.SYMMETRIC, True)
    assert edge.exponent[0] == pytest.approx(0.0128, abs=4.0 * edge.exponent_error[0])
    beyond = edge.reached_count[[0, 1], [second, first]]
    assert edge.crossing_count.tolist() == beyond.tolist()
    assert beyond == pytest.approx(500 * np.array([0.0202, 0.0264]), abs=3.0 * np.sqrt(500 * 0.0264))


@pytest.mark.slow
def test_a_crossing_counts_if_the_boundary_there_leads_back(near_loss):
    model, attractors, order = near_loss
    states = [attractors[k].motion.state() for k in order]
    edge = edge_state(model, *states[:2], attractors, FEW)

    def leads_back(first):
        """Return whether the boundary between one state and the next leads to the edge state of the first two."""
        pair = states[first], states[first + 1]
        track = EdgeTrack(model, attractors, np.arange(3) == order[first], *pair, 20_000.0, 3)
        return _leads_back(track, pair, 6000.0, edge.mean_distance)

    # The other two are separated by the orbit with (8, 0, 8) stops, with ⟨J⟩ = 0.166.
    assert [leads_back(first) for first in (0, 1)] == [True, False]


@pytest.fixture(scope="module")
def chaotic():
    """Return the edge state between the torus and chaos at a = 0.2, and the attractors."""
    model, attractors = coexisting("linearized", 0.2)
    by_mean = sorted(attractors, key=lambda item: item.motion.mean_distance)
    settings = EdgeSettings(samples=1000)
    return edge_state(model, *(item.motion.state() for item in by_mean), attractors, settings), attractors


@pytest.mark.slow
def test_a_chaotic_saddle(chaotic):
    edge, _ = chaotic
    assert (edge.kind, edge.symmetry, edge.orbit) == (MotionKind.CHAOTIC, Symmetry.SYMMETRIC, None)
    across, within, flow = edge.exponent
    assert across > 10.0 * within
    assert within > 4.0 * edge.exponent_error[1]
    assert flow == pytest.approx(0.0, abs=1e-3)
    # Trajectories leave the boundary much faster than they separate within it: the boundary is smooth.
    assert not edge.has_crossing


@pytest.mark.slow
def test_the_lifetime_is_that_of_displaced_states(chaotic):
    """A fraction exp(−τ/lifetime) of states displaced uniformly in all directions, within 1e-4, remains after τ."""
    edge, attractors = chaotic
    generator = np.random.default_rng(3)
    returns = edge.returns[generator.integers(len(edge.returns), size=1000)]
    returns[:, :3] += generator.uniform(-1e-4, 1e-4, (1000, 3))
    position, velocity = returns[:, :3] + edge.model.sliding_offset, np.abs(returns[:, 3:])
    labels, times = label_states(edge.model, attractors, position, velocity, time_limit=20_000)
    for side in (0, 1):
        left = np.sort(times[labels == side])
        tail = left[3 * len(left) // 4 :] - left[3 * len(left) // 4]
        error = np.hypot(tail.mean() / np.sqrt(len(tail)), edge.lifetime_error)
        assert edge.lifetime == pytest.approx(tail.mean(), abs=3.0 * error)
    assert edge.lifetime == pytest.approx(1.0 / edge.exponent[0], rel=0.15)


def test_smaller_radii_are_used_if_labels_contradict_each_other():
    model, attractors = coexisting("linearized", 0.08)
    states = [item.motion.state() for item in attractors[:2]]
    exact = edge_state(model, *states, attractors, FEW)
    wide = [replace(item, radius=0.06) for item in attractors]
    check_same(edge_state(model, *states, wide, FEW, time_limit=5000).orbit, exact.orbit)


def test_states_without_a_boundary_between_them_are_refused():
    model, attractors = coexisting("linearized", 0.08)
    first, second = (item.motion.state() for item in attractors[:2])
    with refused("state_b", "attractor 0"):
        edge_state(model, first, first, attractors)
    with refused("state_b", "20000"):
        edge_state(model, first, second, attractors[:1], time_limit=20_000)
    with pytest.raises(OrbitError, match="no state"):
        edge_state(model, first, second, attractors, time_limit=400)
