"""The bifurcation diagrams: section points W' versus a, as in the paper's Figs. 4a and 4b."""

from __future__ import annotations

import numpy as np
import xarray
from matplotlib.figure import Figure

from burridge_knopoff.attractors.lookup import CROSSINGS
from burridge_knopoff.figures.style import label_panels, panel_table, say, show_all, styled
from burridge_knopoff.summaries.bifurcation_diagram import NEVER_UPWARD, ROUNDING, STAYS, section_points

TITLE = "Bifurcation diagrams"
CATEGORY = "Synchronization"
PAPER = "Figs. 4a, 4b"
INPUTS = ("bifurcation_diagram",)
CAPTION = """\
Section points W' on the section W = 0 versus a, for each law and initial state: upward crossings have W' > 0, downward
crossings W' < 0. W is the sum of the positions relative to uniform sliding, or the position of one block if the config
sets `section`. Crossings slower than 10⁻⁹ are rounding errors of uniform sliding and are left out. At a = 0 the paper's
laws are constant: free oscillations neither grow nor decay, and their several frequencies give a band.
"""

# With more values of a than this, points are drawn small, to resolve dense clouds; with fewer, large, to be visible.
FEW = 30


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
        for a, velocity in (last_points(*upward), last_points(*downward)):
            real = np.abs(velocity) > ROUNDING
            # A cloud of 10^5 points is stored as an image in the PDF, not as 10^5 shapes.
            panel.plot(
                a[real],
                velocity[real],
                ".",
                markersize=1.2 if len(grid) > FEW else 3.6,
                markeredgewidth=0,
                color="black",
                rasterized=True,
            )
        show_all(panel, grid)
        panel.axhline(0.0, color="0.6", linewidth=0.5, zorder=0)
        if not panel.get_lines()[0].get_xdata().size:
            # In uniform sliding, only rounding crosses the section.
            say(panel, STAYS if upward[0].size else NEVER_UPWARD)
        titles.append(f"{state}, {law} law")
    label_panels(panels, titles)
    return figure


def last_points(a: np.ndarray, velocity: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the last section points of each run, about as many as an attractor has, so that columns look alike.

    a : ascending
    """
    behind = np.searchsorted(a, a, "right") - np.arange(len(a))
    chosen = behind <= CROSSINGS // 2
    return a[chosen], velocity[chosen]
