"""Tori between two orbits: where they are searched for, and their motion in the gap below the orbit of 6 stops."""

from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr

from burridge_knopoff import BifurcationKind, Model, MotionKind, follow, limit_cycle, locate_bifurcations
from burridge_knopoff.attractors.settings import SEARCH
from burridge_knopoff.continuation import tori
from burridge_knopoff.continuation.followed_orbits import FollowedOrbits
from burridge_knopoff.continuation.tori import Torus, TorusPoint
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.motion.rotation import mean_rotation
from burridge_knopoff.motion.settings import MOTION
from burridge_knopoff.running.runner import Runner
from burridge_knopoff.summaries.bifurcations import VARIABLES
from burridge_knopoff.summaries.tori import torus_lines, torus_values

#: Where the orbit with stops 1, 1, 1 ends, and that with 6, 6, 3 begins (linearized law).
END, BIRTH = 0.1122215462, 0.1123857856


@pytest.fixture(scope="module")
def end():
    """The grazing at which the orbit of one turn becomes an unstable focus."""
    model = Model("linearized", a=0.112)
    orbit = limit_cycle(model, model.begin(PAPER_STATES["minus"]), 8000.0)
    (grazing,) = [
        item for item in locate_bifurcations(follow(orbit, (0.112, 0.1123), parameter="a")) if item.loses_stability
    ]
    return grazing


@pytest.fixture(scope="module")
def points(end):
    return tori._points(end.at.orbit, BIRTH, SEARCH, MOTION)


def test_the_motion_between_both_orbits_is_a_torus_with_its_tongues(end, points):
    assert end.a == pytest.approx(END, abs=1e-9)
    assert tori._is_focus(end)
    assert tori._is_torus(points)
    assert len(points) == tori.VALUES
    rotation = np.array([point.rotation for point in points])
    assert (np.diff(rotation) <= 1e-6).all()
    assert 1 / 6 < rotation[-1] < 0.17 < rotation[0] < 0.174
    for point in points:
        turns = point.period / end.period
        # Each orbit closes after a whole number of turns, in which it goes a whole number of times around the focus.
        assert turns == pytest.approx(round(turns), rel=2e-4)
        if point.kind == MotionKind.PERIODIC:
            assert point.rotation * round(turns) == pytest.approx(round(point.rotation * round(turns)), abs=1e-2)


def test_the_rotation_number_counts_the_oscillations_of_an_orbit(points):
    """At a = 0.112231 the orbit closes after 23 stops of block 1, whose positions there have four maxima."""
    model = Model("linearized", a=points[0].a)
    runner = Runner(model, keep_events=True, events_from=30_000.0, stops_only=True)
    runner.begin(model.begin(PAPER_STATES["minus"]))
    runner.run(30_400.0)
    stops = runner.log.events.values()
    position = stops[stops[:, 0] == 1, 2]
    repeats = [n for n in range(1, 40) if np.abs(position[n : n + 24] - position[:24]).max() < 1e-10]
    assert repeats[0] == 23
    left, middle, right = (np.roll(position[:23], k) for k in (1, 0, -1))
    maxima = np.count_nonzero((middle > left) & (middle > right))
    assert maxima == 4
    assert points[0].rotation == pytest.approx(4 / 23, abs=1e-6)


@pytest.mark.parametrize("number", [0.17, 0.01, 3 / 7, (np.sqrt(5.0) - 1.0) / 4.0])
def test_rotation_on_a_curve_of_known_rotation_number(number):
    angle = 2.0 * np.pi * number * np.arange(2000)
    # A curve around its centre, in four coordinates, along which the angle does not grow evenly.
    angle = angle + 0.3 * np.sin(angle)
    curve = np.stack([3.0 * np.cos(angle), np.sin(angle), 0.1 * np.cos(2.0 * angle), np.ones(len(angle))], axis=1)
    assert mean_rotation(curve) == pytest.approx(number, abs=1e-6)


def segment(low, high, focus):
    """Return a segment of orbits that are stable between two values; focus : whether it ends as a focus there."""
    leading = SimpleNamespace(whole=np.array([0.5 + 1.2j if focus else 1.2 + 0.0j]))
    after = SimpleNamespace(multipliers=leading)
    ends = (SimpleNamespace(a=a, after=after, is_turning_point=False) for a in (low, high))
    return SimpleNamespace(
        **{side: SimpleNamespace(end=end) for side, end in zip(("downward", "upward"), ends, strict=True)}
    )


A = [0.10, 0.11, 0.12, 0.13, 0.14]
PERIODIC, TORUS, CHAOTIC = (int(MotionKind[name]) for name in ("PERIODIC", "QUASIPERIODIC", "CHAOTIC"))


