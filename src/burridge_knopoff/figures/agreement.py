"""The agreement of each friction law with the first law, versus a."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from burridge_knopoff.dataset.variables import Answer
from burridge_knopoff.figures.strips import shade, shade_entry
from burridge_knopoff.figures.style import (
    label_panels,
    legend_below,
    legend_entries,
    lone_marker,
    new_figure,
    page_width,
    panel_table,
    say,
    say_nothing,
    scale_to_decades,
    styled,
)

TITLE = "Agreement of the laws"
CATEGORY = "Friction laws"
INPUTS = ("agreement",)
CONDITION = "has_several_laws"
CAPTION = """\
Each law compared with the first law of the study, for each initial state, versus a: the difference of ⟨J⟩ with both
tolerances, the Wasserstein distance between the section points W', and the time up to which both laws have the same
order of events. Differences below 10⁻⁸ (⟨J⟩) or 10⁻⁷ (sections), including 0, are drawn at the lower edge; tolerances
below it are not shown. Shaded: the laws disagree in ⟨J⟩ or in the kind of motion. Open symbols: undecided, since the
difference of ⟨J⟩ is close to the tolerance or a kind of motion is undetermined.
"""

# Smaller differences of ⟨J⟩ and of section points, including 0, are drawn here, so that they do not set the scale.
FLOORS = (1e-8, 1e-7)

POINT: dict[str, Any] = {"marker": "o", "markersize": 2.2, "color": "black", "linestyle": ""}
UNKNOWN: dict[str, Any] = {"markerfacecolor": "white", "markeredgewidth": 0.6}

#: Titles and vertical axes of the panels of a comparison.
NAMES = (r"difference of $\langle J\rangle$", "difference of the sections", "common event order")
LABELS = (
    r"$|\Delta\langle J\rangle|$",
    "Wasserstein distance\nof section points $W$′",
    "same event order\n" r"until $\tau$",
)


@styled
def draw(agreement: xarray.Dataset) -> Figure:
    """Draw, for each initial state, |Δ⟨J⟩| with both tolerances, the section distance, and the common event order.

    Each law other than the first has three rows. Shaded: it disagrees with the first law, in ⟨J⟩ (by more than the
    tolerance and the errors together) or in the kind of motion. Open symbols: undecided.
    """
    states, other_laws = agreement["initial"].values, agreement["other_law"].values
    first = agreement["law"].values[0]
    if not len(other_laws):
        figure, (panel,) = new_figure(page_width(1), 1.5)
        say_nothing(panel, f"{first} is the only law: nothing to compare")
        return figure
    figure, table = panel_table(1.7, len(states), "$a$", LABELS * len(other_laws))
    panels = list(table.flat)
    titles = []
    for block, other in zip(np.reshape(table, (len(other_laws), 3, len(states))), other_laws, strict=True):
        for panel in block[:, 0]:
            panel.set_yscale("log")
        for column, initial in enumerate(states):
            _comparison(block[:, column], agreement.sel(initial=initial, other_law=other), agreement.attrs)
        for panel in block[:, 0]:
            scale_to_decades(panel)
        laws = f", {other} law" if len(other_laws) > 1 else ""
        titles += [f"{initial}{laws}: {name}" for name in NAMES for initial in states]
    points = f"{other_laws[0] if len(other_laws) == 1 else 'each'} law compared with the {first} law"
    handles: list[Artist] = [Line2D([], [], **POINT, label=points), *legend_entries(panels)[0]]
    if (agreement["agrees"] == Answer.NO).any():
        handles.append(shade_entry("the laws disagree"))
    if (agreement["agrees"] == Answer.UNDETERMINED).any():
        handles.append(Line2D([], [], **POINT, **UNKNOWN, label="undecided: difference close to tolerance"))
    legend_below(figure, handles)
    label_panels(panels, titles)
    return figure


def _comparison(panels: np.ndarray, run: xarray.Dataset, settings: dict[str, float]) -> None:
    """Draw the comparison of one law with the first, from one initial state, into three panels."""
    a = run["a"].values
    difference, sections, order = panels
    unknown = run["agrees"].values == Answer.UNDETERMINED
    _points(difference, a, abs(run["difference"]).clip(min=FLOORS[0]), unknown)
    if not run["difference"].any():
        say(difference, "0 at all $a$")
    noise, share = (tolerance.where(tolerance >= FLOORS[0]) for tolerance in tolerances(run, settings))
    name = f"{settings['standard_errors']:g} standard errors"
    alone: Any = {"marker": lone_marker(a), "markersize": 3.5}
    difference.plot(a, noise, "--", linewidth=0.8, color="0.4", label=name, **alone)
    name = rf"{100 * settings['relative_tolerance']:g} % of $\langle J\rangle$"
    difference.plot(a, share, ":", linewidth=1.1, color="0.4", label=name, **alone)
    _points(sections, a, run["section_distance"].clip(min=FLOORS[1]), unknown)
    _points(order, a, run["event_order_time"].where(run["event_order_time"] > 0.0), unknown)
    for panel in panels:
        shade(panel, a, run["agrees"].values == Answer.NO)


def tolerances(run: xarray.Dataset, settings: dict[str, float]) -> tuple[xarray.DataArray, xarray.DataArray]:
    """Return what |Δ⟨J⟩| of one law and initial state may be: multiples of its error, and a share of the larger ⟨J⟩."""
    pair = run["mean_distance"].sel(law=[run["law"].values[0], run["other_law"].item()])
    noise = settings["standard_errors"] * run["difference_error"]
    return noise, settings["relative_tolerance"] * pair.max("law", skipna=False)


def _points(panel: Axes, a: np.ndarray, values: xarray.DataArray, unknown: np.ndarray) -> None:
    panel.plot(a, values, **POINT)
    panel.plot(a, values.where(unknown), **POINT, **UNKNOWN)
    if not values.notnull().any():
        say(panel, "unknown at every $a$")
