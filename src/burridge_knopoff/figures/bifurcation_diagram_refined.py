"""The bifurcation diagrams with the sections of attractors at values of a between those of the grid."""

from __future__ import annotations

import xarray
from matplotlib.figure import Figure

from burridge_knopoff.figures import bifurcation_diagram as of_runs

TITLE = "Bifurcation diagrams, refined"
CATEGORY = "Attractors"
INPUTS = ("bifurcation_diagram", "attractors", "refined")
CAPTION = """\
Section points W' at W = 0 against a, for each law and initial state; upward crossings above 0, downward crossings
below. At values of a in between, where some attractor changes: the section of the attractor that the initial state
reaches at the nearest value of the grid at which it is the same branch.
"""


def draw(bifurcation: xarray.Dataset, attractors: xarray.Dataset, refined: xarray.Dataset) -> Figure:
    """Draw W' at W = 0 against a: a row of panels for each law, a column for each initial state."""
    return of_runs.draw(bifurcation, attractors, refined)
