"""The stick-slip cycles versus a: cycle times, frequencies, and the correlation of the end blocks."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from burridge_knopoff.figures.palette import block_color
from burridge_knopoff.figures.style import PAGE, begin_at_zero, label_panels, legend_below, new_figure, say, styled

TITLE = "Stick-slip cycles"
CATEGORY = "Runs"
INPUTS = ("stick_slip",)
FROM_STUDY = ("shown_law",)
CAPTION = """\
Stick-slip cycles of the first, middle and last block versus a, for each initial state, under one law of the study (the
config's `figures.law`). From top to bottom: the time between two stops, with its standard error; in chains of more than
two blocks, the frequency of the end blocks divided by that of the middle block, from the peaks of the velocity spectra
(bars: resolution of the spectra) and from the stops; the correlation of the velocities of the end blocks; and the
fraction of time for which each block sticks. Band and dotted lines: the paper's statements for its three blocks, a
cycle of two to three units of time and half the frequency of the middle block.
"""

#: The paper's statements: a stick-slip cycle lasts about two or three time units; the end blocks oscillate at about
#: half the frequency of the middle block.
PAPER_CYCLE = (2.0, 3.0)
PAPER_RATIO = 0.5

# The end blocks often coincide: the later one is drawn smaller, inside the marker of the first.
SIZES = (4.4, 2.8, 2.0)
MARKERS = ("o", "s", "o")


@styled
def draw(stick_slip: xarray.Dataset, shown_law: str) -> Figure:
    """Draw cycle times, frequency ratios, the correlation of the end blocks and stick fractions under one law.

    A column for each initial state, with the first, middle and last block. Frequency ratios are those of the end blocks
    to the middle block, which needs three blocks; the correlation needs two. Gaps are blocks that do not stop and runs
    that did not complete.
    """
    states, count = stick_slip["initial"].values, stick_slip.sizes["block"]
    middle = (count + 1) // 2
    numbers = sorted({1, middle, count})
    # Two blocks have no middle block.
    over_middle = [f"{quantity} frequency\nover that of block {middle}" for quantity in ("velocity", "stop")]
    together_label = f"correlation of\n$U_1$′ with $U_{{{count}}}$′"
    rows = {"cycle time": "time between stops"}
    if count > 2:
        rows |= dict(zip(("velocity frequencies", "stop frequencies"), over_middle, strict=True))
    if count > 1:
        rows["velocity correlation"] = together_label
    rows["stick time"] = "fraction of time stuck"
    labels = list(rows.values())
    figure, panels = new_figure(PAGE, 0.6 + 1.45 * len(labels), rows=len(labels), columns=len(states))
    for column, initial in enumerate(states):
        run = stick_slip.sel(law=shown_law, initial=initial)
        cycles, *inner_panels, sticks = panels[column :: len(states)]
        ratios, together = inner_panels[:-1], inner_panels[-1] if inner_panels else None
        for n, block in enumerate(numbers):
            series = run.sel(block=block)
            _points(cycles, n, series["cycle_time"], series["cycle_time_error"])
            _points(sticks, n, series["stick_fraction"])
            if ratios and block != middle:
                _ratios(ratios, n, series, run.sel(block=middle))
        _say_why(cycles, run, "cycle_time", "no stops")
        _say_why(sticks, run, "stick_fraction", "")
        cycles.axhspan(*PAPER_CYCLE, color="0.88", linewidth=0, zorder=0)
        if together is not None:
            _say_why(together, run, "velocity_correlation", "the velocities do not change")
            together.plot(run["a"], run["velocity_correlation"], "o", color="black", markersize=2.0)
            together.axhline(0.0, color="0.7", linewidth=0.6, zorder=0)
            together.set_ylim(-1.1, 1.1)
        sticks.set_xlabel("$a$")
        if ratios:
            _say_why(ratios[0], run, "velocity_frequency", "the velocities do not change")
            _say_why(ratios[1], run.sel(block=middle), "cycle_time", f"block {middle} does not stop")
        for panel in ratios:
            panel.axhline(PAPER_RATIO, color="0.4", linestyle=":", linewidth=0.9, zorder=0)
    for panel, label in zip(panels[:: len(states)], labels, strict=True):
        panel.set_ylabel(label)
        if label != together_label:
            begin_at_zero(panel)
    legend_below(figure, _legend(numbers))
    label_panels(panels, [f"{initial}: {name}" for name in rows for initial in states])
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


def _ratios(panels: Sequence[Axes], n: int, end: xarray.Dataset, middle: xarray.Dataset) -> None:
    """Draw the frequency ratio of an end block to the middle block, from velocities and from stops."""
    velocities, stops = panels
    # Both errors are resolutions of the spectrum.
    ratio = end["velocity_frequency"] / middle["velocity_frequency"].drop_vars("block")
    shares = [(part["velocity_frequency_error"] / part["velocity_frequency"]).values for part in (end, middle)]
    _points(velocities, n, ratio, ratio * np.hypot(shares[0], shares[1]))
    rate = middle["stop_rate"].drop_vars("block")
    _points(stops, n, end["stop_rate"] / rate.where(rate > 0.0))


def _legend(numbers: list[int]) -> list[Line2D | Patch]:
    band = Patch(facecolor="0.88", label="stated in the paper: 2 to 3")
    blocks = [Line2D([], [], **_look(n, block), label=f"block {block}") for n, block in enumerate(numbers)]
    if len(numbers) < 3:
        return [*blocks, band]
    half = Line2D([], [], color="0.4", linestyle=":", linewidth=0.9, label="stated in the paper: 1/2")
    return [*blocks, band, half]
