"""Whether a run shows that its motion still changes, and the period of motion that is its own mirror image."""

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from burridge_knopoff import (
    ChainState,
    Model,
    MotionKind,
    hopf_bifurcations,
    limit_cycle,
    simulate,
    sweep,
)
from burridge_knopoff.motion.kind import CHAOS, is_same_result, motion_of_completed_run
from burridge_knopoff.motion.settings import MOTION
from burridge_knopoff.periodic_orbits.symmetry import Symmetry
from tests.motion.test_kind import run_of

LAWS = ("linearized", "nonlinear")


@cache
def grid_of_kinds(v, transient, window):
    grid = {"a": np.arange(0.01, 0.3, 0.02).round(2).tolist(), "initial": ["minus", "plus"], "v": v}
    return sweep([Model(law) for law in LAWS], **grid, transient=transient, window=window).kind.values


@pytest.mark.slow
@pytest.mark.parametrize(("transient", "window"), [(200.0, 500.0), (500.0, 500.0), (1000.0, 1000.0), (2000.0, 2000.0)])
@pytest.mark.parametrize("v", [0.1, 0.2])
def test_a_short_run_has_the_kind_of_a_long_one_or_none(transient, window, v):
    """Whether chaos lasts no single run can show."""
    short, long = grid_of_kinds(v, transient, window), grid_of_kinds(v, 20_000.0, 10_000.0)
    decided = ~np.isin(short, (*CHAOS, MotionKind.UNDETERMINED))
    assert np.mean(decided) > (0.2 if window < 1000.0 else 0.4)
    assert is_same_result(short, long)[decided].all()


@pytest.mark.parametrize("contact", ["one_sided", "symmetric"])
@pytest.mark.parametrize("law", LAWS)
def test_motion_that_approaches_synchrony_is_undetermined_until_it_is_there(law, contact):
    """Section points repeat to 1e-6 long before J is below 1e-6."""
    model = Model(law, a=0.08, v=0.1, contact=contact)
    runs = [simulate(model, initial="minus", transient=transient, window=500.0) for transient in (500.0, 1500.0)]
    assert [run.kind for run in runs] == [MotionKind.UNDETERMINED, MotionKind.SYNCHRONIZED]
    assert runs[0].mean_distance > 1e-6
    # In parts: the second half of the first run, from its own final state.
    later = simulate(model, initial=runs[0].final, transient=500.0, window=500.0)
    assert later.kind == MotionKind.SYNCHRONIZED


@pytest.mark.parametrize("law", LAWS)
def test_motion_that_leaves_synchrony_is_not_synchronized(law):
    """Above a_c a small antisymmetric displacement grows, which W does not show."""
    model = Model(law, a=0.12)
    settled = simulate(
        model, initial={"position": [-0.99] * 3, "velocity": [0.1, 0.1012, 0.1]}, transient=2000.0, window=10.0
    )
    assert settled.mean_distance == 0.0
    state = settled.final
    away = ChainState(state.position + 1e-11 * np.array([1.0, 0.0, -1.0]), state.velocity, state.stuck, state.time)
    run = simulate(model, initial=away, transient=0.0, window=400.0, lyapunov_exponents=0)
    assert run.batch_mean_distance[-1] > 2.0 * run.batch_mean_distance[0]
    assert run.mean_distance < MOTION.synchronization_threshold
    assert run.kind == MotionKind.UNDETERMINED
    assert (
        simulate(model, initial=state, transient=0.0, window=400.0, lyapunov_exponents=0).kind
        == MotionKind.SYNCHRONIZED
    )


