"""A chain in other units is the same chain: its orbits scale and are found equally well and fast."""

import math

import numpy as np
import pytest

from burridge_knopoff import (
    Chain,
    InitialState,
    Model,
    follow,
    follow_bifurcation,
    limit_cycle,
    locate_bifurcations,
    multipliers,
    synchronized_orbit,
    transverse_exponent,
)
from burridge_knopoff.motion.synchronized_orbit import synchronized_orbits
from burridge_knopoff.periodic_orbits.pitchfork import branching_orbit
from burridge_knopoff.periodic_orbits.synchronized_bifurcations import (
    bifurcations_of,
    critical_a,
    finite_difference_multiplier,
    grazing_a,
)
from burridge_knopoff.running.runner import Runner
from tests.conftest import quick_first
from tests.refused import refused

#: Units of time and length, in those of the paper's chain.
UNITS = [(2.0**p, 2.0**q) for p, q in ((10, 10), (-9, -9), (-9, -18), (9, 18), (-5, 0), (5, 0), (0, -6), (3, -3))]


def paper(time=1.0, length=1.0, a=0.08, law="linearized"):
    """Return the paper's chain in other units of time and length, in which its forces are the same."""
    springs = 1.0 / length
    chain = Chain(3, coupling=springs, pulling=(springs, 2.0 * springs, springs), mass=time * time / length)
    return Model(law, a=a * time / length, chain=chain, v=0.1 * length / time)


def asymmetric_state(model, time, length):
    """Return a state of no symmetry."""
    position = tuple(length * x for x in (-0.9, -1.15, -1.0))
    return model.begin(InitialState("own", position, 0.1 * length / time))


@pytest.fixture(scope="module")
def branch():
    """Return a function that continues a branch of synchronized orbits, treated as asymmetric, in any units."""

    def followed(time=1.0, length=1.0):
        model = paper(time, length, 0.0865)
        orbit, slope = limit_cycle(model, synchronized_orbit(model).reference), time / length
        return follow(orbit, (0.086 * slope, 0.0875 * slope), parameter="a")

    return followed


@pytest.mark.parametrize("time", [2.0**10, 2.0**-9])
def test_the_synchronized_orbit_is_the_same_to_the_bit(time):
    """For units in which v and a have the same values; otherwise rounding differs."""
    paper_orbit, scaled_orbit = synchronized_orbit(paper()), synchronized_orbit(paper(time, time))
    assert scaled_orbit.period == paper_orbit.period * time
    assert (scaled_orbit.reference.position == paper_orbit.reference.position * time).all()
    assert (scaled_orbit.reference.velocity == paper_orbit.reference.velocity).all()
    assert multipliers(scaled_orbit).transverse == pytest.approx(multipliers(paper_orbit).transverse, abs=1e-14)


@pytest.mark.parametrize(
    ("time", "length", "law"),
    # The nonlinear law has an intrinsic speed.
    [(*units, "linearized") for units in UNITS] + [(2.0**10, 2.0**10, "nonlinear"), (2.0**-9, 2.0**-9, "nonlinear")],
)
def test_the_synchronized_orbit_scales(time, length, law):
    paper_orbit, scaled_orbit = synchronized_orbit(paper(law=law)), synchronized_orbit(paper(time, length, law=law))
    assert scaled_orbit.period / time == pytest.approx(paper_orbit.period, abs=1e-11)
    assert scaled_orbit.reference.position / length == pytest.approx(paper_orbit.reference.position, abs=1e-11)
    assert abs(multipliers(scaled_orbit).whole) == pytest.approx(abs(multipliers(paper_orbit).whole), abs=1e-10)
    assert finite_difference_multiplier(scaled_orbit) == pytest.approx(multipliers(paper_orbit).transverse, abs=1e-9)


def test_a_chain_a_thousand_times_as_slow_has_its_orbit():
    """Its springs are a thousand times softer and its blocks a thousand times heavier; a run gives the same period."""
    chain = Chain(3, coupling=0.001, pulling=(0.001, 0.002, 0.001), mass=1000.0)
    orbit = synchronized_orbit(Model("linearized", a=0.08, chain=chain))
    assert orbit.period == pytest.approx(1000.0 * synchronized_orbit(paper()).period, rel=1e-12)
    slow_orbit = limit_cycle(orbit.model, orbit.model.begin(InitialState("own", (-900.0, -1100.0, -900.0), 0.1)), 2e6)
    assert slow_orbit.period == pytest.approx(orbit.period, rel=1e-12)


