"""Attractors of one model, and edge states between their basins, in the section of their stops."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from burridge_knopoff.attractors.attractor import Attractor
from burridge_knopoff.attractors.labels import UNDETERMINED
from burridge_knopoff.basins.edge_state import EdgeState
from burridge_knopoff.figures.branches import ranked_colors
from burridge_knopoff.figures.model_words import model_title
from burridge_knopoff.figures.palette import BRANCHES, pale
from burridge_knopoff.figures.single_panel import draw_panel, widen_constant_axes
from burridge_knopoff.figures.style import say
from burridge_knopoff.model.model import Model
from burridge_knopoff.motion.kind import SYNCHRONOUS

# Sets with at most so many different returns are drawn with large points.
FEW = 50


def draw(attractors: Sequence[Attractor], labels: np.ndarray | None = None, axes: Axes | None = None) -> Figure:
    """Draw the positions of the end blocks at the stops of one block, for each attractor.

    A mirror image has a lighter shade. labels : index of the attractor that each state reaches, for the legend
    """
    return draw_panel(lambda panel: _attractors(panel, attractors, labels), axes)


def _attractors(panel: Axes, attractors: Sequence[Attractor], labels: np.ndarray | None) -> str:
    if not attractors:
        say(panel, "no attractor was found")
        return ""
    for k, (attractor, color) in enumerate(zip(attractors, _colors(attractors), strict=True)):
        motion = attractor.motion
        words = f"{k}: {motion.kind.words}, $\\langle J\\rangle={motion.mean_distance:.3f}$"
        _returns(panel, attractor.model, motion.returns, color, words + _share(labels, k))
    if labels is not None and (labels == UNDETERMINED).any():
        panel.plot([], [], linestyle="", label=f"undetermined{_share(labels, UNDETERMINED)}")
    return model_title(attractors[0].model)


def _colors(attractors: Sequence[Attractor]) -> list[str]:
    """Return the colour of each attractor, as of the branches of a study, pale for the second of a mirror pair."""
    first = [min(k, attractor.partner) for k, attractor in enumerate(attractors)]
    others = [k for k in dict.fromkeys(first) if attractors[k].motion.kind not in SYNCHRONOUS]
    colors = ranked_colors(dict.fromkeys(range(1 + len(others)), 1.0), len(BRANCHES))
    hues = [colors[1 + others.index(k) if k in others else 0] for k in first]
    return [hue if k == index else pale(hue) for index, (k, hue) in enumerate(zip(first, hues, strict=True))]


def _share(labels: np.ndarray | None, index: int) -> str:
    return "" if labels is None or not len(labels) else f", {100.0 * np.mean(labels == index):.0f} % of the states"


def _returns(panel: Axes, model: Model, returns: np.ndarray, color: str, label: str) -> None:
    position = returns[:, : model.blocks]
    first, last = position[:, 0], position[:, -1]
    size = 3.6 if len(np.unique(position.round(6), axis=0)) <= FEW else 0.9
    look: Any = {"markeredgewidth": 0.0, "color": color}
    panel.plot(first, last, "o", markersize=size, rasterized=True, **look)
    panel.plot([], [], "o", markersize=4.0, label=label, **look)
    panel.set(xlabel="$x_1$ at the returns", ylabel=f"$x_{{{model.blocks}}}$ at the returns")
    widen_constant_axes(panel)


def draw_edge(edge: EdgeState, axes: Axes | None = None) -> Figure:
    """Draw an edge state in the section of its stops."""
    return draw_panel(lambda panel: _edge(panel, edge), axes)


def _edge(panel: Axes, edge: EdgeState) -> str:
    label = f"edge state: {edge.kind.words}, $\\langle J\\rangle={edge.mean_distance:.3f}$"
    _returns(panel, edge.model, edge.returns, "black", label)
    return model_title(edge.model)
