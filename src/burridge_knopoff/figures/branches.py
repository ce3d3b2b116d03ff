"""The colours and names of attractor branches, the same in every figure."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass
from itertools import cycle

import numpy as np
import xarray

from burridge_knopoff.attractors.lookup import branch_names, side_name
from burridge_knopoff.figures.palette import BRANCHES, OTHER_BRANCHES, OTHER_SHADES, UNDETERMINED, pale
from burridge_knopoff.model.sampling import fraction_interval

OTHERS = "other branches"


def branch_colors(attractors: xarray.Dataset) -> dict[int, str]:
    """Return the colour of each branch: its own for branches that hold many states somewhere, otherwise grey.

    Branches are ranked by the largest basin fraction that they have at any a, under any law. The branch number decides
    the colour, so that files of one model agree. If two branches would have the same colour, the lower number keeps it
    and the other branch takes the next free colour.
    """
    branch, count, samples = (attractors[name].values for name in ("branch", "basin_count", "sample_count"))
    share = count / np.maximum(samples, 1)[..., None]
    # Without sampled states, or for equal fractions, the branch found at more values of a comes first.
    present = {int(n): branch == n for n in np.unique(branch) if n >= 0}
    sizes = {
        n: (float(np.where(where, share, 0.0).sum(axis=-1).max()), int(where.any(axis=-1).sum()))
        for n, where in present.items()
    }
    return ranked_colors(sorted(sizes, key=lambda n: (-sizes[n][0], -sizes[n][1], n)))


def ranked_colors(branches: Iterable[int]) -> dict[int, str]:
    """Return the colour of each branch by its number; grey for the last ones, if there are more than colours."""
    ranked = [*branches]
    colors = {0: BRANCHES[0]} if 0 in ranked else {}
    ranked = [number for number in ranked if number > 0]
    most = len(BRANCHES) - 1
    free = dict.fromkeys(range(most))
    for number in sorted(ranked[:most]):
        place = min(free, key=lambda k: (k - number + 1) % most)
        del free[place]
        colors[number] = BRANCHES[1 + place]
    return colors | dict.fromkeys(ranked[most:], OTHER_BRANCHES)


def map_colors(colors: Mapping[int, str], branches: Collection[int]) -> dict[int, str]:
    """Return the colours of the branches in maps; branches that share a colour have different shades of it."""
    shades = cycle(OTHER_SHADES)
    return {n: next(shades) if colors[n] == OTHER_BRANCHES else colors[n] for n in sorted(branches) if n >= 0}


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
    """The states of a map that reach one side of a branch; branch −1 is undetermined.

    members : which pixels, of the shape of the map
    """

    branch: int
    side: int
    name: str
    color: str
    members: np.ndarray


def map_parts(basin_map: xarray.Dataset, colors: Mapping[int, str], names: Mapping[int, str]) -> list[MapPart]:
    """Return the parts of one map of basins: branches in order, the side + before −, undetermined last.

    colors, names : of the branches, as of `map_colors` and `branch_names`
    """
    branch, side = basin_map["branch"].values.astype(int), basin_map["side"].values.astype(int)
    present = set(zip(branch.ravel().tolist(), side.ravel().tolist(), strict=True))
    return [
        MapPart(
            b,
            s,
            "undetermined" if b < 0 else side_name(names[b], s),
            UNDETERMINED if b < 0 else colors[b] if s >= 0 else pale(colors[b]),
            (branch == b) & (side == s),
        )
        for b, s in sorted(present, key=lambda pair: (pair[0] < 0, pair[0], -pair[1]))
    ]
