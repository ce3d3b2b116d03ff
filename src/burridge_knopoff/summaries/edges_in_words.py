"""The edge states of a study in words."""

from __future__ import annotations

from collections import Counter
from functools import partial

import numpy as np
import xarray

from burridge_knopoff.motion.kind import MotionKind
from burridge_knopoff.periodic_orbits.symmetry import Symmetry
from burridge_knopoff.study.formatting import format_count


def edges_in_words(dataset: xarray.Dataset) -> str:
    """Return the edge states in words: those of each law counted, then a line for each.

    A line tells the branches that an edge state separates, its motion, and whether the boundary is crossed.
    """
    laws = [_law_text(law, dataset.isel(edge=dataset["law"].values == law)) for law in dataset.attrs["laws"].split()]
    return "".join(f"{line}.\n" for line in (*laws, *map(partial(_edge_text, dataset), range(dataset.sizes["edge"]))))


def _law_text(law: str, dataset: xarray.Dataset) -> str:
    """Return the number of edge states under one law by their kinds, and the values of a with a fractal boundary.

    The depth of the search is that of the edge state with the fewest displaced states.
    """
    if not dataset.sizes["edge"]:
        return f"{law}: no edge state was found"
    a, kinds = dataset["a"].values, Counter(dataset["kind"].values.tolist())
    counted = ", ".join(f"{count} {MotionKind(kind).words}" for kind, count in sorted(kinds.items()))
    crosses = dataset["has_crossing"].values == 1
    parts = []
    if crosses.any():
        parts.append(f"fractal boundary at a = {', '.join(f'{value:g}' for value in np.unique(a[crosses]))}")
    if not crosses.all():
        seen, missed = (dataset[name].values[~crosses] for name in ("reached_count", "crossing_high"))
        parts.append(
            f"{'otherwise ' if parts else ''}undecided at this depth: no crossing that leads back is seen with at "
            f"least {_displaced(seen).min()} displaced states, of which up to {100.0 * missed.max():.2g} % may cross"
        )
    states, values = format_count(len(a), "edge state"), format_count(len(np.unique(a)), "value")
    return f"{law}: {states} at {values} of a: {counted}; {'; '.join(parts)}"


def _edge_text(dataset: xarray.Dataset, number: int) -> str:
    edge = {name: item.values[number] for name, item in dataset.variables.items() if item.dims[:1] == ("edge",)}
    branches = " and ".join(_branch_label(*pair) for pair in zip(edge["branch"], edge["side"], strict=True))
    motion = f"{Symmetry(edge['symmetry']).name.lower()}, {MotionKind(edge['kind']).words}"
    if np.isfinite(edge["period"]):
        stops = " ".join(map(str, edge["stops"]))
        motion += f", period {edge['period']:.6g}, stops {stops}, multiplier {edge['multiplier']:.4g}"
    count, crossing = _displaced(edge["reached_count"]), edge["crossing_count"].sum()
    low, high = (f"{100.0 * edge[f'crossing_{end}']:.2g}" for end in ("low", "high"))
    share = f"{crossing} of {count} displaced states (95 %: {low} to {high} %)"
    if edge["has_crossing"]:
        boundary = f"fractal boundary, crossed by {share}: of far fewer than {count // crossing} none may cross"
    elif crossing:
        boundary = f"another part of the boundary is crossed by {share}"
    else:
        boundary = f"undecided whether fractal: crossed by {share}"
    return (
        f"{edge['law']}, a = {edge['a']:g}, between branches {branches}: {motion}; lifetime {edge['lifetime']:.4g}; "
        f"{boundary}"
    )


def _displaced(reached_count: np.ndarray) -> np.ndarray:
    """Return the number of displaced states that reach an attractor, from those for each side and attractor."""
    return np.maximum(reached_count, 0).sum(axis=(-2, -1))


def _branch_label(branch: int, side: int) -> str:
    return f"{branch}{'+' if side > 0 else '-' if side < 0 else ''}"
