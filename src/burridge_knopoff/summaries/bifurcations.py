"""The bifurcations of all branches of attractors: where each branch begins, ends or changes, and by which bifurcation.

An attractor that is a periodic orbit is continued in a to where it loses its stability or ends; this locates the
bifurcation to 1e-10. A bifurcation without a periodic orbit on either side is only known to lie between two values of
a.

Laws follow one another, each with a ascending. `a_error` is a power of ten; without a periodic orbit it is half the
distance of the two values of a. If an attractor was not found again where it exists, the bifurcation lies up to one
step of the grid outside. `change` is *change* if the kind of motion, the symmetry or the orbit changes, and *passed* if
the orbits stay stable but their stops change. Where multipliers jump, `multiplier_beyond` differs from `multiplier`;
both have five digits and a nonnegative imaginary part. Where a doubled orbit ends at a period doubling, `period` and
`stops` are those of the doubled orbit, and the multiplier −1 is that of the single one.

`torus` has the tori that lie between two orbits of a branch without being seen at any value of `refined.nc`; see
`continuation.tori`. Inside, the torus is locked to one orbit after another.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray

from burridge_knopoff.attractors.settings import SEARCH, SearchSettings
from burridge_knopoff.continuation.bifurcations import LEAST_ERROR, Entry, entries
from burridge_knopoff.continuation.branch_changes import Change, branch_changes
from burridge_knopoff.continuation.followed_orbits import FollowedOrbits, follow_orbits
from burridge_knopoff.continuation.tori import find_tori
from burridge_knopoff.dataset.columns import Column, column_values
from burridge_knopoff.dataset.summary import axes, summary
from burridge_knopoff.dataset.variables import ANSWER, Variable, flag
from burridge_knopoff.model.model import Model
from burridge_knopoff.motion.kind import MotionKind
from burridge_knopoff.motion.settings import MOTION, MotionSettings
from burridge_knopoff.periodic_orbits.bifurcation_kind import BifurcationKind
from burridge_knopoff.periodic_orbits.bifurcations import Bifurcation
from burridge_knopoff.periodic_orbits.pseudo_arclength import BranchOrbit
from burridge_knopoff.provenance.keys import digest_of
from burridge_knopoff.provenance.sources import source_fingerprint
from burridge_knopoff.study.formatting import format_count
from burridge_knopoff.study.grid import values_of
from burridge_knopoff.study.model import model_of, motion_of
from burridge_knopoff.summaries import tori
from burridge_knopoff.summaries.edges import saddle_at_crisis

#: Largest number of bifurcations that are listed one by one.
MOST_LISTED = 20

PARTS = ("real", "imaginary")
_AT, _ORBIT = ("bifurcation",), ("orbit",)


def _bifurcation_value(value: Callable[[Bifurcation], Any]) -> Callable[[Entry], Any]:
    """Return the values of a column for bifurcations located on an orbit; None for the others."""
    return lambda entry: value(entry.bifurcation) if entry.bifurcation else None


def _multiplier(point: BranchOrbit | None) -> tuple[float, float] | None:
    """Return the real part and the modulus of the imaginary part of the largest multiplier."""
    if point is None:
        return None
    largest = complex(point.multipliers.whole[0])
    return largest.real, abs(largest.imag)


_NONE, _MOTION = {"comment": "-1 undetermined"}, flag("i1", MotionKind)
_BELOW, _ABOVE = (
    "branch at smaller a: or to which the branch at larger a leads",
    "branch at larger a: or to which the branch at smaller a leads",
)
_TURNS = "turning point: whether the orbits before and after the bifurcation exist on the same side in a"
_LIFE = "lower end of the lifetime: 95 % interval of the mean lifetime of chaos at grid_low or grid_high"
_LONGER = "upper end of the lifetime: if both are chaotic, of the shorter lifetime"
_SADDLE = "period of the saddle orbit: on the basin boundary that the attractor meets at a crisis, NaN if "
"none is known"
_LARGEST = "largest multiplier: Floquet multiplier of largest modulus at the bifurcation"
#: Columns of a bifurcation, from its `Entry`.
BIFURCATIONS = {
    "a": Column(_AT, "f8", "friction parameter a: of the bifurcation", value=lambda entry: entry.a),
    "a_error": Column(
        _AT,
        "f8",
        "error of a: half the width of the interval that brackets it",
        value=_bifurcation_value(lambda at: at.error),
    ),
    "kind": Column(_AT, "i1", "kind of bifurcation", flag("i1", BifurcationKind), value=lambda entry: entry.kind),
    "change": Column(
        _AT, "i1", "change of the branch of attractors", flag("i1", Change), value=lambda entry: entry.change
    ),
    "from_branch": Column(_AT, "i2", _BELOW, _NONE, value=lambda entry: entry.from_branch),
    "to_branch": Column(_AT, "i2", _ABOVE, _NONE, value=lambda entry: entry.to_branch),
    "grid_low": Column(
        _AT,
        "f8",
        "largest a below: largest a of refined.nc at which the branch is unchanged, NaN if there is none",
        value=lambda entry: entry.low,
    ),
    "grid_high": Column(
        _AT,
        "f8",
        "smallest a above: smallest a of refined.nc at which the branch has changed, NaN if there is none",
        value=lambda entry: entry.high,
    ),
    "motion_before": Column(_AT, "i1", "kind of motion at grid_low", _MOTION, value=lambda entry: entry.motion[0]),
    "motion_after": Column(_AT, "i1", "kind of motion at grid_high", _MOTION, value=lambda entry: entry.motion[1]),
    "turns": Column(_AT, "i1", _TURNS, ANSWER, value=_bifurcation_value(lambda at: at.is_turning_point)),
    "period": Column(
        _AT, "f8", "period of the orbit at the bifurcation", value=_bifurcation_value(lambda at: at.period)
    ),
    "stops": Column(
        (*_AT, "block"),
        "i4",
        "stops in a period: of each block, in a period of the stable orbits",
        value=_bifurcation_value(lambda at: at.before.orbit.stop_counts),
    ),
    "stops_beyond": Column(
        (*_AT, "block"),
        "i4",
        "stops in a period beyond: of each block, in a period of the orbits beyond the bifurcation",
        value=_bifurcation_value(lambda at: at.after.orbit.stop_counts if at.after else None),
    ),
    "multiplier": Column((*_AT, "part"), "f8", _LARGEST, value=_bifurcation_value(lambda at: _multiplier(at.at))),
    "multiplier_beyond": Column(
        (*_AT, "part"),
        "f8",
        "largest multiplier beyond: Floquet multiplier of largest modulus of the orbits beyond the bifurcation",
        value=_bifurcation_value(lambda at: _multiplier(at.after)),
    ),
    "mean_distance": Column(
        _AT,
        "f8",
        "<J> of the orbit: over a period of the orbit at the bifurcation",
        value=_bifurcation_value(lambda at: at.mean_distance),
    ),
    "stick_time": Column(
        _AT,
        "f8",
        "shortest stick: of the orbit at the bifurcation, 0 if its duration vanishes there",
        value=_bifurcation_value(lambda at: at.stick_time),
    ),
    "lifetime_low": Column(_AT, "f8", _LIFE, value=lambda entry: entry.lifetime[0]),
    "lifetime_high": Column(_AT, "f8", _LONGER, value=lambda entry: entry.lifetime[1]),
    # Filled in from the edge states.
    "saddle_period": Column(_AT, "f8", _SADDLE),
    "saddle_stops": Column(
        (*_AT, "block"), "i4", "stops in a period of the saddle: of each block, in a period of the saddle orbit"
    ),
    "saddle_distance": Column(
        _AT, "f8", "distance from the saddle: distance of the attractor from the saddle orbit before the crisis"
    ),
}
#: Columns that tell how a branch changes.
CHANGE = ("change", "from_branch", "to_branch", "motion_before", "motion_after")
_SEGMENT = "number of the segment: of a branch, whose orbits are in the order in which they were continued"
_STABLE = "stable: whether all multipliers except that of the flow lie inside the unit circle"
#: Columns of an orbit, from (number of its segment, branch of the segment, orbit).
ORBITS = {
    "orbit_segment": Column(_ORBIT, "i4", _SEGMENT, value=lambda row: row[0]),
    "orbit_branch": Column(_ORBIT, "i2", "branch of most attractors on the segment", value=lambda row: row[1]),
    "orbit_a": Column(_ORBIT, "f8", "friction parameter a: of the periodic orbit", value=lambda row: row[2].orbit.a),
    "orbit_stable": Column(_ORBIT, "i1", _STABLE, ANSWER, value=lambda row: row[2].multipliers.unstable_count == 0),
    "orbit_period": Column(_ORBIT, "f8", "period of the orbit", value=lambda row: row[2].orbit.period),
    "orbit_stops": Column(
        (*_ORBIT, "block"),
        "i4",
        "stops in a period: of each block, in a period of the orbit",
        value=lambda row: row[2].orbit.stop_counts,
    ),
    "orbit_mean_distance": Column(
        _ORBIT, "f8", "<J> over a period of the orbit", value=lambda row: row[2].orbit.mean_distance
    ),
}
VARIABLES: dict[str, Variable] = {
    "law": Variable(_AT, "U", "friction law"),
    **BIFURCATIONS,
    "orbit_law": Variable(_ORBIT, "U", "friction law"),
    **ORBITS,
    **tori.VARIABLES,
}
#: Significant digits of the stored values: further digits differ between machines.
PLACES = 11
DIGITS = {"multiplier": 5, "multiplier_beyond": 5, "stick_time": 5, "lifetime_low": 3, "lifetime_high": 3}


def bifurcations_of_law(
    config: Mapping[str, Any], law: str, attractors: xarray.Dataset, refined: xarray.Dataset, cores: int, cache: Path
) -> xarray.Dataset:
    """Return the bifurcations under one law.

    config : the keys of a study's config that decide them
    attractors, refined : of all laws, on the grid and at all values of a
    cores, cache : number of processes, and the folder in which a study caches what they find
    """
    model = model_of(config, law, values_of(config["a"], "a")[0])
    decides = {key: value for key, value in config.items() if key != "a"}
    digest = digest_of(decides, source_fingerprint("burridge_knopoff.continuation.bifurcations"))
    folder = cache / f"bifurcations {law}" / digest
    settings, motion = SearchSettings(**config["attractors"]), motion_of(config)
    return one_law(model, attractors.sel(law=law), refined.sel(law=law), cores, folder, settings, motion)


def merge_laws(parts: Sequence[xarray.Dataset], edges: xarray.Dataset | None) -> xarray.Dataset:
    """Return the bifurcations under all laws, with the saddles at their crises; edges : None without edge states."""
    dataset = merge(parts)
    if edges is not None:
        for k in np.flatnonzero(dataset["kind"].values == BifurcationKind.CRISIS):
            saddle = saddle_at_crisis(edges, str(dataset["law"].values[k]), float(dataset["a"].values[k]))
            for name, value in saddle.items():
                dataset[f"saddle_{name}"].values[k] = value
    return dataset


def one_law(
    model: Model,
    attractors: xarray.Dataset,
    refined: xarray.Dataset,
    processes: int = 1,
    folder: str | Path | None = None,
    settings: SearchSettings = SEARCH,
    motion: MotionSettings = MOTION,
) -> xarray.Dataset:
    """Return the bifurcations of one law.

    model : with this law, at any a
    attractors, refined : of this law, at the values of the grid, and at all
    processes, folder : see `follow_orbits`
    settings, motion : of the search for the attractors, for the tori between them
    """
    law = str(attractors["law"].item())
    refinement = refined.load()
    changes = branch_changes(attractors, refinement)
    orbits = follow_orbits(model, refinement, changes, processes, folder)
    bifurcations = list(entries(refinement, changes, orbits))
    segments = enumerate(zip(_branches_of_segments(orbits, refinement["branch"].values), orbits.segments, strict=True))
    points = [(number, branch, point) for number, (branch, segment) in segments for point in segment.drawn_orbits]
    sizes = {"bifurcation": len(bifurcations), "orbit": len(points), "block": model.blocks, "part": len(PARTS)}
    values = column_values(BIFURCATIONS, {(k,): row for k, row in enumerate(bifurcations)}, sizes)
    rounded = {name: _round_digits(value, DIGITS.get(name, 10)) for name, value in values.items()}
    rounded["a_error"] = 10.0 ** np.ceil(np.log10(np.maximum(values["a_error"], LEAST_ERROR)))
    located = np.isfinite(rounded["period"])
    rounded["a_error"][~located] = 0.5 * (rounded["grid_high"] - rounded["grid_low"])[~located]
    # Unrounded: these are values of refined.nc and must be found there.
    rounded["grid_low"], rounded["grid_high"] = values["grid_low"], values["grid_high"]
    rounded = _sort_rows(rounded)
    rounded |= {
        name: _round_digits(value, 10)
        for name, value in column_values(ORBITS, {(k,): row for k, row in enumerate(points)}, sizes).items()
    }
    between = find_tori(refinement, orbits, settings, motion, processes)
    rounded |= {
        name: _round_digits(value, tori.ROTATION_DIGITS if name == "torus_rotation_number" else 10)
        for name, value in tori.torus_values(between).items()
    }
    counts = {"law": len(bifurcations), "orbit_law": len(points), "torus_law": len(between)}
    rounded |= {name: np.repeat(law, count) for name, count in counts.items()}
    head = {"v": model.v, "contact": model.contact}
    return _dataset([law], rounded, attractors["block"].variable, head)


def merge(parts: Sequence[xarray.Dataset]) -> xarray.Dataset:
    """Return the bifurcations of several laws in one Dataset, one law after the other."""
    values = {name: np.concatenate([part[name].values for part in parts]) for name in VARIABLES}
    head = {name: parts[0].attrs[name] for name in ("v", "contact")}
    return _dataset([part.attrs["laws"] for part in parts], values, parts[0]["block"].variable, head)


def listing(dataset: xarray.Dataset) -> str:
    """Return a line for each bifurcation, with the change of the branch and the stops on both sides, and each torus."""
    columns = {name: dataset[name].values for name in ("law", *BIFURCATIONS)}
    lines = []
    for number in range(dataset.sizes["bifurcation"]):
        row = {name: values[number] for name, values in columns.items()}
        kind = BifurcationKind(row["kind"])
        # A fold is always a turning point.
        words = kind.words + (" (turning point)" if kind == BifurcationKind.GRAZING and row["turns"] == 1 else "")
        parts = [f"{row['law']}, a = {row['a']:.10g} +/- {row['a_error']:.2g}: {words}", change_text(row)]
        low, high = row["lifetime_low"], row["lifetime_high"]
        if np.isfinite(low):
            parts.append(
                "mean lifetime of chaos " + (f"{low:g} to {high:g}" if np.isfinite(high) else f"above {low:g}")
            )
        if np.isfinite(row["saddle_period"]):
            saddle = f"period {row['saddle_period']:.6g}, stops {_format_stops(row['saddle_stops'])}"
            parts.append(f"the attractor meets the saddle orbit of {saddle} on its basin boundary")
        if np.isfinite(row["period"]):
            beyond = f", beyond it {_format_stops(row['stops_beyond'])}" if (row["stops_beyond"] >= 0).all() else ""
            parts.append(f"period {row['period']:.6g}, stops {_format_stops(row['stops'])}{beyond}")
        lines.append("; ".join(parts))
    lines += tori.torus_lines(dataset)
    return "\n".join(lines or ["No bifurcation was found between the values of a."]) + "\n"


def change_text(row: Mapping[str, Any]) -> str:
    """Return the change of a branch at a bifurcation, as a increases, as text; row : values by the names in CHANGE."""
    before, after = (MotionKind(row[f"motion_{side}"]).words for side in ("before", "after"))
    low, high = (f"branch {row[name]}" if row[name] >= 0 else "" for name in ("from_branch", "to_branch"))
    match Change(row["change"]):
        case Change.BEGINNING:
            return f"{high} begins, {after}" + (f"; at smaller a it leads to {low}" if low else "")
        case Change.END:
            return f"{low} ends, {before}" + (f"; at larger a it leads to {high}" if high else "")
        case Change.CHANGE:
            motion = f"from {before} to {after}" if before != after else f"to another {after} motion"
            return f"{low} changes {motion}"
        case _:
            return f"{low} continues, {before}"


def _format_stops(stops: np.ndarray) -> str:
    return " ".join(map(str, stops))


def _dataset(
    names: Sequence[str], values: Mapping[str, np.ndarray], block: xarray.Variable, head: Mapping[str, Any]
) -> xarray.Dataset:
    """Return the bifurcations of the laws of these names as a Dataset."""
    coordinates = {**axes(part=PARTS), "block": block}
    about = {
        "laws": " ".join(names),
        **head,
        "history": "snakemake, from the attractors and the equations of motion",
    }
    return summary("Bifurcations of the branches of attractors", VARIABLES, values, coordinates, about, module=__name__)


def _sort_rows(rows: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Return bifurcations sorted by a, then by change, then by all other columns.

    The rounded values are sorted, since further digits differ between linear-algebra libraries.
    """
    count = len(rows["a"])
    keys = [column for name in ("a", "change", *rows) for column in rows[name].reshape(count, -1).T] if count else []
    order = np.lexsort(keys[::-1]) if keys else np.arange(0)
    return {name: values[order] for name, values in rows.items()}


