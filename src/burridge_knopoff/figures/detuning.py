"""The amplitudes of end blocks of unequal mass, compared with the normal modes."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from burridge_knopoff.figures.palette import BRANCHES, MARKERS
from burridge_knopoff.figures.strips import show_all
from burridge_knopoff.figures.style import label_panels, legend_below, legend_entries, panel_table, say, styled
from burridge_knopoff.summaries.one_frequency import has_one_frequency

TITLE = "End blocks of unequal mass"
CATEGORY = "Attractors"
INPUTS = ("rotation",)
CONDITION = "has_end_blocks"
CAPTION = """\
Are the end blocks locked to each other without synchrony? With a mass of the last block larger by the detuning d, its
amplitude over that of block 1 in their common oscillation, on branches 1 and 2, where both have one frequency. Lines:
the same ratio in the normal mode of the sliding chain that has most of the energy. In a normal mode the ratio follows
the masses; for oscillators of equal amplitude that are locked to each other it is 1.
"""


@styled
def draw(rotation: xarray.Dataset) -> Figure:
    """Draw the amplitude ratio after detuning versus a for each law, in the colours of the branches."""
    laws = [str(law) for law in rotation["law"].values]
    ratio = f"amplitude of block {rotation.sizes['block']} over that of block 1"
    figure, (panels,) = panel_table(2.4, len(laws), "$a$", [ratio])
    grid = np.unique(rotation["a"].values[rotation["in_grid"].values == 1])
    for panel, law in zip(panels, laws, strict=True):
        _ratios(panel, rotation.sel(law=law))
        show_all(panel, grid)
        # Room for the label of the lowest line.
        panel.margins(y=0.1)
    label_panels(panels, [f"{law} law" for law in laws])
    handles, _ = legend_entries(panels)
    if handles:
        legend_below(figure, handles)
    return figure


def _ratios(panel: Axes, rotation: xarray.Dataset) -> None:
    """Draw the ratios where both end blocks have one frequency, and those of the modes."""
    for detuning in rotation["detuning"].values:
        detuned = rotation.sel(detuning=detuning)
        together = has_one_frequency(detuned["detuned_frequency"].values)
        if not together.any():
            continue
        leading_mode = detuned["detuned_mode_share"].values[together].mean(axis=0).argmax()
        of_mode = abs(detuned["mode_end_ratio"].values[leading_mode])
        panel.axhline(of_mode, color="0.4", linewidth=0.6, zorder=0, label="normal mode")
        panel.annotate(
            f"$d$ = {detuning:g}", (1.0, of_mode), xycoords=("axes fraction", "data"), xytext=(-3, -2), ha="right",
            va="top", textcoords="offset points", fontsize=8.0,
        )  # fmt: skip
        for place, branch in enumerate(detuned["branch"].values.tolist()):
            drawn = together[:, place]
            if drawn.any():
                look: Any = {"color": BRANCHES[branch % len(BRANCHES)], "markerfacecolor": "none", "markersize": 3.0}
                panel.plot(
                    detuned["a"].values[drawn], detuned["detuned_end_ratio"].values[drawn, place],
                    MARKERS[branch % len(MARKERS)], label=f"branch {branch}", **look,
                )  # fmt: skip
    if not panel.lines:
        say(panel, "no branch without synchrony was found")
