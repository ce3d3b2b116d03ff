"""The search of attractors step by step, each with what the others answer told beforehand."""

import dataclasses

import numpy as np
import pytest

from burridge_knopoff import Chain, Model, law_of
from burridge_knopoff.stability import attractors
from burridge_knopoff.stability.attractor import Symmetry
from burridge_knopoff.stability.attractors import Search
from burridge_knopoff.stability.motion import MotionKind
from burridge_knopoff.stability.settings import SearchSettings
from burridge_knopoff.stability.steady import Returns, instant_of
from burridge_knopoff.stability.tuning import TUNING
from tests.stability.stand_in import stand_in

SETTINGS = SearchSettings(transient=2000.0, window=1500.0)


def model():
    return Model(Chain(3), law_of("linearized", 0.08))


@pytest.mark.parametrize(
    ("spacing", "symmetric", "drifts", "windows", "transients", "found"),
    [
        (1e-7, False, [0.0], [1], [1], True),
        # A set that is no closed orbit has to fill: its own mirror image soon, any other in the longest window.
        (0.01, True, [0.0] * 3, [1, 2, 4], [1, 1, 1], True),
        (0.01, False, [0.0] * 5, [1, 2, 4, 8, 16], [1] * 5, True),
        (0.01, True, [1.0, 1.0, 0.0], [1, 2, 4], [1, 2, 4], True),
        # What has not settled has twice the time, and is let go if it drifts by more than ten resolutions.
        (1e-7, False, [2e-5, 0.0], [1, 1], [1, 2], True),
        (1e-7, False, [9e-3] * 5, [1] * 5, [1, 2, 4, 8, 16], True),
        (1e-7, False, [1.1e-2] * 5, [1] * 5, [1, 2, 4, 8, 16], False),
        (1e-7, False, [1.0, None], [1, 1], [1, 2], False),
    ],
)
def test_a_motion_is_given_time_to_settle(monkeypatch, spacing, symmetric, drifts, windows, transients, found):
    returns, asked = np.array([[1.0, 0.0, 0.0, 0.0, 0.1, 0.1]]), []

    def scripted(of_model, start, transient, window, *_):
        asked.append((transient / SETTINGS.transient, window / SETTINGS.window))
        drift = drifts[len(asked) - 1]
        return None if drift is None else Returns(returns, returns if symmetric else -returns, spacing, drift)

    monkeypatch.setattr(attractors, "visit", scripted)
    settled = Search(model(), SETTINGS)._settle(instant_of(returns[0]))
    assert (settled is not None) == found
    assert asked == list(zip(transients, windows, strict=True))


CLOSED, WIDE = 1e-7, 0.01
ONE, OTHER = np.array([[1.0, 0.0, 0.0, 0.0, 0.1, 0.1]]), np.array([[2.0, 0.0, 0.0, 0.0, 0.1, 0.1]])


@pytest.fixture
def scripted(monkeypatch):
    """Return how a motion is added: what it is measured to be, where it is after a while, and the radii that are found.

    What is asked for is kept in `asked`, transients and windows in those of the settings.
    """
    asked = []

    def add(measured, lasting, radii, found_model=None, mirror=OTHER, spacing=CLOSED, in_chaos=False):
        measured, radii = list(measured), list(radii)

        def measure(of_model, start, transient, window, motion, *_):
            asked.append(("measure", transient / SETTINGS.transient, window / SETTINGS.window))
            return measured.pop(0)

        def visit(of_model, start, transient, window, *_):
            asked.append(("visit", transient / SETTINGS.transient, window / SETTINGS.window))
            return lasting

        def captured(of_model, known, index, least, tolerance, settings, *_):
            asked.append(("captured", index, least))
            return radii.pop(0)

        for name, item in (("measure", measure), ("visit", visit), ("captured", captured)):
            monkeypatch.setattr(attractors, name, item)
        monkeypatch.setattr(Search, "_lies_in_chaos", lambda *_: in_chaos)
        monkeypatch.setattr(attractors, "bounded", lambda of_model, known, *_: list(known))
        monkeypatch.setattr(attractors, "midst", lambda known, index, *_: [])
        monkeypatch.setattr(attractors, "spread", lambda of_model, motion, *_: dataclasses.replace(motion, returns=ONE))
        search = Search(found_model or model(), SETTINGS)
        added = search._add(Returns(ONE, mirror, spacing, 0.0))
        assert not measured
        assert not radii
        assert added == bool(search.attractors)
        return search.attractors, asked

    return add


def motion(mean_distance=0.1, **told):
    return stand_in(Symmetry.ASYMMETRIC, mean_distance, 0, returns=ONE, mirror_returns=OTHER, **told).motion


