"""Closed orbits to which what looks like a torus is locked."""

from types import SimpleNamespace

import numpy as np
import pytest

from burridge_knopoff import Chain, Model, OrbitError, Symmetry, law_of
from burridge_knopoff.model.model import Instant
from burridge_knopoff.orbits.floquet import multipliers
from burridge_knopoff.stability import locking
from burridge_knopoff.stability.locking import locked_orbit
from burridge_knopoff.stability.returns import instant_of, visit
from burridge_knopoff.stability.tuning import Tuning
from tests.stability.stand_in import shown

LOCKED = Model(Chain(3), law_of("linearized", 0.0275))
#: A state on a torus there, which comes nearer to its closed orbit by the factor e in 30 000 time units.
ON_IT = instant_of(np.array([0.027653, 0.008746, -0.031365, 0.0, 0.201334, 0.12468]))


def test_orbit_of_a_locked_torus_is_where_the_motion_ends():
    start = visit(LOCKED, ON_IT, 30_000.0, 500.0).instant()
    orbit = locked_orbit(LOCKED, start, 12_000.0)
    factor = abs(multipliers(orbit).whole[0])
    assert 0.8 < factor < 0.95
    # Without any of this: the returns of the motion itself, which repeat in the end and come nearer by that factor.
    late = visit(LOCKED, start, 900_000.0, 3.5 * orbit.period).returns
    away = np.abs(late - late[-1]).max(axis=1)
    turn = len(late) - 1 - np.flatnonzero(away[:-1] < 1e-9)[-1]
    assert not (away[-turn:-1] < 1e-4).any()
    begun = visit(LOCKED, start, 0.0, orbit.period).stop_count
    assert turn == pytest.approx(begun[0], abs=1)
    ends = visit(LOCKED, instant_of(late[-1]), 0.0, orbit.period + 1e-6)
    assert np.abs(ends.returns[-1] - late[-1]).max() < 1e-8
    settling = [visit(LOCKED, start, 200_000.0 + k * orbit.period, 200.0).returns[0] for k in range(3)]
    last = visit(LOCKED, start, 200_000.0 + 200 * orbit.period, 200.0).returns[0]
    distances = [np.abs(one - last).max() for one in settling]
    assert np.divide(distances[1:], distances[:-1]) == pytest.approx(factor, abs=0.01)


def test_nothing_is_found_that_is_not_approached():
    # Not even two turns of the orbit of 3935 time units fit in.
    start = visit(LOCKED, ON_IT, 30_000.0, 500.0).instant()
    assert locked_orbit(LOCKED, start, 7800.0) is None
    assert locked_orbit(LOCKED, start, 20.0) is None
    # A torus, in a window of which its nearest returns are those of orbits that are not there.
    torus = Model(Chain(3), law_of("linearized", 0.0125))
    resting = Instant(np.array([0.5, 0.0, -0.5]), np.zeros(3), np.ones(3, dtype=bool))
    assert locked_orbit(torus, visit(torus, resting, 20_000.0, 500.0).instant(), 12_000.0) is None
    # Chaos.
    chaos = Model(Chain(3), law_of("linearized", 0.2))
    assert locked_orbit(chaos, visit(chaos, resting, 3000.0, 500.0).instant(), 6000.0) is None


def told(monkeypatch, orbits, stable=True):
    """Let Newton's method come to these orbits in turn, and return the times that it is asked for."""
    asked, left = [], iter(orbits)

    def answer(model, guess, time, symmetry):
        asked.append(time)
        assert symmetry == Symmetry.ASYMMETRIC
        orbit = next(left)
        if orbit is None:
            raise OrbitError("none")
        return orbit

    monkeypatch.setattr(locking, "find_periodic_orbit", answer)
    monkeypatch.setattr(locking, "multipliers", lambda orbit: SimpleNamespace(unstable=orbit.unstable))
    monkeypatch.setattr(locking, "_approaches", lambda found, passed, orbit, tuning: orbit.approached)
    return asked


def test_the_nearest_returns_are_tried_in_turn(monkeypatch):
    start = visit(LOCKED, ON_IT, 30_000.0, 500.0).instant()
    returns = visit(LOCKED, start, 0.0, 4000.0).returns
    unstable, away, one = (SimpleNamespace(unstable=u, approached=n) for u, n in ((1, True), (0, False), (0, True)))
    asked = told(monkeypatch, [None, unstable, away, one])
    assert locked_orbit(LOCKED, start, 4000.0) is one
    assert len(asked) == 4
    assert all(0.0 < time <= 2000.0 for time in asked)
    # They are those after which the state is nearest to the last one, in the order of the distance.
    reached = [visit(LOCKED, start, 0.0, 4000.0 - time - 1e-6).returns[-1] for time in asked]
    distances = [np.abs(state - returns[-1]).max() for state in reached]
    assert distances == sorted(distances)
    others = np.sort(np.abs(returns[:-1] - returns[-1]).max(axis=1))
    assert distances[0] >= others[0]
    assert told(monkeypatch, [away] * 9) is not None
    assert locked_orbit(LOCKED, start, 4000.0, Tuning(nearest_returns=2)) is None


@pytest.mark.parametrize(
    ("away", "block", "expected"),
    [
        ((0.029, 0.0295, 0.03), 1, True),
        ((0.031, 0.032, 0.033), 1, False),  # too far off
        ((0.02, 0.01, 0.03), 1, False),  # farther in the last turn than before
        ((0.02, 0.02, 0.03), 1, False),
        ((0.01, 0.02, 0.015), 1, False),
        ((0.02, 0.03, 0.04, 0.05, 0.01), 1, True),  # four turns tell
        ((0.02, 0.03, 0.04, 0.03), 1, False),
        ((0.01, 0.02, 0.03), 2, False),
    ],
)
def test_each_turn_has_to_be_nearer(tell, away, block, expected):
    on_orbit = np.random.default_rng(5).uniform(-1.0, 1.0, (40, 6))
    around = SimpleNamespace(returns=on_orbit, block=block)
    tell(locking, "visit", [around])
    orbit = SimpleNamespace(model=LOCKED, reference=None, period=100.0)
    turns = [on_orbit + distance for distance in away[::-1]]
    passed = np.concatenate([100.0 * k + np.linspace(99.0, 0.0, 40) for k in range(len(away))][::-1])
    # The oldest turn is not whole, and is not compared.
    returns, passed = (
        np.concatenate([on_orbit[20:], *turns]),
        np.concatenate([passed[0] + np.arange(20)[::-1] + 2.0, passed]),
    )
    found = shown(returns, returns, 0.0, 0.0)
    assert locking._approaches(found, passed, orbit, Tuning()) == expected
