"""The stick-slip cycles versus a: cycle times, frequencies, and the correlation of the end blocks."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from burridge_knopoff.figures.palette import block_color
from burridge_knopoff.figures.style import begin_at_zero, label_panels, legend_below, panel_table, say, styled

TITLE = "Stick-slip cycles"
CATEGORY = "Runs"
INPUTS = ("stick_slip",)
FROM_STUDY = ("shown_law", "has_paper_chain")
CAPTION = """\
Stick-slip cycles of the first, middle and last block versus a, for each initial state, under one law of the study (the
config's `figures.law`). Top: the time between two stops, with its standard error. Bottom: in chains of more than two
blocks, the frequency of the end blocks divided by that of the middle block, from the peaks of the velocity spectra
(bars: resolution of the spectra); and the correlation of the velocities of the end blocks. For the paper's chain, a
band and a dotted line show its statements: a cycle of two to three units of time, and half the frequency of the middle
block.
"""

#: The paper's statements: a stick-slip cycle lasts about two or three time units; the end blocks oscillate at about
#: half the frequency of the middle block.
PAPER_CYCLE = (2.0, 3.0)
PAPER_RATIO = 0.5

# The end blocks often coincide: the later one is drawn smaller, inside the marker of the first.
SIZES = (4.4, 2.8, 2.0)
MARKERS = ("o", "s", "o")
# Seen on the other symbols where all are 1.
CORRELATION: Any = {"color": "black", "marker": "D", "markersize": 2.6, "markerfacecolor": "white", "linestyle": ""}
CORRELATION |= {"markeredgewidth": 0.6, "zorder": 4}


@styled
def draw(stick_slip: xarray.Dataset, shown_law: str, has_paper_chain: bool) -> Figure:
    """Draw cycle times, and the frequency ratios and the correlation of the end blocks, under one law.

    A column for each initial state, with the first, middle and last block. Frequency ratios are those of the end blocks
    to the middle block, which needs three blocks; the correlation needs two. Gaps are blocks that do not stop and runs
    that did not complete. The paper's statements are shown for its chain.
    """
    states, count = stick_slip["initial"].values, stick_slip.sizes["block"]
    middle = (count + 1) // 2
    numbers = sorted({1, middle, count})
    of_ends = "frequency ratio,\ncorrelation" if count > 2 else "correlation"
    rows = {"cycle time": "time between stops"} | ({"end blocks": of_ends} if count > 1 else {})
    figure, table = panel_table(2.1, len(states), "$a$", list(rows.values()))
    for column, initial in enumerate(states):
        run = stick_slip.sel(law=shown_law, initial=initial)
        cycles, *ends = table[:, column]
        for n, block in enumerate(numbers):
            _points(cycles, n, run["cycle_time"].sel(block=block), run["cycle_time_error"].sel(block=block))
        _say_why(cycles, run, "cycle_time", "no stops")
        if has_paper_chain:
            cycles.axhspan(*PAPER_CYCLE, color="0.88", linewidth=0, zorder=0)
        for panel in ends:
            for n, block in enumerate(numbers if count > 2 else ()):
                if block != middle:
                    _ratios(panel, n, run.sel(block=block), run.sel(block=middle))
            panel.plot(run["a"], run["velocity_correlation"], **CORRELATION)
            _say_why(panel, run, "velocity_correlation", "the velocities do not change")
            panel.axhline(0.0, color="0.7", linewidth=0.6, zorder=0)
            if has_paper_chain:
                panel.axhline(PAPER_RATIO, color="0.4", linestyle=":", linewidth=0.9, zorder=0)
    begin_at_zero(table[0, 0])
    legend_below(figure, _legend(numbers, has_paper_chain))
    label_panels(table.flat, [f"{initial}: {name}" for name in rows for initial in states])
    figure.suptitle(f"{shown_law} law", fontsize="medium")
    return figure


def _look(n: int, block: int) -> dict[str, Any]:
    """Return the look of the points of the first (0), middle (1) or last block, given with its number."""
    return {
        "color": block_color(block - 1),
        "marker": MARKERS[n],
        "markersize": SIZES[n],
        "markeredgewidth": 0,
        "linestyle": "",
    }


def _points(panel: Axes, n: int, values: xarray.DataArray, errors: xarray.DataArray | None = None) -> None:
    panel.errorbar(values["a"], values, errors, elinewidth=0.6, **_look(n, values["block"].item()))


def _say_why(panel: Axes, run: xarray.Dataset, name: str, words: str) -> None:
    """State the reason in a panel that has no points of a variable."""
    if run[name].isnull().all():
        say(panel, "no run completed" if run["stick_fraction"].isnull().all() else words)


def _ratios(panel: Axes, n: int, end: xarray.Dataset, middle: xarray.Dataset) -> None:
    """Draw the ratio of the velocity frequencies of an end block and the middle block."""
    ratio = end["velocity_frequency"] / middle["velocity_frequency"].drop_vars("block")
    # Both errors are resolutions of the spectrum.
    shares = [(part["velocity_frequency_error"] / part["velocity_frequency"]).values for part in (end, middle)]
    _points(panel, n, ratio, ratio * np.hypot(shares[0], shares[1]))


def _legend(numbers: list[int], has_paper_chain: bool) -> list[Line2D | Patch]:
    blocks = [Line2D([], [], **_look(n, block), label=f"block {block}") for n, block in enumerate(numbers)]
    correlation = Line2D([], [], **CORRELATION, label=f"correlation of $U_1$′ with $U_{{{numbers[-1]}}}$′")
    band = Patch(facecolor="0.88", label="stated in the paper: 2 to 3")
    half = Line2D([], [], color="0.4", linestyle=":", linewidth=0.9, label="stated in the paper: 1/2")
    of_paper: list[Line2D | Patch] = [band, half] if has_paper_chain else []
    return [*blocks, *([correlation] if len(numbers) > 1 else []), *of_paper]
