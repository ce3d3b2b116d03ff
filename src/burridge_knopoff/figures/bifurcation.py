"""Bifurcation diagrams: section points W' against a, the paper's Figs. 4a and 4b."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

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
from burridge_knopoff.summaries.bifurcation import ROUNDING, section_points

TITLE = "Bifurcation diagrams"
CATEGORY = "Synchronization"
PAPER = "Figs. 4a, 4b"
INPUTS = ("bifurcation",)
CAPTION = """\
Section points W' at W = 0 against a, for each law and initial state; upward crossings above 0, downward crossings
below. W is the sum of the positions relative to uniform sliding. Crossings slower than 10⁻⁹ are not shown: they are
uniform sliding itself, by rounding.
"""

# Values of a beyond which points are so small that a cloud of many can be told apart; those of few are to be seen.
FEW = 30

_DIRECTIONS = (1, -1)
_LABELS = dict(zip(DIRECTION["flag_values"].tolist(), DIRECTION["flag_meanings"].split(), strict=True))


@styled
def draw(bifurcation: xarray.Dataset) -> Figure:
    """Draw W' at W = 0 against a: a row of panels for each law, a column for each initial state."""
    laws, initial = (bifurcation[name].attrs["flag_meanings"].split() for name in ("law", "initial"))
    figure, table = panel_table(2.6, len(initial), "$a$", ["$W$′ at $W=0$" for _ in laws])
    panels = list(table.flat)
    grid = np.unique(bifurcation["a"])
    titles = []
    for number, panel in enumerate(panels):
        law, state = laws[number // len(initial)], initial[number % len(initial)]
        for index, direction in enumerate(_DIRECTIONS):
            a, velocity = section_points(bifurcation, law, state, direction)
            real = np.abs(velocity) > ROUNDING
            # A cloud of 10^5 points is a picture, not 10^5 shapes: kept as pixels inside the PDF.
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
        if not any(line.get_xdata().size for line in panel.get_lines()):
            say(panel, "no crossings")
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
