"""Frequencies without synchrony: the rotation number of branch 1 over (law, a), and branches 1 and 2 after detuning.

Branch 1 is the motion that `plus` reaches at a = 0.08; on branch 2 the end blocks move in antiphase. The rotation
number of branch 1 (`motion.rotation`), at all values of `refined`, shows whether its end blocks are locked to the
middle block. To show whether end blocks are locked to each other, the mirror symmetry that makes their frequencies
equal is broken by changing the mass of the last block (`summaries.detuning`), at the values of the grid; their
frequencies, the Lyapunov exponents and the shares of the normal modes then decide.

The rotation number counts the turns of (x_1 − x_N, U_1' − U_N') for each turn of (x_m, U_m' − v), m being the middle
block or the sum over both middle blocks, as a weighted average over `duration`. After detuning, the exponents are taken
over `detuned_window` after `detuned_transient`, or up to `detuned_longest_window` if a third exponent that is not
certain to be negative would decide; the frequencies and modes over the following `detuned_window`. Each detuning begins
where the one before ended.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import Any

import numpy as np
import xarray

from burridge_knopoff.dataset.summary import axes, summary
from burridge_knopoff.dataset.variables import YES_OR_NO, Variable, flag
from burridge_knopoff.model.model import ChainState, Model, at_recorded_a
from burridge_knopoff.motion.kind import REGULAR, MotionKind
from burridge_knopoff.motion.modes import sliding_modes
from burridge_knopoff.motion.rotation import rotation_number
from burridge_knopoff.running.processes import ParallelMap, parallel_map
from burridge_knopoff.running.settings import Settings
from burridge_knopoff.study.formatting import format_count, span
from burridge_knopoff.summaries.detuning import LONGEST_WINDOW, TRANSIENT, WINDOW, detuned_model, detuned_motions
from burridge_knopoff.summaries.sentences import lines_of

TITLE = "Rotation number of branch 1, and branches 1 and 2 after detuning"

#: The branch with a rotation number, and the branches that are detuned.
BRANCH = 1
DETUNED_BRANCHES = (1, 2)

#: Time for which the motion is followed at each a. The error is usually below 1e-5, and far smaller on periodic orbits.
DURATION = 1000.0

#: Detunings, from small to large; each motion begins at the last state of the one before.
DETUNINGS = (0.1, 0.3, 0.8)

_WHERE = "NaN at values of a outside the grid of the study, and where there is no such motion"

_VALUE = ("law", "value")
_DETUNED = (*_VALUE, "branch", "detuning")
_MODE = ("detuning", "mode")
VARIABLES = {
    "a": Variable(_VALUE, "f8", "friction parameter a: ascending; NaN beyond the last value of a law"),
    "in_grid": Variable(_VALUE, "i1", "whether a is in the grid of the study", YES_OR_NO),
    "rotation_number": Variable(
        _VALUE,
        "f8",
        "rotation number: oscillations of the end blocks against each other per oscillation of the middle block",
        {"comment": "NaN where there is no such motion, or the phase of an oscillation is undefined"},
    ),
    "rotation_error": Variable(
        _VALUE, "f8", "error of the rotation number: its difference between the two halves of the time"
    ),
    "locked": Variable(
        _VALUE, "i1", "locked: whether the motion is a periodic orbit", flag("i1", {-1: "unknown", 0: "no", 1: "yes"})
    ),
    "detuned_frequency": Variable(
        (*_DETUNED, "block"),
        "f8",
        "frequency after detuning: of a block, in cycles per unit time",
        {"ancillary_variables": "detuned_frequency_error", "comment": _WHERE},
    ),
    "detuned_frequency_error": Variable((*_DETUNED, "block"), "f8", "error of this frequency: from parts of the time"),
    "detuned_exponent": Variable(
        (*_DETUNED, "exponent"),
        "f8",
        "Lyapunov exponent after detuning: in descending order",
        {"ancillary_variables": "detuned_exponent_error", "comment": _WHERE},
    ),
    "detuned_exponent_error": Variable((*_DETUNED, "exponent"), "f8", "standard error of this exponent"),
    "detuned_mode_share": Variable(
        (*_DETUNED, "mode"),
        "f8",
        "share of a normal mode: in the kinetic energy of the oscillation with the frequency of block 1",
        {"comment": _WHERE},
    ),
    "detuned_end_ratio": Variable(
        _DETUNED,
        "f8",
        "amplitude ratio of the end blocks: last block over block 1, in this oscillation",
        {"comment": _WHERE},
    ),
    "detuned_end_phase": Variable(
        _DETUNED,
        "f8",
        "phase difference of the end blocks: last block minus block 1, in this oscillation",
        {"units": "degree"},
    ),
    "mode_frequency": Variable(_MODE, "f8", "frequency of a normal mode: in cycles per unit time, ascending"),
    "mode_end_ratio": Variable(
        _MODE, "f8", "displacement ratio of the end blocks: last block over block 1, in a normal mode"
    ),
}
COORDINATES = {
    "branch": Variable(("branch",), "i2", "number of the branch", coordinate=True),
    "detuning": Variable(
        ("detuning",), "f8", "detuning: relative increase of the mass of the last block", coordinate=True
    ),
}


def summarize(refined: xarray.Dataset, models: Sequence[Model], processes: int = 1) -> xarray.Dataset:
    """Return the rotation number of branch 1, whether it is locked, and the branches without synchrony after detuning.

    refined : the summary of that name; models : one for each of its laws, at any a
    processes : number of processes; the results do not depend on it
    """
    exponents = Settings().exponent_count(models[0].chain)
    sizes = {
        **refined.sizes,
        "branch": len(DETUNED_BRANCHES),
        "detuning": len(DETUNINGS),
        "exponent": exponents,
        "mode": models[0].blocks,
    }
    values = {
        name: np.full([sizes[key] for key in item.dimensions], -1 if item.dtype == "i1" else np.nan, item.dtype)
        for name, item in VARIABLES.items()
    }
    values["a"], values["in_grid"] = refined["a"].values, refined["in_grid"].values
    for k, detuning in enumerate(DETUNINGS):
        values["mode_frequency"][k], shape = sliding_modes(detuned_model(models[0], detuning).chain)
        with np.errstate(divide="ignore", invalid="ignore"):
            values["mode_end_ratio"][k] = shape[:, -1] / shape[:, 0]
    # Where the middle block oscillates an odd number of times in a period, the branch is a mirror pair: use one side.
    slots = np.isin(refined["branch"].values, DETUNED_BRANCHES) & (refined["side"].values >= 0)
    slots &= np.isin(refined["kind"].values, REGULAR)
    rotating, detuned = [], []
    for law, value, slot in np.argwhere(slots).tolist():
        at = law, value
        attractor = refined.isel(law=law, value=value, attractor=slot)
        model, velocity = at_recorded_a(models[law], float(values["a"][at])), attractor["velocity"].values
        start = ChainState(attractor["position"].values - model.sliding_offset, velocity, velocity == 0.0)
        branch = attractor["branch"].item()
        if branch == BRANCH:
            rotating.append((at, model, start))
            values["locked"][at] = attractor["kind"].item() == MotionKind.PERIODIC
        if values["in_grid"][at]:
            detuned.append(((*at, DETUNED_BRANCHES.index(branch)), model, start))
    rotation = partial(rotation_number, duration=DURATION)
    detune = partial(detuned_motions, detunings=DETUNINGS, exponents=exponents)
    with parallel_map(processes) as pool:
        for place, (number, error) in _for_each(pool, "rotation numbers", rotation, rotating):
            values["rotation_number"][place], values["rotation_error"][place] = number, error
        for place, motions in _for_each(pool, "branches detuned", detune, detuned):
            for name in ("frequency", "frequency_error", "exponent", "exponent_error", "mode_share", "end_ratio",
                         "end_phase"):  # fmt: skip
                values[f"detuned_{name}"][place] = [getattr(motion, name) for motion in motions]
    attributes = {
        "branch": BRANCH,
        "duration": DURATION,
        "detuned_transient": TRANSIENT,
        "detuned_window": WINDOW,
        "detuned_longest_window": LONGEST_WINDOW,
        "history": "snakemake, from refined.nc",
    }
    coordinates = {
        "law": refined["law"].variable,
        **axes(COORDINATES, branch=DETUNED_BRANCHES, detuning=DETUNINGS),
        "block": refined["block"].variable,
    }
    return summary(
        "Rotation number of branch 1, and detuned branches", VARIABLES, values, coordinates, attributes, module=__name__
    )


def _for_each(
    pool: ParallelMap,
    what: str,
    function: Callable[..., Any],
    motions: Sequence[tuple[tuple[int, ...], Model, ChainState]],
) -> Iterator[tuple[tuple[int, ...], Any]]:
    """Yield (place in the arrays, result of the function) of motions, given as (place, model, state)."""
    places, models, states = ([motion[k] for motion in motions] for k in range(3))
    yield from zip(places, pool(what, function, models, states), strict=True)


def digest(data: xarray.Dataset) -> str:
    """Return at how many values of the grid a branch is locked, and the range of its rotation number."""
    branch = data.attrs["branch"]

    def sentence(part: xarray.Dataset) -> str:
        locked, number = part["locked"].values, part["rotation_number"].values
        mask = (locked >= 0) & (part["in_grid"].values == 1)
        if not mask.any():
            return f"branch {branch} is neither periodic nor quasiperiodic at any a of the grid"
        words = (
            f"branch {branch} is locked (periodic) at {np.count_nonzero(locked[mask] == 1)} of "
            f"{format_count(int(mask.sum()), 'value')} of a in the grid at which it is periodic or quasiperiodic"
        )
        if np.isfinite(number).any():
            words += f"; rotation number {span(f'{np.nanmin(number):.5g}', f'{np.nanmax(number):.5g}')}"
        return words

    return lines_of(data, ["law"], sentence)