def test_a_motion_is_added_with_its_mirror_image(scripted):
    pair, asked = scripted([motion()], None, [0.02])
    assert [(item.symmetry, item.partner, item.radius) for item in pair] == [
        (Symmetry.ASYMMETRIC, 1, 0.02),
        (Symmetry.ASYMMETRIC, 0, 0.02),
    ]
    assert [item.motion.returns.tolist() for item in pair] == [ONE.tolist(), OTHER.tolist()]
    assert asked == [("measure", 1, 1), ("captured", 0, TUNING.smallest_radius)]
    # Within the resolution of its mirror image it is its own.
    (own,), _ = scripted([motion()], None, [0.02], mirror=ONE + 9e-4)
    assert (own.symmetry, own.partner) == (Symmetry.SYMMETRIC, 0)
    assert own.motion.returns.tolist() == [*ONE.tolist(), *OTHER.tolist()]
    (still,), _ = scripted([motion(9e-7)], None, [0.02])
    assert (still.symmetry, still.partner) == (Symmetry.SYNCHRONIZED, 0)
    unequal = Model(Chain(3, threshold=(1.0, 1.0, 0.9)), law_of("linearized", 0.08))
    (alone,), _ = scripted([motion(9e-7)], None, [0.02], found_model=unequal, mirror=ONE[:0])
    assert (alone.symmetry, alone.partner) == (Symmetry.ASYMMETRIC, 0)


def test_chaos_has_to_last(scripted):
    chaos = motion(kind=MotionKind.CHAOTIC)
    closed, open_still = (Returns(OTHER, ONE, spacing, 0.0) for spacing in (CLOSED, WIDE))
    (first, _), asked = scripted([chaos], open_still, [0.02], spacing=WIDE)
    assert first.motion is chaos
    assert asked == [("measure", 1, 4), ("visit", 33, 1), ("captured", 0, TUNING.smallest_radius)]
    orbit = motion()
    (first, _), _ = scripted([chaos, orbit], closed, [0.02], spacing=WIDE)
    assert first.motion is orbit
    assert scripted([chaos], None, [], spacing=WIDE)[0] == []
    # A closed orbit is none, whatever its exponents, and needs not last; what cannot be measured is nothing.
    pair, _ = scripted([chaos], None, [0.02])
    assert [item.motion.kind for item in pair] == [MotionKind.PERIODIC] * 2
    assert scripted([None], None, [])[0] == []


def test_what_attracts_as_a_whole_is_a_slow_set(scripted):
    smallest, tiny = TUNING.smallest_radius, TUNING.tiny_radius
    (slow,), asked = scripted([motion()], None, [0.0, 0.02])
    assert (slow.slow, slow.symmetry, slow.partner, slow.motion.returns.tolist()) == (
        True,
        Symmetry.SYMMETRIC,
        0,
        ONE.tolist(),
    )
    assert asked[1:] == [("captured", 0, smallest)] * 2
    # An orbit in the midst of chaos is not all of it, and may attract from nearby alone.
    pair, asked = scripted([motion()], None, [0.0, 1e-7], in_chaos=True)
    assert (len(pair), pair[0].slow, asked[-2:]) == (2, False, [("captured", 0, smallest), ("captured", 0, tiny)])
    # A closed orbit may attract from one side only; next to synchrony what does not attract is unstable.
    pair, asked = scripted([motion()], None, [0.0, 0.0, 1e-7])
    assert (len(pair), asked[-1]) == (2, ("captured", 0, tiny))
    assert scripted([motion()], None, [0.0, 0.0], spacing=WIDE)[0] == []
    assert scripted([motion(9.9e-3)], None, [0.0])[0] == []
    assert len(scripted([motion(1.01e-2)], None, [0.0, 0.02])[0]) == 1


@pytest.fixture
def told_search(monkeypatch):
    """A search that knows a mirror pair and a slow set, and whose trajectories reach what is told."""
    search = Search(model(), SETTINGS)
    pair = [
        stand_in(Symmetry.ASYMMETRIC, 0.1, partner, returns=place, radius=0.01)
        for partner, place in ((1, ONE), (0, OTHER))
    ]
    search.attractors = [*pair, stand_in(Symmetry.SYMMETRIC, 0.2, 2, returns=3.0 * ONE, slow=True, radius=0.01)]
    search.told, search.followed = [], []

    def reach(start):
        search.followed.append(start)
        answer = search.told.pop(0)
        if answer == "new":
            search.attractors = [*search.attractors, search.attractors[2]]
        return answer

    monkeypatch.setattr(search, "reach", reach, raising=False)
    return search


