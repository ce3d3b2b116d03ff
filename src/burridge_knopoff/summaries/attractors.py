"""The attractors of each law against a, as `stability.continuation` finds them, as a file.

Features, branches, sweeps, basin fractions, and what each initial state reaches.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, replace
from typing import Any

import numpy as np
import xarray

from burridge_knopoff.dataset.summary import axes, summary
from burridge_knopoff.dataset.variables import Variable, flag
from burridge_knopoff.model.initial import InitialState
from burridge_knopoff.model.model import CONTACTS, STARTS, Model
from burridge_knopoff.provenance.software import provenance
from burridge_knopoff.stability.attractor import Symmetry
from burridge_knopoff.stability.continuation import BranchPoint, Continuation, continue_attractors, same_numbers
from burridge_knopoff.stability.labels import UNDETERMINED, label
from burridge_knopoff.stability.motion import MotionKind
from burridge_knopoff.stability.sampling import fraction_interval
from burridge_knopoff.stability.settings import MotionSettings, SearchSettings
from burridge_knopoff.stability.steady import EXPONENTS

#: Difference of ⟨J⟩ up to which branches of two laws may be the same at one a.
SAME_BRANCH = 0.01

_SLOT = ("a", "attractor")
_REACHED = ("contact", "start", "initial", "a")
_SWEEP = ("direction", "sweep", "a")
DIRECTIONS = ("upward", "downward")
NOTHING = {"comment": "-1 where there is none or it is undetermined"}
_V = Variable
VARIABLES = {
    "branch": _V(_SLOT, "i2", "branch of attractors along a; 0 is the synchronized one", NOTHING),
    "side": _V(_SLOT, "i1", "side of the branch: 1 and -1 for mirror images of each other, 0 for its own mirror image"),
    "symmetry": _V(
        _SLOT,
        "i1",
        "mirror symmetry of the attractor",
        flag("i1", {-1: "none", **{int(item): item.name.lower() for item in Symmetry}}),
    ),
    "mean_distance": _V(_SLOT, "f8", "time average <J> of the phase-space distance between the end blocks"),
    "mean_distance_error": _V(_SLOT, "f8", "standard error of <J> from batch means"),
    "kind": _V(_SLOT, "i1", "kind of motion", flag("i1", MotionKind)),
    "section_period": _V(_SLOT, "i2", "upward section points after which W' repeats, 0 if it does not"),
    "stop_rate": _V((*_SLOT, "block"), "f8", "stops of a block in a unit of time"),
    "lyapunov_exponent": _V((*_SLOT, "exponent"), "f8", "Lyapunov exponents, the largest first"),
    "radius": _V(_SLOT, "f8", "distance from its returns within which trajectories are captured"),
    "close_returns": _V(_SLOT, "i4", "successive returns within the radius after which a trajectory is captured"),
    "slow": _V(
        _SLOT,
        "i1",
        "whether motion on the attractor is too slow to settle",
        flag("i1", {-1: "none", 0: "no", 1: "yes"}),
    ),
    "position": _V(
        (*_SLOT, "block"),
        "f8",
        "positions of one state on the attractor, at a stop of the first block",
        {"comment": "relative to the driver: U - v*tau, U the position of the paper"},
    ),
    "velocity": _V((*_SLOT, "block"), "f8", "velocities U' of that state"),
    "upward_branch": _V(_SLOT, "i2", "branch reached from the attractor at the next larger a", NOTHING),
    "downward_branch": _V(_SLOT, "i2", "branch reached from the attractor at the next smaller a", NOTHING),
    "basin_count": _V(_SLOT, "i4", "sampled initial states that reach the attractor"),
    "basin_fraction": _V(_SLOT, "f8", "fraction of the sampled initial states that reach the attractor"),
    "basin_fraction_low": _V(_SLOT, "f8", "lower end of the 95 % Wilson interval of the basin fraction"),
    "basin_fraction_high": _V(_SLOT, "f8", "upper end of the 95 % Wilson interval of the basin fraction"),
    "undetermined_count": _V(("a",), "i4", "sampled initial states that reach no attractor by the time limit"),
    "initial_branch": _V(_REACHED, "i2", "branch reached by an initial state under each convention", NOTHING),
    "initial_side": _V(_REACHED, "i1", "side of that branch"),
    "sweep_branch": _V(_SWEEP, "i2", "branch on which a sweep of a is", NOTHING),
    "sweep_mean_distance": _V(_SWEEP, "f8", "<J> of the attractor on which a sweep of a is"),
}


def one_law(
    model: Model,
    grid: Sequence[float],
    initial: Sequence[InitialState],
    settings: SearchSettings,
    motion: MotionSettings,
    start: str,
) -> xarray.Dataset:
    """Find and match the attractors of one law along a.

    model : under that law, at any a; grid : values of a, ascending
    initial : states from which attractors are looked for, and whose own is found under each convention
    settings : of the search; motion : how kinds of motion are told apart; start : convention for the drawn states
    """
    models = [model.at(a) for a in grid]
    found = continue_attractors(models, settings, motion, starts=initial, start=start)
    values = _features(models, found, settings.samples)
    values.update(_reached(models, found, initial, settings.time_limit))
    values.update(_sweeps(found))
    law = model.law.name
    coordinates = axes([state.name for state in initial], list(grid), [law])
    del coordinates["law"]
    numbers = np.arange(1, model.blocks + 1, dtype="i2")
    coordinates["block"] = ("block", numbers, {"long_name": "block number", "units": "1"})
    for name, names in (("contact", CONTACTS), ("start", STARTS), ("direction", DIRECTIONS)):
        coordinates[name] = (name, np.array(names, dtype=object), {"long_name": f"convention of {name}"})
    coordinates["direction"][2]["long_name"] = "direction in which a is swept"
    attributes = {
        "law": law,
        "history": "snakemake, from sampled initial states",
        "v": model.v,
        "contact_convention": model.contact,
        "start_convention": start,
        "synchronization_threshold": motion.synchronization_threshold,
        "position_box": np.array(settings.position),
        "velocity_box": np.array(settings.velocity),
        **{key: value for key, value in asdict(settings).items() if key not in ("position", "velocity")},
    }
    return summary(f"Attractors, {law} friction law", VARIABLES, values, coordinates, attributes, module=__name__)


def merge(parts: Sequence[xarray.Dataset]) -> xarray.Dataset:
    """Return the attractors of all laws in one Dataset with the dimension law; missing slots are −1 or NaN.

    Branches that another law shares with the first one take its numbers; all others have a number of their own.
    """
    values = {}
    variables = {}
    curves = [_curves(part) for part in parts]
    numbers = [{n: n for n in curves[0]}]
    for other in curves[1:]:
        largest = max((0, *(n for renamed in numbers for n in renamed.values())))
        numbers.append(same_numbers(curves[0], other, SAME_BRANCH, largest))
    for name, item in VARIABLES.items():
        arrays = [part[name].values for part in parts]
        if name.endswith("branch"):
            arrays = [_renumbered(array, renamed) for array, renamed in zip(arrays, numbers, strict=True)]
        shape = np.max([array.shape for array in arrays], axis=0)
        whole = np.full((len(parts), *shape), _missing(name, item), dtype=item.dtype)
        for number, array in enumerate(arrays):
            within: Any = (number, *(slice(0, size) for size in array.shape))
            whole[within] = array
        values[name] = whole
        variables[name] = replace(item, dimensions=("law", *item.dimensions))
    coordinates: dict[str, Any] = {str(name): parts[0][name].variable for name in parts[0].coords}
    coordinates["law"] = axes([], [], [part.attrs["law"] for part in parts])["law"]
    attributes = {key: parts[0].attrs[key] for key in parts[0].attrs if key not in _HEAD}
    return summary("Attractors", variables, values, coordinates, attributes, module=__name__)


_HEAD = ("Conventions", "title", "law", *provenance(__name__))


def digest(dataset: xarray.Dataset) -> str:
    """Return, for each law, in a line a branch where it exists, its ⟨J⟩, kinds of motion and largest basin fraction."""
    lines = []
    a = dataset["a"].values
    for law in dataset["law"].values:
        one = dataset.sel(law=law)
        branch = one["branch"].values
        for number in np.unique(branch[branch >= 0]):
            slots = branch == number
            where = a[slots.any(axis=1)]
            mean = one["mean_distance"].values[slots]
            kinds = ", ".join(MotionKind(kind).name.lower() for kind in np.unique(one["kind"].values[slots]))
            sticks = (one["stop_rate"].values[slots] > 0.0).any(axis=0)
            never = [str(block) for block, sticking in zip(one["block"].values, sticks, strict=True) if not sticking]
            share = np.nansum(np.where(slots, one["basin_fraction"].values, 0.0), axis=1)
            name = "synchronized" if number == 0 else f"branch {number}"
            note = f"; block {', '.join(never)} never sticks" if never else ""
            lines.append(
                f"{law}, {name}: at {len(where)} of {len(a)} values of a, {where[0]:g} to {where[-1]:g}; "
                f"<J> {mean.min():.4f} to "
                f"{mean.max():.4f}; {kinds}; basin fraction at most {share.max():.3f} (a = {a[share.argmax()]:g}){note}"
            )
        undetermined = one["undetermined_count"].values
        empty = a[branch.max(axis=1) < 0]
        total = int(dataset.attrs["samples"]) * len(a)
        lines.append(
            f"{law}: {int(undetermined.sum())} of {total} sampled states are undetermined"
            + (f"; no attractor at a = {', '.join(f'{value:g}' for value in empty)}" if len(empty) else "")
        )
    return "\n".join(lines) + "\n"


def _curves(part: xarray.Dataset) -> dict[int, dict[int, BranchPoint]]:
    """Return the branches of one law in the form that `same_numbers` compares."""
    curves: dict[int, dict[int, BranchPoint]] = {}
    branch, mean = part["branch"].values, part["mean_distance"].values
    # Mirror images have their stop rates the other way round; which blocks stick does not tell them apart.
    sticks = part["stop_rate"].values > 0.0
    for k, slot in np.argwhere(branch >= 0):
        point = (float(mean[k, slot]), tuple(bool(stuck) for stuck in sticks[k, slot]))
        curves.setdefault(int(branch[k, slot]), {})[int(k)] = point
    return curves


def _renumbered(branch: np.ndarray, renamed: Mapping[int, int]) -> np.ndarray:
    """Return the numbers of branches replaced by new ones; what is undetermined stays so."""
    result = np.full_like(branch, UNDETERMINED)
    for before, after in renamed.items():
        result[branch == before] = after
    return result


def _missing(name: str, item: Variable) -> Any:
    if item.dtype == "f8":
        return np.nan
    return 0 if name in ("side", "initial_side", "section_period", "basin_count", "undetermined_count") else -1


def _empty(shape: Mapping[str, int]) -> dict[str, np.ndarray]:
    """Return an array of missing values for each variable whose dimensions are given."""
    return {
        name: np.full([shape[key] for key in item.dimensions], _missing(name, item), dtype=item.dtype)
        for name, item in VARIABLES.items()
        if all(key in shape for key in item.dimensions)
    }


def _features(models: Sequence[Model], found: Continuation, samples: int) -> dict[str, np.ndarray]:
    """Return all variables of single attractors; in each slot order they are sorted by branch and side."""
    blocks = models[0].blocks
    slots = max(1, *(len(here) for here in found.attractors))
    values = _empty({"a": len(models), "attractor": slots, "block": blocks, "exponent": EXPONENTS})
    for k, here in enumerate(found.attractors):
        reached = found.samples[k][:samples]
        values["undetermined_count"][k] = np.count_nonzero(reached == UNDETERMINED)
        order = sorted(range(len(here)), key=lambda i: (found.branch[k][i], -found.side[k][i]))
        for slot, i in enumerate(order):
            at = (k, slot)
            motion = here[i].motion
            values["branch"][at], values["side"][at] = found.branch[k][i], found.side[k][i]
            values["symmetry"][at], values["radius"][at] = here[i].symmetry, here[i].radius
            values["slow"][at], values["close_returns"][at] = here[i].slow, here[i].close_returns
            for name in ("mean_distance", "mean_distance_error", "kind", "section_period", "stop_rate"):
                values[name][at] = getattr(motion, name)
            values["lyapunov_exponent"][at][: len(motion.exponent)] = motion.exponent
            state = motion.instant()
            values["position"][at] = state.position + models[k].sliding_offset
            values["velocity"][at] = state.velocity
            for name, step, index in (("upward", 1, found.upward[k][i]), ("downward", -1, found.downward[k][i])):
                values[f"{name}_branch"][at] = found.branch[k + step][index] if index != UNDETERMINED else UNDETERMINED
            hits = int(np.count_nonzero(reached == i))
            values["basin_count"][at] = hits
            interval = fraction_interval(hits, samples)
            for name, value in zip(("", "_low", "_high"), interval, strict=True):
                values[f"basin_fraction{name}"][at] = value
    return values


def _reached(
    models: Sequence[Model], found: Continuation, states: Sequence[InitialState], time_limit: float
) -> dict[str, np.ndarray]:
    """Return which branch each initial state reaches under each convention of contact and start."""
    shape = {"contact": len(CONTACTS), "start": len(STARTS), "initial": len(states), "a": len(models)}
    values = {name: value for name, value in _empty(shape).items() if name.startswith("initial")}
    for k, model in enumerate(models):
        for i, contact in enumerate(CONTACTS):
            for j, start in enumerate(STARTS):
                other = replace(model, contact=contact)
                allowed = [n for n, state in enumerate(states) if contact == "symmetric" or min(state.velocity) >= 0]
                starts = [other.begin(states[n], start) for n in allowed]
                reached, _ = label(other, found.attractors[k], starts, time_limit)
                for n, index in zip(allowed, reached, strict=True):
                    if index != UNDETERMINED:
                        values["initial_branch"][i, j, n, k] = found.branch[k][index]
                        values["initial_side"][i, j, n, k] = found.side[k][index]
    return values


def _sweeps(found: Continuation) -> dict[str, np.ndarray]:
    """Follow each attractor of the smallest a upward and each of the largest a downward, step by step of the grid."""
    count = len(found.attractors)
    # Where there is no attractor, as at a = 0, no sweep can begin.
    there = [k for k in range(count) if found.attractors[k]] or [0]
    ends = (there[0], there[-1])
    sweeps = max(1, *(len(found.attractors[end]) for end in ends))
    values = _empty({"direction": 2, "sweep": sweeps, "a": count})
    for direction, (end, steps, following) in enumerate(
        zip(ends, (range(ends[0], count), range(ends[1], -1, -1)), (found.upward, found.downward), strict=True)
    ):
        order = np.lexsort((-found.side[end], found.branch[end]))
        for sweep, first in enumerate(order):
            index = int(first)
            for k in steps:
                values["sweep_branch"][direction, sweep, k] = found.branch[k][index]
                values["sweep_mean_distance"][direction, sweep, k] = found.attractors[k][index].motion.mean_distance
                index = int(following[k][index])
                if index == UNDETERMINED:
                    break
    return {name: value for name, value in values.items() if name.startswith("sweep")}
