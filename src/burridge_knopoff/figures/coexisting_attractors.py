"""⟨J⟩ and basin fractions of the attractors along a parameter, in the colours of their branches."""

from __future__ import annotations

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from burridge_knopoff.attractors.lookup import branch_names
from burridge_knopoff.continuation.branch_changes import Change
from burridge_knopoff.figures.basin_fractions import draw_fractions, fraction_handles
from burridge_knopoff.figures.branches import branch_colors
from burridge_knopoff.figures.mean_distance import branch_handles, draw_attractors
from burridge_knopoff.figures.model_words import constant, fixed_numbers, symbol
from burridge_knopoff.figures.strips import SHADE, shade_entry, show_all
from burridge_knopoff.figures.style import (
    begin_at_zero,
    label_panels,
    legend_below,
    legend_inside,
    new_figure,
    page_width,
    say,
    styled,
)


@styled
def draw(attractors: xarray.Dataset) -> Figure:
    """Draw ⟨J⟩ of the attractors above the fractions of the sampled states that reach them, a column for each law.

    attractors : in the form of `attractors.nc`, along any one parameter; with the changes of branches, as of
        `continue_attractors`, the ranges in which a branch begins or ends are shaded
    """
    (parameter,) = (str(name) for name in attractors["branch"].dims if name not in ("law", "attractor"))
    laws, colors = np.atleast_1d(constant(attractors, "law")), branch_colors(attractors)
    figure, panels = new_figure(page_width(len(laws)), 4.8, rows=2, columns=len(laws))
    for column, law in enumerate(laws):
        above, below = panels[column], panels[len(laws) + column]
        part = attractors.sel(law=law) if "law" in attractors.dims else attractors
        draw_attractors(above, part, parameter, colors, 2.6)
        if (part["branch"] < 0).all():
            say(above, "no attractor was found")
        _changes(above, part)
        draw_fractions(below, part, parameter, colors)
        show_all(above, attractors[parameter].values)
        below.set_xlabel(f"${symbol(parameter)}$")
    begin_at_zero(panels[0])
    panels[0].set_ylabel(r"$\langle J\rangle$")
    panels[len(laws)].set(ylabel="fraction of initial states", ylim=(-0.02, 1.02))
    legend_inside(panels[len(laws)], fraction_handles(panels[len(laws) :]))
    if any(panel.patches for panel in panels):
        legend_inside(panels[0], [shade_entry("a branch begins or ends")])
    legend_below(figure, branch_handles(colors, branch_names(attractors)))
    at = "".join(f", {words}" for words in fixed_numbers(attractors, [parameter]))
    label_panels(panels, [f"{law} law{at}{end}" for end in ("", ": basin fractions") for law in laws])
    return figure


def _changes(panel: Axes, attractors: xarray.Dataset) -> None:
    """Shade the ranges in which a branch begins or ends, if they are there."""
    if "change" not in attractors:
        return
    rows = (attractors[name].values for name in ("change", "grid_low", "grid_high"))
    for change, low, high in zip(*rows, strict=True):
        if change in (Change.BEGINNING, Change.END):
            panel.axvspan(low, high, color=SHADE, linewidth=0, zorder=0)