@pytest.mark.parametrize(
    ("law", "a", "transient", "points"), [("nonlinear", 0.1825, 9000.0, 268), ("linearized", 0.08, 3000.0, 48)]
)
def test_the_period_of_a_symmetric_orbit_does_not_depend_on_what_is_recorded(law, a, transient, points):
    options = ({}, {"events": "all"}, {"event_window": 7000.0}, {"event_window": 2500.0})
    runs = [simulate(Model(law, a=a), "plus", transient=transient, **recorded) for recorded in options]
    orbit = limit_cycle(runs[0].model, runs[0].final)
    assert orbit.symmetry == Symmetry.SYMMETRIC
    for run in runs:
        motion = run.motion()
        assert (motion.kind, motion.section_period) == (MotionKind.PERIODIC, points)
        assert motion.period == pytest.approx(orbit.period, rel=1e-8)
    # Section points alone do not tell a state from its mirror image.
    none = simulate(Model(law, a=a), "plus", transient=transient, events="none", trajectory=0.0).motion()
    assert (none.kind, none.section_period, math.isnan(none.period)) == (MotionKind.PERIODIC, 0, True)
    # Half of the period is below the longest period, the period is not.
    longest = replace(MOTION, longest_period=0.75 * orbit.period)
    assert [run.motion(longest).kind for run in runs] == len(runs) * [MotionKind.QUASIPERIODIC]
    assert (
        simulate(Model(law, a=a), "plus", transient=transient, events="none", trajectory=0.0).motion(longest).kind == -1
    )


def test_the_trajectory_shows_the_period_where_no_events_are_kept():
    """Of orbits shorter than the trajectory: synchrony, its own mirror image after half a period, and neither."""
    for a, initial in ((0.08, "minus"), (0.1, "minus"), (0.29, "plus")):
        kept = simulate(Model("linearized", a=a), initial).motion()
        bare = simulate(Model("linearized", a=a), initial, events="none").motion()
        assert (bare.kind, bare.section_period) == (kept.kind, kept.section_period)
        assert bare.period == pytest.approx(kept.period, rel=1e-9)


@pytest.mark.parametrize("part", [0.5, 0.8, 1.0])
def test_chaos_that_has_just_ended_is_not_chaotic(part):
    """Section points at random up to a part of the window, then in a cycle of three."""
    velocity = np.random.default_rng(3).random(2000)
    end = int(part * len(velocity))
    velocity[end:] = np.resize([0.1, 0.2, 0.4], len(velocity) - end)
    run = run_of(velocity, np.zeros((2000, 3)), first_event=np.inf)
    run |= {"lyapunov_exponent": np.array([0.02, 0.0]), "lyapunov_error": np.full(2, 1e-3)}
    expected = {0.5: MotionKind.PERIODIC, 0.8: MotionKind.UNDETERMINED, 1.0: MotionKind.CHAOTIC}
    assert motion_of_completed_run(run, np.inf, MOTION).kind == expected[part]


@pytest.mark.parametrize(("last", "kind"), [(1.0, "PERIODIC"), (0.97, "UNDETERMINED"), (1.03, "UNDETERMINED")])
@pytest.mark.parametrize("batches", [2, 3, 6, 7])
def test_a_periodic_orbit_has_one_mean_distance_however_many_batches(last, kind, batches):
    """In 2000 section points of period 2 the means of two parts differ by 1 % at most."""
    run = run_of(np.resize([0.1, 0.2], 2000), np.zeros((2000, 3)))
    run |= {
        "event_kind": np.ones(2000),
        "batch_mean_distance": np.append(np.full(batches - 1, 0.1), 0.1 * last**batches),
    }
    run |= {"lyapunov_exponent": np.array([0.0, -0.01]), "lyapunov_error": np.full(2, 1e-4)}
    assert motion_of_completed_run(run, 0.1, MOTION).kind.name == kind


@pytest.mark.parametrize(("transient", "kind"), [(800.0, "UNDETERMINED"), (400_000.0, "SYNCHRONIZED")])
def test_synchrony_does_not_hide_an_amplitude_that_decays(transient, kind):
    """Next to the Hopf point two blocks in phase decay at a rate of 2e-5; ⟨J⟩ is 0."""
    law = {"formula": "1 - a*u + b*u**3"}
    model = Model(law, a=0.5, b=0.3, blocks=2, coupling=0.4, pulling=1, damping=0.05)
    critical = hopf_bifurcations(model, (0.4, 1.0), parameter="v")[-1]
    model = critical.model.at(v=critical.value * (1.0 - 2e-5))
    state = {"position": [0.02, 0.02], "velocity": [model.v] * 2}
    run = simulate(model, initial=state, transient=transient, window=760.0 + transient / 20.0)
    assert (run.mean_distance, run.kind.name) == (0.0, kind)
