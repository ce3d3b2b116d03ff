"""Periodic orbits with any stops, and their multipliers, compared with finite differences and long runs."""

from dataclasses import replace

import numpy as np
import pytest

from burridge_knopoff import Chain, ChainState, InitialState, Model, OrbitError, Symmetry, limit_cycle
from burridge_knopoff.periodic_orbits.floquet import multipliers
from burridge_knopoff.periodic_orbits.minimal_orbit import minimal_form
from burridge_knopoff.periodic_orbits.periodic import find_periodic_orbit, refine_orbit
from burridge_knopoff.periodic_orbits.return_map import ReturnMap, allowed_directions
from burridge_knopoff.running.runner import Runner
from burridge_knopoff.running.status import Status
from tests.refused import refused

SYNCHRONIZED, SYMMETRIC, ASYMMETRIC = Symmetry
PAPER, UNEVEN = Chain(3), Chain(3, coupling=(1.0, 2.0))
#: Chain, law, a, U(0) from which a long run ends on a periodic orbit, its symmetry and the stops of each block.
ORBITS = {
    "synchronized": (PAPER, "linearized", 0.05, (-0.989, -0.993, -0.991), SYNCHRONIZED, (1, 1, 1)),
    "symmetric": (PAPER, "linearized", 0.05, (-0.787, -0.661, -0.869), SYMMETRIC, (1, 0, 1)),
    "asymmetric": (PAPER, "linearized", 0.12, (-0.989, -0.993, -0.991), ASYMMETRIC, (6, 6, 3)),
    "two blocks": (Chain(2), "nonlinear", 0.2, (0.28, -0.72), SYMMETRIC, (1, 1)),
    "five blocks": (Chain(5), "linearized", 0.05, (0.68, 0.46, -0.21, 1.1, 0.4), SYMMETRIC, (33, 44, 0, 44, 33)),
    "uneven": (UNEVEN, "linearized", 0.05, (-1.15, -0.42, -1.22), ASYMMETRIC, (1, 0, 1)),
    "friction that drops": (PAPER, "carlson_langer", 0.15, (0.74, -0.17, -0.87), ASYMMETRIC, (4, 7, 7)),
}
#: U'(0) of all except the first.
VELOCITY = {"symmetric": (0.0, 0.101, 0.189)}


@pytest.fixture(scope="module")
def orbits():
    settled = {}
    for name, (chain, law, a, position, *_) in ORBITS.items():
        model = Model(law, a=a, chain=chain)
        velocity = VELOCITY.get(name, tuple(0.1 + 0.001 * k for k in range(chain.blocks)))
        end = Runner(model).state_after(model.begin(InitialState("one", position, velocity)), 20_000.0)
        settled[name] = limit_cycle(model, end)
    return settled


def displaced_return(orbit, direction, size):
    """Return the return of a state next to the reference of an orbit."""
    blocks = orbit.model.blocks
    vector = orbit.reference.vector() + size * direction
    start = ChainState(vector[:blocks], vector[blocks:], orbit.reference.stuck)
    return ReturnMap(orbit.model, orbit.symmetry).end(start, orbit.return_time).vector()


@pytest.mark.parametrize("name", ORBITS)
def test_the_orbit_of_a_settled_motion_returns_and_attracts(orbits, name):
    orbit = orbits[name]
    end = Runner(orbit.model).state_after(orbit.reference, orbit.period)
    assert np.abs(end.vector() - orbit.reference.vector()).max() < 1e-11
    assert orbit.residual < 1e-12
    assert (orbit.symmetry, orbit.stop_counts) == ORBITS[name][4:]
    assert (float(orbit.model.law(0.0)) < 1.0) == (name == "friction that drops")
    spectrum = multipliers(orbit)
    assert spectrum.unstable_count == 0
    assert len(spectrum.whole) == 2 * orbit.model.blocks - 1
    # The monodromy agrees with finite differences.
    basis = allowed_directions(orbit.reference.stuck, ASYMMETRIC)
    difference = [(displaced_return(orbit, d, 1e-6) - displaced_return(orbit, d, -1e-6)) / 2e-6 for d in basis.T]
    assert orbit.monodromy @ basis == pytest.approx(np.stack(difference, axis=1), rel=1e-5, abs=1e-6)


@pytest.mark.parametrize("name", ORBITS)
def test_the_reference_is_in_the_middle_of_the_longest_time_without_events(orbits, name):
    """The guess may be a stop, an event at either end of the longest time without events, or a state right after it."""
    orbit = orbits[name]
    times = np.array([time for time, _, _ in orbit.events])
    gaps = np.diff(times, append=times[0] + orbit.period)
    ends = [times[gaps.argmax()] + since + late for since in (0.0, gaps.max()) for late in (0.0, 1e-9)]
    guesses = [Runner(orbit.model).state_after(orbit.reference, time) for time in ends]
    for guess in (*guesses, *(orbit.start(block) for block in np.flatnonzero(orbit.stop_counts))):
        solution = find_periodic_orbit(orbit.model, guess, orbit.return_time, orbit.symmetry)
        around = [solution.events[0][0], solution.period - solution.events[-1][0]]
        assert around == pytest.approx([0.5 * gaps.max()] * 2, abs=1e-9)


