"""The synchronization of mirror blocks in longer chains."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from burridge_knopoff.figures.palette import dashes, law_color
from burridge_knopoff.figures.style import PAGE, label_panels, legend_below, legend_entries, styled
from burridge_knopoff.motion.chain_synchronization import STANDARD_ERRORS

TITLE = "Longer chains"
CATEGORY = "Longer chains"
INPUTS = ("chains",)
CAPTION = """\
The fraction of random initial states, sampled independently at each a, that lead to synchrony of all mirror blocks,
versus a for each number of blocks N, with 95 % Wilson intervals. Open circles count undetermined states as
synchronized. Squares at the top mark values of a at which synchrony is stable.
"""

COLUMNS = 3
ROW_HEIGHT = 1.45

# Points of different laws at the same a are drawn apart by this fraction of a step.
SHIFT = 0.15


@styled
def draw(chains: xarray.Dataset) -> Figure:
    """Draw the synchronized fraction against a, a panel for each number of blocks.

    Bars are confidence intervals that count undetermined states either way; open circles count all of these as
    synchronized. Squares at the top: some symmetric motion has a transverse exponent that is negative beyond its error,
    so that synchrony is stable.
    """
    blocks = chains["blocks"].values
    rows = math.ceil(len(blocks) / COLUMNS)
    figure = Figure(figsize=(PAGE, rows * ROW_HEIGHT + 0.6), layout="constrained")
    grid = figure.subplots(rows, COLUMNS, sharex=True, sharey=True, squeeze=False)
    panels = list(grid.flat)
    for panel in panels[len(blocks) :]:
        panel.set_axis_off()
    for panel, count in zip(panels, blocks, strict=False):
        _draw_fraction(panel, chains.sel(blocks=count))
        # The last row may be shorter than the others.
        panel.tick_params(labelbottom=True)
    for panel in panels[max(0, len(blocks) - COLUMNS) : len(blocks)]:
        panel.set_xlabel("$a$")
    for panel in grid[:, 0]:
        panel.set_ylabel("fraction of states")
    handles, labels = legend_entries(panels[: len(blocks)])
    # Points with error bars are drawn last anyway.
    order = sorted(range(len(labels)), key=lambda k: " or " in labels[k] or labels[k].startswith("stable"))
    legend_below(figure, [handles[k] for k in order])
    label_panels(panels[: len(blocks)], [f"$N={count}$" for count in blocks])
    return figure


def _draw_fraction(panel: Axes, chain: xarray.Dataset) -> None:
    a = chain["a"].values
    step = np.diff(a).min() if len(a) > 1 else 0.0
    for index, law in enumerate(chain["law"].values):
        run = chain.sel(law=law)
        fraction = run["synchronized_fraction"].values
        bars = [fraction - run["synchronized_low"].values, run["synchronized_high"].values - fraction]
        shifted = a + index * SHIFT * step
        name = f", {law}" if index or chain.sizes["law"] > 1 else ""
        look: Any = {"color": law_color(index), "markeredgewidth": 0.6}
        line: Any = {"fmt": "o", "linestyle": dashes(index), "markersize": 2.4, "linewidth": 0.8, "elinewidth": 0.6}
        panel.errorbar(shifted, fraction, np.maximum(bars, 0.0), label=f"synchronized{name}", **line, **look)
        unknown = run["undetermined_fraction"].values
        places, totals = shifted[unknown > 0.0], (fraction + unknown)[unknown > 0.0]
        either = f"synchronized or undetermined{name}"
        panel.plot(places, totals, "o", markersize=2.8, fillstyle="none", label=either, **look)
        below = run["symmetric_exponent"] + STANDARD_ERRORS * run["symmetric_error"] < 0.0
        stable = a[below.any("symmetric_state").values]
        height = np.full(len(stable), 1.1 + 0.05 * index)
        panel.plot(stable, height, "s", markersize=2.0, label=f"stable synchrony{name}", **look)
    laws = chain.sizes["law"]
    panel.axhline(1.05, color="0.6", linewidth=0.5)
    panel.set_ylim(-0.05, 1.15 + 0.05 * laws)
    panel.set_yticks([0.0, 0.5, 1.0], ["0", "0.5", "1"])