def _branches_of_segments(orbits: FollowedOrbits, branch: np.ndarray) -> list[int]:
    """Return the branch of most attractors on each segment, which may differ from that of its first attractor.

    branch : of the attractors, shape (value, attractor)
    """
    numbers: list[Counter[int]] = [Counter() for _ in orbits.segments]
    for place, number in orbits.of_place.items():
        numbers[number][int(branch[place])] += 1
    return [counted.most_common(1)[0][0] for counted in numbers]


def _round_digits(values: np.ndarray, digits: int) -> np.ndarray:
    """Return floating-point numbers rounded to some significant digits; integers and texts are returned unchanged."""
    if values.dtype.kind != "f":
        return values
    # Near 0 the number of decimal places is limited as well. Adding 0 turns -0 into 0.
    rounded = [float(f"{round(value, PLACES) + 0.0:.{digits - 1}e}") for value in values.ravel().tolist()]
    return np.reshape(rounded, values.shape).astype(float)


def digest(data: xarray.Dataset) -> str:
    """Return the number of bifurcations of each kind under each law, and all of them if they are few."""
    lines = []
    for law in data.attrs["laws"].split():
        mask = data["law"].values == law
        kinds = Counter(data["kind"].values[mask].tolist())
        counts = ", ".join(f"{BifurcationKind(kind).words} {count}" for kind, count in kinds.most_common())
        lines.append(f"{law}: {format_count(int(mask.sum()), 'bifurcation')}{f': {counts}' if counts else ''}")
    if data.sizes["bifurcation"] > MOST_LISTED:
        return "\n".join([*lines, "bifurcations.txt, next to the summary of all laws, has a line for each"])
    return "\n".join([*lines, "", listing(data)])
