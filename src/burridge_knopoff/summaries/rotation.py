"""The rotation number of branch 1 over (law, a), at all values of `refined`, and which part of a is locked.

Branch 1 is the motion without synchrony that `plus` reaches at a = 0.08. By mirror symmetry its end blocks have one
frequency at every a; whether it is locked is shown by its rotation number (`motion.rotation`).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray

from burridge_knopoff.dataset.summary import summary
from burridge_knopoff.dataset.variables import YES_OR_NO, Variable, flag
from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.motion.kind import REGULAR, MotionKind
from burridge_knopoff.motion.rotation import rotation_number

BRANCH = 1

#: Time for which the motion is followed at each a: the error is then below 1e-5 as a rule, on closed orbits far less.
FOLLOWED = 1000.0

_VALUE = ("law", "value")
VARIABLES = {
    "a": Variable(_VALUE, "f8", "friction parameter a, ascending; NaN beyond the last value of a law"),
    "in_grid": Variable(_VALUE, "i1", "whether a is in the grid of the study", YES_OR_NO),
    "rotation_number": Variable(
        _VALUE,
        "f8",
        "oscillations of the end blocks against each other for one of the middle block",
        {"comment": "NaN where there is no such motion, or an oscillation has no phase"},
    ),
    "rotation_error": Variable(_VALUE, "f8", "difference of the rotation number between both halves of the time"),
    "locked": Variable(
        _VALUE, "i1", "whether the motion is a closed orbit", flag("i1", {-1: "unknown", 0: "no", 1: "yes"})
    ),
}


def summarize(refined: xarray.Dataset, models: Sequence[Model]) -> xarray.Dataset:
    """Return the rotation number of branch 1 at all values of a, and where it is locked.

    refined : the summary of that name; models : one for each of its laws, at any a
    """
    shape = (refined.sizes["law"], refined.sizes["value"])
    values = {
        name: np.full(shape, -1 if item.dtype == "i1" else np.nan, item.dtype) for name, item in VARIABLES.items()
    }
    values["a"], values["in_grid"] = refined["a"].values, refined["in_grid"].values
    # Of a mirror pair, into which the branch parts where the middle block makes an odd number of turns, one is enough.
    slots = (refined["branch"].values == BRANCH) & (refined["side"].values >= 0)
    slots &= np.isin(refined["kind"].values, REGULAR)
    for law, value, slot in np.argwhere(slots).tolist():
        at = law, value
        one = refined.isel(law=law, value=value, attractor=slot)
        model, velocity = models[law].at(float(values["a"][at])), one["velocity"].values
        start = ChainState(one["position"].values - model.sliding_offset, velocity, velocity == 0.0)
        values["rotation_number"][at], values["rotation_error"][at] = rotation_number(model, start, FOLLOWED)
        values["locked"][at] = one["kind"].item() == MotionKind.PERIODIC
    attributes = {"branch": BRANCH, "duration": FOLLOWED, "history": "snakemake, from refined.nc"}
    coordinates = {"law": refined["law"].variable}
    return summary("Rotation number of branch 1", VARIABLES, values, coordinates, attributes, module=__name__)
