"""The edge states on the boundaries between basins versus a: ⟨J⟩ and lifetime."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from burridge_knopoff.figures.palette import KINDS
from burridge_knopoff.figures.strips import show_all
from burridge_knopoff.figures.style import begin_at_zero, label_panels, legend_below, page_width, say, styled
from burridge_knopoff.motion.kind import MotionKind

TITLE = "Edge states"
CATEGORY = "Attractors"
INPUTS = ("attractors", "edges")
CAPTION = """\
The motion on which trajectories on the boundaries between basins settle, versus a for each law. Top: ⟨J⟩ of the edge
states, in the colour of their kind of motion, over that of the attractors (grey). Middle: saddle orbits, continued in a
for as long as they have one unstable direction, and the edge states at which the boundary is fractal, since the
unstable manifold crosses the stable one. At the others none of the displaced states, whose number the legend gives,
shows this; a crossing by fewer of them is not excluded. Bottom: the mean time for which trajectories stay near an edge
state.
"""

EDGE: Any = {"linestyle": "", "marker": "o", "markersize": 3.0, "markeredgecolor": "0.3", "markeredgewidth": 0.3}
FRACTAL: Any = {"linestyle": "", "marker": "D", "markersize": 3.4, "color": "black"}
SADDLE: Any = {"color": "black", "linewidth": 0.7}
ATTRACTORS: Any = {"linestyle": "", "marker": ".", "color": "#bbbbbb", "markersize": 2.0, "zorder": 0}


@styled
def draw(attractors: xarray.Dataset, edges: xarray.Dataset) -> Figure:
    """Draw, for each law, ⟨J⟩ of the edge states by kind, the saddle orbits and fractal boundaries, and lifetimes."""
    laws = [str(law) for law in attractors["law"].values]
    figure = Figure(figsize=(page_width(len(laws)), 7.2), layout="constrained")
    panels = figure.subplots(3, len(laws), sharex="col", sharey="row", squeeze=False, height_ratios=[3.0, 2.4, 1.6])
    for (above, middle, below), law in zip(panels.T, laws, strict=True):
        part = edges.isel(edge=edges["law"].values == law)
        for panel in (above, middle):
            _attractors(panel, attractors.sel(law=law))
        _kinds(above, part)
        _saddles(middle, edges, law)
        fractal = part.isel(edge=part["has_crossing"].values == 1)
        middle.plot(fractal["a"].values, fractal["mean_distance"].values, **FRACTAL)
        below.plot(part["a"].values, part["lifetime"].values, "o", color="black", markersize=2.0, markeredgewidth=0)
        below.set_yscale("log")
        if not part.sizes["edge"]:
            say(below, "no edge state was found")
        show_all(above, attractors["a"].values)
        below.set_xlabel("$a$")
    for row, label in zip(panels, (r"$\langle J\rangle$", r"$\langle J\rangle$", "lifetime"), strict=True):
        row[0].set_ylabel(label)
    begin_at_zero(panels[0, 0])
    begin_at_zero(panels[1, 0])
    figure.align_ylabels()
    legend_below(figure, _kind_handles(edges), _other_handles(edges))
    thoughts = ("", ": saddle orbits", ": lifetimes")
    label_panels(panels.flat, [f"{law} law{thought}" for thought in thoughts for law in laws])
    return figure


def _attractors(panel: Axes, attractors: xarray.Dataset) -> None:
    there = attractors["branch"].values >= 0
    a = np.broadcast_to(attractors["a"].values[:, None], there.shape)[there]
    panel.plot(a, attractors["mean_distance"].values[there], **ATTRACTORS)


def _saddles(panel: Axes, edges: xarray.Dataset, law: str) -> None:
    mask = edges["orbit_law"].values == law
    number, a, mean = (edges[f"orbit_{name}"].values for name in ("segment", "a", "mean_distance"))
    for segment in np.unique(number[mask]):
        chosen = mask & (number == segment)
        panel.plot(a[chosen], mean[chosen], **SADDLE)


def _kinds(panel: Axes, edges: xarray.Dataset) -> None:
    for kind, color in KINDS.items():
        chosen = edges.isel(edge=edges["kind"].values == kind)
        panel.plot(chosen["a"].values, chosen["mean_distance"].values, color=color, **EDGE)


def _kind_handles(edges: xarray.Dataset) -> list[Line2D]:
    look = EDGE | {"markersize": 4.0}
    kinds = np.unique(edges["kind"].values).tolist()
    return [Line2D([], [], color=KINDS[kind], label=MotionKind(kind).words, **look) for kind in kinds]


def _other_handles(edges: xarray.Dataset) -> list[Line2D]:
    depth = np.maximum(edges["reached_count"].values, 0).sum(axis=(1, 2)).max(initial=0)
    fractal = f"fractal boundary (elsewhere no crossing among {depth} states)"
    return [
        Line2D([], [], label="attractors", **ATTRACTORS | {"markersize": 4.0}),
        Line2D([], [], label="saddle orbits", **SADDLE),
        Line2D([], [], label=fractal, **FRACTAL),
    ]
