"""The kinds of motion of the attractors versus a, at the values of the grid and those inserted where they change."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from burridge_knopoff.attractors.lookup import branch_names
from burridge_knopoff.figures.palette import KINDS
from burridge_knopoff.figures.strips import STRIP, cells, show_all
from burridge_knopoff.figures.style import label_panels, legend_below, page_width, say, styled
from burridge_knopoff.motion.kind import MotionKind

TITLE = "Kinds of motion of the attractors"
CATEGORY = "Attractors"
INPUTS = ("refined",)
CAPTION = """\
The attractors at all values of a: those of the grid, and those inserted where the attractors of neighbouring values
differ, down to the resolution of the study. Top: ⟨J⟩, in the colour of the kind of motion. Bottom: the kind of motion
along each branch that extends over at least a fiftieth of the range of a.
"""

# Branches that extend over less than this fraction of the range of a have no row.
SHORTEST = 0.02


@styled
def draw(refined: xarray.Dataset) -> Figure:
    """Draw, for each law, ⟨J⟩ of all attractors and a bar with the kinds of motion for each long branch."""
    laws = refined["law"].values
    long = long_branches(refined)
    names = {number: name for number, name in branch_names(refined).items() if number in long}
    strip = 0.16 * len(names) + 0.2
    figure = Figure(figsize=(page_width(len(laws)), 3.0 + strip), layout="constrained")
    panels = figure.subplots(2, len(laws), sharex=True, sharey="row", squeeze=False, height_ratios=[2.4, strip])
    for column, law in enumerate(laws):
        part = refined.sel(law=law)
        _points(panels[0, column], part)
        _bars(panels[1, column], part, list(names))
        panels[1, column].set_xlabel("$a$")
        panels[1, column].set_yticks(np.arange(len(names)), list(names.values()), fontsize=6.5)
        panels[1, column].tick_params(axis="y", length=0)
    a = refined["a"].values
    show_all(panels[0, 0], np.unique(a[np.isfinite(a)]))
    panels[1, 0].set_ylim(max(1, len(names)) - 0.4, -0.6)
    panels[0, 0].set_ylabel(r"$\langle J\rangle$")
    kinds = np.unique(refined["kind"].values[refined["branch"].values >= 0]).tolist()
    handles = [Patch(facecolor=KINDS[kind], edgecolor="0.4", label=MotionKind(kind).words) for kind in kinds]
    if handles:
        legend_below(figure, handles)
    label_panels(panels.flat, [*(f"{law} law" for law in laws), *(f"{law} law: kinds of motion" for law in laws)])
    return figure


def long_branches(refined: xarray.Dataset) -> set[int]:
    """Return the branches that extend over at least SHORTEST of the range of a under some law."""
    branch, a = refined["branch"].values, np.broadcast_to(refined["a"].values[..., None], refined["branch"].shape)
    least = SHORTEST * (np.nanmax(a) - np.nanmin(a))
    extents = [
        (number, np.ptp(a[k][numbers == number])) for k, numbers in enumerate(branch) for number in np.unique(numbers)
    ]
    return {int(number) for number, extent in extents if number >= 0 and extent >= least}


def _points(panel: Axes, refined: xarray.Dataset) -> None:
    there = refined["branch"].values >= 0
    a = np.broadcast_to(refined["a"].values[:, None], there.shape)[there]
    mean, kind = refined["mean_distance"].values[there], refined["kind"].values[there]
    if not len(a):
        say(panel, "no attractor")
    for number, color in KINDS.items():
        chosen = kind == number
        # Transient chaos is rare: two or three points of a study.
        size = 5.0 if number == MotionKind.TRANSIENT_CHAOS else 2.6
        look: Any = {"markersize": size, "markeredgecolor": "0.3", "markeredgewidth": 0.3}
        panel.plot(a[chosen], mean[chosen], "o", color=color, **look)


def _bars(panel: Axes, refined: xarray.Dataset, numbers: list[int]) -> None:
    """Draw each value of a as a bar, halfway to the next on the branch; where the branch ends, to the next of all.

    Between values of the grid, only branches that change are searched for: the others continue. No bar is wider than a
    strip, so that those of a coarse grid do not meet.
    """
    # Other laws may have more values.
    refined = refined.isel(value=refined["a"].notnull().values)
    every, edges = refined["a"].values, cells(refined["a"].values)
    grid, half = every[refined["in_grid"].values == 1], 0.5 * STRIP * (edges[-1] - edges[0])
    for row, number in enumerate(numbers):
        slots = refined["branch"].values == number
        (indices,) = np.nonzero(slots.any(axis=1))
        a, kind = every[indices], refined["kind"].values[indices, slots[indices].argmax(axis=1)]
        joined, middle = np.searchsorted(grid, a[1:]) == np.searchsorted(grid, a[:-1], "right"), 0.5 * (a[1:] + a[:-1])
        left = np.append(edges[indices[:1]], np.where(joined, middle, edges[indices[1:]]))
        right = np.append(np.where(joined, middle, edges[indices[:-1] + 1]), edges[indices[-1:] + 1])
        left, right = np.maximum(left, a - half), np.minimum(right, a + half)
        colors = [KINDS[int(item)] for item in kind]
        panel.barh(
            np.full(len(a), row),
            right - left,
            0.8,
            left,
            color=colors,
            # The shortest branches would be thinner than a hairline.
            edgecolor=colors,
            linewidth=0.4,
        )
