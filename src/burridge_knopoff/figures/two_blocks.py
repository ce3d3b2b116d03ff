"""Two blocks under each law: ⟨J⟩ against a from each initial state."""

from __future__ import annotations

import xarray
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure

from burridge_knopoff.figures.style import (
    PAGE,
    color,
    legend_below,
    legend_entries,
    marker,
    new_figure,
    shade,
    shade_entry,
    styled,
)

TITLE = "Two blocks"
CATEGORY = "Friction laws"
INPUTS = ("two_blocks",)
CAPTION = """\
⟨J⟩ of what two blocks end on against a under each law, from each sampled initial state. Shaded where one law disagrees
with the first one for one of the states, in ⟨J⟩ or in the kind of motion; where the symbols coincide there, that state
leads to another one of the same motions.
"""


@styled
def draw(two_blocks: xarray.Dataset) -> Figure:
    """Draw ⟨J⟩ of all laws from each state; shaded where any disagrees with the first one, for any of the states."""
    figure, (panel,) = new_figure(PAGE, 2.8)
    draw_panel(figure, panel, two_blocks)
    return figure


def draw_panel(figure: Figure | SubFigure, panel: Axes, two_blocks: xarray.Dataset) -> None:
    """Draw the same into the panel of a figure, with a legend below."""
    a = two_blocks["a"].values
    disagree = (two_blocks["agrees"] == 0).any(("other_law", "state")).values
    shade(panel, a, disagree)
    for index, law in enumerate(two_blocks["law"].values):
        mean = two_blocks["mean_distance"].sel(law=law).values
        for number, state in enumerate(mean):
            panel.plot(
                a, state, marker(index), markersize=(3.4, 2.4)[index % 2], markeredgewidth=0.6, fillstyle="none",
                color=color(index), label=law if number == 0 else None,
            )  # fmt: skip
    panel.set_xlabel("$a$")
    panel.set_ylabel(r"$\langle J\rangle$")
    laws = two_blocks["law"].values
    handles, _ = legend_entries([panel])
    if disagree.any():
        words = "the laws disagree" if len(laws) == 2 else f"one disagrees with the {laws[0]} law"
        handles.append(shade_entry(words))
    legend_below(figure, handles)
