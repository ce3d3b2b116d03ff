"""The chain of blocks, its springs and its driver, as in the paper's Fig. 1, drawn from the model."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from burridge_knopoff.figures.palette import block_color, pale
from burridge_knopoff.figures.style import PAGE, styled
from burridge_knopoff.model.chain import Chain

TITLE = "The chain of blocks"
CATEGORY = "Model"
PAPER = "Fig. 1"
CONDITION = "has_one_chain"
INPUTS = ()
OVER = "any"
FROM_STUDY = ("chain",)
CAPTION = """\
The chain of the study. Springs couple neighbouring blocks, and others connect blocks to a driver that moves with
velocity v; the number next to a spring is its stiffness in units of the spring constant k. U_i is the position of block
i. Dry friction holds a block up to its static friction F, in units of F(0). F is given if it differs between blocks,
and so is the weakening w, the factor of the slip speed in friction. Of a long chain, only the first two blocks and the
last are drawn. Springs of a network and dashpots are not drawn.
"""

#: Longer chains are drawn in part.
WHOLE = 6

# Coordinates in units of half the distance between two blocks.
SIDE, TOP, STEP = 0.8, 2.3, 2.2


@styled
def draw(chain: Chain) -> Figure:
    """Draw a chain given as arguments of `Chain`: blocks, springs with their strengths, driver and ground."""
    count = chain.blocks
    blocks = list(range(count)) if count <= WHOLE else [0, 1, count - 1]
    # Leave room for dots in place of the missing blocks.
    place = {block: STEP * (k + (count > WHOLE and k == 2)) for k, block in enumerate(blocks)}
    left, right = -1.5, max(place.values()) + 1.7
    figure = Figure(figsize=(min(PAGE, 0.75 * (right - left) + 0.4), 2.4), layout="constrained")
    panel = figure.subplots()
    differing = {
        symbol: values for symbol, values in (("F", chain.thresholds), ("w", chain.weakenings)) if np.ptp(values) > 0.0
    }
    panel.add_patch(Rectangle((left, -0.3), right - left, 0.3, facecolor="none", edgecolor="0.5", hatch="////", lw=0))
    panel.plot([left, right], [0.0, 0.0], color="black")
    panel.add_patch(Rectangle((left, TOP), right - left, 0.18, facecolor="0.85", edgecolor="black", linewidth=0.7))
    _arrow(panel, right - 1.1, TOP + 0.42, "$v$")
    for block, x in place.items():
        panel.add_patch(
            Rectangle((x - SIDE / 2, 0.0), SIDE, SIDE, facecolor=pale(block_color(block)), edgecolor="black")
        )
        panel.text(x, SIDE / 2, str(block + 1), ha="center", va="center")
        _arrow(panel, x - 0.65, SIDE + 0.2, f"$U_{{{block + 1}}}$")
        if chain.driving[block] > 0.0:
            # The driver is ahead.
            _spring(panel, (x + 0.25, SIDE), (x + 0.8, TOP))
            panel.text(x + 0.75, 1.4, f"${chain.driving[block]:g}$")
        of_block = [f"${symbol}={values[block]:g}$" for symbol, values in differing.items()]
        panel.text(x, -0.38, "\n".join(of_block), ha="center", va="top")
    for block, other in pairwise(blocks):
        start, end = place[block] + SIDE / 2, place[other] - SIDE / 2
        if other != block + 1 or chain.is_network:
            panel.text(0.5 * (start + end), SIDE / 2, "· · ·", ha="center", va="center", fontsize=14.0)
            continue
        _spring(panel, (start, SIDE / 2), (end, SIDE / 2))
        panel.text(0.5 * (start + end), 0.62, f"${chain.coupling_to_next[block]:g}$", ha="center")
    lines = _words(chain)
    top = -0.35 - 0.4 * max(len(differing), 1)
    lowest = top - 0.4 * len(lines) if lines or differing else -0.35
    panel.text(0.5 * (left + right), top, "\n".join(lines), ha="center", va="top")
    panel.set(xlim=(left - 0.05, right + 0.05), ylim=(lowest, TOP + 0.7), aspect="equal")
    panel.set_axis_off()
    return figure


def _words(chain: Chain) -> list[str]:
    """Return in words what is not drawn."""
    lines = []
    if chain.springs:
        lines.append("springs of a network couple the blocks to each other")
    elif chain.ends == "ring":
        lines.append(f"a spring of strength ${chain.coupling_to_next[-1]:g}$ couples block {chain.blocks} to block 1")
    elif chain.grid:
        size = f"{chain.grid[0]} × {chain.grid[1]}"
        x, y = chain.parameter_values("coupling")
        strength = f"${x:g}$" if x == y else f"${x:g}$ along rows and ${y:g}$ along columns"
        lines.append(f"springs of strength {strength} couple a grid of {size} blocks")
    for values, where in ((chain.neighbours.damping, "between blocks"), (chain.driver_damping, "to the driver")):
        if values.any():
            strength = f"{values.min():g}" if np.ptp(values) == 0.0 else f"{values.min():g}$ to ${values.max():g}"
            lines.append(f"dashpots ${strength}$ {where}")
    return lines


def _spring(panel: Axes, start: tuple[float, float], end: tuple[float, float]) -> None:
    """Draw a spring as a zigzag with straight ends."""
    along = np.array([0.0, 0.15, *np.linspace(0.2, 0.8, 9), 0.85, 1.0])
    across = 0.1 * np.array([0.0, 0.0, *(1.0 - 2.0 * (np.arange(9) % 2)), 0.0, 0.0])
    first, last = np.array(start), np.array(end)
    direction = (last - first) / np.hypot(*(last - first))
    points = first + along[:, None] * (last - first) + across[:, None] * [-direction[1], direction[0]]
    panel.plot(*points.T, color="black", linewidth=0.8, solid_joinstyle="round")


def _arrow(panel: Axes, x: float, y: float, words: str) -> None:
    """Draw an arrow to the right, with a symbol at its start."""
    panel.annotate("", (x + 0.6, y), (x, y), arrowprops={"arrowstyle": "->", "linewidth": 0.8})
    panel.text(x, y, words, ha="right", va="center")
