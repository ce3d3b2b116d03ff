"""Periods of section points and kinds of motion."""

from dataclasses import astuple, replace

import numpy as np
import pytest

from burridge_knopoff import ChainState, Model, MotionKind, simulate
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.motion.classification import Classifier
from burridge_knopoff.motion.kind import Motion, format_motion, motion_of_completed_run, motion_of_run
from burridge_knopoff.motion.observables import observe
from burridge_knopoff.motion.period import repetition_length, repetition_of
from burridge_knopoff.motion.settings import MOTION
from tests.flows import weakly_repelling

QUASIPERIODIC = np.cos(np.pi * (np.sqrt(5) - 1) * np.arange(2000))


@pytest.mark.parametrize("period", [1, 2, 3, 7, 40])
def test_period_of_a_repeating_sequence(period):
    random = np.random.default_rng(period)
    section = np.tile(random.normal(size=period), 400 // period)
    assert repetition_length(section, 1e-6, 60) == period
    assert repetition_length(section + 1e-9 * random.normal(size=len(section)), 1e-6, 60) == period
    assert repetition_length(section + 1e-3 * random.normal(size=len(section)), 1e-6, 60) == 0
    # The longest allowed period, observed just often enough.
    assert repetition_length(section[: 3 * period], 1e-6, period) == period


def test_quasiperiodic_and_short_sequences_have_no_period():
    drift = 1.0 + 1e-7 * np.arange(400)
    for section in (QUASIPERIODIC, np.array([]), np.array([1.0, 1.0]), np.tile(np.arange(70.0), 20), drift):
        assert repetition_length(section, 1e-6, 60) == 0


def run_of(velocity, states, first_event=0.0, falling=False):
    """Return a run with section points at τ = 0, 1, … and an event with a state a little later than each of them."""
    time = np.arange(float(len(velocity)))
    events = time[time >= first_event] + 0.25
    states = np.asarray(states, dtype=float)[time >= first_event]
    return {
        "crossing_velocity": np.asarray(velocity, dtype=float),
        "crossing_time": time,
        "crossing_direction": np.full(len(velocity), -1 if falling else 1),
        "event_time": events,
        "event_position": states,
        "event_velocity": 0.5 * states,
        "event_block": np.ones(len(events), dtype=int),
        "event_kind": np.zeros(len(events), dtype=int),
        "batch_mean_distance": np.full(7, 0.1),
        "trajectory_time": np.zeros(0),
        "position": states[:0],
        "velocity": states[:0],
    }


def section_period(run, settings=MOTION, mean_distance=np.inf):
    return repetition_of(run, mean_distance, settings).points


def test_returning_as_the_mirror_image_is_not_a_return():
    """W' repeats after three points, the state of all blocks after six: three points lead to the mirror image."""
    velocity = np.tile([1.0, 2.0, 3.0], 60)
    turn = np.array([[0.1, 0.0, 0.4], [0.2, 0.0, 0.5], [0.3, 0.0, 0.6]])
    states = np.tile(np.concatenate([turn, turn[:, ::-1]]), (30, 1))
    assert section_period(run_of(velocity, states)) == 6
    assert section_period(run_of(velocity, np.tile(turn, (60, 1)))) == 3
    # Positions alone show the period, and so do velocities alone.
    run = run_of(velocity, np.tile(turn, (60, 1)))
    for name in ("event_position", "event_velocity"):
        assert section_period({**run, name: states}) == 6
    # Downward crossings are not section points.
    assert section_period(run_of(velocity, states, falling=True)) == 0
    # States that drift although W' repeats, states that are stored only from late on, and no states at all.
    drifting = states + 1e-4 * np.arange(180.0)[:, None]
    assert section_period(run_of(velocity, drifting)) == 0
    assert section_period(run_of(velocity, states, first_event=150.0)) == 6
    assert section_period(run_of(velocity, states, first_event=1e9)) == 3
    # More than one cycle of states shows the mirror image.
    for first in (165.0, 172.0, 175.0):
        assert section_period(run_of(velocity, states, first_event=first)) == 6
    assert section_period(run_of(velocity, np.tile(turn, (60, 1)), first_event=175.0)) == 3
    assert section_period(run_of(velocity, drifting, first_event=172.0)) == 0
    # With fewer, the period of a symmetric chain is 3 or 6, unless its end blocks move as one.
    for distance, longest, expected in (
        (0.1, 20, (3, np.nan, 0.0)),
        (1e-9, 20, (3, 3.0, 0.0)),
        (0.1, 5, (3, np.nan, np.inf)),
    ):
        few = run_of(velocity, states, first_event=177.0)
        found = repetition_of(few, distance, replace(MOTION, longest_period=longest))
        np.testing.assert_equal(astuple(found), expected)
    # Nor is a period longer than the longest one searched for.
    assert section_period(run_of(velocity, states), replace(MOTION, longest_period=5)) == 0


def test_a_slow_approach_does_not_hide_a_period():
    assert section_period(run_of(1.0 + 0.5 ** np.arange(1000), np.ones((1000, 3)))) == 1


def test_kinds_in_words():
    assert MotionKind.TRANSIENT_CHAOS.words == "transient chaos"


@pytest.mark.parametrize(
    ("mean_distance", "period", "exponents", "error", "kind"),
    [
        (1e-9, 1, (0.0, -0.01), 1e-5, MotionKind.SYNCHRONIZED),
        (0.1, 3, (1e-4, -1e-4), 1e-5, MotionKind.PERIODIC),
        (0.1, 0, (1e-4, -0.01), 1e-5, MotionKind.QUASIPERIODIC),
        (1e-9, 0, (1e-4, -0.01), 1e-5, MotionKind.SYNCHRONIZED),
        (0.1, 0, (1e-4, -1e-4), 1e-5, MotionKind.QUASIPERIODIC),
        # With errors larger than the exponents of chaos, only a repetition is conclusive.
        (0.1, 0, (1e-4, -0.01), 1e-2, MotionKind.UNDETERMINED),
        (0.1, 3, (1e-4, -0.01), 1e-2, MotionKind.PERIODIC),
        (0.1, 0, (1e-4, -0.01), 0.9e-3, MotionKind.QUASIPERIODIC),
        (0.1, 0, (1e-4, -0.01), 1.1e-3, MotionKind.UNDETERMINED),
        (0.1, 0, (2.3e-2, -3e-3), 1e-2, MotionKind.UNDETERMINED),
        (0.1, 0, (0.02, 0.0), 1e-3, MotionKind.CHAOTIC),
        (1e-9, 0, (0.02, 0.0), 1e-3, MotionKind.SYNCHRONIZED_CHAOS),
        # Motion that repeats is periodic, also on an unstable orbit.
        (1e-9, 1, (0.02, 0.0), 1e-3, MotionKind.SYNCHRONIZED),
        (0.1, 2, (0.02, 0.0), 1e-3, MotionKind.PERIODIC),
        # Uniform sliding: its section points are rounding.
        (0.1, 2, (-0.01, -0.02), 1e-5, MotionKind.SLIDING),
        (0.1, 2, (-0.01, -0.02), 1e-2, MotionKind.PERIODIC),
        # Weak chaos or regular motion: the error allows both, unless the exponent is at most that of regular motion.
        (0.1, 0, (2e-3, -0.01), 1e-3, MotionKind.UNDETERMINED),
        (0.1, 0, (6e-4, -0.01), 1e-3, MotionKind.UNDETERMINED),
        (0.1, 0, (4e-4, -0.01), 1e-3, MotionKind.QUASIPERIODIC),
        (0.1, 0, (9e-4, -0.01), 1e-5, MotionKind.UNDETERMINED),
        (0.1, 0, (2e-3, 0.0), 1e-3, MotionKind.UNDETERMINED),
        (0.1, 0, (6e-4, 0.0), 1e-3, MotionKind.UNDETERMINED),
        (0.1, 0, (4e-4, 0.0), 1e-3, MotionKind.QUASIPERIODIC),
        # Motion that repeats, with an error that allows chaos: the cycles decide.
        (0.1, 3, (9e-4, 0.0), 1e-3, MotionKind.PERIODIC),
        # End blocks that move as one are synchronized on a torus too, unless the motion may be chaotic.
        (1e-9, 0, (0.0, -9e-4), 1e-3, MotionKind.SYNCHRONIZED),
        (1e-9, 0, (0.0, -1e-5), 1e-5, MotionKind.SYNCHRONIZED),
        (1e-9, 0, (0.0, -9e-4), 1.1e-3, MotionKind.UNDETERMINED),
        (1e-9, 0, (6e-4, 0.0), 1e-3, MotionKind.UNDETERMINED),
        (0.1, 0, (0.0, -1.1e-3), 1e-3, MotionKind.QUASIPERIODIC),
        (0.1, 0, (-0.01, -0.02), 1e-5, MotionKind.SLIDING),
        # Without exponents, only a repetition of the section points is conclusive.
        (0.1, 5, (), 1e-5, MotionKind.PERIODIC),
        (0.1, 0, (), 1e-5, MotionKind.UNDETERMINED),
        (0.1, 0, (np.nan, np.nan), np.nan, MotionKind.UNDETERMINED),
        (1e-9, 1, (np.nan, np.nan), np.nan, MotionKind.SYNCHRONIZED),
        (0.1, 0, (0.0,), 1e-5, MotionKind.UNDETERMINED),
        # With an unknown error neither chaos nor its absence is shown.
        (0.1, 0, (0.0079, -0.0009), np.nan, MotionKind.UNDETERMINED),
        (0.1, 0, (-0.0079, -0.009), np.nan, MotionKind.UNDETERMINED),
        (0.1, 3, (-0.0079, -0.009), np.nan, MotionKind.PERIODIC),
        # The errors of the first two exponents, whose values decide, must be small; that of a third has no effect.
        (0.1, 0, (1e-4, -0.05, -0.1), (1e-5, 1e-5, 1e-2), MotionKind.QUASIPERIODIC),
        (0.1, 0, (1e-4, -0.05, -0.1), (1e-5, 1e-2, 1e-5), MotionKind.UNDETERMINED),
        (0.1, 0, (1e-4, -0.05, -0.1), (1e-2, 1e-5, 1e-5), MotionKind.UNDETERMINED),
        # Each exponent is judged by its own error.
        (0.1, 0, (2e-3, 0.0), (1e-4, 1e-3), MotionKind.CHAOTIC),
        (0.1, 0, (2e-3, 0.0), (1e-3, 1e-4), MotionKind.UNDETERMINED),
    ],
)
def test_kinds(mean_distance, period, exponents, error, kind):
    """The error is common to all exponents or one for each; periods are counted in section points."""
    assert motion_with(mean_distance, period, exponents, error).kind == kind


def motion_with(mean_distance, period, exponents, error, settings=MOTION, points=2000):
    """Return the motion of a run with section points at τ = 0, 1, … and without events."""
    turn = 1.0 + 0.1 * np.sin(np.sqrt(2.0) * np.arange(period or points))
    run = run_of(np.resize(turn, points), np.zeros((points, 3)), first_event=np.inf)
    exponents = np.array(exponents, dtype=float)
    run |= {"lyapunov_exponent": exponents, "lyapunov_error": np.broadcast_to(error, len(exponents))}
    # Without states only a chain that is not its own mirror image has a known period.
    return motion_of_completed_run(run, mean_distance if mean_distance < 1e-6 else np.inf, settings)


REGULAR = (0.1, (0.0, -1e-5), 1e-5)


@pytest.mark.parametrize(("period", "kind"), [(5, "PERIODIC"), (6, "QUASIPERIODIC"), (0, "QUASIPERIODIC")])
@pytest.mark.parametrize("points", [40, 400, 4000])
def test_the_longest_period_decides_whatever_the_window(period, kind, points):
    mean, *exponents = REGULAR
    motion = motion_with(mean, period, *exponents, replace(MOTION, longest_period=5.0), points)
    assert motion.kind.name == kind
    assert motion.section_period == (5 if kind == "PERIODIC" else 0)


def test_stops_show_a_longer_period():
    """The motion is locked: it has not left its periodic orbit, but no period is observed within a run."""
    states = np.tile(np.random.default_rng(5).random((50, 3)), (12, 1))
    run = run_of(states[:, 0], states) | {"lyapunov_exponent": np.zeros(2), "lyapunov_error": np.full(2, 1e-5)}
    motion = motion_of_completed_run(run, 0.1, replace(MOTION, longest_period=40.0))
    assert motion == Motion(MotionKind.QUASIPERIODIC, 0, 50.0)
    assert not motion.can_be_periodic
    assert motion_of_completed_run(run, 0.1, MOTION) == Motion(MotionKind.PERIODIC, 50, 50.0)
    # The states of the last events cover too short a time to show it.
    late = run_of(states[:, 0], states, first_event=400.0)
    assert np.isnan(repetition_of(late, np.inf, replace(MOTION, longest_period=40.0)).period)


def test_an_approach_that_circles_its_limit_has_no_period():
    """A multiplier close to a root of 1 brings it back to where it was, but closer: this is not a period."""
    k = np.arange(600.0)
    approach = 1.0 + 1e-6 * np.exp(-1e-3 * k) * np.cos(2.0 * np.pi * k / 88.0)
    assert repetition_length(approach, 1e-6, 200) == 0
    assert repetition_length(1.0 + 0.1 * (approach - 1.0), 1e-6, 200) == 1


@pytest.mark.parametrize(
    ("motion", "words"),
    [
        (Motion(MotionKind.PERIODIC, 48, 157.2), "periodic, repeats after 48 section points"),
        (
            Motion(MotionKind.SYNCHRONIZED, 1, 5.7, unstable=True),
            "unstable synchronized, repeats after 1 section point",
        ),
        (Motion(MotionKind.QUASIPERIODIC), "quasiperiodic within 2000 time units"),
        (
            Motion(MotionKind.QUASIPERIODIC, 0, 28991.98),
            "quasiperiodic within 2000 time units; locked with a period of 28992",
        ),
        (Motion(MotionKind.SYNCHRONIZED_CHAOS), "synchronized chaos"),
    ],
)
def test_a_motion_in_words(motion, words):
    assert format_motion(motion, MOTION) == words


@pytest.mark.parametrize(("points", "kind"), [(2, MotionKind.PERIODIC), (3, MotionKind.PERIODIC)])
def test_stops_show_a_period_that_section_points_do_not(points, kind):
    run = run_of(np.arange(points), np.ones((points, 3)))
    averages = {
        "status": "completed",
        "mean_distance": 0.1,
        "lyapunov_exponent": np.zeros(0),
        "lyapunov_error": np.zeros(0),
    }
    states = np.tile([[0.1, 0.2, 0.3], [0.4, 0.5, 0.6]], (20, 1))
    stops = {"event_position": states, "event_velocity": states, "event_time": np.arange(40.0)}
    stops |= {"event_block": np.tile([2, 3], 20), "event_kind": np.zeros(40, dtype=int)}
    assert motion_of_run({**run, **averages, **stops}, True, MOTION).kind == kind


@pytest.mark.parametrize("name", ["period_tolerance", "zero_exponent", "chaotic_exponent"])
def test_motion_under_a_slow_driver_is_smaller_and_slower(name):
    default = getattr(MOTION, name)
    assert [getattr(MOTION.scaled_to_velocity(v), name) / default for v in (0.1, 10.0, 0.01)] == [
        1.0,
        1.0,
        pytest.approx(0.1),
    ]
    assert MOTION.scaled_to_velocity(0.01).longest_period == pytest.approx(10.0 * MOTION.longest_period)
    assert MOTION.scaled_to_velocity(0.01).synchronization_threshold == MOTION.synchronization_threshold


@pytest.mark.parametrize(
    ("period", "exponents", "error", "unstable"),
    [
        (1, (0.02, 0.0), 1e-3, True),
        (0, (0.02, 0.0), 1e-3, False),
        (1, (0.02, 0.0), 1e-2, False),
        (3, (9e-4, 0.0), 1e-6, False),
        (3, (), 1.0, False),
        (3, (np.nan,), np.nan, False),
    ],
)
def test_a_run_may_stay_on_an_unstable_orbit(period, exponents, error, unstable):
    assert motion_with(0.1, period, exponents, error).unstable is unstable


@pytest.mark.parametrize(
    ("growth", "kind"),
    [
        # Cycle by cycle: a repelling orbit, an attracting orbit, and a distance of rounding errors.
        (1.01, MotionKind.UNDETERMINED),
        (-1.01, MotionKind.UNDETERMINED),
        (0.99, MotionKind.PERIODIC),
        (-0.99, MotionKind.PERIODIC),
        (1.001, MotionKind.PERIODIC),
    ],
)
def test_motion_that_leaves_an_orbit_is_not_periodic(growth, kind):
    """The fate of a run whose cycles diverge is undetermined, however close it passes."""
    size = 1e-12 if growth == 1.001 else 1e-7
    away = size * float(growth) ** (np.arange(700.0) - (700.0 if abs(growth) > 1.0 else 0.0))
    run = run_of(0.2 + np.repeat(away, 3) + np.tile([0.0, 0.3, 0.1], 700), np.zeros((2100, 3)), first_event=np.inf)
    exponents = {"lyapunov_exponent": np.array([4e-4, 1e-4]), "lyapunov_error": np.full(2, 3e-4)}
    assert motion_of_completed_run(run | exponents, 0.1, MOTION).kind == kind
    strong = {"lyapunov_exponent": np.array([0.02, 1e-4]), "lyapunov_error": np.full(2, 3e-4)}
    expected = kind if kind == MotionKind.PERIODIC else MotionKind.CHAOTIC
    assert motion_of_completed_run(run | strong, 0.1, MOTION).kind == expected


@pytest.mark.parametrize("cycles", [6, 9, 40])
@pytest.mark.parametrize("exponent", [4e-4, 9e-4])
@pytest.mark.parametrize("growth", [0.7, 1.3, 3.0])
def test_motion_that_repeats_at_its_stops_may_leave_its_orbit(growth, exponent, cycles):
    """Section points are rare; few cycles are seen. An exponent above its threshold allows no growth."""
    orbit = np.random.default_rng(5).random((50, 3))
    away = np.repeat(1e-8 * growth ** np.linspace(0.0, 1.0, cycles), 50)[:, None]
    states = np.tile(orbit, (cycles, 1)) + away * np.where(np.arange(cycles).repeat(50) % 2, 1.0, -1.0)[:, None]
    run = run_of(states[:, 0], states) | {"crossing_direction": np.full(len(states), -1)}
    run |= {"lyapunov_exponent": np.array([exponent, -1e-5]), "lyapunov_error": np.full(2, 8e-4)}
    motion = motion_of_completed_run(run, 0.1, MOTION)
    leaves = growth > (1.0 if exponent > MOTION.zero_exponent else 2.0)
    expected = Motion(MotionKind.UNDETERMINED) if leaves else Motion(MotionKind.PERIODIC, 0, 50.0)
    np.testing.assert_equal(astuple(motion), astuple(expected))


@pytest.mark.parametrize("away", [1e-11, 1e-10])
def test_weak_chaos_next_to_an_unstable_orbit_is_not_periodic(away):
    """The run repeats to 1e-6 throughout; its largest exponent, 7e-4, is within its error."""
    orbit = weakly_repelling()
    start = orbit.reference
    run = simulate(orbit.model, initial=ChainState(start.position + away, start.velocity, start.stuck))
    assert section_period(vars(run)) == 13
    assert motion_of_run(vars(run), True, MOTION).kind == MotionKind.UNDETERMINED


def test_weak_chaos_is_not_regular_if_its_exponent_says_otherwise():
    """The first run stays within 1e-5 of an orbit with multiplier 1.11 over a period of 149; others pass as a torus."""
    model = Model("linearized", a=0.1325)
    start = model.begin(PAPER_STATES["minus"])
    generator = np.random.default_rng(1)
    shifts = [1e-11 * np.array([1.0, -0.3, 0.4]), *1e-10 * generator.normal(size=(11, 3))]
    for index, shift in enumerate(shifts):
        state = ChainState(start.position + shift, start.velocity, start.stuck)
        motion = observe(model, state, 20_000.0, 3000.0, MOTION)
        assert motion.kind not in (MotionKind.PERIODIC, MotionKind.QUASIPERIODIC) or motion.exponent[0] < 5e-4
        if index < 3:
            # Longer windows decide.
            assert Classifier(model, 20_000.0, 3000.0, MOTION).measure(state).kind == MotionKind.CHAOTIC


def test_stable_uniform_sliding_is_not_periodic_motion():
    """Friction increases with speed there; the crossings of W = 0 are rounding errors."""
    model = Model("stribeck", a=0.3, v=0.5)
    run = simulate(model, initial="plus", transient=2000.0, window=2000.0)
    assert run.lyapunov_exponent[0] < -0.01
    motion = motion_of_run(vars(run), True, MOTION)
    assert (motion.kind, motion.section_period) == (MotionKind.SLIDING, 0)
    assert motion_of_run(vars(run) | {"event_time": np.ones(1)}, True, MOTION).kind == MotionKind.UNDETERMINED


def test_motion_that_repeats_without_section_points_is_periodic():
    """Of two blocks W stays above 0, and the orbit belongs to a family, so that the second exponent is 0."""
    start = {"position": [0.5, -1.0], "velocity": [0.05, 0.05]}
    run = simulate(Model("nonlinear", a=3.0, blocks=2, v=0.05), initial=start, transient=2000.0, window=2000.0)
    assert not len(run.crossing_time)
    assert motion_of_run(vars(run), True, MOTION).kind == MotionKind.PERIODIC
