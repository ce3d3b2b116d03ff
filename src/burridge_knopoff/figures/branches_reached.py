"""⟨J⟩ of the attractors against a behind that of the runs, and which branch each initial state reaches."""

from __future__ import annotations

import xarray
from matplotlib.figure import Figure

from burridge_knopoff.figures import mean_distance as of_runs

TITLE = "⟨J⟩ of the attractors, and what each state reaches"
CATEGORY = "Attractors"
INPUTS = ("mean_distance", "attractors")
CAPTION = """\
Coloured points: the attractors that were found, by branch; a branch has the same number, in brackets, and colour in all
figures, and branches that are found at few values of a are grey. Below: the branch on which each initial state ends, a
row for each state and convention: contact one_sided, where a stuck block holds against any backward pull, or symmetric,
where it does not; start moving, where all blocks slip at τ = 0, or tested, where those that friction can hold are
stuck. The state is pushed if the motion before does not attract (white: undetermined); a run above may not get there
within its time.
Black: runs from each initial state, with bars of three standard errors.
"""


def draw(mean_distance: xarray.Dataset, attractors: xarray.Dataset) -> Figure:
    """Draw ⟨J⟩(a) of the runs over the branches of attractors, and which branch each initial state reaches."""
    return of_runs.draw(mean_distance, attractors)