@pytest.mark.parametrize(
    ("place", "spacing", "expected"),
    [(ONE, CLOSED, 0), (OTHER + 5e-4, CLOSED, 1), (3.0 * ONE, CLOSED, 2), (5.0 * ONE, WIDE, -1)],
)
def test_what_a_state_reaches(told_search, monkeypatch, place, spacing, expected):
    sizes = []
    monkeypatch.setattr(attractors, "pushed", lambda start, size, generator: sizes.append(size) or start)
    monkeypatch.setattr(told_search, "_settle", lambda start: Returns(place, -place, spacing, 0.0))
    monkeypatch.setattr(told_search, "_add", lambda found: False)
    assert Search.reach(told_search, None) == expected
    # Off a motion that is none it is pushed twice, by a tenth of the resolution.
    assert sizes == pytest.approx([1e-4, 1e-4] if expected < 0 else [])
    monkeypatch.setattr(told_search, "_settle", lambda start: None)
    assert Search.reach(told_search, None) == -1


def test_states_are_followed_until_something_is_found(told_search):
    told_search.told = [-1, 0, "new", -1, -1, -1, 0]
    assert told_search.discover("abcd")
    assert (told_search.followed, told_search.vain) == (["a", "b", "c"], 2)
    # No more than three at a time, and six in all, in vain.
    assert not told_search.discover("efgh")
    assert (told_search.followed[3:], told_search.vain) == (["e", "f", "g"], 5)
    assert not told_search.discover("ij")
    assert (told_search.followed[6:], told_search.vain) == (["i"], 6)


def test_labels_are_verified_much_closer_to_the_attractors(told_search, monkeypatch):
    narrow = []

    def label(of_model, known, starts, time_limit, *_):
        narrow.append([item.radius for item in known])
        return np.array([0, 2, 1, 0, 2]), None

    monkeypatch.setattr(attractors, "label", label)
    labels = np.array([0, 1, 1, -1, 2])
    for answer in (1, -1):
        told_search.told = [answer]
        assert told_search._verified("abcde", labels)
    assert told_search.followed == ["b", "b"]
    assert narrow[0] == pytest.approx([0.001, 0.001, 0.001])
    # One that settles elsewhere halves the radius of what it was ascribed to, and of its mirror image.
    told_search.told = [2]
    assert not told_search._verified("abcde", labels)
    assert [item.radius for item in told_search.attractors] == [0.005, 0.005, 0.01]


def test_states_that_are_ascribed_to_chaos_are_followed(told_search):
    chaos = stand_in(Symmetry.SYMMETRIC, 0.2, 2, kind=MotionKind.CHAOTIC)
    told_search.attractors[1:] = [chaos, dataclasses.replace(chaos, slow=True)]
    told_search.told = [1] * 6
    assert told_search._single("abcdefghij", np.array([1, 0, 1, 1, 1, 2, 1, 1, 1, 1]))
    assert told_search.followed == list("acdegh")
    told_search.told = ["new"]
    assert not told_search._single("ab", np.array([0, 1]))


@pytest.mark.parametrize(
    ("kind", "later", "in_chaos"),
    [
        (MotionKind.CHAOTIC, WIDE, True),
        (MotionKind.CHAOTIC, CLOSED, False),
        (MotionKind.CHAOTIC, None, False),
        (MotionKind.QUASIPERIODIC, WIDE, False),
        (None, WIDE, False),
    ],
)
def test_what_surrounds_an_orbit_is_seen_from_a_push(monkeypatch, kind, later, in_chaos):
    """Chaos that ends on the orbit belongs to it."""

    def measure(of_model, start, transient, window, *_):
        asked.append((transient / SETTINGS.transient, window / SETTINGS.window))
        assert 0.0 < np.abs(start.position - ONE[0, :3]).max() <= TUNING.slow_push * 1e-3
        return None if kind is None else motion(kind=kind)

    def visit(of_model, start, transient, window, *_):
        asked.append((transient / SETTINGS.transient, window / SETTINGS.window))
        return None if later is None else Returns(ONE, OTHER, later, 0.0)

    asked = []
    monkeypatch.setattr(attractors, "measure", measure)
    monkeypatch.setattr(attractors, "visit", visit)
    assert Search(model(), SETTINGS)._lies_in_chaos(Returns(ONE, OTHER, CLOSED, 0.0)) == in_chaos
    expected = [(TUNING.slow_time, TUNING.filling), (TUNING.lasting, 1)]
    assert asked == expected[: 2 if kind == MotionKind.CHAOTIC else 1]
