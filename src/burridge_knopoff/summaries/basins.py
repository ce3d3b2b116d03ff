"""Maps of basins of attraction: which attractor each initial state of a plane reaches, and how rough boundaries are."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import xarray

from burridge_knopoff.attractors.labels import UNDETERMINED, label_states
from burridge_knopoff.attractors.lookup import branch_names
from burridge_knopoff.attractors.stored_returns import KnownAttractors
from burridge_knopoff.attractors.table import NAMES
from burridge_knopoff.basins.pair_separation import SEPARATIONS, follow_pairs
from burridge_knopoff.basins.plane import pixel_centres, plane, states
from burridge_knopoff.basins.settings import BasinSettings
from burridge_knopoff.basins.uncertainty import ExponentKind, uncertainty_exponent
from burridge_knopoff.dataset.summary import summary
from burridge_knopoff.dataset.variables import Variable, flag
from burridge_knopoff.model.model import Model
from burridge_knopoff.study.formatting import plain, with_error

_PLANE = ("last_position", "first_position")
_V = Variable
TILE_VARIABLES = {
    "branch": _V(_PLANE, "i2", "branch of the attractor that the state reaches, -1 if undetermined"),
    "side": _V(_PLANE, "i1", "side of that branch: 1 and -1 for mirror images, 0 for its own mirror image"),
    "decision_time": _V(_PLANE, "f4", "time tau at which the attractor was certain"),
}
PAIR_VARIABLES = {
    "uncertain_count": _V(("separation",), "i4", "pairs of states that were found to reach different attractors"),
    "pair_count": _V(("separation",), "i4", "pairs of states that were found to reach an attractor both"),
    "uncertain_fraction": _V(
        ("separation",),
        "f8",
        "fraction f of all pairs of states of the plane that reach different attractors",
        {"ancillary_variables": "uncertain_fraction_error"},
    ),
    "uncertain_fraction_error": _V(("separation",), "f8", "standard error of f, from a jackknife"),
    "local_exponent": _V(
        ("separation_step",),
        "f8",
        "slope of log f against log separation, from each separation to the next",
        {"ancillary_variables": "local_exponent_error"},
    ),
    "local_exponent_error": _V(("separation_step",), "f8", "standard error of the slope, from a jackknife"),
    "uncertainty_exponent": _V(
        (),
        "f8",
        "uncertainty exponent alpha of the basin boundary, NaN unless it is known and a single one",
        {"ancillary_variables": "uncertainty_exponent_error"},
    ),
    "uncertainty_exponent_error": _V((), "f8", "standard error of alpha, from a jackknife"),
    "exponent_change": _V(
        (), "f8", "by how much the local exponent changes over the fitted separations, by a parabola"
    ),
    "exponent_change_error": _V((), "f8", "standard error of that change, from a jackknife"),
    "exponent_kind": _V((), "i1", "whether the boundary has a single exponent", flag("i1", ExponentKind)),
}
MAP_VARIABLES = {
    **{name: _V(("map", *_PLANE), item.dtype, item.long_name) for name, item in TILE_VARIABLES.items()},
    "undetermined_count": _V(("map",), "i4", "states that reach no attractor by label_limit"),
    **{name: replace(item, dimensions=("map", *item.dimensions)) for name, item in PAIR_VARIABLES.items()},
    **NAMES,
}
COORDINATES = {
    "first_position": "initial position U_1(0) of the first block",
    "last_position": "initial position U_N(0) of the last block",
}


def tile(known: KnownAttractors, number: int, basins: BasinSettings, label_limit: float, start: str) -> xarray.Dataset:
    """Label one tile of a map: a band of rows of equal U_N(0).

    known : the attractors of the model
    number : of the tile, from 0
    label_limit : time by which a state has to reach an attractor; start : see `Model.begin`
    """
    first = pixel_centres(basins.first_position, basins.pixels)
    last = np.array_split(pixel_centres(basins.last_position, basins.pixels), basins.tiles)[number]
    u, w = basins.initial.numbers(known.model.blocks)
    position, velocity = plane(u, first, last, w)
    labels, times = _labels(known, position, velocity, basins, label_limit, start)
    shape = (len(last), len(first))
    values = {
        name: np.where(labels == UNDETERMINED, missing, table[labels] if len(table) else missing).reshape(shape)
        for name, table, missing in (("branch", known.branch, UNDETERMINED), ("side", known.side, 0))
    }
    values["decision_time"] = np.where(labels == UNDETERMINED, np.nan, times).reshape(shape)
    attributes = {"law": known.model.law.name, "a": known.model.a, "history": "snakemake, from attractors.nc"}
    coordinates = _coordinates(first, last)
    return summary("Tile of a map of basins", TILE_VARIABLES, values, coordinates, attributes, module=__name__)


def pairs(known: KnownAttractors, basins: BasinSettings, label_limit: float, seed: int, start: str) -> xarray.Dataset:
    """Label pairs of near states of the plane of a map, for the uncertainty exponent of its boundary; see `tile`."""

    u, w = basins.initial.numbers(known.model.blocks)

    def label(points: np.ndarray) -> np.ndarray:
        first, last = points.T
        position, velocity = states(u, first, last, w)
        return _labels(known, position, velocity, basins, label_limit, start)[0]

    found = follow_pairs(label, basins.first_position, basins.last_position, basins.pairs, seed)
    exponent = uncertainty_exponent(found)
    values: dict[str, Any] = {"uncertain_count": found.different_count, "pair_count": found.known_count}
    for name, pair in (
        ("uncertain_fraction", exponent.fraction),
        ("local_exponent", exponent.local),
        ("uncertainty_exponent", exponent.alpha),
        ("exponent_change", exponent.change),
    ):
        values[name], values[f"{name}_error"] = pair
    values["exponent_kind"] = exponent.kind
    attributes = {"law": known.model.law.name, "a": known.model.a, "history": "snakemake, from attractors.nc"}
    coordinates = {"separation": _separation(basins)}
    return summary("Pairs of near states", PAIR_VARIABLES, values, coordinates, attributes, module=__name__)


def _labels(
    known: KnownAttractors,
    position: np.ndarray,
    velocity: np.ndarray,
    basins: BasinSettings,
    label_limit: float,
    start: str,
) -> tuple[np.ndarray, np.ndarray]:
    return label_states(
        known.model,
        known.attractors,
        position,
        velocity,
        start=start,
        time_limit=label_limit,
        threads=basins.threads,
    )


def _separation(basins: BasinSettings) -> tuple[str, np.ndarray, dict[str, str]]:
    width = basins.first_position[1] - basins.first_position[0]
    text = "distance between the two states of a pair in the plane"
    return "separation", np.array(SEPARATIONS) * width, {"long_name": text, "units": "1"}


def merge(
    maps: Sequence[tuple[Model, Sequence[xarray.Dataset], xarray.Dataset]],
    attractors: xarray.Dataset,
    laws: Sequence[str],
    basins: BasinSettings,
    label_limit: float,
    start: str,
) -> xarray.Dataset:
    """Put the maps together, each (model, its tiles in order, its pairs).

    attractors : the summary of that name, which has the names of the branches
    laws : names of the laws of the study, in order; basins, label_limit, start : what the maps were made with
    """
    wholes = [xarray.concat(tiles, "last_position", combine_attrs="drop_conflicts") for _, tiles, _ in maps]
    values: dict[str, Any] = {name: np.stack([whole[name].values for whole in wholes]) for name in TILE_VARIABLES}
    values["undetermined_count"] = [np.count_nonzero(whole["branch"] == UNDETERMINED) for whole in wholes]
    values |= {name: np.stack([near[name].values for *_, near in maps]) for name in PAIR_VARIABLES}
    values |= {name: attractors[name].values for name in NAMES}
    coordinates = _coordinates(wholes[0]["first_position"].values, wholes[0]["last_position"].values)
    coordinates["separation"] = _separation(basins)
    models = [model for model, *_ in maps]
    law = {
        "long_name": "friction law",
        "flag_values": np.arange(len(laws), dtype="i1"),
        "flag_meanings": " ".join(laws),
    }
    coordinates["law"] = ("map", np.array([laws.index(model.law.name) for model in models], dtype="i1"), law)
    a = {"long_name": "friction parameter a", "units": "1"}
    coordinates["a"] = ("map", np.array([model.a for model in models]), a)
    u, w = basins.initial.numbers(models[0].blocks)
    attributes = {
        "history": "snakemake, from attractors.nc",
        "v": models[0].v,
        "contact": models[0].contact,
        "start": start,
        "plane_position": u,
        "plane_velocity": w,
        "first_range": np.array(basins.first_position),
        "last_range": np.array(basins.last_position),
        "label_limit": label_limit,
    }
    return summary("Basins of attraction", MAP_VARIABLES, values, coordinates, attributes, module=__name__)


def digest(dataset: xarray.Dataset) -> str:
    """Return, in a line for each map, the shares of the basins and the uncertainty exponent of their boundary."""
    lines = []
    names = {UNDETERMINED: "undetermined", **branch_names(dataset)}
    laws = dataset["law"].attrs["flag_meanings"].split()
    for number in range(dataset.sizes["map"]):
        one = dataset.isel(map=number)
        pairs, counts = np.unique(
            np.stack([one["branch"].values.ravel(), one["side"].values.ravel()]), axis=1, return_counts=True
        )
        shares = []
        for (branch, side), count in zip(pairs.T, counts, strict=True):
            name = names[int(branch)] + {1: " (+)", -1: " (-)", 0: ""}[int(side)]
            alike = undetermined_alike(one) if branch == UNDETERMINED else 0
            within = f" ({alike} of {count} where mirror blocks are alike, a line of no area)" if alike else ""
            shares.append(f"{name} {100.0 * count / one['branch'].size:.2f} %{within}")
        times = one["decision_time"].values
        decided = f"; decided at tau = {np.nanmean(times):.0f} in the mean" if np.isfinite(times).any() else ""
        lines.append(
            f"{laws[int(one['law'])]}, a = {one['a'].item():g}: {', '.join(shares)}; {_exponent_text(one)}{decided}"
        )
    return "\n".join(lines) + "\n"


def undetermined_alike(one: xarray.Dataset) -> int:
    """Return how many undetermined states of a map are their own mirror images: U_1(0) = U_N(0), a line of no area.

    In a chain that is its own mirror image such states stay alike, and so come to no attractor where synchrony repels.
    None is counted where all states of the map are undetermined, as this has other reasons then.
    """
    position, velocity = one.attrs["plane_position"], one.attrs["plane_velocity"]
    undetermined = one["branch"].values == UNDETERMINED
    if undetermined.all() or (position[1:-1] != position[-2:0:-1]).any() or (velocity != velocity[::-1]).any():
        return 0
    alike = np.equal.outer(one["last_position"].values, one["first_position"].values)
    return int(np.count_nonzero(undetermined[alike]))


def _exponent_text(one: xarray.Dataset) -> str:
    """Return what is known of the exponent of one map's boundary."""
    kind = ExponentKind(one["exponent_kind"].item())
    if kind == ExponentKind.UNKNOWN:
        return "uncertainty exponent unknown: too few pairs differ"
    change, error = one["exponent_change"].item(), one["exponent_change_error"].item()
    changes = f"it changes by {plain(with_error(change, error))} over the separations"
    if kind == ExponentKind.VARYING:
        return f"no single uncertainty exponent: {changes}"
    alpha, error = one["uncertainty_exponent"].item(), one["uncertainty_exponent_error"].item()
    return f"uncertainty exponent {plain(with_error(alpha, error))} ({changes})"


def _coordinates(first: np.ndarray, last: np.ndarray) -> dict[str, Any]:
    values = {"first_position": first, "last_position": last}
    return {name: (name, values[name], {"long_name": text, "units": "1"}) for name, text in COORDINATES.items()}
