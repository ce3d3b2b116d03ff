"""Lyapunov exponents and kinds of motion against a."""

from __future__ import annotations

import numpy as np
import xarray
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.ticker import NullLocator

from burridge_knopoff.figures.kinds import KIND_COLORS
from burridge_knopoff.figures.style import cells, label_panels, legend_entries, new_figure, page_width, styled
from burridge_knopoff.stability.motion import MotionKind

TITLE = "Lyapunov exponents"
CATEGORY = "Synchronization"
INPUTS = ("lyapunov",)
CAPTION = """\
The largest Lyapunov exponents against a, with bars of three standard errors from batches, for each law and initial
state. The strips above the panels show the kind of motion that follows from the exponents and the section points; white
is undetermined.
"""


@styled
def draw(lyapunov: xarray.Dataset) -> Figure:
    """Draw the largest exponents against a with three standard errors, the kind of motion as a strip above them.

    A panel for each law and initial state; exponents below the panel, among them those that are −∞, are not shown.
    """
    laws, states = lyapunov["law"].values, lyapunov["initial"].values
    figure, panels = new_figure(page_width(len(states)), 0.8 + 2.1 * len(laws), rows=len(laws), columns=len(states))
    a = lyapunov["a"].values
    edges = cells(a)
    titles = []
    for number, panel in enumerate(panels):
        run = lyapunov.sel(law=laws[number // len(states)], initial=states[number % len(states)])
        titles.append(f"{run['initial'].item()}, {run['law'].item()} law")
        exponent = np.where(np.isfinite(run["lyapunov_exponent"]), run["lyapunov_exponent"], np.nan)
        error = np.nan_to_num(run["lyapunov_error"].values)
        panel.axhline(0.0, color="0.6", linewidth=0.5, zorder=0)
        for n in range(min(3, exponent.shape[1])):
            panel.errorbar(
                a,
                exponent[:, n],
                3.0 * error[:, n],
                fmt="o-",
                markersize=1.8,
                linewidth=0.5,
                elinewidth=0.5,
                color=("black", "0.5", "0.75")[n],
                label=rf"$\lambda_{n + 1}$",
            )
        panel.set_ylim(-0.13, 0.08)
        # A strip above the curves, in units of the panel's height.
        for left, right, kind in zip(edges[:-1], edges[1:], run["kind"].values, strict=True):
            panel.axvspan(left, right, 0.93, 1.0, color=KIND_COLORS[int(kind)], linewidth=0)
        panel.axhline(0.0653, color="black", linewidth=0.5)
        panel.xaxis.set_minor_locator(NullLocator())
        if number >= len(panels) - len(states):
            panel.set_xlabel("$a$")
        if number % len(states) == 0:
            panel.set_ylabel("Lyapunov exponents")
    for panel in panels:
        panel.set_xlim(edges[0], edges[-1])
    panels[0].legend(*legend_entries(panels), loc="upper left", bbox_to_anchor=(0.0, 0.93))
    kinds = sorted({int(kind) for kind in np.unique(lyapunov["kind"].values)})
    figure.legend(
        handles=[Patch(facecolor=KIND_COLORS[kind], edgecolor="0.4", label=MotionKind(kind).words) for kind in kinds],
        loc="outside lower center",
        ncols=len(kinds),
    )
    label_panels(panels, titles)
    return figure
