"""Which periodic orbits are continued, tested with constructed ones."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

from burridge_knopoff import Model, MotionKind, OrbitError
from burridge_knopoff.continuation import followed_orbits
from burridge_knopoff.continuation.branch_changes import BranchChange, Change
from burridge_knopoff.motion.synchronized_orbit import synchronized_orbit
from burridge_knopoff.periodic_orbits.branch_segment import HalfBranch
from burridge_knopoff.periodic_orbits.parameter_line import line_along_a
from burridge_knopoff.periodic_orbits.pseudo_arclength import begin_branch


@pytest.mark.parametrize("processes", [1, 4, 8])
@pytest.mark.parametrize(
    ("failing", "expected", "numbers"),
    [(None, [1.0, 1.01, 0.99], {0: 0, 1: 0, 2: 1, 3: 2}), (1.0, [1.01, 1.0001, 0.99], {1: 1, 2: 0, 3: 2})],
)
def test_orbits_of_different_periods_are_continued_separately(
    monkeypatch, tmp_path, processes, failing, expected, numbers
):
    """At one a and with the same stops, periods that differ by 1e-4 are one orbit, by 1e-2 two orbits.

    So are results from the cache, of which one may be that an orbit cannot be followed.
    """
    orbit = synchronized_orbit(Model("linearized", a=0.05))
    periods = [1.0, 1.0001, 1.01, 0.99]

    def limit_cycle(model, at):
        slot = round(float(at.position[0] + model.sliding_offset[0]))
        return replace(orbit, return_time=periods[slot] * orbit.return_time)

    def alone(start, *_):
        if start.period == pytest.approx((failing or 0.0) * orbit.period, rel=1e-6):
            raise OrbitError("cannot be followed")
        return HalfBranch([begin_branch(start, True, line_along_a(start.model.chain))])

    monkeypatch.setattr(followed_orbits, "limit_cycle", limit_cycle)
    monkeypatch.setattr(followed_orbits, "follow_half_branch", alone)
    slots = {"branch": [0, 1, 2, 3], "side": [0] * 4, "kind": [MotionKind.PERIODIC] * 4, "period": [6.0] * 4}
    table = xr.Dataset({name: ("attractor", values) for name, values in slots.items()}).expand_dims("value")
    table.attrs["refine_longest_period"] = 500.0
    names, position = ("value", "attractor", "block"), np.zeros((1, 4, 3))
    position[0, :, 0] = range(4)
    table = table.assign(a=("value", [0.05]), in_grid=("value", [1]), position=(names, position))
    table["velocity"] = names, np.zeros((1, 4, 3))
    for _ in range(2):
        followed_set = followed_orbits.follow_orbits(orbit.model, table, [], processes, tmp_path)
    assert followed_set.of_place == {(0, slot): number for slot, number in numbers.items()}
    assert [followed_set.of_place[place] for place in followed_set.places] == list(range(len(expected)))
    followed = [item.upward.orbits[0].orbit.period / orbit.period for item in followed_set.segments]
    assert followed == pytest.approx(expected)


def test_the_longest_orbits_are_continued_first_and_neighbours_late():
    periods = [6.0] * 8 + [100.0, 6.3, 90.0]
    placed = [((k, 0), type("Orbit", (), {"period": period})) for k, period in enumerate(periods)]
    # Their places within an octave are those of the van der Corput sequence.
    assert [k for (k, _), _ in followed_orbits._sort(placed)] == [8, 10, 0, 4, 2, 6, 1, 9, 5, 3, 7]


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        ([], [(0, 0), (4, 0)]),
        ([(1, 2, 0, 0)], [(0, 0), (1, 0), (2, 0), (4, 0)]),
        # A branch has no attractor before its beginning.
        ([(1, 2, -1, 0)], [(0, 0), (2, 0), (4, 0)]),
        # Chaos is not a periodic orbit, and one orbit of a mirror pair is followed.
        ([(2, 3, 0, 0), (2, 3, 1, -1)], [(0, 0), (2, 0), (4, 0)]),
    ],
)
def test_between_values_of_the_grid_orbits_are_continued_next_to_changes(changes, expected):
    kind = np.full((5, 2), MotionKind.PERIODIC)
    kind[3] = MotionKind.CHAOTIC
    slots = {"branch": np.tile([0, 1], (5, 1)), "side": np.tile([0, -1], (5, 1)), "kind": kind}
    slots["period"] = np.full((5, 2), 6.0)
    table = xr.Dataset({name: (("value", "attractor"), values) for name, values in slots.items()})
    table.attrs["refine_longest_period"] = 500.0
    table = table.assign(in_grid=("value", [1, 0, 0, 0, 1]))
    known_changes = [BranchChange(*change, 0, 0, Change.CHANGE) for change in changes]
    assert followed_orbits._places(table, known_changes) == expected
    # Longer orbits are not followed.
    table["period"][0] = 501.0
    assert followed_orbits._places(table, known_changes) == [place for place in expected if place[0] != 0]
