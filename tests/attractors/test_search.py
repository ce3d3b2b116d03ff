"""The search of attractors step by step, each with what the others answer told beforehand."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from burridge_knopoff import Chain, Model, MotionKind, OrbitError, SearchSettings, law_of
from burridge_knopoff.attractors import convergence as settling
from burridge_knopoff.attractors import search as attractors
from burridge_knopoff.attractors.search import Search
from burridge_knopoff.motion.section_returns import state_of
from burridge_knopoff.motion.tuning import TUNING
from tests.motion.stand_in import ASYMMETRIC, SYMMETRIC, SYNCHRONIZED, shown, stand_in

MODEL = Model(Chain(3), law_of("linearized", 0.08))
#: So that times tell of how many transients, or windows, they are.
SETTINGS = SearchSettings(transient=1.0, window=100.0)
CLOSED, WIDE = 1e-7, 0.01
ONE, OTHER = np.array([[1.0, 0.0, 0.0, 0.0, 0.1, 0.1]]), np.array([[2.0, 0.0, 0.0, 0.0, 0.1, 0.1]])


@pytest.fixture
def add(monkeypatch):
    """Return how a motion is added that is measured to be, and is after a while, what is told, as its radii are.

    With what is found comes what has been asked: transients and windows, or an index and the least radius.
    """

    def added(
        measured,
        lasting,
        radii,
        model=MODEL,
        mirror=OTHER,
        spacing=CLOSED,
        in_chaos=False,
        mirror_cloud=ONE,
        known=(),
        inner=(),
        tuning=TUNING,
    ):
        asked, answers = [], {"measure": measured, "visit": [lasting], "captured": radii}

        def tell(name, left):
            def answer(*arguments):
                asked.append((name, *arguments[2:4]))
                return next(left)

            monkeypatch.setattr(attractors if name == "captured" else settling, name, answer)

        for name, left in answers.items():
            tell(name, iter(left))
        monkeypatch.setattr(Search, "lies_in_chaos", lambda *_: in_chaos)
        monkeypatch.setattr(attractors, "bounded", lambda _, known, *__: list(known))
        monkeypatch.setattr(attractors, "midst", lambda *_: [*inner])
        monkeypatch.setattr(
            attractors, "spread", lambda _, motion, *__: replace(motion, returns=ONE, mirror_returns=mirror_cloud)
        )
        search = Search(model, SETTINGS, tuning=tuning, attractors=[*known])
        assert search._add(shown(ONE, mirror, spacing, 0.0)) == (len(search.attractors) > len(known))
        names = [name for name, *_ in asked]
        assert (names.count("measure"), names.count("captured")) == (len(measured), len(radii))
        return search.attractors, asked

    return added


def motion(mean_distance=0.1, **told):
    return stand_in(ASYMMETRIC, mean_distance, returns=ONE, mirror_returns=OTHER, **told).motion


def test_a_motion_is_added_with_its_mirror_image(add):
    pair, asked = add([motion()], None, [0.02])
    assert [(item.symmetry, item.partner, item.radius) for item in pair] == [(ASYMMETRIC, k, 0.02) for k in (1, 0)]
    assert [item.motion.returns.tolist() for item in pair] == [ONE.tolist(), OTHER.tolist()]
    assert asked == [("measure", 1, 100), ("captured", 0, TUNING.smallest_radius)]
    # Within the resolution of its mirror image it is its own.
    (own,), _ = add([motion()], None, [0.02], mirror=ONE + 9e-4)
    assert (own.symmetry, own.partner) == (SYMMETRIC, 0)
    assert own.motion.returns.tolist() == [*ONE.tolist(), *OTHER.tolist()]
    (still,), _ = add([motion(9e-7)], None, [0.02])
    assert (still.symmetry, still.partner) == (SYNCHRONIZED, 0)
    unequal = Model(Chain(3, threshold=(1.0, 1.0, 0.9)), law_of("linearized", 0.08))
    (alone,), _ = add([motion(9e-7)], None, [0.02], unequal, mirror=ONE[:0])
    assert (alone.symmetry, alone.partner) == (ASYMMETRIC, 0)


def test_partners_are_numbered_after_what_is_known(add):
    """As what is known is left as it was, whether something is added or not."""
    known = [stand_in(partner=k) for k in range(2)]
    for mean, mirror, partners in ((9e-7, OTHER, [2]), (0.1, ONE, [2]), (0.1, OTHER, [3, 2])):
        found, asked = add([motion(mean)], None, [0.02], mirror=mirror, known=known)
        assert found[:2] == known
        assert [item.partner for item in found[2:]] == partners
        assert asked[-1] == ("captured", 2, TUNING.smallest_radius)
    assert add([motion(9e-7)], None, [0.0], known=known)[0] == known


def test_a_slow_set_with_a_known_attractor_in_its_midst_is_no_other_one(add):
    drifting = motion(exponent=np.array([0.0, -0.1, -0.2]))
    pair, asked = add([drifting], None, [0.0, 1e-7], known=[stand_in()], inner=[0])
    assert [item.slow for item in pair] == [False] * 3
    assert [least for name, _, least in asked if name == "captured"] == [TUNING.smallest_radius, TUNING.tiny_radius]


def test_chaos_has_to_last(add):
    chaos, orbit = motion(kind=MotionKind.CHAOTIC), motion()
    closed, open_still = (shown(OTHER, ONE, spacing, 0.0) for spacing in (CLOSED, WIDE))
    (first, _), asked = add([chaos], open_still, [0.02], spacing=WIDE)
    assert first.motion is chaos
    assert asked == [("measure", 1, 400), ("visit", SETTINGS.time_limit, 100), ("captured", 0, TUNING.smallest_radius)]
    (first, _), _ = add([chaos, orbit], closed, [0.02], spacing=WIDE)
    assert first.motion.exponent is orbit.exponent
    assert add([chaos], None, [], spacing=WIDE)[0] == []
    # What cannot be measured is nothing.
    assert add([None], None, [])[0] == []


def test_thin_chaos_may_look_closed(add):
    chaos, orbit = motion(kind=MotionKind.CHAOTIC), motion()
    elsewhere, there = (shown(ONE, OTHER, CLOSED, drift) for drift in (1.1e-5, 0.9e-5))
    (first, _), asked = add([chaos], elsewhere, [0.02])
    assert first.motion is chaos
    assert [name for name, *_ in asked] == ["measure", "visit", "captured"]
    assert add([chaos, orbit], there, [0.02])[0][0].motion.exponent is orbit.exponent


@pytest.mark.parametrize(
    ("error", "stops", "measured", "captured"),
    [
        (0.02, (9, 9, 9), 1, True),
        (0.0201, (9, 9, 9), 2, True),  # it has left for another motion
        (0.0201, (50, 101, 49), 1, True),
        (0.0201, None, 1, False),
    ],
)
def test_what_is_no_chaos_has_to_be_steady(add, error, stops, measured, captured):
    """By the error of ⟨J⟩, and then by how often its blocks stop later."""
    first = motion(1.0, kind=MotionKind.QUASIPERIODIC, mean_distance_error=error)
    later = None if stops is None else shown(OTHER, ONE, WIDE, 0.0, stops)
    steady = replace(first, mean_distance_error=0.0)
    pair, asked = add([first, steady][:measured], later, [0.02][:captured], spacing=WIDE)
    assert [name for name, *_ in asked].count("visit") == (error > 0.02)
    assert [item.motion.mean_distance_error for item in pair] == [error if measured == 1 else 0.0] * 2 * captured


@pytest.mark.parametrize("kind", [MotionKind.QUASIPERIODIC, MotionKind.UNDETERMINED])
def test_what_repeats_is_a_closed_orbit_whatever_its_exponents(add, kind):
    pair, asked = add([motion(kind=kind, period=2000.0)], None, [0.02])
    assert [item.motion.kind for item in pair] == [MotionKind.PERIODIC] * 2
    assert "visit" not in [name for name, *_ in asked]
    (as_one,), _ = add([motion(9e-7, kind=kind)], None, [0.02])
    assert as_one.motion.kind == MotionKind.SYNCHRONIZED
    # Locked with a longer period, or with one that nobody has seen.
    for period in (2001.0, np.nan):
        pair, _ = add([motion(kind=kind, period=period)], None, [0.02])
        assert [item.motion.kind for item in pair] == [MotionKind.QUASIPERIODIC] * 2


def test_what_attracts_as_a_whole_is_a_slow_set(add):
    smallest, tiny = ("captured", 0, TUNING.smallest_radius), ("captured", 0, TUNING.tiny_radius)
    # Pushes shrink by e within the time for which a slow set is shown.
    marginal = -1.0 / (TUNING.slow_time * SETTINGS.transient)
    drifting = motion(exponent=np.array([0.0, 0.99 * marginal, -0.2]))
    (slow,), asked = add([drifting], None, [0.0, 0.02])
    assert (slow.slow, slow.symmetry, slow.partner) == (True, SYMMETRIC, 0)
    assert slow.motion.returns.tolist() == [*ONE.tolist(), *ONE.tolist()]
    # What pushed states show on one side only is a pair.
    pair, _ = add([drifting], None, [0.0, 0.02], mirror_cloud=OTHER)
    assert [(item.slow, item.symmetry, item.partner) for item in pair] == [(True, ASYMMETRIC, k) for k in (1, 0)]
    assert pair[1].motion.returns.tolist() == OTHER.tolist()
    assert asked[1:] == [smallest] * 2
    # An orbit in the midst of chaos is not all of it, and may attract from nearby alone; as may one that pushes soon
    # fall back to, but what is no orbit may still lie on a set.
    quick = motion(exponent=np.array([0.0, 1.01 * marginal, -0.2]))
    for found, in_chaos in ((drifting, True), (quick, False)):
        pair, asked = add([found], None, [0.0, 1e-7], in_chaos=in_chaos)
        assert (len(pair), pair[0].slow, asked[-2:]) == (2, False, [smallest, tiny])
    assert add([quick], None, [0.0, 0.02], spacing=WIDE)[0][0].slow
    # A closed orbit may attract from one side only; next to synchrony what does not attract is unstable.
    pair, asked = add([drifting], None, [0.0, 0.0, 1e-7])
    assert (len(pair), asked[-1]) == (2, tiny)
    assert add([drifting], None, [0.0, 0.0], spacing=WIDE)[0] == []
    assert add([replace(drifting, mean_distance=9.9e-3)], None, [0.0])[0] == []
    assert len(add([replace(drifting, mean_distance=1.01e-2)], None, [0.0, 0.02])[0]) == 1


def test_every_attractor_captures_after_the_returns_that_the_tuning_says(add):
    tuning = replace(TUNING, close_returns=5)
    drifting = motion(exponent=np.array([0.0, -0.1, -0.2]))
    for radii, spacing in (([0.02], WIDE), ([0.0, 0.02], CLOSED), ([0.0, 0.02], WIDE)):
        found, _ = add([drifting], None, radii, spacing=spacing, tuning=tuning)
        assert [item.close_returns for item in found] == [5] * len(found)
        assert found


@pytest.mark.parametrize(
    ("modulus", "mean", "found"),
    [
        (0.999, 5e-4, [SYNCHRONIZED]),
        (1.0, 5e-4, []),
        (None, 5e-4, []),  # there is no such orbit
        (0.999, 1.1e-3, [ASYMMETRIC] * 2),
    ],
)
def test_synchrony_that_is_slow_is_told_by_its_multipliers(monkeypatch, modulus, mean, found):
    """Within the resolution of it; pushes need not come back as close as off any other motion."""
    exact, asked = motion(0.0), []

    def orbit(model):
        if modulus is None:
            raise OrbitError("none")
        return SimpleNamespace(reference=state_of(OTHER[0]))

    def captured(*arguments):
        asked.append((arguments[2], arguments[-1].recovery))
        return 0.02

    monkeypatch.setattr(attractors, "synchronized_orbit", orbit)
    monkeypatch.setattr(attractors, "multipliers", lambda orbit: SimpleNamespace(whole=[modulus]))
    monkeypatch.setattr(attractors, "measure", lambda model, start, *_: exact if start.position[0] == 2.0 else None)
    monkeypatch.setattr(settling, "measure", lambda *_: motion(mean))
    monkeypatch.setattr(attractors, "captured", captured)
    known, tuning = [stand_in(ASYMMETRIC, returns=9.0 * ONE)], replace(TUNING, close_returns=5)
    search = Search(MODEL, SETTINGS, tuning=tuning, attractors=known)
    assert search._add(shown(ONE, OTHER, CLOSED, 0.0)) == bool(found)
    new = search.attractors[1:]
    assert [item.symmetry for item in new] == found
    slow = found == [SYNCHRONIZED]
    assert [item.motion is exact for item in new] == [slow] * len(found)
    assert asked == [(1, TUNING.slow_recovery if slow else TUNING.recovery)] * bool(found)
    assert not slow or (new[0].partner, new[0].close_returns) == (1, 5)


@pytest.fixture
def search(monkeypatch):
    """A search that knows a mirror pair and a slow set, and whose trajectories reach what is told."""
    pair = [stand_in(ASYMMETRIC, 0.1, partner, returns=place) for partner, place in ((1, ONE), (0, OTHER))]
    found = Search(MODEL, SETTINGS, attractors=[*pair, stand_in(partner=2, returns=3.0 * ONE, slow=True)])
    found.told, found.followed = [], []

    def reach(start):
        found.followed.append(start)
        answer = found.told.pop(0)
        if answer == "new":
            found.attractors = [*found.attractors, found.attractors[2]]
        return answer

    monkeypatch.setattr(found, "reach", reach, raising=False)
    return found


@pytest.mark.parametrize(
    ("place", "spacing", "expected"),
    [
        (ONE, CLOSED, 0),
        (OTHER + 5e-4, CLOSED, 1),
        (3.0 * ONE + 9e-4, CLOSED, 2),
        (3.0 * ONE + 1.1e-3, CLOSED, -1),
        (5.0 * ONE, WIDE, -1),
    ],
)
def test_what_a_state_reaches(search, monkeypatch, place, spacing, expected):
    sizes = []
    monkeypatch.setattr(attractors, "pushed", lambda start, size, generator: sizes.append(size) or start)
    monkeypatch.setattr(search, "settle", lambda start: shown(place, -place, spacing, 0.0))
    monkeypatch.setattr(search, "_add", lambda found: False)
    assert Search.reach(search, None) == expected
    # Off a motion that is none it is pushed twice, by a tenth of the resolution.
    assert sizes == pytest.approx([1e-4, 1e-4] if expected < 0 else [])
    monkeypatch.setattr(search, "settle", lambda start: None)
    assert Search.reach(search, None) == -1


def test_an_orbit_on_a_slow_set_is_itself_where_it_is_known(search, monkeypatch):
    """Although the set is listed before it, and is as near as its own returns are to each other."""
    slow = stand_in(returns=ONE + 0.05, spacing=0.1, slow=True)
    search.attractors = [slow, stand_in(partner=1, returns=ONE)]
    monkeypatch.setattr(search, "settle", lambda start: shown(ONE, -ONE, CLOSED, 0.0))
    assert Search.reach(search, None) == 1


def test_what_is_handed_on_is_pushed_off_its_symmetry():
    """By up to a tenth of the resolution, at twice the speed of the paper twice that, and by the seed."""
    many = [stand_in(partner=k) for k in range(20)]
    pushes = []
    for seed in (3, 3, 4):
        search = Search(Model(Chain(3), law_of("linearized", 0.08), 0.2), replace(SETTINGS, seed=seed))
        pushes.append([start.position - many[0].motion.state().position for start in search.seeds(many)])
    assert 1.8e-4 < np.abs(pushes[0]).max() <= 2e-4
    assert np.array_equal(pushes[0], pushes[1])
    assert not np.array_equal(pushes[0], pushes[2])


def test_states_are_followed_until_something_is_found(search):
    search.told = [-1, 0, "new", -1, -1, -1, 0]
    states = {name: state_of(np.full(6, float(ord(name)))) for name in "abcdefghij"}
    # No more than three at a time, six in all, and none twice, in vain.
    for starts, found, followed, vain in (("abcd", True, "abc", 2), ("efgh", False, "efg", 5), ("aij", False, "i", 6)):
        search.followed.clear()
        assert search.discover([states[name] for name in starts]) == found
        assert (search.followed, len(search.vain)) == ([states[name] for name in followed], vain)


def test_labels_are_verified_much_closer_to_the_attractors(search, tell):
    asked, labels = tell(attractors, "label", [(np.array([0, 2, 1, 0, 2]), None)] * 3), np.array([0, 1, 1, -1, 2])
    for answer in (1, -1):
        search.told = [answer]
        assert search._verified("abcde", labels)
    assert search.followed == ["b", "b"]
    assert [item.radius for item in asked[0][1]] == pytest.approx([0.001, 0.001, 0.001])
    # One that settles elsewhere halves the radius of what it was ascribed to, and of its mirror image.
    search.told = [2]
    assert not search._verified("abcde", labels)
    assert [item.radius for item in search.attractors] == [0.005, 0.005, 0.01]


def test_states_that_are_ascribed_to_chaos_are_followed(search):
    chaos = stand_in(partner=2, kind=MotionKind.CHAOTIC)
    search.attractors[1:] = [chaos, replace(chaos, slow=True)]
    search.told = [1] * 6
    assert search._single("abcdefghij", np.array([1, 0, 1, 1, 1, 2, 1, 1, 1, 1]))
    assert search.followed == list("acdegh")
    search.told = ["new"]
    assert not search._single("ab", np.array([0, 1]))
