"""The bifurcation diagrams: section points W' versus a, as in the paper's Figs. 4a and 4b."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from burridge_knopoff.attractors.lookup import CROSSINGS
from burridge_knopoff.figures.strips import show_all
from burridge_knopoff.figures.style import label_panels, panel_table, say, styled
from burridge_knopoff.summaries.bifurcation_diagram import (
    NEVER_UPWARD,
    NONE_COMPLETED,
    ROUNDING,
    STAYS,
    has_completed,
    section_points,
)

TITLE = "Bifurcation diagrams"
CATEGORY = "Synchronization"
PAPER = "Figs. 4a, 4b"
INPUTS = ("bifurcation_diagram",)
CAPTION = """\
Section points W' on the section W = 0 versus a, for each law and initial state: upward crossings have W' > 0, downward
crossings W' < 0. W is the sum of the positions relative to uniform sliding, or the position of one block if the config
sets `section`. Dotted: W' = −Nv, with W of all N blocks, where all of them stick at the crossing. Points are larger
where a run has only a few. Crossings slower than 10⁻⁹ are rounding errors of uniform
sliding and are left out, as are all crossings of runs that did not complete. At a = 0 the paper's laws are constant:
free oscillations neither grow nor decay, and their several frequencies give a band.
"""

# With more values of a than this, the points of a cloud are drawn small, to resolve it; with fewer, large.
FEW = 30
# Section points of different runs are equal, at the foot, if they differ by less.
EQUAL = 1e-9
# A run with at most so many different section points has no cloud, and its points are drawn large.
DISTINCT = 24
SMALL, LARGE = 1.8, 3.2


@styled
def draw(bifurcation: xarray.Dataset) -> Figure:
    """Draw W' at W = 0 versus a: a row of panels for each law, a column for each initial state."""
    laws, initial = (list(dict.fromkeys(bifurcation[name].values.tolist())) for name in ("law", "initial"))
    figure, table = panel_table(2.6, len(initial), "$a$", ["$W$′ at $W=0$" for _ in laws])
    panels = list(table.flat)
    grid = np.unique(bifurcation["a"])
    titles = []
    for number, panel in enumerate(panels):
        law, state = laws[number // len(initial)], initial[number % len(initial)]
        upward, downward = (section_points(bifurcation, law, state, direction) for direction in (1, -1))
        last_upward, last_downward = last_points(*upward), last_points(*downward)
        for a, velocity in (last_upward, last_downward):
            real = np.abs(velocity) > ROUNDING
            a, velocity = a[real], velocity[real]
            is_cloud = np.isin(a, dense_values(a, velocity)) if len(grid) > FEW else np.zeros(len(a), dtype=bool)
            for chosen, size in ((is_cloud, SMALL), (~is_cloud, LARGE)):
                # A cloud of 10^5 points is stored as an image in the PDF, not as 10^5 shapes.
                look: Any = {"markersize": size, "markeredgewidth": 0, "color": "black", "rasterized": True}
                panel.plot(a[chosen], velocity[chosen], ".", **look)
        show_all(panel, grid)
        panel.axhline(0.0, color="0.6", linewidth=0.5, zorder=0)
        if not (np.abs(last_upward[1]) > ROUNDING).any():
            # In uniform sliding, only rounding crosses the section.
            empty = STAYS if upward[0].size else NEVER_UPWARD
            say(panel, empty if has_completed(bifurcation, law, state).any() else NONE_COMPLETED)
        _mark_foot(panel, *last_downward, str(bifurcation.attrs.get("section", "sum")))
        titles.append(f"{state}, {law} law")
    label_panels(panels, titles)
    return figure


def _mark_foot(panel: Axes, a: np.ndarray, velocity: np.ndarray, section: str) -> None:
    """Say that blocks stick at the lowest W', if runs at several values of a share it: none is slower than at rest.

    section : "sum", or "block=" and the number of a block
    """
    foot = velocity.min(initial=0.0)
    if len(np.unique(a[velocity <= foot + EQUAL])) < 2:
        return
    panel.axhline(foot, color="0.4", linestyle=":", linewidth=0.8, zorder=0)
    words = r"all blocks stick: $W$′$\,=-Nv$" if section == "sum" else r"the block sticks: $W$′$\,=-v$"
    look: Any = {"xycoords": ("axes fraction", "data"), "textcoords": "offset points", "va": "top", "fontsize": 7.5}
    panel.annotate(words, (0.02, foot), (0, -2), **look)
    low, high = panel.get_ylim()
    panel.set_ylim(bottom=min(low, foot - 0.08 * (high - foot)))


def dense_values(a: np.ndarray, velocity: np.ndarray) -> np.ndarray:
    """Return the values of a at which more than DISTINCT section points differ by a thousandth of their range."""
    if not len(a):
        return a
    steps = np.round(1000.0 * velocity / max(np.ptp(velocity), ROUNDING))
    values, counts = np.unique(np.unique(np.column_stack([a, steps]), axis=0)[:, 0], return_counts=True)
    return values[counts > DISTINCT]


def last_points(a: np.ndarray, velocity: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the last section points of each run, about as many as an attractor has, so that columns look alike.

    a : ascending
    """
    behind = np.searchsorted(a, a, "right") - np.arange(len(a))
    chosen = behind <= CROSSINGS // 2
    return a[chosen], velocity[chosen]
