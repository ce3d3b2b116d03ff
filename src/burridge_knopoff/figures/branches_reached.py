"""⟨J⟩ of the attractors and of the runs versus a, and the branch that each initial state reaches."""

from __future__ import annotations

import xarray
from matplotlib.figure import Figure

from burridge_knopoff.figures import mean_distance as of_runs

TITLE = "⟨J⟩ of the attractors, and the branch reached from each state"
CATEGORY = "Attractors"
INPUTS = ("mean_distance", "attractors")
CAPTION = """\
Coloured points: attractors, by branch. A branch has the same number (in brackets) and colour in all figures; branches
found at few values of a are grey. Black: runs from each initial state, with bars of three standard errors. A run may
end before it reaches its attractor. Below: the branch reached from each initial state, with a row for each state and
convention. Contact one_sided: a stuck block holds against any backward pull; symmetric: it slips backward beyond its
static friction. Start moving: all blocks slip at τ = 0; tested: blocks that friction can hold are stuck. A state whose
motion does not attract is perturbed. White: undetermined.
"""


def draw(mean_distance: xarray.Dataset, attractors: xarray.Dataset) -> Figure:
    """Draw ⟨J⟩(a) of the runs over the branches of attractors, and the branch that each initial state reaches."""
    return of_runs.draw(mean_distance, attractors)