@pytest.mark.parametrize("a", [0.02, 0.036, 0.08, 0.15, 0.3])
def test_the_symmetry_of_an_orbit_changes_none_of_its_multipliers(families, law, a):
    synchronized = families[law].at(a)
    orbit = find_periodic_orbit(synchronized.model, synchronized.reference, synchronized.period, ASYMMETRIC)
    assert orbit.period == pytest.approx(synchronized.period, abs=1e-11)
    spectrum, expected = multipliers(orbit), multipliers(synchronized)
    assert np.sort(np.abs(spectrum.whole)) == pytest.approx(np.sort(np.abs(expected.whole)), abs=1e-7)
    assert np.isnan(spectrum.transverse)


def test_how_long_blocks_stick(orbits):
    """Compare with a densely sampled run."""
    orbit = orbits["asymmetric"]
    times = np.linspace(0.0, orbit.period, 4001)
    runner = Runner(orbit.model)
    sticks = np.mean([runner.state_after(orbit.reference, float(time)).stuck for time in times[1:]], axis=0)
    assert [orbit.stick_time(block) for block in range(3)] == pytest.approx(sticks * orbit.period, abs=0.02)
    assert [orbits["symmetric"].stick_time(block) > 0.0 for block in range(3)] == [True, False, True]


def test_a_refined_orbit_is_solved_to_rounding(orbits):
    for orbit in orbits.values():
        refined = refine_orbit(orbit)
        assert refined.residual <= max(orbit.residual, 2e-14)
        assert refined.period == pytest.approx(orbit.period, abs=1e-10)


def test_uniform_sliding_is_not_an_orbit(families, law):
    """Uniform sliding returns after any time; Newton's method reaches it from a guess that returns too early."""
    model = families[law].at(0.08).model
    nearly = ChainState(np.array([1e-4, -1e-4, 1e-4]), np.full(3, model.v), np.zeros(3, dtype=bool))
    with pytest.raises(OrbitError, match="slides uniformly"):
        find_periodic_orbit(model, nearly, 1e-6, SYNCHRONIZED)


def test_the_half_of_a_symmetric_orbit_gives_the_whole(orbits):
    half = orbits["symmetric"]
    whole = find_periodic_orbit(half.model, half.reference, half.period, ASYMMETRIC)
    assert whole.period == pytest.approx(half.period, abs=1e-12)
    assert whole.stop_counts == half.stop_counts
    assert np.abs(multipliers(whole).whole) == pytest.approx(np.abs(multipliers(half).whole), abs=1e-11)
    assert half.start(0).mirrored().position == pytest.approx(half.start(2).position, abs=1e-12)


def test_an_orbit_traversed_twice_is_detected(orbits):
    half = orbits["symmetric"]
    twice = find_periodic_orbit(half.model, half.reference, 2.0 * half.period, ASYMMETRIC)
    reduced = minimal_form(twice, 1e-9)
    assert (reduced.symmetry, reduced.stop_counts) == (SYMMETRIC, half.stop_counts)
    assert minimal_form(half, 1e-9) is half
    synchronized = orbits["synchronized"]
    twice = find_periodic_orbit(synchronized.model, synchronized.reference, 2.0 * synchronized.period, SYNCHRONIZED)
    assert twice.stop_counts == (2, 2, 2)
    assert minimal_form(twice, 1e-9).period == pytest.approx(synchronized.period, abs=1e-12)
    # An orbit that is its mirror image after half a period is so after three halves as well, but not after two.
    thrice = find_periodic_orbit(half.model, half.reference, 3.0 * half.return_time, SYMMETRIC)
    assert thrice.stop_counts == (3, 0, 3)
    assert minimal_form(thrice, 1e-9).period == pytest.approx(half.period, abs=1e-12)


@pytest.mark.parametrize("name", ["synchronized", "symmetric"])
def test_an_asymmetric_chain_has_no_symmetric_orbit(orbits, name):
    """This holds even very close to a symmetric orbit."""
    even = orbits[name]
    model = replace(even.model, chain=Chain(3, coupling=(1.0, 1.0 + 1e-7)))
    uneven = find_periodic_orbit(model, even.reference, even.period, ASYMMETRIC)
    assert uneven.period == pytest.approx(even.period, abs=1e-5)
    assert minimal_form(uneven, 1e-4) is uneven


def test_an_orbit_starts_at_the_first_stop_of_a_block(orbits):
    orbit = orbits["asymmetric"]
    for block in range(3):
        runner = Runner(orbit.model)
        runner.begin(orbit.reference)
        assert runner.run(orbit.period, halting_block=block) == Status.HALTED
        start, stopped = orbit.start(block), runner.state()
        assert start.vector() == pytest.approx(stopped.vector(), abs=1e-12)
        assert start.stuck.tolist() == stopped.stuck.tolist()
        assert start.velocity[block] == 0.0


def test_guesses_that_do_not_lead_to_an_orbit_are_refused(orbits):
    orbit = orbits["asymmetric"]
    with refused("a = 0.12", "near", error=OrbitError):
        find_periodic_orbit(orbit.model, orbit.reference, 0.37 * orbit.period, ASYMMETRIC)
    with refused("symmetry: 'symmetric'"):
        find_periodic_orbit(orbits["uneven"].model, orbit.reference, orbit.period, SYMMETRIC)
    with pytest.raises(OrbitError, match="never stops"):
        orbits["symmetric"].start(1)
    with refused("a = 0.12", "within 20", error=OrbitError):
        limit_cycle(orbit.model, orbit.reference, window=20.0)


@pytest.mark.parametrize("name", ORBITS)
def test_forgotten_events_are_recomputed(orbits, name):
    orbit = orbits[name]
    rows, signature = orbit.event_rows, orbit.stop_counts
    orbit.forget_events()
    assert orbit.stop_counts == signature
    assert orbit.event_rows is not rows
    assert np.array_equal(orbit.event_rows, rows)
