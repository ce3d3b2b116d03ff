"""The mean distance ⟨J⟩ of two blocks under each law versus a, and the states for which the laws disagree."""

from __future__ import annotations

import numpy as np
import xarray
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from burridge_knopoff.dataset.variables import Answer
from burridge_knopoff.figures.palette import law_symbol
from burridge_knopoff.figures.strips import SHADE, draw_strips, show_all
from burridge_knopoff.figures.style import PAGE, label_panels, legend_below, legend_entries, say, styled

TITLE = "Two blocks"
CATEGORY = "Friction laws"
INPUTS = ("two_blocks",)
CAPTION = """\
⟨J⟩ of the attractor reached by two blocks, versus a, under each law and from each sampled initial state, and the states
for which the laws disagree in ⟨J⟩ or in the kind of motion; each law is compared with the first. (a, b) The train
model, to which the paper refers, pulled at its first block only. (c, d) Both blocks are pulled; this is not the paper's
chain. Where symbols coincide although the state is marked, both laws have both attractors, but the state reaches a
different one under each law.
"""

# Colour and label of states for which the laws disagree, or may disagree.
ANSWERS = {Answer.NO: ("0.25", "the laws disagree"), Answer.UNDETERMINED: (SHADE, "undecided")}


TITLES = {
    "train": "train model: only the first block is pulled",
    "both_pulled": "both blocks are pulled (not the paper's chain)",
}


@styled
def draw(two_blocks: xarray.Dataset) -> Figure:
    """Draw ⟨J⟩ under all laws from each state, over a strip for each state, dark where a law disagrees with the first.

    Each chain of two blocks has two panels.
    """
    strip = 0.4 + 0.1 * two_blocks.sizes["state"]
    figure = Figure(figsize=(PAGE, 0.6 + len(TITLES) * (2.1 + strip)), layout="constrained")
    panels = figure.subplots(2 * len(TITLES), 1, sharex=True, height_ratios=len(TITLES) * [2.1, strip])
    entries: dict[object, Artist] = {}
    for n, chain in enumerate(TITLES):
        for handle in draw_panels(panels[2 * n], panels[2 * n + 1], two_blocks.sel(chain=chain)):
            entries.setdefault(handle.get_label(), handle)
    # The panels share the axis of a.
    for panel in panels[:-1]:
        panel.set_xlabel("")
    legend_below(figure, list(entries.values()))
    below = "initial states for which the laws disagree"
    label_panels(panels, [title for chain in TITLES for title in (TITLES[chain], below)])
    return figure


def draw_panels(upper: Axes, lower: Axes, two_blocks: xarray.Dataset) -> list[Artist]:
    """Draw one chain of two blocks into two panels, and return its legend entries."""
    a = two_blocks["a"].values
    for index, law in enumerate(two_blocks["law"].values):
        mean = two_blocks["mean_distance"].sel(law=law).values
        for number, state in enumerate(mean):
            label = f"{law} law" if number == 0 else None
            upper.plot(a, state, **law_symbol(index, 2.2), linestyle="", label=label)
    upper.set_ylabel(r"$\langle J\rangle$")
    show_all(upper, a)
    if two_blocks["mean_distance"].isnull().all():
        say(upper, "no known attractor was reached")
    agrees = two_blocks["agrees"].transpose("other_law", "state", "a").values
    states = agrees.shape[1]
    picture, handles = np.ones((states, len(a), 3)), legend_entries([upper])[0]
    # Draw known disagreement over undecided cases.
    for answer, (shade, words) in reversed(ANSWERS.items()):
        there = (agrees == answer).any(axis=0)
        picture[there] = to_rgb(shade)
        if there.any():
            handles.append(Patch(facecolor=shade, edgecolor="0.6", label=words))
    draw_strips(lower, a, picture, bottom=0.5)
    lower.set(xlabel="$a$", ylabel="initial state", ylim=(states + 0.5, 0.5))
    lower.set_yticks(np.arange(1, states + 1), map(str, range(1, states + 1)), fontsize=6.5)
    lower.tick_params(axis="y", length=0)
    return handles
