"""The mean distance ⟨J⟩ versus a for each initial state and law, as in the paper's Figs. 3a and 3b."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from burridge_knopoff.attractors.lookup import branch_names
from burridge_knopoff.figures.branches import branch_colors, named_colors
from burridge_knopoff.figures.palette import UNDETERMINED, state_symbol
from burridge_knopoff.figures.strips import draw_strips, show_all
from burridge_knopoff.figures.style import (
    begin_at_zero,
    label_panels,
    legend_below,
    legend_inside,
    page_width,
    panel_table,
    say,
    styled,
)
from burridge_knopoff.summaries.orbit_flags import stability_edge

TITLE = "⟨J⟩ versus a"
CATEGORY = "Synchronization"
PAPER = "Figs. 3a, 3b"
INPUTS = ("mean_distance", "orbits")
CONDITION = "has_end_blocks"
CAPTION = """\
The time average ⟨J⟩ of the phase-space distance between the end blocks versus a, for each law. Symbols: runs from each
initial state, with bars of three standard errors. Dotted: a_c, at which the synchronized orbit changes its stability
(not drawn if this orbit is unstable on both sides). At a = 0 the paper's laws are constant: free oscillations neither
grow nor decay, and ⟨J⟩ depends on the initial state alone.
"""


@styled
def draw(
    mean_distance: xarray.Dataset, orbits: xarray.Dataset | None = None, attractors: xarray.Dataset | None = None
) -> Figure:
    """Draw ⟨J⟩(a) of the runs over the branches of attractors, and the branch that each initial state reaches.

    A panel for each law, with a second one if there are attractors. Above: coloured points are attractors, black
    symbols are runs with three standard errors; runs that did not complete are left out. Below: a row for each initial
    state and convention of contact and start, in the colour of the branch that it reaches; black is undetermined.

    orbits : the summary of the synchronized orbit; without it, a_c is not marked
    attractors : without them, only the runs are drawn
    """
    laws = mean_distance["law"].values
    if attractors is None:
        figure, panels = panel_table(2.1, len(laws), "$a$", [r"$\langle J\rangle$"])
    else:
        figure, panels = _with_strips(len(laws), attractors["initial_branch"].isel(law=0, a=0).size)
    colors = {} if attractors is None else branch_colors(attractors)
    for column, law in enumerate(laws):
        if attractors is not None:
            draw_attractors(panels[0, column], attractors.sel(law=law), "a", colors, 6.0)
            _conventions(panels[1, column], attractors.sel(law=law), colors)
        _label_constant_friction(panels[0, column], mean_distance.sel(law=law))
        # Small over the attractors, so that they do not hide the colours of the branches.
        runs, size = mean_distance.sel(law=law), 1.9 if attractors is None else 0.9
        if runs["mean_distance"].isnull().all():
            say(panels[0, column], "no run completed")
        if not runs["mean_distance"].any() and (
            attractors is None or not attractors["mean_distance"].fillna(0.0).any()
        ):
            say(panels[0, column], "$J = 0$ at all times")
        for index, initial in enumerate(runs["initial"].values):
            draw_runs(panels[0, column], runs.sel(initial=initial), "a", **state_symbol(index, size))
        if orbits is not None and np.isfinite(critical := stability_edge(orbits.sel(law=law))):
            panels[0, column].axvline(critical, zorder=0, color="0.4", linestyle=":", linewidth=0.9)
            top, look = ("data", "axes fraction"), {"textcoords": "offset points", "va": "top", "fontsize": 8.0}
            panels[0, column].annotate("$a_c$", (critical, 1.0), (3, -3), xycoords=top, **look)
    begin_at_zero(panels[0, 0])
    show_all(panels[0, 0], mean_distance["a"].values)
    states = mean_distance["initial"].values
    symbols: list[Artist] = [
        Line2D([], [], label=f"run from {name}", **state_symbol(n)) for n, name in enumerate(states)
    ]
    if attractors is None:
        legend_below(figure, symbols)
    else:
        if (attractors["initial_branch"] < 0).any():
            symbols.append(Patch(facecolor=UNDETERMINED, label="undetermined"))
        legend_inside(panels[0, 0], symbols)
        legend_below(figure, branch_handles(colors, branch_names(attractors)))
    label_panels(
        panels.flat, [*(f"{law} law" for law in laws), *(f"{law} law: branch reached" for law in laws)][: panels.size]
    )
    return figure


def _with_strips(laws: int, rows: int) -> tuple[Figure, np.ndarray]:
    """Return a figure with a column for each law, and its panels, of which the lower have a number of rows."""
    height = 0.13 * rows + 0.2
    figure = Figure(figsize=(page_width(laws), 3.2 + height), layout="constrained")
    panels = figure.subplots(2, laws, sharex=True, sharey="row", squeeze=False, height_ratios=[2.6, height])
    for panel in panels[1]:
        panel.set_xlabel("$a$")
    panels[0, 0].set_ylabel(r"$\langle J\rangle$")
    panels[1, 0].set_ylabel("initial state,\ncontact, start", fontsize=7.0)
    return figure, panels


def draw_attractors(
    panel: Axes, attractors: xarray.Dataset, parameter: str, colors: Mapping[int, str], size: float
) -> None:
    """Draw ⟨J⟩ of the attractors of one law versus a parameter, in the colours of their branches."""
    branch = attractors["branch"].values
    for number in np.unique(branch[branch >= 0]):
        slots = branch == number
        a = np.broadcast_to(attractors[parameter].values[:, None], branch.shape)[slots]
        panel.plot(
            a,
            attractors["mean_distance"].values[slots],
            "o",
            color=colors[int(number)],
            markersize=size,
            markeredgewidth=0,
            zorder=1,
        )


def draw_runs(panel: Axes, runs: xarray.Dataset, parameter: str, **look: Any) -> None:
    """Draw ⟨J⟩ of runs versus a parameter, with bars of three standard errors; look : arguments of `errorbar`."""
    error = 3.0 * runs["mean_distance_error"].values
    panel.errorbar(runs[parameter].values, runs["mean_distance"].values, error, elinewidth=0.5, **look)


def _label_constant_friction(panel: Axes, runs: xarray.Dataset) -> None:
    """Say next to the runs at a = 0 that their friction is constant, if it is: nothing attracts them."""
    first = runs.isel(a=0)
    highest = first["mean_distance"].values.max()
    if first["a"] == 0.0 and (first["least_friction"] == 1.0).all() and np.isfinite(highest):
        words = "constant friction\nat $a=0$"
        panel.annotate(words, (0.0, highest), (5, 0), textcoords="offset points", va="center", fontsize=7.0)


def _conventions(panel: Axes, attractors: xarray.Dataset, colors: dict[int, str]) -> None:
    names, reached = branches_reached(attractors)
    picture = np.zeros((*reached.shape, 3))
    for branch, color in {**colors, -1: UNDETERMINED}.items():
        picture[reached == branch] = to_rgb(color)
    draw_strips(panel, attractors["a"].values, picture)
    panel.set_yticks(np.arange(len(names)) + 0.5, names, fontsize=6.5)
    panel.tick_params(axis="y", length=0)
    panel.set_ylim(len(names), 0)


def branches_reached(attractors: xarray.Dataset) -> tuple[list[str], np.ndarray]:
    """Return the names of all initial states under all conventions, and the branches that they reach, shape (name, a).

    attractors : of one law
    """
    reached = attractors["initial_branch"].stack(row=("initial", "contact", "start")).transpose("row", "a")
    # The names of a config are written with hyphens in prose.
    return [", ".join(map(str, row)).replace("one_sided", "one-sided") for row in reached["row"].values], reached.values


def branch_handles(colors: Mapping[int, str], names: Mapping[int, str]) -> list[Line2D]:
    """Return the legend entries of branches."""
    return [
        Line2D([], [], color=color, label=name, linestyle="", marker="o", markersize=5, markeredgewidth=0)
        for name, color in named_colors(colors, names).items()
    ]
