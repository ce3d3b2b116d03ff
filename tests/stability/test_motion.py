"""Periods of section points and kinds of motion."""

from dataclasses import replace

import numpy as np
import pytest

from burridge_knopoff import Chain, Model, MotionKind, law_of, simulate
from burridge_knopoff.stability.motion import (
    is_unstable,
    motion_kind,
    motion_of_run,
    repetition,
    section_closed,
    section_period,
)
from burridge_knopoff.stability.settings import MOTION

QUASIPERIODIC = np.cos(np.pi * (np.sqrt(5) - 1) * np.arange(2000))


@pytest.mark.parametrize("period", [1, 2, 3, 7, 40])
def test_period_of_a_repeating_sequence(period):
    random = np.random.default_rng(period)
    section = np.tile(random.normal(size=period), 400 // period)
    assert repetition(section, 1e-6, 60) == period
    assert repetition(section + 1e-9 * random.normal(size=len(section)), 1e-6, 60) == period
    assert repetition(section + 1e-3 * random.normal(size=len(section)), 1e-6, 60) == 0
    # As long as it may be, and seen just often enough.
    assert repetition(section[: 3 * period], 1e-6, period) == period


def test_quasiperiodic_and_short_sequences_have_no_period():
    drift = 1.0 + 1e-7 * np.arange(400)
    for section in (QUASIPERIODIC, np.array([]), np.array([1.0, 1.0]), np.tile(np.arange(70.0), 20), drift):
        assert repetition(section, 1e-6, 60) == 0


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
    }


def test_a_state_that_comes_back_as_its_mirror_image_has_not_come_back():
    """W' repeats after three points, the state of all blocks after six: every other turn it is the mirror image."""
    velocity = np.tile([1.0, 2.0, 3.0], 60)
    turn = np.array([[0.1, 0.0, 0.4], [0.2, 0.0, 0.5], [0.3, 0.0, 0.6]])
    states = np.tile(np.concatenate([turn, turn[:, ::-1]]), (30, 1))
    assert section_period(run_of(velocity, states), MOTION) == 6
    assert section_period(run_of(velocity, np.tile(turn, (60, 1))), MOTION) == 3
    # Positions alone tell it, velocities alone too.
    run = run_of(velocity, np.tile(turn, (60, 1)))
    for name in ("event_position", "event_velocity"):
        assert section_period({**run, name: states}, MOTION) == 6
    # Downward crossings are no section points.
    assert section_period(run_of(velocity, states, falling=True), MOTION) == 0
    # States that drift although W' repeats; states known from late on only; none at all.
    drifting = states + 1e-4 * np.arange(180.0)[:, None]
    assert section_period(run_of(velocity, drifting), MOTION) == 0
    assert section_period(run_of(velocity, states, first_event=150.0), MOTION) == 6
    assert section_period(run_of(velocity, states, first_event=1e9), MOTION) == 3
    # Too few states to show three turns say nothing; enough of them that do not repeat in three say that it is none.
    assert section_period(run_of(velocity, states, first_event=172.0), MOTION) == 3
    assert section_period(run_of(velocity, states, first_event=165.0), MOTION) == 0
    # Nor is one that is longer than what is looked for.
    assert section_period(run_of(velocity, states), replace(MOTION, longest_period=5)) == 0


def test_a_slow_approach_does_not_hide_a_period():
    assert section_period(run_of(1.0 + 0.5 ** np.arange(1000), np.ones((1000, 3))), MOTION) == 1


def test_the_words_of_a_kind():
    assert MotionKind.TRANSIENT_CHAOS.words == "transient chaos"


