"""The results of independent solvers: ⟨J⟩ and the number of steps of each."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from burridge_knopoff.figures.style import (
    begin_at_zero,
    color,
    label_panels,
    legend_below,
    new_figure,
    page_width,
    styled,
    to_decades,
)

TITLE = "Independent solvers"
CATEGORY = "Friction laws"
INPUTS = ("solvers",)
CAPTION = """\
Every solver of each law at a few values of a: ⟨J⟩ with its standard error; the difference from ⟨J⟩ of the study's
solver, with the standard error of the difference as a short line; and the number of steps per unit time. Differences of
0 or below 10⁻¹⁵ are drawn at the lower edge.
"""

#: Steps per unit time in the paper's own numerical solution.
PAPER_STEPS = 1e6

MARKERS = ("o", "s", "^")
FILLINGS = ("full", "none", "left", "top", "right", "bottom")

# Width, in distances between values of a, over which the points at one a are spread.
SPREAD = 0.8


# Smaller differences are rounding; they, and 0, are drawn here.
FLOOR = 1e-15


@styled
def draw(solvers: xarray.Dataset) -> Figure:
    """Draw ⟨J⟩, its difference from that of the study's solver, and steps per unit time, for every solver at each a.

    A column for each law. The points at one a are spread out, first by initial state, then by solver. Short lines in
    the middle row are standard errors of the differences between independent runs; differences of 0 are at the lower
    edge.
    """
    laws, states = solvers["law"].values, solvers["initial"].values
    figure, panels = new_figure(page_width(len(laws)), 6.2, rows=3, columns=len(laws))
    names = [name for name in solvers["solver"].values.tolist() if (solvers["status"].sel(solver=name) >= 0).any()]
    place = np.arange(solvers.sizes["a"])
    for column, law in enumerate(laws):
        means, differences, steps = panels[column :: len(laws)]
        own = solvers.attrs[f"solver_{law}"]
        there = [name for name in names if (solvers["status"].sel(law=law, solver=name) >= 0).any()]
        slots = len(states) * len(there)
        for j, initial in enumerate(states):
            for n, name in enumerate(there):
                run = solvers.sel(law=law, solver=name, initial=initial)
                x = place + SPREAD * ((j * len(there) + n + 0.5) / slots - 0.5)
                look = _look(names.index(name), j)
                means.errorbar(x, run["mean_distance"], run["mean_distance_error"], **look)
                steps.plot(x, run["step_count"] / run["end_time"], **look)
                if name != own:
                    differences.plot(x, np.maximum(abs(run["difference"]), FLOOR), **look)
                    error = np.maximum(run["difference_error"], FLOOR)
                    differences.plot(x, error, "_", color=look["color"], markersize=6, markeredgewidth=0.7)
        steps.axhline(PAPER_STEPS, color="0.4", linestyle=":", linewidth=0.9)
        steps.set_xticks(place, [f"{value:g}" for value in solvers["a"].values])
        steps.set(xlabel="$a$", xlim=(-0.5, len(place) - 0.5))
    panels[0].set_ylabel(r"$\langle J\rangle$")
    begin_at_zero(panels[0])
    panels[len(laws)].set(ylabel=r"$|\Delta\langle J\rangle|$", yscale="log", ylim=(0.2 * FLOOR, 1.0))
    panels[2 * len(laws)].set(ylabel="steps per unit time", yscale="log")
    to_decades(panels[2 * len(laws)])
    handles = [Line2D([], [], **_look(n, 0), label=name) for n, name in enumerate(names)]
    handles += [Line2D([], [], **_look(0, j, "0.3"), label=f"from {initial}") for j, initial in enumerate(states)]
    handles.append(Line2D([], [], color="0.3", marker="_", linestyle="", markersize=6, label="standard error"))
    handles.append(Line2D([], [], color="0.4", linestyle=":", linewidth=0.9, label="steps of the paper's runs"))
    legend_below(figure, handles)
    titles = [[r"$\langle J\rangle$" for _ in laws]]
    titles.append([f"difference from {solvers.attrs[f'solver_{law}']}" for law in laws])
    titles.append(["steps" for _ in laws])
    label_panels(panels, [f"{law} law: {what}" for row in titles for law, what in zip(laws, row, strict=True)])
    return figure


def _look(solver: int, initial: int, hue: str | None = None) -> dict[str, Any]:
    """Return the marker of a point: colour and shape show the solver, the filling shows the initial state."""
    look = {
        "color": color(solver) if hue is None else hue,
        "marker": MARKERS[solver],
        "fillstyle": FILLINGS[initial % 6],
    }
    return {**look, "markersize": 4.5, "markeredgewidth": 0.6, "linestyle": ""}