def gaps(kinds, segments, places, in_grid=(1, 0, 0, 0, 1), branch=(3, 3, 3, 3, 3)):
    """Return (branch, end, far) of the gaps on one branch with these kinds at A, and these segments at some places."""
    slots = {"branch": [[n] for n in branch], "side": [[0]] * 5, "kind": [[kind] for kind in kinds]}
    table = xr.Dataset({name: (("value", "attractor"), values) for name, values in slots.items()})
    table = table.assign(a=("value", A), in_grid=("value", list(in_grid))).assign_attrs(refine_resolution=1e-3)
    followed = FollowedOrbits(segments, [], {(k, 0): n for k, n in places.items()})
    return [(gap.branch, gap.end.a, gap.far) for gap in tori._gaps(table, followed)]


FIRST, TONGUE, NEXT = segment(0.09, 0.115, True), segment(0.1199, 0.1201, False), segment(0.125, 0.15, False)
PLACES = {0: 0, 1: 0, 2: 1, 3: 2, 4: 2}


def test_a_gap_reaches_from_a_focus_to_the_next_orbit_that_is_no_tongue():
    assert gaps([PERIODIC] * 5, [FIRST, TONGUE, NEXT], PLACES) == [(3, 0.115, 0.125)]
    # The same towards smaller a.
    below, focus = segment(0.09, 0.115, False), segment(0.125, 0.15, True)
    assert gaps([PERIODIC] * 5, [below, TONGUE, focus], PLACES) == [(3, 0.125, 0.115)]
    # A value between both need not be an orbit that was followed.
    assert gaps([PERIODIC] * 5, [FIRST, TONGUE, NEXT], {0: 0, 1: 0, 3: 2, 4: 2}) == [(3, 0.115, 0.125)]


@pytest.mark.parametrize(
    ("kinds", "segments", "options"),
    [
        # The first orbit ends otherwise; a value shows the torus; chaos follows; the branch has ended at a grid value.
        ([PERIODIC] * 5, [segment(0.09, 0.115, False), TONGUE, NEXT], {}),
        ([PERIODIC, PERIODIC, TORUS, PERIODIC, PERIODIC], [FIRST, NEXT, NEXT], {"places": {0: 0, 1: 0, 3: 2, 4: 2}}),
        ([PERIODIC, PERIODIC, CHAOTIC, PERIODIC, PERIODIC], [FIRST, NEXT, NEXT], {"places": {0: 0, 1: 0, 3: 2, 4: 2}}),
        ([PERIODIC] * 5, [FIRST, TONGUE, NEXT], {"branch": [3, 3, -1, 3, 3], "in_grid": [1, 1, 1, 1, 1]}),
        # The next orbit overlaps with the first one.
        ([PERIODIC] * 5, [FIRST, TONGUE, segment(0.114, 0.15, False)], {}),
    ],
)
def test_no_torus_is_searched_for_elsewhere(kinds, segments, options):
    assert gaps(kinds, segments, **{"places": PLACES, **options}) == []


def test_orbits_of_one_rotation_number_are_no_torus():
    def motions(kinds, rotation):
        return [TorusPoint(0.1, kind, 100.0, number) for kind, number in zip(kinds, rotation, strict=True)]

    locked = [MotionKind.PERIODIC] * 4
    assert not tori._is_torus(motions(locked, [1 / 6] * 4))
    assert not tori._is_torus(motions(locked, [1 / 6, 1 / 6, 1 / 7, 1 / 7]))
    assert not tori._is_torus(motions(locked, [np.nan] * 4))
    assert not tori._is_torus([])
    assert tori._is_torus(motions(locked, [0.174, 0.173, 0.172, 0.171]))
    assert tori._is_torus(motions([*locked[:3], MotionKind.QUASIPERIODIC], [1 / 6] * 4))


def test_tori_in_the_file_and_in_words():
    motions = [
        TorusPoint(0.1122, MotionKind.PERIODIC, 131.4, 4 / 23),
        TorusPoint(0.1123, MotionKind.QUASIPERIODIC, np.nan, 0.17),
    ]
    torus = Torus(3, SimpleNamespace(kind=BifurcationKind.GRAZING), END, BIRTH, motions)
    values = torus_values([torus])
    assert values["torus_a"].shape == (1, tori.VALUES)
    assert values["torus_rotation_number"][0, :2].tolist() == [4 / 23, 0.17]
    assert np.isnan(values["torus_a"][0, 2:]).all()
    assert values["torus_kind"][0, :3].tolist() == [
        MotionKind.PERIODIC,
        MotionKind.QUASIPERIODIC,
        MotionKind.UNDETERMINED,
    ]
    names = [name for name in VARIABLES if name.startswith("torus_")]
    data = xr.Dataset(
        {name: (VARIABLES[name].dimensions, {**values, "torus_law": ["linearized"]}[name]) for name in names}
    )
    assert [*torus_lines(data)] == [
        "linearized, a = 0.1122215462 to 0.1123857856: torus; branch 3; locked at 1 of 2 values; "
        "rotation number 0.17000 to 0.17391"
    ]
    assert [*torus_lines(data.isel(torus=slice(0)))] == []