@pytest.mark.parametrize(
    ("mean_distance", "period", "exponents", "error", "kind"),
    [
        (1e-9, 1, (0.0, -0.01), 1e-5, MotionKind.SYNCHRONIZED),
        (0.1, 3, (1e-4, -1e-4), 1e-5, MotionKind.PERIODIC),
        (0.1, 0, (1e-4, -0.01), 1e-5, MotionKind.PERIODIC),
        (0.1, 0, (1e-4, -1e-4), 1e-5, MotionKind.QUASIPERIODIC),
        # With errors larger than the exponents of chaos only a repetition tells something.
        (0.1, 0, (1e-4, -0.01), 1e-2, MotionKind.UNDETERMINED),
        (0.1, 3, (1e-4, -0.01), 1e-2, MotionKind.PERIODIC),
        (0.1, 0, (1e-4, -0.01), 0.9e-3, MotionKind.PERIODIC),
        (0.1, 0, (1e-4, -0.01), 1.1e-3, MotionKind.UNDETERMINED),
        (0.1, 0, (2.3e-2, -3e-3), 1e-2, MotionKind.UNDETERMINED),
        (0.1, 0, (0.02, 0.0), 1e-3, MotionKind.CHAOTIC),
        (1e-9, 0, (0.02, 0.0), 1e-3, MotionKind.CHAOTIC),
        # Motion that repeats is periodic, also on an orbit that repels all others.
        (1e-9, 1, (0.02, 0.0), 1e-3, MotionKind.SYNCHRONIZED),
        (0.1, 2, (0.02, 0.0), 1e-3, MotionKind.PERIODIC),
        # Uniform sliding: its section points are rounding.
        (0.1, 2, (-0.01, -0.02), 1e-5, MotionKind.UNDETERMINED),
        (0.1, 2, (-0.01, -0.02), 1e-2, MotionKind.PERIODIC),
        # Above the threshold but not above its error, or the other way round: no chaos.
        (0.1, 0, (2e-3, -0.01), 1e-3, MotionKind.PERIODIC),
        (0.1, 0, (9e-4, -0.01), 1e-5, MotionKind.UNDETERMINED),
        # Weak chaos or a torus: the error leaves both.
        (0.1, 0, (2e-3, 0.0), 1e-3, MotionKind.UNDETERMINED),
        (0.1, 0, (9e-4, 0.0), 1e-3, MotionKind.QUASIPERIODIC),
        # End blocks that move as one are on a torus only if the second exponent is as good as 0.
        (1e-9, 0, (0.0, -9e-4), 1e-3, MotionKind.QUASIPERIODIC),
        (1e-9, 0, (0.0, -1.1e-3), 1e-3, MotionKind.UNDETERMINED),
        (0.1, 0, (0.0, -1.1e-3), 1e-3, MotionKind.QUASIPERIODIC),
        (0.1, 0, (-0.01, -0.02), 1e-5, MotionKind.UNDETERMINED),
        # Without exponents only a repetition of the section points says something.
        (0.1, 5, (), 1e-5, MotionKind.PERIODIC),
        (0.1, 0, (), 1e-5, MotionKind.UNDETERMINED),
        (0.1, 0, (np.nan, np.nan), np.nan, MotionKind.UNDETERMINED),
        (1e-9, 1, (np.nan, np.nan), np.nan, MotionKind.SYNCHRONIZED),
        (0.1, 0, (0.0,), 1e-5, MotionKind.UNDETERMINED),
        # An error that is not known decides nothing, neither chaos nor rest.
        (0.1, 0, (0.0079, -0.0009), np.nan, MotionKind.UNDETERMINED),
        (0.1, 0, (-0.0079, -0.009), np.nan, MotionKind.UNDETERMINED),
        (0.1, 3, (-0.0079, -0.009), np.nan, MotionKind.PERIODIC),
        # Of the first two exponents, whose values decide, both errors have to be small; that of a third tells nothing.
        (0.1, 0, (1e-4, -0.05, -0.1), (1e-5, 1e-5, 1e-2), MotionKind.PERIODIC),
        (0.1, 0, (1e-4, -0.05, -0.1), (1e-5, 1e-2, 1e-5), MotionKind.UNDETERMINED),
        (0.1, 0, (1e-4, -0.05, -0.1), (1e-2, 1e-5, 1e-5), MotionKind.UNDETERMINED),
        # Each is judged by its own one.
        (1e-9, 0, (0.0, -9e-4), (1e-4, 1e-3), MotionKind.QUASIPERIODIC),
        (1e-9, 0, (0.0, -9e-4), (1e-3, 5e-4), MotionKind.UNDETERMINED),
        (0.1, 0, (2e-3, 0.0), (1e-4, 1e-3), MotionKind.CHAOTIC),
        (0.1, 0, (2e-3, 0.0), (1e-3, 1e-4), MotionKind.UNDETERMINED),
    ],
)
def test_kinds(mean_distance, period, exponents, error, kind):
    """By one error of all exponents, or one each."""
    errors = np.broadcast_to(error, len(exponents))
    assert motion_kind(mean_distance, period, np.array(exponents), errors, MOTION) == kind


