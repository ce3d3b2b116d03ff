"""The bifurcations of all branches of attractors: where each begins, ends or changes, and by what.

An attractor that is a closed orbit is followed in a to where it loses its stability or ends; that bifurcation is known
to 1e-10. A bifurcation without a closed orbit on either side is only known to lie between two values of a.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray

from burridge_knopoff.continuation.bifurcations import LEAST_ERROR, Entry, entries
from burridge_knopoff.continuation.branch_changes import Change, branch_changes
from burridge_knopoff.continuation.followed_orbits import FollowedOrbits, followed
from burridge_knopoff.dataset.summary import summary
from burridge_knopoff.dataset.variables import ANSWER, Variable, flag
from burridge_knopoff.model.model import Model
from burridge_knopoff.motion.kind import MotionKind
from burridge_knopoff.periodic_orbits.bifurcation_kind import BifurcationKind
from burridge_knopoff.periodic_orbits.branch_segment import BranchSegment

PARTS = ("real", "imaginary")
_BIFURCATION, _ORBIT = ("bifurcation",), ("orbit",)
_V = Variable
VARIABLES = {
    "law": _V(_BIFURCATION, "i1", "friction law, by its number in the attribute laws"),
    "a": _V(_BIFURCATION, "f8", "friction parameter a of the bifurcation"),
    "a_error": _V(_BIFURCATION, "f8", "its error: half the width of the interval that brackets it"),
    "kind": _V(_BIFURCATION, "i1", "what happens there", flag("i1", BifurcationKind)),
    "change": _V(_BIFURCATION, "i1", "what the branch of attractors does there", flag("i1", Change)),
    "from_branch": _V(
        _BIFURCATION, "i2", "branch below the bifurcation, or reached from above it", {"comment": "-1 undetermined"}
    ),
    "to_branch": _V(
        _BIFURCATION, "i2", "branch above the bifurcation, or reached from below it", {"comment": "-1 undetermined"}
    ),
    "grid_low": _V(_BIFURCATION, "f8", "largest a of refined.nc at which the branch is as before, NaN for none"),
    "grid_high": _V(_BIFURCATION, "f8", "smallest a of refined.nc at which it is as after, NaN for none"),
    "motion_before": _V(_BIFURCATION, "i1", "kind of motion at grid_low", flag("i1", MotionKind)),
    "motion_after": _V(_BIFURCATION, "i1", "kind of motion at grid_high", flag("i1", MotionKind)),
    "turns": _V(
        _BIFURCATION, "i1", "whether the orbits on both sides of the bifurcation lie at a on one side of it", ANSWER
    ),
    "period": _V(_BIFURCATION, "f8", "period of the orbit at the bifurcation"),
    "stops": _V(("bifurcation", "block"), "i4", "stops of each block in a period of the stable orbits"),
    "stops_beyond": _V(("bifurcation", "block"), "i4", "the same of the orbits beyond the bifurcation"),
    "multiplier": _V(
        ("bifurcation", "part"), "f8", "Floquet multiplier of the largest modulus next to the bifurcation"
    ),
    "multiplier_beyond": _V(("bifurcation", "part"), "f8", "the same of the orbits beyond the bifurcation"),
    "mean_distance": _V(_BIFURCATION, "f8", "<J> over a period of that orbit"),
    "stick_time": _V(_BIFURCATION, "f8", "shortest stick at the bifurcation, 0 where it shrinks to nothing"),
    "lifetime_low": _V(
        _BIFURCATION, "f8", "lower end of the 95 % interval of the lifetime of chaos at grid_low or grid_high"
    ),
    "lifetime_high": _V(_BIFURCATION, "f8", "upper end of that interval; of the shorter life where both are chaotic"),
    "orbit_law": _V(_ORBIT, "i1", "friction law, by its number in the attribute laws"),
    "orbit_segment": _V(_ORBIT, "i4", "number of the segment of orbits that were followed together, in this order"),
    "orbit_branch": _V(_ORBIT, "i2", "branch of most of the attractors that lie on them"),
    "orbit_a": _V(_ORBIT, "f8", "friction parameter a of the periodic orbit"),
    "orbit_stable": _V(
        _ORBIT, "i1", "whether all its multipliers but that of the flow lie inside the unit circle", ANSWER
    ),
    "orbit_period": _V(_ORBIT, "f8", "period of the orbit"),
    "orbit_stops": _V(("orbit", "block"), "i4", "stops of each block in a period of the orbit"),
    "orbit_mean_distance": _V(_ORBIT, "f8", "<J> over a period of the orbit"),
}
#: Significant digits of what is written: the last ones differ between machines.
PLACES = 11
DIGITS = {"multiplier": 5, "multiplier_beyond": 5, "stick_time": 5, "lifetime_low": 3, "lifetime_high": 3}


def one_law(
    model: Model,
    attractors: xarray.Dataset,
    refined: xarray.Dataset,
    processes: int = 1,
    folder: str | Path | None = None,
) -> xarray.Dataset:
    """Return the bifurcations of one law.

    model : with this law, at any a
    attractors, refined : of this law, at the values of the grid, and at all
    processes, folder : see `followed`
    """
    values: dict[str, list[Any]] = {name: [] for name in VARIABLES}
    blocks = model.blocks
    one = refined.load()
    changes = branch_changes(attractors, one)
    orbits = followed(model, one, changes, processes, folder)
    for entry in entries(one, changes, orbits):
        _append_bifurcation(values, entry, blocks)
    branches = _branches_of_segments(orbits, one["branch"].values)
    for index, (branch, segment_) in enumerate(zip(branches, orbits.segments, strict=True)):
        _append_orbits(values, index, branch, segment_)
    rounded = {name: _rounded(item, values[name], DIGITS.get(name, 10)) for name, item in VARIABLES.items()}
    rounded["a_error"] = 10.0 ** np.ceil(np.log10(np.maximum(values["a_error"], LEAST_ERROR)))
    located = np.isfinite(rounded["period"])
    rounded["a_error"][~located] = 0.5 * (rounded["grid_high"] - rounded["grid_low"])[~located]
    # They are values of refined.nc, to be looked up there.
    rounded["grid_low"], rounded["grid_high"] = np.array(values["grid_low"]), np.array(values["grid_high"])
    shapes = dict.fromkeys(("stops", "stops_beyond", "orbit_stops"), (-1, blocks)) | {
        "multiplier": (-1, 2),
        "multiplier_beyond": (-1, 2),
    }
    for name, shape in shapes.items():
        rounded[name] = rounded[name].reshape(shape)
    rounded |= _in_order({name: rounded[name] for name, item in VARIABLES.items() if "bifurcation" in item.dimensions})
    head = {"v": model.v, "contact": model.contact}
    return _dataset([str(attractors["law"].item())], rounded, attractors["block"].variable, head)


def merge(parts: Sequence[xarray.Dataset]) -> xarray.Dataset:
    """Return the bifurcations of several laws in one Dataset, one law after the other."""
    values = {name: np.concatenate([part[name].values for part in parts]) for name in VARIABLES}
    for name, dimension in (("law", "bifurcation"), ("orbit_law", "orbit")):
        values[name] = np.repeat(np.arange(len(parts), dtype="i1"), [part.sizes[dimension] for part in parts])
    head = {name: parts[0].attrs[name] for name in ("v", "contact")}
    return _dataset([part.attrs["laws"] for part in parts], values, parts[0]["block"].variable, head)


def digest(dataset: xarray.Dataset) -> str:
    """Return a line for each bifurcation: what happens there, to which branch, and the stops on both sides of it."""
    laws = dataset.attrs["laws"].split()
    columns = {name: dataset[name].values for name, item in VARIABLES.items() if item.dimensions[0] == "bifurcation"}
    lines = []
    for number in range(dataset.sizes["bifurcation"]):
        one = {name: values[number] for name, values in columns.items()}
        kind = BifurcationKind(one["kind"]).name.lower() + (", turns" if one["turns"] == 1 else "")
        parts = [f"{laws[one['law']]}, a = {one['a']:.10g} +/- {one['a_error']:.2g}: {kind}", _happening(one)]
        if np.isfinite(one["lifetime_low"]):
            parts.append(f"chaos lasts for {one['lifetime_low']:g} to {one['lifetime_high']:g} in the mean")
        if np.isfinite(one["period"]):
            beyond = f", beyond {_listed(one['stops_beyond'])}" if (one["stops_beyond"] >= 0).all() else ""
            parts.append(f"period {one['period']:.6g}, stops {_listed(one['stops'])}{beyond}")
        lines.append("; ".join(parts))
    return "\n".join(lines or ["No bifurcation was found between the values of a."]) + "\n"


def _happening(one: Mapping[str, Any]) -> str:
    """Return what a branch does at a bifurcation as a grows, in words."""
    before, after = (MotionKind(one[f"motion_{side}"]).words for side in ("before", "after"))
    low, high = (f"branch {one[name]}" if one[name] >= 0 else "" for name in ("from_branch", "to_branch"))
    match Change(one["change"]):
        case Change.BEGINNING:
            return f"{high} begins, {after}" + (f"; below, it leads to {low}" if low else "")
        case Change.END:
            return f"{low} ends, {before}" + (f"; above, it leads to {high}" if high else "")
        case Change.CHANGE:
            return f"{low}, {before} to {after}" if before != after else f"{low}, to another {after} motion"
        case _:
            return f"{low} goes on, {before}"


def _listed(stops: np.ndarray) -> str:
    return " ".join(map(str, stops))


def _dataset(
    names: Sequence[str], values: Mapping[str, np.ndarray], block: xarray.Variable, head: Mapping[str, Any]
) -> xarray.Dataset:
    """Return the bifurcations of some laws, of these names, as a Dataset."""
    coordinates = {
        "part": ("part", np.array(PARTS, dtype=object), {"long_name": "part of a complex number"}),
        "block": block,
    }
    described = {**VARIABLES, **{name: _numbered(VARIABLES[name], names) for name in ("law", "orbit_law")}}
    about = {
        "laws": " ".join(names),
        **head,
        "history": "snakemake, from the attractors and the equations of motion",
    }
    return summary("Bifurcations of the branches of attractors", described, values, coordinates, about, module=__name__)


def _numbered(item: Variable, names: Sequence[str]) -> Variable:
    return Variable(item.dimensions, item.dtype, "friction law", flag("i1", dict(enumerate(names))))


def _append_bifurcation(values: dict[str, list[Any]], entry: Entry, blocks: int) -> None:
    for name in ("change", "from_branch", "to_branch", "kind", "a"):
        values[name].append(getattr(entry, name))
    values["law"].append(0)
    values["grid_low"].append(entry.low)
    values["grid_high"].append(entry.high)
    values["motion_before"].append(entry.motion[0])
    values["motion_after"].append(entry.motion[1])
    bifurcation = entry.bifurcation
    after = bifurcation.after if bifurcation else None
    values["a_error"].append(bifurcation.error if bifurcation else 1.0)
    values["turns"].append(int(bifurcation.turns) if bifurcation else -1)
    values["period"].append(bifurcation.period if bifurcation else np.nan)
    values["mean_distance"].append(bifurcation.mean_distance if bifurcation else np.nan)
    values["stick_time"].append(bifurcation.stick_time if bifurcation else np.nan)
    values["lifetime_low"].append(entry.lifetime[0])
    values["lifetime_high"].append(entry.lifetime[1])
    values["stops"] += bifurcation.before.orbit.stop_counts if bifurcation else [-1] * blocks
    values["stops_beyond"] += after.orbit.stop_counts if after else [-1] * blocks
    for name, point in (("multiplier", bifurcation.at if bifurcation else None), ("multiplier_beyond", after)):
        largest = complex(point.multipliers.whole[0]) if point else complex(np.nan, np.nan)
        values[name] += [largest.real, abs(largest.imag)]


def _in_order(rows: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Return bifurcations by their a, then by their change, then by all else that is written of them.

    Only what is written decides: further digits differ between linear-algebra libraries.
    """
    count = len(rows["a"])
    keys = [column for name in ("a", "change", *rows) for column in rows[name].reshape(count, -1).T] if count else []
    order = np.lexsort(keys[::-1]) if keys else np.arange(0)
    return {name: values[order] for name, values in rows.items()}


