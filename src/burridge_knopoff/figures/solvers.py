"""The results of independent solvers: ⟨J⟩, its difference from that of the study's solver, and the steps of each."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from burridge_knopoff.figures.palette import LAWS, MARKERS
from burridge_knopoff.figures.style import PAGE, label_panels, legend_below, new_figure, styled

TITLE = "Independent solvers"
CATEGORY = "Friction laws"
INPUTS = ("solvers",)
CAPTION = """\
Every solver for each law at a few values of a, with a row for each initial state and a. Left: ⟨J⟩ with its standard
error. Middle: the difference from ⟨J⟩ of the solver that the study uses; short lines are standard errors of this
difference. Differences below 10⁻¹⁵, including 0, are drawn at the left edge. Right: the number of steps per unit time;
dotted: that of the paper's runs.
"""

#: Steps per unit time in the paper's own numerical solution.
PAPER_STEPS = 1e6

# Smaller differences are rounding; they, and 0, are drawn here.
FLOOR = 1e-15


@styled
def draw(solvers: xarray.Dataset) -> Figure:
    """Draw ⟨J⟩, its difference from that of the study's solver, and steps per unit time, for every solver.

    A row of panels for each law, with a line for each initial state and a.
    """
    laws, states, a = (solvers[name].values for name in ("law", "initial", "a"))
    lines = [(initial, value) for initial in states for value in a]
    height = 0.5 + 0.17 * len(lines)
    figure, panels = new_figure(PAGE, 0.9 + height * len(laws), rows=len(laws), columns=3)
    names = [name for name in solvers["solver"].values.tolist() if (solvers["status"].sel(solver=name) >= 0).any()]
    place = np.arange(len(lines))
    titles = []
    for row, law in enumerate(laws):
        means, differences, steps = panels[3 * row : 3 * row + 3]
        reference = solvers.attrs[f"solver_{law}"]
        for n, name in enumerate(names):
            run = solvers.sel(law=law, solver=name).stack(line=("initial", "a"))
            look = _look(n)
            means.errorbar(run["mean_distance"], place, xerr=run["mean_distance_error"], **look)
            steps.plot(run["step_count"].where(run["step_count"] > 0) / run["end_time"], place, **look)
            if name != reference:
                differences.plot(np.maximum(abs(run["difference"]), FLOOR), place, **look)
                error = np.maximum(run["difference_error"], FLOOR)
                differences.plot(error, place, "|", color=look["color"], markersize=6, markeredgewidth=0.8)
        steps.axvline(PAPER_STEPS, color="0.4", linestyle=":", linewidth=0.9)
        means.set_yticks(place, [f"{initial}, $a={value:g}$" for initial, value in lines], fontsize=7.5)
        means.tick_params(axis="y", length=0)
        means.set_ylim(len(lines) - 0.4, -0.6)
        titles += [rf"{law} law: $\langle J\rangle$", f"{law} law: difference", f"{law} law: steps"]
    means, differences, steps = panels[-3:]
    means.set_xlabel(r"$\langle J\rangle$")
    differences.set(xlabel=r"$|\Delta\langle J\rangle|$", xscale="log", xlim=(0.2 * FLOOR, 1.0))
    steps.set(xlabel="steps per unit time", xscale="log", xlim=(0.3, 10.0 * PAPER_STEPS))
    handles = [Line2D([], [], **_look(n), label=name) for n, name in enumerate(names)]
    handles.append(Line2D([], [], color="0.3", marker="|", linestyle="", markersize=6, label="standard error"))
    handles.append(Line2D([], [], color="0.4", linestyle=":", linewidth=0.9, label="steps of the paper's runs"))
    legend_below(figure, handles)
    label_panels(panels, titles)
    return figure


def _look(solver: int) -> dict[str, Any]:
    """Return the symbol of a solver: open and of growing size, so that all are seen where they coincide."""
    return {
        "color": LAWS[solver % 2],
        "marker": MARKERS[solver],
        "markerfacecolor": "none",
        "markersize": 3.0 + 1.7 * solver,
        "markeredgewidth": 0.8,
        "linestyle": "",
    }
