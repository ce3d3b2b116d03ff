"""The colours and names of attractor branches, the same in every figure."""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Mapping
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
import xarray

from burridge_knopoff.attractors.lookup import branch_names, side_name
from burridge_knopoff.figures.palette import BRANCHES, OTHER_BRANCHES, UNDETERMINED, light
from burridge_knopoff.figures.style import MOST_ENTRIES
from burridge_knopoff.model.sampling import fraction_interval

OTHERS = "other branches"

Part = TypeVar("Part", bound=Hashable)


def largest_parts(fill: Mapping[Part, float], most: int) -> list[Part]:
    """Return the parts of a picture with an entry of their own in a legend of at most `most` entries, largest first.

    fill : how much of the picture each part fills; if there are more parts than entries, those that fill the least
        share the last entry
    """
    ranked = sorted(fill, key=lambda part: -fill[part])
    return ranked if len(ranked) <= most else ranked[: most - 1]


def branch_colors(attractors: xarray.Dataset) -> dict[int, str]:
    """Return the colour of each branch: its own for those that fill the figures, grey for the others.

    A branch fills as much as its basin fractions at all a, under all laws, together.
    """
    branch, count, samples = (attractors[name].values for name in ("branch", "basin_count", "sample_count"))
    share = count / np.maximum(samples, 1)[..., None]
    # Without sampled states, or for equal fractions, the branch found at more values of a comes first.
    return ranked_colors({int(n): (share + 1e-9)[branch == n].sum().item() for n in np.unique(branch) if n >= 0})


def ranked_colors(fill: Mapping[int, float], most: int = MOST_ENTRIES) -> dict[int, str]:
    """Return the colour of each branch by its number, from how much of the picture it fills.

    The branch number decides the colour, so that files of one model agree. If two branches would have the same colour,
    the lower number keeps it and the other branch takes the next free colour.
    """
    colors, count = {}, len(BRANCHES) - 1
    free = dict.fromkeys(range(count))
    for number in sorted(largest_parts(fill, most)):
        if number == 0:
            colors[0] = BRANCHES[0]
            continue
        place = min(free, key=lambda k: (k - number + 1) % count)
        del free[place]
        colors[number] = BRANCHES[1 + place]
    return colors | {number: OTHER_BRANCHES for number in fill if number not in colors}


def named_colors(colors: Mapping[int, str], names: Mapping[int, str]) -> dict[str, str]:
    """Return the colours of branches by name, for a legend; the shared colour comes last."""
    hues = {names[branch]: color for branch, color in sorted(colors.items()) if color != OTHER_BRANCHES}
    return hues | ({OTHERS: OTHER_BRANCHES} if len(hues) < len(colors) else {})


def fraction_curves(attractors: xarray.Dataset, colors: Mapping[int, str]) -> Iterator[tuple[str, str, np.ndarray]]:
    """Yield name, colour and basin fraction of each branch of one law; branches that share a colour come last, as one.

    The fraction comes with the ends of its 95 % Wilson interval, shape (a, 3); NaN where the attractor does not exist.
    Both mirror images of a branch are counted together.

    colors : of all branches, from `branch_colors`
    """
    names, samples = branch_names(attractors), attractors["sample_count"].values.tolist()
    branch, count = attractors["branch"].values, attractors["basin_count"].values
    curves = [([number], names[number], color) for number, color in sorted(colors.items()) if color != OTHER_BRANCHES]
    other_branches = [number for number, color in colors.items() if color == OTHER_BRANCHES]
    for numbers, name, color in (*curves, (other_branches, OTHERS, OTHER_BRANCHES)):
        members = np.isin(branch, numbers)
        there = members.any(axis=1)
        if there.any():
            hits = np.where(members, count, 0).sum(axis=1)
            interval = np.array([fraction_interval(*pair) for pair in zip(hits.tolist(), samples, strict=True)])
            interval[~there] = np.nan
            yield name, color, interval


def undetermined_share(attractors: xarray.Dataset) -> np.ndarray:
    """Return the fraction of sampled states whose attractor is undetermined, shape (a,); NaN without samples."""
    with np.errstate(invalid="ignore"):
        share = attractors["undetermined_count"].values / attractors["sample_count"].values
    return np.where(share > 0.0, share, np.nan)


@dataclass(frozen=True)
class MapPart:
    """The states of maps of basins that have one colour: they reach one side of a branch, say.

    members : which pixels, of the shape of the maps
    """

    name: str
    color: str
    members: np.ndarray


def map_parts(basins: xarray.Dataset) -> list[MapPart]:
    """Return the parts of maps of basins: branches in order, the side + before −, other branches, undetermined."""
    names = branch_names(basins.isel(map=0))
    branch, side = basins["branch"].values.astype(int), basins["side"].values.astype(int)
    undetermined = branch < 0
    pairs, pixels = np.unique(np.stack([branch, side])[:, ~undetermined], axis=1, return_counts=True)
    fill = dict(zip(map(tuple, pairs.T.tolist()), pixels.tolist(), strict=True))
    shown = sorted(largest_parts(fill, MOST_ENTRIES - int(undetermined.any())), key=lambda pair: (pair[0], -pair[1]))
    colors = ranked_colors({number: 1.0 for number, _ in shown})
    parts = [
        MapPart(side_name(names[b], s), colors[b] if s >= 0 else light(colors[b]), (branch == b) & (side == s))
        for b, s in shown
    ]
    others = ~np.any([undetermined, *(part.members for part in parts)], axis=0)
    last = (MapPart(OTHERS, OTHER_BRANCHES, others), MapPart("undetermined", UNDETERMINED, undetermined))
    return [*parts, *(part for part in last if part.members.any())]
