"""The bifurcation diagrams, with attractors at additional values of a between those of the grid."""

from __future__ import annotations

import xarray
from matplotlib.figure import Figure

from burridge_knopoff.figures import bifurcation_diagram as of_runs

TITLE = "Bifurcation diagrams, refined"
CATEGORY = "Attractors"
INPUTS = ("bifurcation_diagram", "attractors", "refined")
CAPTION = """\
Section points W' on the section W = 0 versus a, for each law and initial state; upward crossings above 0, downward
crossings below. At additional values of a, where some attractor changes, the points are those of the branch that the
initial state reaches at the nearest value of the grid.
"""


def draw(bifurcation: xarray.Dataset, attractors: xarray.Dataset, refined: xarray.Dataset) -> Figure:
    """Draw W' at W = 0 versus a: a row of panels for each law, a column for each initial state."""
    return of_runs.draw(bifurcation, attractors, refined)
