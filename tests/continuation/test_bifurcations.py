"""Entries in the list of bifurcations, for constructed orbits and branches."""

from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr

from burridge_knopoff import BifurcationKind, MotionKind
from burridge_knopoff.continuation.bifurcations import LEAST_ERROR, entries
from burridge_knopoff.continuation.branch_changes import BranchChange, Change
from burridge_knopoff.continuation.followed_orbits import FollowedOrbits

A = [0.1, 0.11]


def ends(a):
    """Return an orbit that is followed in both directions to a bifurcation at a, and no further."""
    way = SimpleNamespace(
        end=SimpleNamespace(a=a, kind=BifurcationKind.FOLD) if a is not None else None, bifurcations=[]
    )
    return SimpleNamespace(upward=way, downward=way)


@pytest.mark.parametrize(
    ("first", "second", "expected"),
    [
        (0.104, 0.106, [0.104, 0.106]),
        (0.104, 0.104 + 0.5 * LEAST_ERROR, [0.104]),
        (0.104, 0.104 + 2.0 * LEAST_ERROR, [0.104, 0.104 + 2.0 * LEAST_ERROR]),
        # More than a step of the grid away the change is not due to this orbit.
        (0.104, 0.1201, [0.104]),
        (0.0899, 0.106, [0.106]),
        (0.0901, 0.1199, [0.0901, 0.1199]),
        (None, 0.106, [0.106]),
        # Not located: the middle of the range.
        (None, None, [0.105]),
    ],
)
def test_a_change_has_an_entry_for_each_of_its_two_ends(first, second, expected):
    slots = {"branch": [[0], [1]], "kind": [[1], [1]], "lifetime_low": [[np.nan]] * 2, "lifetime_high": [[np.nan]] * 2}
    table = xr.Dataset({name: (("value", "attractor"), values) for name, values in slots.items()})
    table = table.assign(a=("value", A), in_grid=("value", [1, 1]), side=table["branch"] * 0)
    change = BranchChange(0, 1, 0, 0, 0, 1, Change.CHANGE)
    followed = FollowedOrbits([ends(first), ends(second)], [(0, 0), (1, 0)], {(0, 0): 0, (1, 0): 1})
    listed = entries(table, [change], followed)
    assert [entry.a for entry in listed] == pytest.approx(expected, rel=1e-15)
    assert {(entry.low, entry.high, entry.from_branch, entry.to_branch) for entry in listed} == {(*A, 0, 1)}
    located = first is not None or second is not None
    assert {entry.kind for entry in listed} == {BifurcationKind.FOLD if located else BifurcationKind.UNDETERMINED}


@pytest.mark.parametrize(("before", "after"), [(0, -1), (-1, 0), (0, 0)])
def test_uniform_sliding_begins_and_ends_in_a_hopf_bifurcation(before, after):
    """A real eigenvalue cannot cross 0, so that the kind is certain where the place is not located."""
    kinds = [[MotionKind.SLIDING if before == 0 else MotionKind.PERIODIC], [MotionKind.SLIDING]]
    slots = {"branch": [[0], [0]], "kind": kinds, "lifetime_low": [[np.nan]] * 2, "lifetime_high": [[np.nan]] * 2}
    table = xr.Dataset({name: (("value", "attractor"), values) for name, values in slots.items()})
    table = table.assign(a=("value", A), in_grid=("value", [1, 1]), side=table["branch"] * 0)
    (entry,) = entries(table, [BranchChange(0, 1, before, after, 0, 0, Change.CHANGE)], FollowedOrbits([], [], {}))
    assert entry.kind == BifurcationKind.HOPF
    assert (entry.low, entry.high) == (0.1, 0.11)