def _branches_of_segments(orbits: FollowedOrbits, branch: np.ndarray) -> list[int]:
    """Return the branch of most of the attractors on each segment: that of the one it began from may be another.

    branch : of the attractors, shape (value, attractor)
    """
    numbers: list[Counter[int]] = [Counter() for _ in orbits.segments]
    for place, number in orbits.of_place.items():
        numbers[number][int(branch[place])] += 1
    return [counted.most_common(1)[0][0] for counted in numbers]


def _append_orbits(values: dict[str, list[Any]], number: int, branch: int, one: BranchSegment) -> None:
    for point in one.shown:
        values["orbit_law"].append(0)
        values["orbit_segment"].append(number)
        values["orbit_branch"].append(branch)
        values["orbit_a"].append(point.orbit.a)
        values["orbit_stable"].append(int(point.multipliers.unstable == 0))
        values["orbit_period"].append(point.orbit.period)
        values["orbit_stops"] += point.orbit.stop_counts
        values["orbit_mean_distance"].append(point.orbit.mean_distance)


def _rounded(item: Variable, values: Sequence[Any], digits: int) -> np.ndarray:
    """Return values of a variable with so many significant digits."""
    if item.dtype != "f8":
        return np.array(values, dtype=item.dtype)
    # Next to 0 digits behind the point count as well: nothing is known to more of them. Adding 0 makes -0 a 0.
    return np.array([float(f"{round(value, PLACES) + 0.0:.{digits - 1}e}") for value in values], dtype=float)
