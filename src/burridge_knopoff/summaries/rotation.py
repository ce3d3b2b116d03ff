"""Locking of the blocks on branch 1: its rotation number over (law, a), and its frequencies after detuning.

Branch 1 is the motion without synchrony that `plus` reaches at a = 0.08. Its rotation number (`motion.rotation`), at
all values of `refined`, shows whether its end blocks are locked to the middle block. To show whether the end blocks are
locked to each other, the mirror symmetry that makes their frequencies equal is broken by changing the mass of the last
block (`summaries.detuning`), at the values of the grid; their frequencies and the Lyapunov exponents then decide.
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
from burridge_knopoff.running.settings import Settings
from burridge_knopoff.summaries.detuning import TRANSIENT, WINDOW, detuned_motion

TITLE = "Rotation number of branch 1, and its frequencies after detuning"
BRANCH = 1

#: Time for which the motion is followed at each a. The error is usually below 1e-5, and far smaller on periodic orbits.
DURATION = 1000.0

#: Detunings of branch 1, from small to large.
DETUNINGS = (0.1, 0.3, 0.8)

_WHERE = "NaN at values of a outside the grid of the study, and where there is no such motion"

_VALUE = ("law", "value")
_DETUNED = (*_VALUE, "detuning")
VARIABLES = {
    "a": Variable(_VALUE, "f8", "friction parameter a, ascending; NaN beyond the last value of a law"),
    "in_grid": Variable(_VALUE, "i1", "whether a is in the grid of the study", YES_OR_NO),
    "rotation_number": Variable(
        _VALUE,
        "f8",
        "oscillations of the end blocks against each other per oscillation of the middle block",
        {"comment": "NaN where there is no such motion, or the phase of an oscillation is undefined"},
    ),
    "rotation_error": Variable(_VALUE, "f8", "difference of the rotation number between the two halves of the time"),
    "locked": Variable(
        _VALUE, "i1", "whether the motion is a periodic orbit", flag("i1", {-1: "unknown", 0: "no", 1: "yes"})
    ),
    "detuned_frequency": Variable(
        (*_DETUNED, "block"),
        "f8",
        "frequency, in cycles per unit time, of the strongest line in the spectrum of U' after detuning",
        {"ancillary_variables": "detuned_frequency_error", "comment": _WHERE},
    ),
    "detuned_frequency_error": Variable(
        (*_DETUNED, "block"), "f8", "difference of this frequency between the two halves of the time"
    ),
    "detuned_exponent": Variable(
        (*_DETUNED, "exponent"),
        "f8",
        "Lyapunov exponents after detuning, in descending order",
        {"ancillary_variables": "detuned_exponent_error", "comment": _WHERE},
    ),
    "detuned_exponent_error": Variable((*_DETUNED, "exponent"), "f8", "standard error of this exponent"),
}
DETUNING = Variable(("detuning",), "f8", "relative increase of the mass of the last block", coordinate=True)


def summarize(refined: xarray.Dataset, models: Sequence[Model]) -> xarray.Dataset:
    """Return the rotation number of branch 1 at all values of a, whether it is locked, and its motion after detuning.

    refined : the summary of that name; models : one for each of its laws, at any a
    """
    exponents = Settings().exponent_count(models[0].chain)
    sizes = {**refined.sizes, "detuning": len(DETUNINGS), "exponent": exponents}
    values = {
        name: np.full([sizes[key] for key in item.dimensions], -1 if item.dtype == "i1" else np.nan, item.dtype)
        for name, item in VARIABLES.items()
    }
    values["a"], values["in_grid"] = refined["a"].values, refined["in_grid"].values
    # Where the middle block oscillates an odd number of times in a period, the branch is a mirror pair: use one side.
    slots = (refined["branch"].values == BRANCH) & (refined["side"].values >= 0)
    slots &= np.isin(refined["kind"].values, REGULAR)
    for law, value, slot in np.argwhere(slots).tolist():
        at = law, value
        one = refined.isel(law=law, value=value, attractor=slot)
        model, velocity = models[law].at(float(values["a"][at])), one["velocity"].values
        start = ChainState(one["position"].values - model.sliding_offset, velocity, velocity == 0.0)
        values["rotation_number"][at], values["rotation_error"][at] = rotation_number(model, start, DURATION)
        values["locked"][at] = one["kind"].item() == MotionKind.PERIODIC
        if not values["in_grid"][at]:
            continue
        for k, detuning in enumerate(DETUNINGS):
            found = detuned_motion(model, start, detuning, exponents)
            for name in ("frequency", "frequency_error", "exponent", "exponent_error"):
                values[f"detuned_{name}"][*at, k] = getattr(found, name)
    attributes = {
        "branch": BRANCH,
        "duration": DURATION,
        "detuned_transient": TRANSIENT,
        "detuned_window": WINDOW,
        "history": "snakemake, from refined.nc",
    }
    coordinates = {
        "law": refined["law"].variable,
        "detuning": ("detuning", np.array(DETUNINGS), DETUNING.all_attributes()),
        "block": refined["block"].variable,
    }
    return summary(
        "Rotation number and detuning of branch 1", VARIABLES, values, coordinates, attributes, module=__name__
    )
