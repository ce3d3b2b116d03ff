"""⟨J⟩ of the attractors and of the runs versus a, and the branch that each initial state reaches."""

from __future__ import annotations

import xarray
from matplotlib.figure import Figure

from burridge_knopoff.figures import mean_distance as of_runs

TITLE = "⟨J⟩ of the attractors, and the branch reached from each state"
CATEGORY = "Attractors"
INPUTS = ("mean_distance", "orbits", "attractors")
CAPTION = """\
Top: ⟨J⟩ of the attractors, in the colour of their branch, and of the runs from each initial state (thin symbols, with
bars of three standard errors). A branch has the same number (in brackets) in all figures, and the same colour where it
has one of its own; branches that the fewest states reach, over all a, share a colour. A run may end before it reaches
its attractor. Dotted: a_c, at which the synchronized orbit changes its stability (not drawn if this orbit is unstable
on both sides). At a = 0 the paper's laws are constant, and there is no attractor: ⟨J⟩ depends on the initial state.
Bottom: the branch reached from each initial state, with a row for each state and convention; black where it is
undetermined, white between the values of a coarse grid. A state from which a run reaches a motion that does not attract
is perturbed. Contact one-sided: a stuck block holds against any backward pull; symmetric: it slips backward beyond its
static friction. Start moving: all blocks slip at τ = 0; tested: blocks that friction can hold are stuck.
"""


def draw(mean_distance: xarray.Dataset, orbits: xarray.Dataset, attractors: xarray.Dataset) -> Figure:
    """Draw ⟨J⟩(a) of the runs over the branches of attractors, and the branch that each initial state reaches."""
    return of_runs.draw(mean_distance, orbits, attractors)
