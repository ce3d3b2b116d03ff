"""Lifetimes of chaos: of ensembles with a known rate, and of transient chaos of the paper's chain."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import poisson

from burridge_knopoff import Model, MotionKind, SearchSettings, find_attractors
from burridge_knopoff.attractors import lifetime
from burridge_knopoff.attractors.attractor import Lifetime, perturb
from burridge_knopoff.attractors.capture_radius import LONGEST_PATIENCE
from burridge_knopoff.attractors.labels import advance
from burridge_knopoff.attractors.lifetime import EXPOSURE, EXTENSIONS, TRAJECTORIES, lifetimes, mark_transients
from burridge_knopoff.motion.section_returns import state_of, visit
from burridge_knopoff.motion.set_distance import SPACINGS, is_near
from tests.motion.stand_in import stand_in

MODEL = Model("linearized", a=0.2)
SETTINGS = SearchSettings(lifetime=800.0, time_limit=50.0, seed=5, window=10.0)
#: Observation time of each trajectory.
TIME = EXPOSURE * SETTINGS.lifetime / TRAJECTORIES


@pytest.mark.parametrize("ends", [0, 1, 5, 40])
def test_the_interval_is_that_of_a_poisson_count(ends):
    """At the ends of the interval this number of escapes or fewer, or more, has a probability of 2.5 %."""
    low, high = Lifetime(ends, 1e6).interval
    assert poisson.cdf(ends, 1e6 / low) == pytest.approx(0.025)
    if ends:
        assert poisson.sf(ends - 1, 1e6 / high) == pytest.approx(0.025)
        assert Lifetime(ends, 1e6).mean == 1e6 / ends
    else:
        assert (high, Lifetime(0, 1e6).mean) == (math.inf, math.inf)
    assert Lifetime(ends, 1e6).is_longer_than(0.99 * low)
    assert not Lifetime(ends, 1e6).is_longer_than(low)


def test_the_interval_contains_the_lifetime_at_its_confidence_level():
    random = np.random.default_rng(1)
    mean, time, followed = 300.0, 100.0, 32
    held = 0
    for _ in range(400):
        lives = random.exponential(mean, followed)
        low, high = Lifetime(int((lives < time).sum()), float(np.minimum(lives, time).sum())).interval
        held += low <= mean <= high
    assert 0.93 <= held / 400 <= 0.99


def test_an_ensemble_that_no_trajectory_leaves_shows_that_chaos_lasts():
    """The total time is just long enough."""
    assert Lifetime(0, EXPOSURE * 1e5).is_longer_than(1e5)
    assert not Lifetime(1, EXPOSURE * 1e5).is_longer_than(1e5)


@pytest.mark.slow
@pytest.mark.parametrize(("share", "least", "most"), [(1.0, 0.025, 0.04), (0.8, 0.0, 0.012)])
def test_short_chaos_counts_as_lasting_no_more_often_than_the_settings_say(monkeypatch, share, least, most):
    """Both tests together, for random lifetimes whose mean equals the limit or is shorter."""

    def drawn(model, attractors, index, settings, exposure, random, count):
        lives = random.exponential(share * settings.lifetime, count)
        time = exposure * settings.lifetime / TRAJECTORIES
        return Lifetime(int((lives < time).sum()), float(np.minimum(lives, time).sum()))

    monkeypatch.setattr(lifetime, "_follow", drawn)
    passed = 0
    for seed in range(6000):
        settings = replace(SETTINGS, seed=seed)
        passed += lifetime._lifetime(MODEL, [], 0, settings, EXPOSURE).is_longer_than(settings.lifetime)
    assert least <= passed / 6000 <= most


@pytest.mark.parametrize(
    ("share", "kind"),
    [(0.1, MotionKind.TRANSIENT_CHAOS), (0.5, MotionKind.TRANSIENT_CHAOS), (20.0, MotionKind.CHAOTIC)],
)
def test_chaos_has_a_lifetime_and_is_transient_unless_it_is_long(monkeypatch, share, kind):
    """Random lifetimes of known mean, for a chaotic set, its mirror image and an orbit."""

    def drawn(model, attractors, index, settings, exposure, random, count):
        lives = random.exponential(share * settings.lifetime, count)
        time = exposure * settings.lifetime / TRAJECTORIES
        return Lifetime(int((lives < time).sum()), float(np.minimum(lives, time).sum()))

    monkeypatch.setattr(lifetime, "_follow", drawn)
    first, image, orbit = mark_transients(MODEL, [chaos(1), chaos(0), stand_in(partner=2)], SETTINGS)
    assert first.motion.kind == image.motion.kind == kind
    assert first.lifetime == image.lifetime
    low, high = first.lifetime.interval
    assert 0.8 * low < share * SETTINGS.lifetime < 1.25 * high
    assert first.lifetime.words in repr(first)
    assert (orbit.motion.kind, orbit.lifetime) == (MotionKind.PERIODIC, None)


def test_the_words_say_how_long_chaos_was_followed():
    words = [Lifetime(ends, 4e5).words for ends in (0, 1, 7)]
    assert words == ["no escapes in 4e+05 time units", "1 escape in 4e+05 time units", "7 escapes in 4e+05 time units"]


@pytest.mark.slow
def test_chaos_next_to_a_locked_orbit_is_transient():
    """At v = 0.3, a = 0.25 (nonlinear) half of the states are in chaos that leads to an orbit of period 2056.

    The own count: of ten perturbed states at most two are still away from the orbit after 60 000 time units.
    """
    attractors, labels = find_attractors(Model("nonlinear", a=0.25, v=0.3), SearchSettings(samples=20))
    kinds = [attractor.motion.kind for attractor in attractors]
    (transient,) = [k for k, kind in enumerate(kinds) if kind == MotionKind.TRANSIENT_CHAOS]
    assert MotionKind.CHAOTIC not in kinds
    assert np.count_nonzero(labels == transient) >= 5
    (orbit,) = [item for item in attractors if math.isfinite(item.motion.period)]
    returns, generator = attractors[transient].motion.returns, np.random.default_rng(7)
    starts = [perturb(state_of(returns[k]), 1e-5, generator) for k in generator.integers(len(returns), size=10)]
    left = 0
    for state in advance(orbit.model, starts, 60_000.0):
        section = visit(orbit.model, state, 0.0, 3000.0)
        left += is_near(section.returns, orbit.motion.returns, 1e-3)
    assert left >= 8
    assert attractors[transient].lifetime.mean == pytest.approx(14_000, rel=0.6)


#: Exponent, radius, close returns and stops of the other attractor, which give its capture time.
CAUGHT = {
    "exponent": np.array([0.0, -1.0, -2.0]),
    "radius": 0.2 / math.e,
    "close_returns": 4,
    "stop_rate": np.array([0.1, 0.2, 0.3]),
    "block": 2,
}
#: Twice the sum of 1 / 1.0 for the approach and 4 returns, at the stops of its block.
LATE = 2.0 * (1.0 + 4 / 0.2)


@pytest.fixture
def find(monkeypatch, script_answers):
    """Return a function that computes lifetimes with scripted captures and ends of the trajectories in each round.

    when : capture times, NaN for none; nowhere : number of the others that reach no attractor; early : their labels at
        LATE
    """

    def lifetimes_of(attractors, *rounds):
        runs = []

        def advance(model, starts, time):
            runs.append((len(starts), time))
            return starts

        monkeypatch.setattr(lifetime, "advance", advance)
        first, later = [], []
        for when, nowhere, early in rounds:
            first.append((np.where(np.isnan(when), -1, 0), np.nan_to_num(when), np.zeros((len(when), 6))))
            ends = np.zeros(int(np.isnan(when).sum()), int)
            ends[:nowhere] = -1
            later += [(ends, None), (np.array(early, int), None)]
        followed, calls_of_label = (
            script_answers(lifetime, "label_arrays", first),
            script_answers(lifetime, "label", later),
        )
        lives = lifetimes(MODEL, attractors, SETTINGS)
        calls = [(len(position), time_limit, len(targets)) for _, targets, position, *_, time_limit in followed]
        return lives, runs + calls + [
            (len(starts), time_limit, len(targets)) for _, targets, starts, time_limit in calls_of_label
        ]

    return lifetimes_of


def chaos(partner=0):
    return stand_in(partner=partner, kind=MotionKind.CHAOTIC)


NEVER = math.nan


def all_stay(times):
    """Return a round in which no trajectory leaves."""
    return [NEVER] * (32 * times), 0, []


def test_trajectories_that_have_left_are_counted_with_their_times(find):
    """Six are captured by the other attractor, two of them too early to count; seven leave for an unknown set."""
    when = [LATE + 20.0] * 4 + [LATE, 0.5 * LATE] + [NEVER] * 26
    lives, calls = find(
        [chaos(), stand_in(partner=1, **CAUGHT)], (when, 7, [-1, 0, 0, -1, 0, 0, 0]), *map(all_stay, EXTENSIONS)
    )
    # Nine escapes do not decide: more trajectories are followed, until six times as many are enough.
    assert lives == [Lifetime(9, (19 + 6 * 32) * TIME + 4 * 20.0 + 5 * 0.5 * TIME), None]
    assert [call for call in calls if 0 < call[0] < 32] == [(7, LATE), (26, 50.0, 2), (7, 50.0, 2)]
    assert [call for call in calls if call[1:] == (LATE + TIME, 1)] == [(32 * n, LATE + TIME, 1) for n in (1, 1, 2, 3)]


def test_all_captures_count_if_chaos_is_short(find):
    when = [10.0] * 28 + [NEVER] * 4
    lives, _ = find([chaos(), stand_in(partner=1, **CAUGHT)], (when, 2, [0, -1]))
    assert lives == [Lifetime(30, 28 * 10.0 + 2 * (LATE + TIME) + 2 * 0.5 * LATE), None]
    # All captures also count if fewer than eight trajectories are left, lost ones excluded.
    lives, _ = find([chaos(), stand_in(partner=1, **CAUGHT)], ([10.0] * 21 + [NEVER] * 11, 9, [-1] * 4 + [0] * 5))
    assert lives == [Lifetime(30, 21 * 10.0 + 2 * (LATE + TIME) + 9 * 0.5 * LATE), None]


def test_more_trajectories_are_followed_if_some_leave(find):
    first = [LATE + 20.0] + [NEVER] * 31
    lives, calls = find([chaos(), stand_in(partner=1, **CAUGHT)], (first, 0, []), *map(all_stay, EXTENSIONS))
    assert lives == [Lifetime(1, (31 + 3 * 32) * TIME + 20.0), None]
    assert lives[0].is_decided(SETTINGS.lifetime)
    assert lives[0].is_longer_than(SETTINGS.lifetime)
    assert calls[:3] == [(32 * n, LATE + TIME, 1) for n in (1, 1, 2)]


@pytest.mark.parametrize(
    ("ends", "time", "decided"),
    [
        (0, 4000.0, False),
        (0, 5000.0, True),
        (4, 11_000.0, True),
        (29, 8000.0, False),
        (30, 8000.0, True),
        (30, 20_000.0, False),
    ],
)
def test_a_lifetime_is_decided_by_an_interval_of_high_confidence(ends, time, decided):
    """Below the limit it takes thirty ends as well."""
    assert Lifetime(ends, time).is_decided(800.0) == decided


def test_a_change_to_the_mirror_image_does_not_end_chaos(find):
    lives, calls = find([chaos(1), chaos(0)], ([NEVER] * 32, 0, []))
    assert lives == [Lifetime(0, 32 * TIME)] * 2
    assert calls == [(32, TIME, 0), (32, 50.0, 2), (0, 50.0, 2)]


def test_motion_that_is_not_chaotic_has_no_lifetime(find):
    assert find([stand_in()]) == ([None], [])


@pytest.mark.parametrize(
    ("rate", "radius", "way"),
    [
        # A torus, chaos or a locked torus.
        (0.0, 0.2 / math.e, 0.5 * LONGEST_PATIENCE - 20.0),
        (0.99e-4, 0.005, 0.5 * LONGEST_PATIENCE - 20.0),
        (-1e-4, 0.2, 0.5 * LONGEST_PATIENCE - 20.0),
        (1.01e-4, 0.2 / math.e, 1.0 / 1.01e-4),
        (5e-4, 0.2 / math.e, 2000.0),
        (5e-4, 0.4, 0.0),
        # A tiny orbit embedded in chaos: trajectories in its own basin take long to be captured.
        (5e-4, 0.2 * math.exp(-12.0), 24_000.0),
    ],
)
def test_counting_starts_after_the_capture_time_of_a_slow_attractor(find, rate, radius, way):
    slow = stand_in(partner=1, **{**CAUGHT, "exponent": np.array([0.0, -rate, -1.0]), "radius": radius})
    _, calls = find([chaos(), slow], ([NEVER] * 32, 0, []))
    assert calls[0] == (32, pytest.approx(2.0 * (way + 20.0) + TIME), 1)


@pytest.mark.slow
def test_lifetimes_do_not_depend_on_how_slowly_a_trajectory_is_captured():
    """At a = 0.243828 an orbit takes about 3000 time units to capture trajectories that leave chaos.

    Its mean lifetime is 109 000 (97 100 to 122 700), from 289 escapes with another solver, each detected by J.
    """
    model = Model("linearized", a=0.243828125)
    settings = SearchSettings()
    attractors, _ = find_attractors(model, settings)
    lives = [attractor.lifetime for attractor in attractors if attractor.lifetime]
    assert len(lives) == 1
    low, high = lives[0].interval
    assert low < 122_700
    assert high > 97_100
    assert lives[0].mean == pytest.approx(109_000, rel=0.35)


def test_perturbations_depend_on_the_seed_and_scale_with_v(script_answers):
    """At twice the v of the paper the perturbations are up to twice a tenth of the resolution."""
    fast, away = Model(MODEL.law, v=0.2), []
    for seed in (3, 3, 4):
        calls = script_answers(lifetime, "label_arrays", [(np.full(32, -1), np.zeros(32), np.zeros((32, 6)))])
        script_answers(lifetime, "label", [(np.zeros(32, int), None), (np.zeros(0, int), None)])
        wide = stand_in(kind=MotionKind.CHAOTIC, radius=0.021)
        lifetimes(fast, [wide], replace(SETTINGS, seed=seed, lifetime=100.0))
        states = np.concatenate(calls[0][2:4], axis=1)
        away.append([np.abs(state - chaos().motion.returns).max(axis=1).min() for state in states])
    assert 1.8e-4 < max(away[0]) <= 2e-4
    assert away[0] == away[1] != away[2]


def test_trajectories_that_start_on_thin_chaos_are_recognised_there(script_answers):
    """Perturbations are far smaller than the radius; states within a few spacings of the returns are on the set."""
    thin = stand_in(kind=MotionKind.CHAOTIC, radius=1e-6, spacing=0.01)
    followed = script_answers(lifetime, "label_arrays", [(np.full(32, -1), np.zeros(32), np.zeros((32, 6)))])
    calls = script_answers(lifetime, "label", [(np.zeros(32, int), None), (np.zeros(0, int), None)])
    (life,) = lifetimes(MODEL, [thin], SETTINGS)
    assert life.ends == 0
    returns = thin.motion.returns
    states = np.concatenate(followed[0][2:4], axis=1)
    away = [min(np.abs(state - row).max() for row in returns) for state in states]
    assert 0.9e-8 < max(away) <= 1e-8
    assert [attractor.radius for attractor in calls[0][1]] == [pytest.approx(SPACINGS * 0.01)]
