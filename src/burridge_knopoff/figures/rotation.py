"""The rotation number of branch 1 versus a, with the plateaux of phase locking."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from burridge_knopoff.figures.palette import KINDS
from burridge_knopoff.figures.strips import show_all
from burridge_knopoff.figures.style import label_panels, legend_below, panel_table, say, styled
from burridge_knopoff.motion.kind import MotionKind
from burridge_knopoff.summaries.plateaux import locked_share, plateaux

TITLE = "Rotation number"
CATEGORY = "Attractors"
INPUTS = ("rotation",)
CONDITION = "has_end_blocks"
CAPTION = """\
The rotation number ρ of branch 1, the unsynchronized motion, versus a: the number of oscillations of the end blocks
against each other per oscillation of the middle block. In a chain that is its own mirror image both end blocks have the
same frequency, locked to the middle block or not. On a torus (quasiperiodic motion) this ratio varies with a. On a
phase-locked, periodic orbit it is a rational number and constant, which gives a plateau; the widest plateaux are
labelled with their ratio. The title of each panel says at how many of the grid's values of a on this branch the motion
is locked.
"""

# The widest plateaux, up to this number, are labelled with their ratio.
NAMED = 4

#: Look of the points of tori and of locked orbits, and their names in the legend.
LOOKS = (
    (MotionKind.QUASIPERIODIC, 0.0, "quasiperiodic (torus)"),
    (MotionKind.PERIODIC, 0.5, "periodic (locked)"),
)


@styled
def draw(rotation: xarray.Dataset) -> Figure:
    """Draw the rotation number versus a for each law; periodic orbits and tori in the colours of their kinds."""
    laws = [str(law) for law in rotation["law"].values]
    figure, (panels,) = panel_table(2.1, len(laws), "$a$", [r"rotation number $\rho$"])
    titles = []
    for panel, law in zip(panels, laws, strict=True):
        part = rotation.sel(law=law)
        share = locked_share(part, np.isfinite(part["a"].values))
        locked = f": {100 * share:.0f} % of grid values locked" if np.isfinite(share) else ""
        titles.append(f"{law} law{locked}")
        _curve(panel, part)
        a = rotation["a"].values[rotation["in_grid"].values == 1]
        show_all(panel, np.unique(a))
    label_panels(panels, titles)
    handles = {
        label: handle for panel in panels for handle, label in zip(*panel.get_legend_handles_labels(), strict=True)
    }
    if handles:
        legend_below(figure, list(handles.values()))
    return figure


def _curve(panel: Axes, rotation: xarray.Dataset) -> None:
    a, number = rotation["a"].values, rotation["rotation_number"].values
    if not np.isfinite(number).any():
        say(panel, "branch 1 was not found, or has no rotation number")
        return
    for locked, (kind, edge, name) in enumerate(LOOKS):
        chosen = (rotation["locked"].values == locked) & np.isfinite(number)
        if chosen.any():
            look: Any = {"color": KINDS[kind], "markeredgecolor": "0.2", "markeredgewidth": edge, "markersize": 2.6}
            panel.plot(a[chosen], number[chosen], "o", label=name, zorder=2 + locked, **look)
    steps = sorted(plateaux(rotation), key=lambda step: step.first - step.last)[:NAMED]
    for step in steps:
        if step.last > step.first:
            height = step.ratio.numerator / step.ratio.denominator
            panel.plot([step.first, step.last], [height, height], color="0.2", linewidth=0.6, zorder=1)
            panel.annotate(
                f"{step.ratio.numerator}/{step.ratio.denominator}",
                (step.first, height),
                xytext=(-4, -4),
                ha="right",
                textcoords="offset points",
                fontsize=8.0,
            )
