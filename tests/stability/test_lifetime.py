"""Lifetimes of chaos: what an ensemble of known rate gives, and chaos of the paper's chain that dies."""

import math

import numpy as np
import pytest
from scipy.stats import poisson

from burridge_knopoff import Chain, Model, MotionKind, SearchSettings, law_of
from burridge_knopoff.stability import lifetime
from burridge_knopoff.stability.lifetime import Lifetime, lifetimes
from burridge_knopoff.stability.tuning import TUNING
from tests.stability.stand_in import stand_in

MODEL = Model(Chain(3), law_of("linearized", 0.2))
SETTINGS = SearchSettings(lifetime=800.0, time_limit=50.0, seed=5)
#: Of each trajectory.
TIME = TUNING.exposure * SETTINGS.lifetime / TUNING.followed


@pytest.mark.parametrize("ends", [0, 1, 5, 40])
def test_the_interval_is_that_of_a_poisson_count(ends):
    """At either end of the interval so few, or so many, ends have a probability of 2.5 %."""
    low, high = Lifetime(ends, 1e6).interval
    assert poisson.cdf(ends, 1e6 / low) == pytest.approx(0.025)
    if ends:
        assert poisson.sf(ends - 1, 1e6 / high) == pytest.approx(0.025)
        assert Lifetime(ends, 1e6).mean == 1e6 / ends
    else:
        assert (high, Lifetime(0, 1e6).mean) == (math.inf, math.inf)
    assert Lifetime(ends, 1e6).lasts(0.99 * low)
    assert not Lifetime(ends, 1e6).lasts(low)


def test_the_interval_holds_the_lifetime_as_often_as_it_says():
    random = np.random.default_rng(1)
    mean, time, followed = 300.0, 100.0, 32
    held = 0
    for _ in range(400):
        lives = random.exponential(mean, followed)
        low, high = Lifetime(int((lives < time).sum()), float(np.minimum(lives, time).sum())).interval
        held += low <= mean <= high
    assert 0.93 <= held / 400 <= 0.99


def test_an_ensemble_that_nothing_leaves_shows_that_chaos_lasts():
    """The time of all trajectories is just enough for that."""
    assert Lifetime(0, TUNING.exposure * 1e5).lasts(1e5)
    assert not Lifetime(1, TUNING.exposure * 1e5).lasts(1e5)


@pytest.fixture
def find(monkeypatch, tell):
    """Return how lifetimes are found of trajectories whose labels and ends are told for each round."""

    def found(attractors, *rounds):
        runs = []

        def moved(model, starts, time):
            runs.append((len(starts), time))
            return starts

        monkeypatch.setattr(lifetime, "moved", moved)
        labels = []
        for reached, ends in rounds:
            labels += [(np.array(reached), np.zeros(len(reached))), (np.where(np.isnan(ends), -1, 0), np.array(ends))]
        asked = tell(lifetime, "label", labels)
        lives = lifetimes(MODEL, attractors, SETTINGS)
        return lives, runs + [(len(starts), time_limit, len(known)) for _, known, starts, time_limit in asked]

    return found


def chaos(partner=0):
    return stand_in(partner=partner, kind=MotionKind.CHAOTIC)


MANY = 32 * TUNING.undecided
#: More than enough to show that chaos lasts: none of so many trajectories leaves.
ALL_STAY = ([0] * MANY, [])


def test_trajectories_that_have_left_are_counted_with_their_times(find):
    """Six are captured by the other attractor soon, and of seven it is not known what they have reached, nor when."""
    found, asked = find([chaos(), stand_in(partner=1)], ([0] * 19 + [1] * 6 + [-1] * 7, [20.0] * 6 + [math.nan] * 7))
    assert found == [Lifetime(13, 19 * TIME + 6 * 20.0 + 7 * 0.5 * TIME), None]
    assert not found[0].lasts(SETTINGS.lifetime)
    assert asked == [(32, TIME), (32, 50.0, 2), (13, TIME, 1)]


def test_where_some_leave_so_many_more_are_followed_that_they_decide(find):
    found, asked = find([chaos(), stand_in(partner=1)], ([0] * 31 + [1], [20.0]), ALL_STAY)
    assert found == [Lifetime(1, (31 + MANY) * TIME + 20.0), None]
    assert found[0].lasts(SETTINGS.lifetime)
    assert asked[:2] == [(32, TIME), (MANY, TIME)]


def test_who_leaves_after_the_time_of_watching_has_not_left(find):
    first = [0] * 29 + [1, 1, 1], [20.0, math.nan, math.nan]
    found, _ = find([chaos(), stand_in(partner=1)], first, ALL_STAY)
    assert found == [Lifetime(1, (31 + MANY) * TIME + 20.0), None]


def test_a_change_to_the_mirror_image_is_no_end(find):
    found, asked = find([chaos(1), chaos(0)], ([0, 1] * 16, []))
    assert found == [Lifetime(0, 32 * TIME)] * 2
    assert asked == [(32, TIME), (32, 50.0, 2), (0, TIME, 0)]


def test_motion_that_is_not_chaotic_has_no_lifetime(find):
    assert find([stand_in()]) == ([None], [])
