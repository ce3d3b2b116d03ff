"""Agreement of the two friction laws against a."""

from __future__ import annotations

import numpy as np
import xarray
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from burridge_knopoff.figures.style import cells, color, label_panels, new_figure, page_width, styled

ROUNDING = 1e-17


@styled
def draw(agreement: xarray.Dataset) -> Figure:
    """Draw, for each initial state, |Δ⟨J⟩| against both tolerances, the section distance, and the common event order.

    Shaded: the laws disagree, in ⟨J⟩ (by more than both tolerances) or in the kind of motion.
    """
    states = agreement["initial"].values
    figure, panels = new_figure(page_width(len(states)), 5.6, rows=3, columns=len(states))
    a = agreement["a"].values
    edges = cells(a)
    for column, initial in enumerate(states):
        run = agreement.sel(initial=initial)
        difference, sections, order = panels[column :: len(states)]
        difference.plot(a, _positive(abs(run["difference"])), "-o", markersize=2.2, linewidth=0.8, color=color(0))
        noise = _positive(agreement.attrs["standard_errors"] * run["difference_error"])
        difference.plot(a, noise, "--", linewidth=0.8, color=color(1))
        share = _positive(agreement.attrs["relative_tolerance"] * run["mean_distance"].max("law"))
        difference.plot(a, share, ":", linewidth=0.9, color=color(2))
        sections.plot(a, _positive(run["section_distance"]), "-o", markersize=2.2, linewidth=0.8, color=color(0))
        order.plot(a, _positive(run["event_order_time"]), "-o", markersize=2.2, linewidth=0.8, color=color(0))
        for panel in (difference, sections, order):
            for k in np.flatnonzero(run["agrees"].values == 0):
                panel.axvspan(edges[k], edges[k + 1], color="0.9", linewidth=0, zorder=0)
        order.set_xlabel("$a$")
    # Differences of synchronized runs are rounding; they set the scale of nothing.
    for panel, floor in ((panels[0], ROUNDING), (panels[len(states)], 1e-8)):
        panel.set_ylim(floor, max(1.0, panel.get_ylim()[1]))
    for row, label in enumerate(
        (r"$|\Delta\langle J\rangle|$", "Wasserstein distance", r"same event order until $\tau$")
    ):
        panels[row * len(states)].set_ylabel(label)
        panels[row * len(states)].set_yscale("log")
    lines = panels[0].get_lines()
    panels[0].legend(
        [*lines[:3], Patch(facecolor="0.9", edgecolor="0.6")],
        [
            "difference",
            f"{agreement.attrs['standard_errors']:g} standard errors",
            rf"{100 * agreement.attrs['relative_tolerance']:g} % of $\langle J\rangle$",
            "the laws disagree",
        ],
        loc="lower right",
        frameon=True,
        framealpha=1.0,
        edgecolor="none",
    )
    names = (r"difference of $\langle J\rangle$ between the laws", "distance of the section points $W'$", "event order")
    label_panels(panels, [f"{initial}: {name}" for name in names for initial in states])
    return figure


def _positive(values: xarray.DataArray) -> np.ndarray:
    """Return the values with those that a logarithmic axis cannot show left out."""
    array = np.asarray(values, dtype=float)
    return np.where(array > 0.0, array, np.nan)
