"""Basins of attraction over a plane of initial states: tiles of a map, and the maps put together."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray

from burridge_knopoff.dataset.summary import summary
from burridge_knopoff.dataset.variables import Variable
from burridge_knopoff.friction import LAWS
from burridge_knopoff.stability.basins import known_attractors, label_states, pixel_centres, plane
from burridge_knopoff.stability.labels import UNDETERMINED
from burridge_knopoff.stability.uncertainty import SEPARATIONS, uncertain_fraction, uncertainty_exponent

_PLANE = ("last_position", "first_position")
_V = Variable
TILE_VARIABLES = {
    "branch": _V(_PLANE, "i2", "branch of the attractor that the state reaches, -1 if undetermined"),
    "side": _V(_PLANE, "i1", "side of that branch: 1 and -1 for mirror images, 0 for its own mirror image"),
    "decision_time": _V(_PLANE, "f4", "time tau at which the attractor was certain"),
}
MAP_VARIABLES = {
    **{name: _V(("map", *_PLANE), item.dtype, item.long_name) for name, item in TILE_VARIABLES.items()},
    "undetermined_count": _V(("map",), "i4", "states that reach no attractor by the time limit"),
    "uncertain_fraction": _V(("map", "separation"), "f8", "share of pairs of states that reach different attractors"),
    "uncertainty_exponent": _V(("map",), "f8", "uncertainty exponent alpha of the basin boundary"),
    "uncertainty_exponent_error": _V(("map",), "f8", "standard error of alpha, a jackknife over bands of the map"),
}
COORDINATES = {
    "first_position": "initial position U_1(0) of the first block",
    "last_position": "initial position U_N(0) of the last block",
}


def tile(
    attractors: xarray.Dataset, law: str, a: float, number: int, config: Mapping[str, Any], threads: int
) -> xarray.Dataset:
    """Label one tile of a map: a band of rows of equal U_N(0).

    attractors : the summary of that name; number : of the tile, from 0
    config : the config's v, contact, start, initial, synchronization_threshold and sections attractors, motion, basins
    """
    basins = config["basins"]
    known = known_attractors(attractors, law, a, config)
    first = pixel_centres(basins["first_position"], basins["pixels"])
    last = np.array_split(pixel_centres(basins["last_position"], basins["pixels"]), basins["tiles"])[number]
    state = config["initial"][basins["initial"]]
    position, velocity = plane(state["position"], first, last, state["velocity"])
    time_limit = config["attractors"]["time_limit"]
    labels, times = label_states(known, position, velocity, config["start"], time_limit, threads)
    shape = (len(last), len(first))
    values = {
        name: np.where(labels == UNDETERMINED, missing, table[labels] if len(table) else missing).reshape(shape)
        for name, table, missing in (("branch", known.branch, UNDETERMINED), ("side", known.side, 0))
    }
    values["decision_time"] = times.reshape(shape)
    attributes = {"law": law, "a": a, "history": "snakemake, from attractors.nc"}
    return summary("Tile of a map of basins", TILE_VARIABLES, values, _coordinates(first, last), attributes)


def merge(maps: Sequence[tuple[str, float, Sequence[xarray.Dataset]]], config: Mapping[str, Any]) -> xarray.Dataset:
    """Put the maps together, each (law, a, its tiles in order), with the uncertainty exponents of their boundaries."""
    wholes = [xarray.concat(tiles, "last_position", combine_attrs="drop_conflicts") for _, _, tiles in maps]
    values: dict[str, Any] = {name: np.stack([whole[name].values for whole in wholes]) for name in TILE_VARIABLES}
    # The two sides of a branch are two attractors.
    labels = [
        np.where(whole["branch"] < 0, -1, 3 * whole["branch"] + whole["side"] + 1).astype(int) for whole in wholes
    ]
    values["undetermined_count"] = [np.count_nonzero(label < 0) for label in labels]
    values["uncertain_fraction"] = [uncertain_fraction(label) for label in labels]
    exponents = [uncertainty_exponent(label) for label in labels]
    values["uncertainty_exponent"], values["uncertainty_exponent_error"] = np.array(exponents).T
    basins = config["basins"]
    coordinates = _coordinates(wholes[0]["first_position"].values, wholes[0]["last_position"].values)
    width = (basins["first_position"][1] - basins["first_position"][0]) / basins["pixels"]
    coordinates["separation"] = ("separation", np.array(SEPARATIONS) * width, {"long_name": "separation", "units": "1"})
    law = {
        "long_name": "friction law",
        "flag_values": np.arange(len(LAWS), dtype="i1"),
        "flag_meanings": " ".join(LAWS),
    }
    coordinates["law"] = ("map", np.array([LAWS.index(name) for name, _, _ in maps], dtype="i1"), law)
    a = {"long_name": "friction parameter a", "units": "1"}
    coordinates["a"] = ("map", np.array([value for _, value, _ in maps]), a)
    state = config["initial"][basins["initial"]]
    attributes = {
        "history": "snakemake, from attractors.nc",
        "v": config["v"],
        "contact": config["contact"],
        "start": config["start"],
        "plane_position": np.array(state["position"], dtype=float),
        "plane_velocity": np.array(state["velocity"], dtype=float),
        "time_limit": config["attractors"]["time_limit"],
    }
    return summary("Basins of attraction", MAP_VARIABLES, values, coordinates, attributes)


def digest(dataset: xarray.Dataset) -> str:
    """Return, in a line for each map, the shares of the basins and the uncertainty exponent of their boundary."""
    lines = []
    for number in range(dataset.sizes["map"]):
        one = dataset.isel(map=number)
        pairs, counts = np.unique(
            np.stack([one["branch"].values.ravel(), one["side"].values.ravel()]), axis=1, return_counts=True
        )
        shares = []
        for (branch, side), count in zip(pairs.T, counts, strict=True):
            name = {-1: "undetermined", 0: "synchronized"}.get(int(branch), f"branch {branch}")
            name += {1: " (+)", -1: " (-)", 0: ""}[int(side)]
            shares.append(f"{name} {100.0 * count / one['branch'].size:.2f} %")
        alpha, error = one["uncertainty_exponent"].item(), one["uncertainty_exponent_error"].item()
        lines.append(
            f"{LAWS[int(one['law'])]}, a = {one['a'].item():g}: {', '.join(shares)}; "
            f"uncertainty exponent {alpha:.3f} +- {error:.3f}; "
            f"decided at tau = {one['decision_time'].values.mean():.0f} in the mean"
        )
    return "\n".join(lines) + "\n"


def _coordinates(first: np.ndarray, last: np.ndarray) -> dict[str, Any]:
    values = {"first_position": first, "last_position": last}
    return {name: (name, values[name], {"long_name": text, "units": "1"}) for name, text in COORDINATES.items()}
