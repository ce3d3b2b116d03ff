"""Maps of basins of attraction: the attractor that each state of a plane reaches, and the uncertainty exponent.

A map is a plane of initial states; the components that are the same in all of them are the attributes `plane_position`
and `plane_velocity`, those of the first map. The map of one block is the plane of U_1(0) and U_1'(0), with
`first_velocity` in place of `last_position`.

The uncertainty exponent α of f ∝ ε^α is fitted to all separations ε from the fifth on, a range of a factor of 6561; a
boundary of dimension D has α = 2 − D. Near boundaries more pairs are examined, and each counts in f with its weight, so
that f is not the ratio of `uncertain_count` and `pair_count`. `exponent_kind` is *unknown* if fewer than four
separations have eight differing pairs in more than one batch, and *varying* if the local exponent changes by more than
0.3 and three standard errors. Errors are from a jackknife over 20 independent batches of pairs; the error of α includes
half the change of the local exponent, as far as two standard errors do not explain it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import xarray

from burridge_knopoff.attractors.labels import UNDETERMINED, label_states
from burridge_knopoff.attractors.settings import SearchSettings
from burridge_knopoff.attractors.stored_returns import KnownAttractors, known_attractors
from burridge_knopoff.attractors.table import NAMES
from burridge_knopoff.basins.pair_separation import SEPARATIONS, follow_pairs
from burridge_knopoff.basins.plane import pixel_centres, plane, states
from burridge_knopoff.basins.settings import BasinSettings
from burridge_knopoff.basins.uncertainty import ExponentKind, uncertainty_exponent
from burridge_knopoff.dataset.law_attributes import has_a, without_a
from burridge_knopoff.dataset.summary import AXES, axes, summary
from burridge_knopoff.dataset.variables import Variable, flag
from burridge_knopoff.laws.law import recorded_a
from burridge_knopoff.model.fields import settings_from_config
from burridge_knopoff.model.initial import initial_state
from burridge_knopoff.model.model import Model
from burridge_knopoff.study.formatting import to_ascii, with_error
from burridge_knopoff.study.model import model_of
from burridge_knopoff.summaries.map_rows import map_rows

_PLANE = ("last_position", "first_position")
_V = Variable
TILE_VARIABLES = {
    "branch": _V(_PLANE, "i2", "branch reached: branch of the attractor that the state reaches, -1 if undetermined"),
    "side": _V(_PLANE, "i1", "side of that branch: 1 and -1 for mirror images, 0 for its own mirror image"),
    "decision_time": _V(_PLANE, "f4", "decision time: time tau at which the attractor was determined"),
}
PAIR_VARIABLES = {
    "uncertain_count": _V(
        ("separation",), "i4", "number of uncertain pairs: pairs of states that reach different attractors"
    ),
    "pair_count": _V(("separation",), "i4", "number of pairs: pairs of states of which both reach an attractor"),
    "uncertain_fraction": _V(
        ("separation",),
        "f8",
        "uncertain fraction f: fraction of all pairs of states of the plane that reach different attractors",
        {"ancillary_variables": "uncertain_fraction_error"},
    ),
    "uncertain_fraction_error": _V(("separation",), "f8", "standard error of f: from a jackknife"),
    "local_exponent": _V(
        ("separation_step",),
        "f8",
        "local exponent: slope of log f against log separation, from each separation to the next",
        {"ancillary_variables": "local_exponent_error"},
    ),
    "local_exponent_error": _V(("separation_step",), "f8", "standard error of the slope: from a jackknife"),
    "uncertainty_exponent": _V(
        (),
        "f8",
        "uncertainty exponent alpha: of the basin boundary, NaN if it is undetermined or not a single one",
        {"ancillary_variables": "uncertainty_exponent_error"},
    ),
    "uncertainty_exponent_error": _V((), "f8", "standard error of alpha: from a jackknife"),
    "exponent_change": _V(
        (), "f8", "change of the local exponent: over the fitted separations, from a fit of a parabola"
    ),
    "exponent_change_error": _V((), "f8", "standard error of this change: from a jackknife"),
    "exponent_kind": _V(
        (), "i1", "kind of exponent: whether the boundary has a single exponent", flag("i1", ExponentKind)
    ),
}
MAP_VARIABLES = {
    **{name: _V(("map", *_PLANE), item.dtype, item.description) for name, item in TILE_VARIABLES.items()},
    "undetermined_count": _V(
        ("map",), "i4", "number of undetermined states: states that reach no attractor by label_limit"
    ),
    **{name: replace(item, dimensions=("map", *item.dimensions)) for name, item in PAIR_VARIABLES.items()},
    **NAMES,
}
COORDINATES = {
    "first_position": _V(("first_position",), "f8", "initial position U_1(0): of the first block", coordinate=True),
    "last_position": _V(("last_position",), "f8", "initial position U_N(0): of the last block", coordinate=True),
    "first_velocity": _V(("first_velocity",), "f8", "initial velocity U_1'(0): of one block", coordinate=True),
    "separation": _V(
        ("separation",), "f8", "separation: distance between the two states of a pair in the plane", coordinate=True
    ),
}
OF_MAP = {name: replace(AXES[name], dimensions=("map",)) for name in ("law", "a")}


def tile_of_map(
    config: Mapping[str, Any], law: str, attractors: xarray.Dataset, returns: xarray.Dataset, number: int, cores: int
) -> xarray.Dataset:
    """Return one tile of the map of a law at one a.

    config : the keys of a study's config that decide the map, with that a
    attractors, returns : of all laws, and of the law, on the grid
    number : of the tile, from 0
    """
    candidates = known_attractors(attractors, returns, model_of(config, law, config["a"]))
    limit = SearchSettings(**config["attractors"]).label_limit
    return tile(candidates, number, replace(_plane(config), cores=cores), limit, config["start"])


def pairs_of_map(
    config: Mapping[str, Any], law: str, attractors: xarray.Dataset, returns: xarray.Dataset, cores: int
) -> xarray.Dataset:
    """Return the pairs of nearby states of the map of a law at one a; arguments as in `tile_of_map`."""
    candidates = known_attractors(attractors, returns, model_of(config, law, config["a"]))
    search = SearchSettings(**config["attractors"])
    return pairs(candidates, replace(_plane(config), cores=cores), search.label_limit, search.seed, config["start"])


def _plane(config: Mapping[str, Any]) -> BasinSettings:
    (state,) = config["initial"].items()
    return replace(settings_from_config(BasinSettings, config["basins"]), initial=initial_state(state[0], **state[1]))


def merge_maps(
    config: Mapping[str, Any],
    attractors: xarray.Dataset,
    tiles: Sequence[xarray.Dataset],
    of_pairs: Sequence[xarray.Dataset],
) -> xarray.Dataset:
    """Return all maps.

    config : the keys of a study's config that decide them
    tiles, of_pairs : all tiles of all maps, and the pairs of each map, in the order of `basins.a`
    """
    plane, maps = _plane(config), [(law, a) for law, values in config["basins"]["a"].items() for a in values]
    parts = [
        (model_of(config, law, a), tiles[n * plane.tiles : (n + 1) * plane.tiles], of_pairs[n])
        for n, (law, a) in enumerate(maps)
    ]
    limit = SearchSettings(**config["attractors"]).label_limit
    return merge(parts, attractors, plane, limit, config["start"])


def tile(
    candidates: KnownAttractors, number: int, basins: BasinSettings, label_limit: float, start: str
) -> xarray.Dataset:
    """Label one tile of a map: a band of rows of equal U_N(0), or U_1'(0) of one block.

    candidates : the attractors of the model
    number : of the tile, from 0
    label_limit : time by which a state has to reach an attractor; start : see `Model.begin`
    """
    first = pixel_centres(basins.first_position, basins.pixels)
    row, interval = basins.rows(candidates.model)
    last = np.array_split(pixel_centres(interval, basins.pixels), basins.tiles)[number]
    u, w = candidates.model.initial_coordinates(basins.initial)
    position, velocity = plane(u, first, last, w)
    labels, times = _labels(candidates, position, velocity, basins, label_limit, start)
    shape = (len(last), len(first))
    values = {
        name: np.where(labels == UNDETERMINED, missing, table[labels] if len(table) else missing).reshape(shape)
        for name, table, missing in (("branch", candidates.branch, UNDETERMINED), ("side", candidates.side, 0))
    }
    values["decision_time"] = np.where(labels == UNDETERMINED, np.nan, times).reshape(shape)
    attributes = {
        "law": candidates.model.law.name,
        "a": recorded_a(candidates.model.law),
        "history": "snakemake, from attractors.nc",
    }
    coordinates = axes(COORDINATES, **{"first_position": first, row: last})
    variables = _of_plane(TILE_VARIABLES, row)
    return summary("Tile of a map of basins", variables, values, coordinates, attributes, module=__name__)


def pairs(
    candidates: KnownAttractors, basins: BasinSettings, label_limit: float, seed: int, start: str
) -> xarray.Dataset:
    """Label pairs of nearby states in the plane of a map, for the uncertainty exponent of its boundary; see `tile`."""

    u, w = candidates.model.initial_coordinates(basins.initial)

    def label(points: np.ndarray) -> np.ndarray:
        first, last = points.T
        position, velocity = states(u, first, last, w)
        return _labels(candidates, position, velocity, basins, label_limit, start)[0]

    _, interval = basins.rows(candidates.model)
    counts = follow_pairs(label, basins.first_position, interval, basins.pairs, seed)
    exponent = uncertainty_exponent(counts)
    values: dict[str, Any] = {"uncertain_count": counts.different_count, "pair_count": counts.labelled_count}
    for name, pair in (
        ("uncertain_fraction", exponent.fraction),
        ("local_exponent", exponent.local),
        ("uncertainty_exponent", exponent.alpha),
        ("exponent_change", exponent.change),
    ):
        values[name], values[f"{name}_error"] = pair
    values["exponent_kind"] = exponent.kind
    attributes = {
        "law": candidates.model.law.name,
        "a": recorded_a(candidates.model.law),
        "history": "snakemake, from attractors.nc",
    }
    width = basins.first_position[1] - basins.first_position[0]
    coordinates = axes(COORDINATES, separation=np.array(SEPARATIONS) * width)
    return summary("Pairs of nearby states", PAIR_VARIABLES, values, coordinates, attributes, module=__name__)


def _labels(
    candidates: KnownAttractors,
    position: np.ndarray,
    velocity: np.ndarray,
    basins: BasinSettings,
    label_limit: float,
    start: str,
) -> tuple[np.ndarray, np.ndarray]:
    return label_states(
        candidates.model,
        candidates.attractors,
        position,
        velocity,
        start=start,
        time_limit=label_limit,
        cores=basins.cores,
    )


def merge(
    maps: Sequence[tuple[Model, Sequence[xarray.Dataset], xarray.Dataset]],
    attractors: xarray.Dataset,
    basins: BasinSettings,
    label_limit: float,
    start: str,
) -> xarray.Dataset:
    """Return all maps in one Dataset; maps : (model, its tiles in order, its pairs) of each.

    attractors : the summary of that name, which has the names of the branches
    basins, label_limit, start : settings of the maps
    """
    row, interval = basins.rows(maps[0][0])
    wholes = [xarray.concat(tiles, row, combine_attrs="drop_conflicts") for _, tiles, _ in maps]
    values = xarray.merge(
        [
            xarray.concat(wholes, "map", join="exact", combine_attrs="drop"),
            xarray.concat([near for *_, near in maps], "map", join="exact", combine_attrs="drop"),
            attractors[list(NAMES)],
        ],
        combine_attrs="drop",
    )
    values["undetermined_count"] = (values["branch"] == UNDETERMINED).sum(["first_position", row])
    models = [model for model, *_ in maps]
    of_map = axes(OF_MAP, law=[model.law.name for model in models], a=[recorded_a(model.law) for model in models])
    coordinates = {**axes(COORDINATES, **{name: values[name] for name in COORDINATES if name in values}), **of_map}
    u, w = models[0].initial_coordinates(basins.initial)
    attributes = {
        "history": "snakemake, from attractors.nc",
        "v": models[0].v,
        "contact": models[0].contact,
        "start": start,
        "plane_position": u,
        "plane_velocity": w,
        "first_range": np.array(basins.first_position),
        "last_range" if row == "last_position" else "velocity_range": np.array(interval),
        "label_limit": label_limit,
        **without_a([model.law for model in models]),
    }
    variables = _of_plane(MAP_VARIABLES, row)
    return summary("Basins of attraction", variables, values, coordinates, attributes, module=__name__)


def _of_plane(variables: Mapping[str, Variable], row: str) -> dict[str, Variable]:
    """Return variables of a map whose second axis has this name."""
    plane = dict(zip(_PLANE, (row, "first_position"), strict=True))
    return {
        name: replace(item, dimensions=tuple(plane.get(axis, axis) for axis in item.dimensions))
        for name, item in variables.items()
    }


def digest(dataset: xarray.Dataset) -> str:
    """Return a line for each map: the fractions of the basins and the uncertainty exponent of their boundary.

    For a part of a map, see `_digest_of_part`.
    """
    if "map" not in dataset.dims:
        return _digest_of_part(dataset)
    lines = []
    for number, row in enumerate(map_rows(dataset)):
        basin_map = dataset.isel(map=number)
        shares = [f"{name} {100.0 * count / row.states:.2f} %" for name, count in row.members.items()]
        if row.symmetric_count:
            line = "on the line of mirror-symmetric states, which has no area"
            shares[0] += f" ({row.symmetric_count} of {row.undetermined} {line})"
        times = basin_map["decision_time"].values
        decided = f"; mean decision time {np.nanmean(times):.0f}" if np.isfinite(times).any() else ""
        place = f"{row.law}, a = {row.a:g}" if has_a(dataset.attrs) else row.law
        lines.append(f"{place}: {', '.join(shares)}; {exponent_text(basin_map)}{decided}")
    return "\n".join(lines) + "\n"


def _digest_of_part(data: xarray.Dataset) -> str:
    """Return the result of a part of a map: the shares of the branches in a tile, or the exponent from pairs."""
    if "branch" not in data:
        return f"{data.attrs['law']}, a = {data.attrs['a']:g}: {exponent_text(data)}"
    branches, counts = np.unique(data["branch"].values, return_counts=True)
    shares = [
        f"{'undetermined' if branch < 0 else f'branch {branch}'} {100.0 * count / counts.sum():.2f} %"
        for branch, count in zip(branches.tolist(), counts.tolist(), strict=True)
    ]
    return (
        f"{data.attrs['law']}, a = {data.attrs['a']:g}: states of this tile by the branch reached: {', '.join(shares)}"
    )


def exponent_text(basin_map: xarray.Dataset) -> str:
    """Return the uncertainty exponent of one map's boundary, and what it means, as text."""
    kind = ExponentKind(basin_map["exponent_kind"].item())
    if kind == ExponentKind.UNKNOWN:
        return "uncertainty exponent undetermined: too few pairs of nearby states reach different attractors"
    change, error = basin_map["exponent_change"].item(), basin_map["exponent_change_error"].item()
    changes = to_ascii(with_error(change, error))
    if kind == ExponentKind.VARYING:
        return f"no single uncertainty exponent: from the largest separation to the smallest it changes by {changes}"
    alpha, error = basin_map["uncertainty_exponent"].item(), basin_map["uncertainty_exponent_error"].item()
    return (
        f"uncertainty exponent {to_ascii(with_error(alpha, error))}: if initial states are known 10 times as "
        f"precisely, the fraction of them whose attractor is uncertain is divided by {10.0**alpha:.2g} (by 10 if the "
        "basin boundary is smooth)"
    )
