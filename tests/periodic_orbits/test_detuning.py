"""Orbits continued in the mass, spring or threshold of one block, without mirror symmetry, to the end of locking."""

import numpy as np
import pytest

from burridge_knopoff import (
    BifurcationKind,
    ChainState,
    Model,
    Symmetry,
    block_frequencies,
    follow,
    follow_bifurcation,
    limit_cycle,
    locate_bifurcations,
    simulate,
    synchronized_orbit,
)
from burridge_knopoff.periodic_orbits.following import ContinuationSettings
from tests.refused import refused
from tests.scipy_flow import model_events

WIDE = ContinuationSettings(first_step=1e-3, largest_step=1e-2)
MODEL = Model("linearized", a=0.06)


def end_of_synchrony(parameter, upward=True, model=MODEL):
    """Return the first bifurcation at which the synchronized orbit ends or loses stability."""
    branch = follow(
        synchronized_orbit(model),
        (0.5, 2.0),
        WIDE,
        parameter=parameter,
        upward=upward,
        is_complete=lambda points: points[-1].multipliers.unstable_count > 0,
    )
    return next(
        bifurcation
        for bifurcation in locate_bifurcations(branch)
        if bifurcation.loses_stability or not bifurcation.keeps_stability
    )


@pytest.fixture(scope="module")
def grazing():
    return end_of_synchrony("mass[3]")


@pytest.mark.parametrize("parameter", ["mass[3]", "coupling[1]", "threshold[1]", "pulling[3]", "weakening[3]"])
def test_a_parameter_of_one_end_block_breaks_the_symmetry(parameter):
    branch = follow(synchronized_orbit(MODEL), (0.999, 1.004), WIDE, parameter=parameter)
    assert all(point.orbit.symmetry == Symmetry.ASYMMETRIC for point in branch)
    orbit = branch[-1].orbit
    assert branch[-1].value > 1.001
    _, end = model_events(orbit.model, orbit.reference, orbit.period)
    assert end == pytest.approx(orbit.reference.vector(), abs=1e-8)


@pytest.mark.parametrize("parameter", ["mass[2]", "weakening[2]"])
def test_a_parameter_of_the_middle_block_keeps_the_symmetry(parameter):
    branch = follow(synchronized_orbit(MODEL), (0.9, 1.004), WIDE, parameter=parameter)
    assert all(point.orbit.symmetry == Symmetry.SYNCHRONIZED for point in branch)


def test_synchrony_ends_where_the_stick_of_the_lighter_block_vanishes(grazing):
    assert grazing.kind == BifurcationKind.GRAZING
    assert grazing.before.orbit.stop_counts == (1, 1, 1)
    assert grazing.after.orbit.stop_counts == (0, 1, 1)
    assert grazing.loses_stability
    assert not grazing.is_turning_point
    # The same chain, numbered from its other end.
    mirrored = end_of_synchrony("mass[1]")
    assert mirrored.value == pytest.approx(grazing.value, abs=1e-9)
    assert mirrored.before.orbit.stop_counts == (1, 1, 1)


def settled(model, orbit):
    start = ChainState(orbit.reference.position + 1e-4, orbit.reference.velocity, orbit.reference.stuck)
    return simulate(model, initial=start, transient=12000.0, window=2000.0, event_window=200.0)


@pytest.mark.slow
def test_runs_are_periodic_inside_the_tongue_and_not_outside(grazing):
    """Compare the motion 2e-4 to either side of the curve in the plane of a and mass[3]."""
    curve = follow_bifurcation(grazing, ("mass[3]", "a"), (0.05, 0.085), WIDE)
    assert curve.errors.max() < 1e-9
    for orbit, (mass, _) in list(zip(curve.orbits, curve.values, strict=True))[::3]:
        for side, inside in ((-2e-4, True), (2e-4, False)):
            run = settled(orbit.model.at(**{"mass[3]": float(mass) + side}), orbit)
            stops = run.event_time[(run.event_block == 1) & (run.event_kind == 0)]
            spread = np.ptp(np.diff(stops)) if len(stops) > 2 else np.inf
            assert (spread < 1e-5) == inside


def test_mean_frequencies_stay_equal_beyond_the_tongue_of_synchrony(grazing):
    """Beyond the end the motion is a torus with a third free phase: a common frequency alone is not locking."""
    orbit = grazing.before.orbit
    run = settled(orbit.model.at(**{"mass[3]": grazing.value + 5e-3}), orbit)
    frequency, _ = block_frequencies(run.model, run.final)
    assert frequency[2] == pytest.approx(frequency[0], abs=1e-6)


@pytest.mark.slow
def test_a_fold_in_the_mass_of_one_end_begins_at_the_pitchfork():
    """Above a_c two asymmetric orbits attract; that of the heavier leader ends at a fold, which is a cusp at a_c."""
    model = Model("linearized", a=0.09)
    orbit = synchronized_orbit(model)
    pushed = orbit.reference.position + np.array([1e-3, 0.0, -1e-3])
    start = ChainState(pushed, orbit.reference.velocity, orbit.reference.stuck)
    pair = limit_cycle(model, start, settling=6000.0)
    assert pair.symmetry == Symmetry.ASYMMETRIC
    # Longer steps would jump across the fold to the other orbit of the pair.
    short = ContinuationSettings(first_step=1e-5)
    (fold,) = [
        bifurcation
        for upward in (True, False)
        for bifurcation in locate_bifurcations(follow(pair, (0.999, 1.001), short, parameter="mass[3]", upward=upward))
        if bifurcation.kind == BifurcationKind.FOLD and bifurcation.loses_stability
    ]
    steps = ContinuationSettings(first_step=1e-4, largest_step=1e-3, smallest_step=1e-7)
    mass, a = follow_bifurcation(fold, ("mass[3]", "a"), (0.086, 0.092), steps).values.T
    assert a.min() == pytest.approx(0.08697290467, abs=1e-6)
    assert mass[a.argmin()] == pytest.approx(1.0, abs=1e-8)
    # Semicubical: the asymmetry of the pair grows as the root of a − a_c.
    inside = (a > 0.0871) & (a < 0.0905)
    assert inside.sum() >= 3
    slope = np.polyfit(np.log(a[inside] - 0.08697290467), np.log(np.abs(mass[inside] - 1.0)), 1)[0]
    assert slope == pytest.approx(1.5, abs=0.1)


def test_a_pitchfork_is_not_followed_without_symmetry():
    (pitchfork,) = locate_bifurcations(follow(synchronized_orbit(MODEL.at(a=0.0865)), (0.0865, 0.0875), parameter="a"))
    with refused("parameters", "mirror"):
        follow_bifurcation(pitchfork, ("a", "mass[3]"))
