"""What precedes chaos, on hand-made branches."""

import numpy as np
import pytest
import xarray as xr

from burridge_knopoff import MotionKind
from burridge_knopoff.claims.locking import _was_chaotic
from burridge_knopoff.continuation.branch_changes import Change

PERIODIC, CHAOTIC = MotionKind.PERIODIC, MotionKind.CHAOTIC


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
