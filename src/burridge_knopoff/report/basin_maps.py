"""Maps of basins for the page: which attractor each initial state reaches, and when that was certain."""

from __future__ import annotations

import base64
from typing import Any

import numpy as np
import xarray

from burridge_knopoff.attractors.table import branch_names
from burridge_knopoff.figures.branches import UNDETERMINED_COLOR, map_colors, side_color
from burridge_knopoff.report.numbers import rounded

#: Largest decision time that two bytes hold; 0 stands for undetermined.
LARGEST_TIME = 65535


def basin_maps(
    basins: xarray.Dataset, attractors: xarray.Dataset, marked: dict[str, tuple[float, float]]
) -> dict[str, Any]:
    """Return the maps, each with `classes` (name, colour and share of the states) and two arrays of one plane.

    label : base64 of one byte a pixel, the position in `classes`, rows of equal U_N(0) one after another
    time : base64 of two bytes a pixel, least significant first: decision time τ, rounded, 0 if undetermined
    marked : U_1(0) and U_N(0) of the initial states of the study in the plane
    """
    colors = map_colors(attractors, np.unique(basins["branch"]).tolist())
    names = branch_names(attractors)
    laws = basins["law"].attrs["flag_meanings"].split()
    return {
        "blocks": basins.attrs["plane_position"].size,
        "first": rounded(basins["first_position"].values),
        "last": rounded(basins["last_position"].values),
        "marked": [{"name": name, "first": x, "last": y} for name, (x, y) in marked.items()],
        "maps": [_map(basins.isel(map=number), laws, colors, names) for number in range(basins.sizes["map"])],
    }


def _map(one: xarray.Dataset, laws: list[str], colors: dict[int, str], names: dict[int, str]) -> dict[str, Any]:
    branch, side = one["branch"].values.astype(int), one["side"].values.astype(int)
    # Branches in order, the side + before −, undetermined last.
    present = sorted(
        {(int(b), int(s)) for b, s in zip(branch.ravel(), side.ravel(), strict=True)},
        key=lambda pair: (pair[0] < 0, pair[0], -pair[1]),
    )
    label = np.zeros(branch.shape, dtype="u1")
    classes = []
    for number, (b, s) in enumerate(present):
        members = (branch == b) & (side == s)
        label[members] = number
        name = "undetermined" if b < 0 else names[b] + {1: " (+)", -1: " (−)", 0: ""}[s]
        shade = UNDETERMINED_COLOR if b < 0 else _hex(side_color(colors[b], s))
        classes.append({"name": name, "color": shade, "percent": rounded(100.0 * members.mean())})
    time = np.nan_to_num(np.clip(np.round(one["decision_time"].values), 1, LARGEST_TIME), nan=0.0)
    return {
        "law": laws[int(one["law"])],
        "a": one["a"].item(),
        "exponent": rounded(one["uncertainty_exponent"].item()),
        "exponent_error": rounded(one["uncertainty_exponent_error"].item()),
        "classes": classes,
        "label": base64.b64encode(label.tobytes()).decode(),
        "time": base64.b64encode(time.astype("<u2").tobytes()).decode(),
    }


def _hex(color: tuple[float, float, float]) -> str:
    return "#" + "".join(f"{round(255 * part):02x}" for part in color)
