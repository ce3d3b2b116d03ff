"""The edge states on the boundaries between basins versus a: ⟨J⟩ and lifetime."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from burridge_knopoff.figures.palette import KINDS
from burridge_knopoff.figures.style import begin_at_zero, label_panels, legend_below, page_width, say, show_all, styled
from burridge_knopoff.motion.kind import MotionKind

TITLE = "Edge states"
CATEGORY = "Attractors"
INPUTS = ("attractors", "edges")
CAPTION = """\
The motion on which trajectories on the boundaries between basins settle, versus a for each law. Top: ⟨J⟩ of the
attractors (grey) and of the edge states, in the colour of their kind of motion. Diamonds: the unstable manifold crosses
the stable one, and the boundary is therefore fractal. Circles: none of the displaced states, whose number the legend
gives, shows this; a crossing by fewer of them is not excluded. Lines: saddle orbits, continued in a for as long as they
have one unstable direction. Bottom: the mean time for which trajectories stay near an edge state.
"""

SADDLE_COLOR = "#555555"
MARKS = {0: ("o", 3.0), 1: ("D", 3.4)}


@styled
def draw(attractors: xarray.Dataset, edges: xarray.Dataset) -> Figure:
    """Draw, for each law, ⟨J⟩ of edge states over the attractors, and their lifetimes."""
    laws = [str(law) for law in attractors["law"].values]
    figure = Figure(figsize=(page_width(len(laws)), 5.4), layout="constrained")
    panels = figure.subplots(2, len(laws), sharex="col", sharey="row", squeeze=False, height_ratios=[3.0, 1.8])
    for (above, below), law in zip(panels.T, laws, strict=True):
        _attractors(above, attractors.sel(law=law))
        _saddles(above, edges, law)
        part = edges.isel(edge=edges["law"].values == law)
        for panel, name in ((above, "mean_distance"), (below, "lifetime")):
            _edges(panel, part, name)
        below.set_yscale("log")
        if not part.sizes["edge"]:
            say(below, "no edge state was found")
        begin_at_zero(above)
        show_all(above, attractors["a"].values)
        below.set_xlabel("$a$")
    panels[0, 0].set_ylabel(r"$\langle J\rangle$")
    panels[1, 0].set_ylabel("lifetime")
    figure.align_ylabels()
    legend_below(figure, _handles(edges))
    label_panels(panels.flat, [f"{law} law{end}" for end in ("", ": lifetimes") for law in laws])
    return figure


def _attractors(panel: Axes, attractors: xarray.Dataset) -> None:
    there = attractors["branch"].values >= 0
    a = np.broadcast_to(attractors["a"].values[:, None], there.shape)[there]
    panel.plot(a, attractors["mean_distance"].values[there], ".", color="#bbbbbb", markersize=2.0, zorder=0)


def _saddles(panel: Axes, edges: xarray.Dataset, law: str) -> None:
    mask = edges["orbit_law"].values == law
    number, a, mean = (edges[f"orbit_{name}"].values for name in ("segment", "a", "mean_distance"))
    for segment in np.unique(number[mask]):
        chosen = mask & (number == segment)
        panel.plot(a[chosen], mean[chosen], "-", color=SADDLE_COLOR, linewidth=0.6, zorder=1)


def _edges(panel: Axes, edges: xarray.Dataset, name: str) -> None:
    for crossing, (mark, size) in MARKS.items():
        for kind, color in KINDS.items():
            chosen = (edges["kind"].values == kind) & (edges["has_crossing"].values == crossing)
            values: Any = edges["a"].values[chosen], edges[name].values[chosen]
            panel.plot(
                *values,
                mark,
                color=color,
                markersize=size,
                markeredgecolor="0.3",
                markeredgewidth=0.3,
                zorder=2 + crossing,
            )


def _handles(edges: xarray.Dataset) -> list[Line2D]:
    kinds = np.unique(edges["kind"].values).tolist()
    depth = np.maximum(edges["reached_count"].values, 0).sum(axis=(1, 2)).max(initial=0)
    style: Any = {"linestyle": "", "markeredgecolor": "0.3", "markeredgewidth": 0.3}
    return [
        *(
            Line2D([], [], marker="o", markersize=4.0, color=KINDS[kind], label=MotionKind(kind).words, **style)
            for kind in kinds
        ),
        *(
            Line2D([], [], marker=MARKS[crossing][0], markersize=4.0, color="0.6", label=words, **style)
            for crossing, words in ((0, f"no crossing among {depth} states"), (1, "crossing: fractal boundary"))
            if crossing in edges["has_crossing"].values
        ),
        Line2D([], [], color=SADDLE_COLOR, linewidth=0.6, label="saddle orbits"),
        Line2D([], [], color="#bbbbbb", marker=".", linestyle="", label="attractors"),
    ]
