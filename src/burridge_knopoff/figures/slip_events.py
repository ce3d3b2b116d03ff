"""Panels of slip events: rates with their slope, extents, intervals, map of slips, recurrence; and all of one run."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator, NullFormatter

from burridge_knopoff.catalogue.slope import format_p_value
from burridge_knopoff.figures.palette import RAMP
from burridge_knopoff.figures.style import (
    PAGE,
    StyledFigure,
    begin_at_zero,
    label_panels,
    new_figure,
    say,
    say_nothing,
    styled,
)
from burridge_knopoff.running.status import STATUS_WORDS, Status

MAGNITUDE = r"magnitude $\ln M$"
INTERVAL = r"interval $\Delta\tau$"
_MARKS: dict[str, Any] = {"marker": "o", "markersize": 2.6, "linewidth": 0.6}


#: Text of a panel without values of a variable, although there are events.
_REASONS = {
    "magnitude_rate": "no rates: no run completed",
    "mean_extent": "no events",
    "interval_count": "no block starts two events",
    "recurrence": "no block slips in two events",
}
#: Most runs without events whose ends are listed.
_LISTED = 12


def figure_without_events(runs: xarray.Dataset) -> Figure | None:
    """Return a figure with a sentence if no run of a summary has events, otherwise None.

    It also names the runs that did not complete.
    """
    if (runs["event_count"] > 0).any():
        return None
    begin, end = (runs.attrs[f"{name}_time"] for name in ("begin", "end"))
    lines = [rf"No slip event began and ended between $\tau={begin:g}$ and $\tau={end:g}$."]
    every = runs.expand_dims([name for name in ("law", "a") if name not in runs.dims])
    for law in every["law"].values:
        for a in every["a"].values:
            if words := ending(every.sel(law=law, a=a)):
                lines.append(f"{law} law, $a={a:g}$: the run did not complete ({words}).")
    if len(lines) > _LISTED + 1:
        lines[_LISTED:] = [f"… and {len(lines) - _LISTED} more runs that did not complete."]
    figure, (panel,) = new_figure(PAGE, 1.2 + 0.17 * len(lines))
    say_nothing(panel, "\n".join(lines))
    return figure


def ending(run: xarray.Dataset) -> str:
    """Return how a run ended if it did not complete, otherwise an empty text."""
    status = run["status"].item()
    return "" if status == Status.COMPLETED else STATUS_WORDS[status].replace("_", " ")


def label_if_empty(panel: Axes, runs: xarray.Dataset, name: str) -> None:
    """Replace the axes of a panel by the reason if none of its runs has values of a variable."""
    if (runs["event_count"] == 0).all():
        say_nothing(panel, "no events")
    elif name == "recurrence" and _unknown_blocks(runs):
        # `draw_recurrence` gives the reason.
        return
    elif not (runs[name] > 0).any():
        say_nothing(panel, _REASONS[name])


def _unknown_blocks(runs: xarray.Dataset) -> bool:
    """Return whether it is unknown which blocks slip, as on a grid or network without profiles."""
    return bool((runs["block_event_count"] < 0).any())


def draw_rate(panel: Axes, run: xarray.Dataset, color: str) -> None:
    """Draw the rate of events against magnitude, and the fitted slope over the range of the fit."""
    rate = run["magnitude_rate"].where(run["magnitude_rate"] > 0.0)
    panel.semilogy(run["magnitude"], rate, color=color, **_MARKS)
    low, high, b = (run[name].item() for name in ("slope_low", "slope_high", "slope"))
    if np.isfinite(b):
        magnitude = np.array([low, high])
        density = np.exp(-b * (magnitude - low)) * (b / -np.expm1(-b * (high - low)) if b else 1.0 / (high - low))
        fitted = run["slope_count"].item() * run["event_rate"].item() / run["event_count"].item()
        panel.semilogy(magnitude, fitted * density, color=color, linewidth=2.4, alpha=0.45, zorder=0)
    panel.set(xlabel=MAGNITUDE, ylabel=r"events per $\tau$ and $\ln M$")


def draw_extent(panel: Axes, run: xarray.Dataset, color: str) -> None:
    """Draw the mean number of slipping blocks against magnitude."""
    panel.semilogy(run["magnitude"], run["mean_extent"], color=color, **_MARKS)
    panel.set(xlabel=MAGNITUDE, ylabel="mean number of blocks")


def draw_interval(panel: Axes, run: xarray.Dataset, color: str) -> None:
    """Draw the share of events by the interval since the event in which the epicentre slipped last."""
    count = run["interval_count"]
    share = count.where(count > 0) / max(int(count.sum()), 1)
    panel.loglog(run["interval"], share, color=color, **_MARKS)
    middle = run["interval"].values
    if len(middle) and middle[-1] > 10.0 * middle[0]:
        # Powers of ten are enough.
        panel.xaxis.set_minor_formatter(NullFormatter())
    panel.set(xlabel=INTERVAL, ylabel="share of events")


def draw_map(panel: Axes, run: xarray.Dataset, norm: Normalize) -> None:
    """Draw the last events as bars over the blocks that slip, at their times, coloured by magnitude."""
    panel.xaxis.set_major_locator(MaxNLocator(integer=True))
    panel.set(xlim=(0.5, run.sizes["block"] + 0.5), xlabel="block")
    if _unknown_blocks(run):
        # The blocks of a grid or network from the first to the last are not those that slip.
        say(panel, "known only with profiles")
        panel.set(yticks=[])
        return
    panel.set(ylabel=r"$\tau$")
    there = np.flatnonzero(run["bar_event"].values > 0)
    if not len(there):
        return
    event = run["bar_event"].values[there] - 1
    # The largest on top.
    order = np.argsort(run["shown_magnitude"].values[event], kind="stable")
    there, event = there[order], event[order]
    low, high = run["bar_first_block"].values[there] - 0.5, run["bar_last_block"].values[there] + 0.5
    times, magnitudes = run["shown_time"].values[event], run["shown_magnitude"].values[event]
    bars = np.stack([np.stack([low, times], axis=1), np.stack([high, times], axis=1)], axis=1)
    panel.add_collection(LineCollection(list(bars), array=magnitudes, norm=norm, cmap=RAMP, linewidth=0.9))
    panel.set_ylim(times.min(), max(times.max(), times.min() + 1.0))


def draw_recurrence(panel: Axes, run: xarray.Dataset, color: str) -> None:
    """Draw the mean time between events that contain a block, with its standard deviation."""
    if _unknown_blocks(run):
        say(panel, "known only with profiles")
        panel.set(xlabel="block", yticks=[])
        return
    block, mean, spread = (run[name].values for name in ("block", "recurrence", "recurrence_spread"))
    panel.fill_between(block, np.maximum(mean - spread, 0.0), mean + spread, color=color, alpha=0.2, linewidth=0)
    panel.plot(block, mean, color=color, marker="." if len(block) < 40 else "")
    panel.set(xlabel="block", ylabel=INTERVAL)
    panel.xaxis.set_major_locator(MaxNLocator(integer=True))
    begin_at_zero(panel)


def magnitude_norm(runs: xarray.Dataset) -> Normalize:
    """Return the scale of colours of the maps of some runs, of which one has events."""
    values = runs["shown_magnitude"].values
    finite = values[np.isfinite(values)]
    return Normalize(finite.min(), finite.max())


def add_magnitudes(figure: Figure, norm: Normalize, panels: list[Axes]) -> None:
    """Add the bar of colours of maps, if any of them shows an event."""
    if not any(panel.collections for panel in panels):
        return
    figure.colorbar(ScalarMappable(norm, RAMP), ax=panels, label=MAGNITUDE, aspect=30)


@styled
def draw_run(run: xarray.Dataset) -> Figure:
    """Draw slips, recurrence, rates, extents and intervals of one run, a summary at one law and a."""
    if (sentence := figure_without_events(run)) is not None:
        return sentence
    figure = StyledFigure(figsize=(PAGE, 5.4), layout="constrained")
    grid = figure.add_gridspec(3, 2, width_ratios=(1.15, 1.0))
    slips, recurrence = figure.add_subplot(grid[:2, 0]), figure.add_subplot(grid[2, 0])
    side_panels = [figure.add_subplot(grid[row, 1]) for row in range(3)]
    norm = magnitude_norm(run)
    draw_map(slips, run, norm)
    add_magnitudes(figure, norm, [slips])
    draw_recurrence(recurrence, run, "black")
    recurrence.set_xlim(slips.get_xlim())
    for panel, draw in zip(side_panels, (draw_rate, draw_extent, draw_interval), strict=True):
        draw(panel, run, "black")
    for panel, name in zip((*side_panels, recurrence), _REASONS, strict=True):
        label_if_empty(panel, run, name)
    words = ending(run)
    label_panels(
        [slips, recurrence, *side_panels],
        [f"slips{words and f', {words}'}", "recurrence at each block", "rate by magnitude", "extent", "intervals"],
    )
    side_panels[0].plot([], [], color="black", linewidth=2.4, alpha=0.45, label=slope_words(run))
    if side_panels[0].axison:
        side_panels[0].legend(loc="upper right", handlelength=1.2)
    return figure


def slope_words(run: xarray.Dataset) -> str:
    """Return slope, error and p-value of the fit for a legend; how the run ended, or that there is none."""
    if words := ending(run):
        return words
    if not run["event_count"]:
        return "no events"
    b, error, p = (run[name].item() for name in ("slope", "slope_error", "slope_p_value"))
    if not np.isfinite(b):
        return "no slope"
    digits = max(0, min(6, 1 - int(np.floor(np.log10(error))))) if error > 0.0 else 2
    return rf"$b={b:.{digits}f}\pm{error:.{digits}f}$, ${format_p_value(p).replace(' ', '')}$"
