"""The bifurcation diagrams: section points W' versus a, as in the paper's Figs. 4a and 4b."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from burridge_knopoff.attractors.lookup import CROSSINGS
from burridge_knopoff.dataset.variables import DIRECTION
from burridge_knopoff.figures.style import (
    color,
    label_panels,
    legend_below,
    legend_entries,
    panel_table,
    say,
    show_all,
    styled,
)
from burridge_knopoff.summaries.bifurcation_diagram import NEVER_UPWARD, ROUNDING, STAYS, section_points

TITLE = "Bifurcation diagrams"
CATEGORY = "Synchronization"
PAPER = "Figs. 4a, 4b"
INPUTS = ("bifurcation_diagram",)
CAPTION = """\
Section points W' on the section W = 0 versus a, for each law and initial state; upward crossings above 0, downward
crossings below. W is the sum of the positions relative to uniform sliding, or the position of one block if the config's
`section` says so (see `bifurcation_diagram.nc`). Crossings slower than 10⁻⁹ are left out: they are uniform sliding with
rounding errors.
"""

# With more values of a than this, points are drawn small, to resolve dense clouds; with fewer, large, to be visible.
FEW = 30

_DIRECTIONS = (1, -1)
_LABELS = dict(zip(DIRECTION["flag_values"].tolist(), DIRECTION["flag_meanings"].split(), strict=True))


@styled
def draw(
    bifurcation: xarray.Dataset, attractors: xarray.Dataset | None = None, refined: xarray.Dataset | None = None
) -> Figure:
    """Draw W' at W = 0 versus a: a row of panels for each law, a column for each initial state.

    attractors, refined : the branch that each initial state reaches, and the sections of all attractors between the
        values of the grid
    """
    laws, initial = (list(dict.fromkeys(bifurcation[name].values.tolist())) for name in ("law", "initial"))
    figure, table = panel_table(2.6, len(initial), "$a$", ["$W$′ at $W=0$" for _ in laws])
    panels = list(table.flat)
    grid = np.unique(bifurcation["a"])
    titles = []
    for number, panel in enumerate(panels):
        law, state = laws[number // len(initial)], initial[number % len(initial)]
        between = np.zeros((2, 0))
        if attractors is not None and refined is not None:
            between = _between(attractors.sel(law=law, initial=state), refined.sel(law=law))
        for index, direction in enumerate(_DIRECTIONS):
            own = section_points(bifurcation, law, state, direction)
            a, velocity = np.hstack([_last(*own), between[:, direction * between[1] > 0.0]])
            real = np.abs(velocity) > ROUNDING
            # A cloud of 10^5 points is stored as an image in the PDF, not as 10^5 shapes.
            panel.plot(
                a[real],
                velocity[real],
                ".",
                markersize=1.2 if len(grid) > FEW else 3.6,
                markeredgewidth=0,
                color=color(index),
                rasterized=True,
                label=_LABELS[direction],
            )
        show_all(panel, grid)
        if not panel.get_lines()[0].get_xdata().size:
            # In uniform sliding, only rounding crosses the section.
            slow = section_points(bifurcation, law, state, _DIRECTIONS[0])[0].size
            say(panel, STAYS if slow else NEVER_UPWARD)
        titles.append(f"{state}, {law} law")
    _, shown = legend_entries(panels)
    look: Any = {"linestyle": "none", "marker": "o", "markersize": 4}
    legend_below(
        figure,
        [
            Line2D([], [], color=color(index), label=f"{_LABELS[direction]} crossings", **look)
            for index, direction in enumerate(_DIRECTIONS)
            if _LABELS[direction] in shown
        ],
    )
    label_panels(panels, titles)
    return figure


def _last(a: np.ndarray, velocity: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the last section points of each run, about as many as an attractor has, so that columns look alike.

    a : ascending
    """
    behind = np.searchsorted(a, a, "right") - np.arange(len(a))
    chosen = behind <= CROSSINGS // 2
    return a[chosen], velocity[chosen]


def _between(attractors: xarray.Dataset, refined: xarray.Dataset) -> np.ndarray:
    """Return a and W' of the section points between the values of the grid, shape (2, points).

    attractors : for one law and initial state; refined : for the same law
    """
    about = attractors.attrs
    reached = attractors["initial_branch"].sel(contact=about["contact"], start=about["start"])
    grid, branches = attractors["a"].values, refined["branch"].values
    found = [np.zeros((2, 0))]
    for place in np.flatnonzero(refined["in_grid"].values == 0):
        a = refined["a"].values[place]
        after = int(np.searchsorted(grid, a))
        if not 0 < after < len(grid):
            continue
        ends = sorted((after - 1, after), key=lambda k: abs(grid[k] - a))
        for branch in reached.values[ends]:
            (slots,) = np.nonzero((branches[place] == branch) & (branch >= 0))
            if len(slots):
                velocity = refined["section_velocity"].values[place, slots[0]]
                velocity = velocity[np.isfinite(velocity)]
                found.append(np.array([np.full(len(velocity), a), velocity]))
                break
    return np.hstack(found)
