"""Agreement of each friction law with the first one against a."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from burridge_knopoff.figures.style import (
    color,
    label_panels,
    legend_below,
    legend_entries,
    new_figure,
    page_width,
    say_nothing,
    shade,
    styled,
)

TITLE = "Agreement of the laws"
CATEGORY = "Friction laws"
INPUTS = ("agreement",)
CONDITION = "has_several_laws"
CAPTION = """\
Each law compared with the first one of the study, for each initial state, against a: the difference of ⟨J⟩ with both
tolerances, the Wasserstein distance between the section points W', and the time until which both laws have the same
order of events. Shaded where the two disagree, in ⟨J⟩ or in the kind of motion.
"""

ROUNDING = 1e-17

LABELS = (r"$|\Delta\langle J\rangle|$", "Wasserstein distance", r"same event order until $\tau$")


@styled
def draw(agreement: xarray.Dataset) -> Figure:
    """Draw, for each initial state, |Δ⟨J⟩| against both tolerances, the section distance, and the common event order.

    Three rows for each law that is compared with the first one. Shaded: the two disagree, in ⟨J⟩ (by more than both
    tolerances) or in the kind of motion.
    """
    states, others = agreement["initial"].values, agreement["other_law"].values
    first = agreement["law"].values[0]
    if not len(others):
        figure, (panel,) = new_figure(page_width(1), 1.5)
        say_nothing(panel, f"the {first} law is the only one: there is nothing to compare")
        return figure
    figure, panels = new_figure(page_width(len(states)), 5.6 * len(others), rows=3 * len(others), columns=len(states))
    rows = np.reshape(np.array(panels, dtype=object), (len(others), 3, len(states)))
    titles = []
    for block, other in zip(rows, others, strict=True):
        for column, initial in enumerate(states):
            _comparison(block[:, column], agreement.sel(initial=initial, other_law=other), agreement.attrs)
        # Differences of synchronized runs are rounding; they set the scale of nothing.
        for panel, floor in ((block[0, 0], ROUNDING), (block[1, 0], 5e-9)):
            panel.set_ylim(floor, max(1.0, panel.get_ylim()[1]))
        for row, label in zip(block, LABELS, strict=True):
            row[0].set(ylabel=label, yscale="log")
        pair = "between the laws" if len(others) == 1 else f"of the {other} and the {first} law"
        names = (rf"difference of $\langle J\rangle$ {pair}", "distance of the section points $W'$", "event order")
        titles += [f"{initial}: {name}" for name in names for initial in states]
    for panel in rows[-1, -1]:
        panel.set_xlabel("$a$")
    handles, _ = legend_entries(panels)
    if (agreement["agrees"] == 0).any():
        handles.append(Patch(facecolor="0.9", edgecolor="0.6", label="the laws disagree"))
    legend_below(figure, handles)
    label_panels(panels, titles)
    return figure


def _comparison(panels: np.ndarray, run: xarray.Dataset, settings: dict[str, float]) -> None:
    """Draw the comparison of one law with the first, from one initial state, into three panels."""
    a = run["a"].values
    difference, sections, order = panels
    _curve(difference, a, abs(run["difference"]), label="difference")
    noise = _positive(settings["standard_errors"] * run["difference_error"])
    name = f"{settings['standard_errors']:g} standard errors"
    difference.plot(a, noise, "--", linewidth=0.8, color=color(1), label=name)
    pair = run["mean_distance"].sel(law=[run["law"].values[0], run["other_law"].item()])
    share = _positive(settings["relative_tolerance"] * pair.max("law"))
    name = rf"{100 * settings['relative_tolerance']:g} % of $\langle J\rangle$"
    difference.plot(a, share, ":", linewidth=0.9, color=color(2), label=name)
    _curve(sections, a, run["section_distance"])
    _curve(order, a, run["event_order_time"])
    for panel in panels:
        shade(panel, a, run["agrees"].values == 0)


def _curve(panel: Axes, a: np.ndarray, values: xarray.DataArray, **look: Any) -> None:
    panel.plot(a, _positive(values), "-o", markersize=2.2, linewidth=0.8, color=color(0), **look)


def _positive(values: xarray.DataArray) -> np.ndarray:
    """Return the values with those that a logarithmic axis cannot show left out."""
    array = np.asarray(values, dtype=float)
    return np.where(array > 0.0, array, np.nan)
