"""Velocities and positions of the blocks at the end of a run: the paper's Figs. 6 and 7."""

from __future__ import annotations

from collections.abc import Mapping

import xarray
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from burridge_knopoff.figures.style import PAGE, label_panels, new_figure, styled

TITLE = "Motion from {initial}"
CATEGORY = "Runs"
PAPER = "Figs. 6, 7"
FILE = "motion_{initial}"
INPUTS = ("runs",)
CAPTION = """\
Velocities U_i' and positions U_i − vτ of all blocks against time τ at the end of the run from the state {initial}.
"""

# Later blocks lie above earlier ones and are thinner or broken, so that blocks in synchrony are all seen.
DASHES = ("-", (0, (5, 2)), (0, (1.2, 2.2)), "-.")
WIDTHS = (2.2, 1.1, 1.4, 1.0)
# A legend of more blocks than these would take the room of the curves.
MOST_NAMED = 12

# Their number has no divisor in common with that of the dashes: all pairs come up before one comes again.
SHADES = ("#7FB2DA", "#D55E00", "#000000", "#009E73", "#CC79A7", "#E69F00", "#0072B2")


@styled
def draw(runs: Mapping[str, xarray.Dataset]) -> Figure:
    """Draw U_i'(τ) and U_i(τ) − vτ of every block over the kept last part of the one run."""
    (point,) = runs.values()
    figure, panels = new_figure(PAGE, 4.0, rows=2)
    for panel, name in zip(panels, ("velocity", "position"), strict=True):
        draw_blocks(panel, point, name)
    panels[0].set_ylabel("$U_i$′")
    panels[1].set(ylabel=r"$U_i-v\tau$", xlabel=r"$\tau$")
    blocks = len(point["block"])
    if blocks <= 3:
        panels[0].legend(ncols=blocks, loc="lower right", bbox_to_anchor=(1.0, 0.98), borderpad=0.1)
    elif blocks <= MOST_NAMED:
        figure.legend(*panels[0].get_legend_handles_labels(), ncols=min(blocks, 6), loc="outside lower center")
    run = f"{point.attrs['initial']}, $a={point['a'].item():g}$, {point.attrs['law']} law"
    label_panels(panels, [f"velocities: {run}", f"positions relative to the driver: {run}"])
    return figure


def draw_blocks(panel: Axes, point: xarray.Dataset, name: str) -> None:
    """Draw velocity or position of every block over the kept last part of a run into a panel."""
    time = point["trajectory_time"].values
    for index, block in enumerate(point["block"].values):
        panel.plot(
            time,
            point[name].sel(block=block),
            linestyle=DASHES[index % len(DASHES)],
            linewidth=WIDTHS[index % len(WIDTHS)],
            color=SHADES[index % len(SHADES)],
            label=f"block {block}",
        )
