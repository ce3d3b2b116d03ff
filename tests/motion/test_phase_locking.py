"""Periodic orbits to which apparent tori are locked."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from burridge_knopoff import Model, Settings
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.motion import phase_locking as locking
from burridge_knopoff.motion.limit_cycle import limit_cycle
from burridge_knopoff.motion.phase_locking import locked_orbit, recurrence
from burridge_knopoff.motion.section_returns import state_of, visit
from burridge_knopoff.periodic_orbits.floquet import multipliers
from burridge_knopoff.running.simulation import run
from tests.flows import weakly_repelling

LOCKED = Model("linearized", a=0.0275)
#: A state near a torus, whose distance from its periodic orbit falls by the factor e in 30 000 time units.
ON_IT = state_of(np.array([0.027653, 0.008746, -0.031365, 0.0, 0.201334, 0.12468]))


def seen(model, start, window):
    """Return times and states of the stops of the first block."""
    trajectory = run(model, start, Settings(transient=0.0, window=window, events="all", lyapunov_exponents=0))
    stops = (trajectory.event_block == 1) & (trajectory.event_kind == 0)
    states = np.hstack([trajectory.event_position - model.sliding_offset, trajectory.event_velocity])
    return trajectory.event_time[stops], states[stops]


@pytest.mark.slow
def test_orbit_of_a_locked_torus_is_where_the_motion_ends():
    start = visit(LOCKED, ON_IT, 30_000.0, 500.0).state()
    times, returns = seen(LOCKED, start, 12_000.0)
    time = recurrence(times, returns)
    orbit = locked_orbit(LOCKED, returns, time)
    assert orbit.period == pytest.approx(time, abs=1e-3)
    factor = abs(multipliers(orbit).whole[0])
    assert 0.8 < factor < 0.95
    # Independently: the returns of the motion itself finally repeat, and the distance falls by that factor.
    late = visit(LOCKED, start, 900_000.0, 3.5 * orbit.period).returns
    away = np.abs(late - late[-1]).max(axis=1)
    turn = len(late) - 1 - np.flatnonzero(away[:-1] < 1e-9)[-1]
    assert not (away[-turn:-1] < 1e-4).any()
    ends = visit(LOCKED, state_of(late[-1]), 0.0, orbit.period + 1e-6)
    assert len(ends.returns) == turn
    assert np.abs(ends.returns[-1] - late[-1]).max() < 1e-8
    settling = [visit(LOCKED, start, 200_000.0 + k * orbit.period, 200.0).returns[0] for k in range(3)]
    last = visit(LOCKED, start, 200_000.0 + 200 * orbit.period, 200.0).returns[0]
    distances = [np.abs(x - last).max() for x in settling]
    assert np.divide(distances[1:], distances[:-1]) == pytest.approx(factor, abs=0.01)


@pytest.mark.parametrize(("law", "a"), [("linearized", 0.0125), ("linearized", 0.2), ("nonlinear", 0.08)])
def test_neither_chaos_nor_a_torus_is_locked(law, a):
    model = Model(law, a=a)
    start = state_of(np.array([0.5, 0.0, -0.5, 0.0, 0.0, 0.0]))
    times, returns = seen(model, visit(model, start, 20_000.0, 500.0).state(), 12_000.0)
    assert locked_orbit(model, returns, recurrence(times, returns)) is None


@pytest.mark.parametrize(
    ("apart", "expected"),
    [
        # Four time units earlier, and much farther away after 3, 2 and 1; the oldest half is ignored.
        ((0.0, 0.0, 0.0, 0.0, 0.0, 0.09, 1.1, 1.0, 2.0), 4.0),
        ((0.0, 0.0, 0.0, 0.0, 0.0, 0.11, 1.1, 1.0, 2.0), 0.0),
        ((0.0, 0.0, 0.0, 0.0, 0.3, 0.2, 1.1, 0.01, 2.0), 2.0),
        ((5.0, 5.0, 5.0, 5.0, 5.0, 4.0, 3.0, 2.0, 1.0), 1.0),
        ((5.0,), 0.0),
        ((0.0, 5.0), 1.0),
    ],
)
def test_the_time_of_the_closest_earlier_approach(apart, expected):
    returns = np.zeros((len(apart) + 1, 6))
    returns[:-1, 2] = apart
    returns += 0.3
    assert recurrence(7.0 + np.arange(len(returns)), returns) == expected


def test_any_coordinate_may_separate_returns():
    returns = np.zeros((9, 6))
    returns[-2, 5], returns[-3, 0] = 1.0, -1e-3
    returns[:-3] = 2.0
    assert recurrence(np.arange(9.0), returns) == 2.0


def test_an_orbit_must_exist_attract_and_be_approached():
    model = Model("linearized", a=0.08)
    stable, unstable = limit_cycle(model, model.begin(PAPER_STATES["plus"]), settling=1000.0), weakly_repelling()

    def locked(orbit, away, time, window):
        """Return the orbit found from returns at these distances from those of an orbit in consecutive windows."""
        turn = visit(orbit.model, orbit.reference, 0.0, window).returns
        return locked_orbit(orbit.model, np.concatenate([turn + distance for distance in away]), time)

    coming, period = (3e-6, 2e-6, 1e-6), stable.period
    assert locked(stable, coming, period, period).period == pytest.approx(period, abs=1e-9)
    assert locked(stable, coming[::-1], period, period) is None
    # Three cycles: a single cycle has too few returns.
    assert locked(unstable, coming, 3.0 * unstable.period, 3.0 * unstable.period) is None
    # No orbit has such a period.
    for time in (0.0, 0.4 * period):
        assert locked(stable, coming, time, period) is None


@pytest.mark.parametrize(
    ("v", "away", "expected"),
    [
        (0.1, (0.029, 0.0295, 0.03), True),
        (0.1, (0.031, 0.032, 0.033), False),  # too far off
        (0.1, (0.058, 0.059, 0.06), False),
        (0.2, (0.058, 0.059, 0.06), True),  # distances grow with the velocity
        (0.1, (0.02, 0.01, 0.03), False),  # farther away in the last cycle than before
        (0.1, (0.02, 0.02, 0.03), False),
        (0.1, (0.01, 0.02, 0.015), False),
        (0.1, (0.02, 0.03, 0.04, 0.05, 0.01), True),  # four cycles decide
        (0.1, (0.02, 0.03, 0.04, 0.03), False),
        (0.1, (0.02,), False),  # a single cycle does not
    ],
)
def test_each_cycle_must_be_closer(script_answers, v, away, expected):
    on_orbit = np.random.default_rng(5).uniform(-1.0, 1.0, (40, 6))
    calls = script_answers(locking, "visit", [SimpleNamespace(returns=on_orbit)])
    orbit = SimpleNamespace(model=replace(LOCKED, v=v), reference="reference", period=100.0)
    # The oldest cycle is incomplete and is not compared.
    returns = np.concatenate([on_orbit[20:], *(on_orbit + distance for distance in away[::-1])])
    assert locking._is_approaching(returns, orbit) == expected
    assert calls[0][:4] == (orbit.model, "reference", 0.0, 100.0)


def test_an_orbit_that_does_not_complete_is_not_approached(script_answers):
    script_answers(locking, "visit", [None])
    orbit = SimpleNamespace(model=LOCKED, reference="reference", period=100.0)
    assert not locking._is_approaching(np.zeros((5, 6)), orbit)
