"""What precedes chaos, on hand-made branches."""

import numpy as np
import pytest
import xarray as xr

from burridge_knopoff import MotionKind
from burridge_knopoff.claims.paper.locking import _was_chaotic, _was_torus
from burridge_knopoff.continuation.branch_changes import Change

PERIODIC, CHAOTIC, TORUS = MotionKind.PERIODIC, MotionKind.CHAOTIC, MotionKind.QUASIPERIODIC


@pytest.mark.parametrize(
    ("change", "kinds", "expected"),
    [
        # The kind is known at one or two values below the bifurcation; the nearest decides.
        (Change.END, {0.1: CHAOTIC}, True),
        (Change.END, {0.1: PERIODIC}, False),
        (Change.END, {0.05: PERIODIC, 0.1: CHAOTIC}, True),
        (Change.END, {0.05: CHAOTIC, 0.1: PERIODIC}, False),
        # Chaos beyond the bifurcation that did not exist before.
        (Change.END, {0.2: CHAOTIC}, False),
        (Change.BEGINNING, {0.1: CHAOTIC}, False),
    ],
)
def test_a_branch_may_end_on_a_branch_that_was_chaotic_before(change, kinds, expected):
    bifurcations = xr.Dataset(
        {"change": ("bifurcation", [change]), "to_branch": ("bifurcation", [7]), "grid_low": ("bifurcation", [0.1])}
    )
    slots = {"branch": np.tile([3, 7], (len(kinds), 1)), "kind": [[CHAOTIC, kind] for kind in kinds.values()]}
    refined = xr.Dataset({name: (("value", "attractor"), values) for name, values in slots.items()})
    assert _was_chaotic(bifurcations, refined.assign(a=("value", list(kinds)))).tolist() == [expected]


@pytest.mark.parametrize(
    ("kinds", "expected"),
    [
        ([TORUS, PERIODIC, PERIODIC], True),
        ([PERIODIC, TORUS, TORUS], True),
        # A cascade from an orbit that begins as one, and a window in chaos after a torus.
        ([PERIODIC, PERIODIC, PERIODIC], False),
        ([TORUS, CHAOTIC, PERIODIC], False),
        ([TORUS, MotionKind.TRANSIENT_CHAOS, PERIODIC], False),
        # The branch is absent at a value of the grid: it ended and began again. Elsewhere it was not searched for.
        ([TORUS, None, PERIODIC], False),
        ([TORUS, PERIODIC, None, PERIODIC], True),
        # A motion of undetermined kind is passed over; chaos above `low` does not matter.
        ([TORUS, MotionKind.UNDETERMINED, PERIODIC, CHAOTIC], True),
    ],
)
def test_an_orbit_is_locked_if_its_branch_was_a_torus(kinds, expected):
    """The last but one of four values of a lies between those of the grid; another branch moves on a torus."""
    a = 0.1 + 0.01 * np.arange(len(kinds))
    low = a[np.flatnonzero([kind not in (None, CHAOTIC) for kind in kinds])[-1]]
    refined = xr.Dataset(
        {
            "branch": (("value", "attractor"), [[-1 if kind is None else 3, 7] for kind in kinds]),
            "kind": (("value", "attractor"), [[-1 if kind is None else kind, TORUS] for kind in kinds]),
            "in_grid": ("value", [1, 1, 0, 1][: len(kinds)]),
        }
    ).assign(a=("value", a))
    assert _was_torus(changes([]), refined, 3, low) == expected


def changes(rows):
    """Return bifurcations: (change, from branch, to branch, value of a above)."""
    change, source, target, high = zip(*rows, strict=True) if rows else ([], [], [], [])
    columns = {"change": change, "from_branch": source, "to_branch": target, "grid_high": high}
    return xr.Dataset({name: ("bifurcation", np.array(values)) for name, values in columns.items()})


BEGINS, ENDS = (Change.BEGINNING, 3, 4, 0.12), (Change.END, 3, 4, 0.12)


@pytest.mark.parametrize(
    ("rows", "expected"),
    [
        ([BEGINS, ENDS], True),
        ([], False),
        # Each has to lead to the other, and the branch has to begin there.
        ([BEGINS], False),
        ([ENDS], False),
        ([BEGINS, (Change.END, 5, 4, 0.12)], False),
        ([(Change.BEGINNING, 3, 4, 0.13), ENDS], False),
        ([(Change.BEGINNING, -1, 4, 0.12), (Change.END, -1, 4, 0.12)], False),
    ],
)
def test_a_branch_is_followed_to_the_one_that_leads_to_it(rows, expected):
    branch, kind = np.array([[3], [3], [4], [4]]), np.array([[TORUS], [PERIODIC], [PERIODIC], [PERIODIC]])
    refined = xr.Dataset({"branch": (("value", "attractor"), branch), "kind": (("value", "attractor"), kind)})
    refined = refined.assign(a=("value", [0.1, 0.11, 0.12, 0.13]), in_grid=("value", [1, 1, 1, 1]))
    assert _was_torus(changes(rows), refined, 4, 0.13) == expected