@pytest.mark.parametrize(("points", "kind"), [(2, MotionKind.PERIODIC), (3, MotionKind.UNDETERMINED)])
def test_stops_tell_a_period_only_where_section_points_do_not(points, kind):
    """Three points would show a repetition, and these do not."""
    run = run_of(np.arange(points), np.ones((points, 3)))
    told = {
        "status": "completed",
        "mean_distance": 0.1,
        "lyapunov_exponent": np.zeros(0),
        "lyapunov_error": np.zeros(0),
    }
    states = np.tile([[0.1, 0.2, 0.3], [0.4, 0.5, 0.6]], (20, 1))
    stops = {"event_position": states, "event_velocity": states, "event_time": np.arange(40.0)}
    stops |= {"event_block": np.tile([2, 3], 20), "event_kind": np.zeros(40, dtype=int)}
    assert motion_of_run({**run, **told, **stops}, True, MOTION).kind == kind


@pytest.mark.parametrize("name", ["period_tolerance", "zero_exponent", "chaotic_exponent"])
def test_motion_under_a_slow_driver_is_smaller_and_slower(name):
    default = getattr(MOTION, name)
    assert [getattr(MOTION.at_speed(v), name) / default for v in (0.1, 10.0, 0.01)] == [1.0, 1.0, pytest.approx(0.1)]
    assert MOTION.at_speed(0.01).synchronization_threshold == MOTION.synchronization_threshold


def test_sections_that_repeat_after_however_many_points():
    random = np.random.default_rng(3)
    orbit = random.random(150)
    assert section_closed(np.tile(orbit, 8), 1e-6)
    assert repetition(np.tile(orbit, 8), 1e-6, 60) == 0
    assert not section_closed(QUASIPERIODIC, 1e-6)
    assert not section_closed(random.random(2000), 1e-6)
    # Many points lie near each other everywhere, and those of small motion: only closer than that tells an orbit.
    assert not section_closed(np.cos(np.pi * (np.sqrt(5) - 1) * np.arange(2_000_000)), 1e-6)
    assert not section_closed(1e-4 * QUASIPERIODIC, 1e-6)
    assert section_closed(1e-4 * np.tile(orbit, 8), 1e-6)
    # Of the second half all but a twentieth have a neighbour, among twelve points at least.
    assert [section_closed(np.ones(count), 1e-6) for count in (5, 22, 24)] == [False, False, True]
    pairs = np.repeat(np.arange(50.0), 2)
    for alone, closed in ((4, True), (6, False)):
        section = pairs + np.where(np.arange(100) < alone, 0.25 * (np.arange(100) % 2), 0.0)
        assert section_closed(np.concatenate([pairs, section]), 1e-6) == closed


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
def test_an_orbit_that_repels(period, exponents, error, unstable):
    assert is_unstable(period, np.array(exponents), np.full(len(exponents), error), MOTION) is unstable


def test_uniform_sliding_that_attracts_is_no_periodic_motion():
    """Friction grows with speed there; what crosses W = 0 is rounding."""
    model = Model(Chain(3), law_of("stribeck", 0.3), 0.5)
    run = simulate(model, "plus", transient=2000.0, window=2000.0)
    assert run.lyapunov_exponent[0] < -0.01
    found = motion_of_run(vars(run), True, MOTION)
    assert (found.kind, found.section_period) == (MotionKind.UNDETERMINED, 0)


def test_what_repeats_without_a_section_point_is_periodic():
    """Two blocks: W stays above 0, and the orbit is one of a family, so that the second exponent is 0."""
    start = {"position": [0.5, -1.0], "velocity": [0.05, 0.05]}
    run = simulate(Model(Chain(2), law_of("nonlinear", 3.0), 0.05), start, transient=2000.0, window=2000.0)
    assert not len(run.crossing_time)
    assert motion_of_run(vars(run), True, MOTION).kind == MotionKind.PERIODIC


@pytest.mark.parametrize(("mean", "kind"), [(0.0, MotionKind.SYNCHRONIZED), (0.1, MotionKind.PERIODIC)])
def test_an_orbit_of_a_long_period_is_known_by_its_section(mean, kind):
    """Its exponents alone look like those of a torus."""
    section = np.tile(np.random.default_rng(3).random(150), 8)
    run = run_of(section, np.arange(3.0 * len(section)).reshape(-1, 3))
    told = {"status": "completed", "mean_distance": mean, "lyapunov_exponent": np.array([0.0, 0.0, -0.1])}
    assert motion_of_run({**run, **told, "lyapunov_error": np.full(3, 1e-5)}, True, MOTION).kind == kind