@pytest.mark.parametrize("mass", [1.0, 2.0**-18])
def test_a_fast_chain_takes_no_longer(monkeypatch, mass):
    """It is hundreds of times as fast: a run of 4000 units of 1/ω would take a million periods."""
    times, run = [], Runner.run
    monkeypatch.setattr(Runner, "run", lambda runner, until: times.append(until) or run(runner, until))
    springs = 2.0**18
    chain = Chain(3, coupling=springs, pulling=(springs, 2.0 * springs, springs), mass=mass)
    orbit = synchronized_orbit(Model("carlson_langer", a=0.5, chain=chain))
    assert 5.0 < orbit.period * math.sqrt(springs / mass) < 7.0
    assert max(times) < 1000.0 * orbit.period


@pytest.mark.parametrize(("time", "length"), UNITS)
def test_an_orbit_that_a_motion_settles_on_scales(time, length):
    model = paper(time, length)
    scaled_orbit = limit_cycle(model, asymmetric_state(model, time, length), settling=4000.0 * time)
    paper_orbit = limit_cycle(paper(), asymmetric_state(paper(), 1.0, 1.0), settling=4000.0)
    assert (scaled_orbit.symmetry, scaled_orbit.stop_counts) == (paper_orbit.symmetry, paper_orbit.stop_counts)
    assert scaled_orbit.period / time == pytest.approx(paper_orbit.period, abs=1e-11)


@pytest.mark.parametrize(("time", "length"), quick_first(UNITS[2:], 3))
def test_a_branch_scales(branch, time, length):
    paper_branch, scaled_branch = branch(), branch(time, length)
    assert len(scaled_branch) == len(paper_branch)
    for first, second in zip(paper_branch, scaled_branch, strict=True):
        assert second.orbit.a * length / time == pytest.approx(first.orbit.a, abs=1e-9)
        assert second.orbit.period / time == pytest.approx(first.orbit.period, abs=1e-9)
        assert second.grazing_distances.in_own_units(second.orbit.model.chain.own_units) == pytest.approx(
            first.grazing_distances.values(), rel=1e-6
        )
    (pitchfork,), (scaled_pitchfork,) = locate_bifurcations(paper_branch), locate_bifurcations(scaled_branch)
    assert scaled_pitchfork.kind == pitchfork.kind
    assert scaled_pitchfork.a * length / time == pytest.approx(pitchfork.a, abs=1e-10)
    curve = follow_bifurcation(scaled_pitchfork, ("a", "v"), (0.0999 * length / time, 0.1001 * length / time))
    assert curve.values[:, 0] * length / time == pytest.approx(scaled_pitchfork.a * length / time, abs=1e-9)
    along = (
        follow(points[0].orbit, (0.95 / size, 1.0 / size), parameter="coupling", upward=False)
        for points, size in ((paper_branch, 1.0), (scaled_branch, length))
    )
    first, second = ([point.value for point in points] for points in along)
    assert np.array(second) * length == pytest.approx(np.array(first), abs=1e-7)
    damping = (
        follow(points[0].orbit, (0.0, 1e-3 * size), parameter="pulling_damping")
        for points, size in ((paper_branch, 1.0), (scaled_branch, time / length))
    )
    first, second = ([point.value for point in points] for points in damping)
    assert np.array(second) * length / time == pytest.approx(np.array(first), abs=1e-9)


@pytest.mark.parametrize(("time", "length"), quick_first([(2.0**-9, 2.0**-18), (2.0**10, 2.0**10), (8.0, 0.125)], 1))
def test_bifurcations_of_the_synchronized_orbit_scale(time, length):
    values = []
    for units in ((1.0, 1.0), (time, length)):
        orbits = synchronized_orbits(paper(*units))
        bifurcations, slope = bifurcations_of(orbits), units[0] / units[1]
        critical = critical_a(bifurcations)
        beyond = branching_orbit(orbits.at(critical), 1e-3 * units[1])
        values.append([critical / slope, grazing_a(bifurcations, 1) / slope, (beyond.a - critical) / slope * 1e4])
    assert values[1] == pytest.approx(values[0], abs=1e-8)


@pytest.mark.parametrize(("time", "length"), UNITS)
def test_a_transverse_exponent_scales(time, length):
    model = paper(time, length)
    expected = np.array(transverse_exponent(paper(), asymmetric_state(paper(), 1.0, 1.0)))
    state = asymmetric_state(model, time, length)
    for times in ((), (200.0 * time, 2500.0 * time)):
        assert np.array(transverse_exponent(model, state, *times)) * time == pytest.approx(expected, abs=1e-10)
    with refused("window"):
        transverse_exponent(model, state, window=49.0 * time)
