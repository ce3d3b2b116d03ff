"""Where branches of attractors begin, end and change, and by what: ⟨J⟩ of periodic orbits against a, with the edges."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from burridge_knopoff.figures.branches import OTHER_COLOR, branch_colors, named_colors
from burridge_knopoff.figures.style import (
    begin_at_zero,
    label_panels,
    legend_below,
    new_figure,
    page_width,
    say_nothing,
    show_all,
    styled,
)
from burridge_knopoff.orbits.edge_kind import EdgeKind
from burridge_knopoff.summaries.slots import branch_names

TITLE = "Edges of the attractors"
CATEGORY = "Attractors"
INPUTS = ("attractors", "edges")
CAPTION = """\
⟨J⟩ of periodic orbits against a for each law, in the colours of the branches of attractors that they belong to: solid
where they are stable, dashed where they are not and were followed a little beyond an edge. Grey points: all attractors.
Marks: edges, by what happens there; a bar at the foot is the range of a in which one is only known to lie. Below, where
the study covers it: the road from one period to chaos, enlarged, with the stops of the three blocks in a period.
"""

# Marker and name of each kind of edge.
MARKS = {
    EdgeKind.GRAZING: ("v", "grazing"),
    EdgeKind.FOLD: ("s", "fold"),
    EdgeKind.FLIP: ("D", "flip"),
    EdgeKind.NEIMARK_SACKER: ("o", "Neimark–Sacker"),
    EdgeKind.PITCHFORK: ("P", "pitchfork"),
}
UNLOCATED: dict[EdgeKind, tuple[Any, str]] = {
    EdgeKind.UNDETERMINED: ({"facecolor": "0.9", "linestyle": ":"}, "undetermined"),
    EdgeKind.CRISIS: ({"facecolor": "0.5", "linestyle": "-"}, "crisis"),
}

BAR: Any = {"edgecolor": "black", "linewidth": 0.7}

#: Ranges of a and ⟨J⟩ of the panels below.
ROAD = ((0.108, 0.182), (0.0412, 0.0488))

# Stretches of stable orbits at least this long in a have their stops beside them there.
NAMED = 0.01


@styled
def draw(attractors: xarray.Dataset, edges: xarray.Dataset) -> Figure:
    """Draw ⟨J⟩ of stable and unstable orbits over the attractors, and a mark at each edge, for each law."""
    laws = [str(law) for law in attractors["law"].values]
    rows = 1 + _covers_road(attractors, edges)
    figure, panels = new_figure(page_width(len(laws)), 0.2 + 3.0 * rows, rows, len(laws), share_columns=False)
    colors = branch_colors(attractors)
    for place, panel in enumerate(panels):
        number = place % len(laws)
        law = attractors.sel(law=laws[number])
        _attractors(panel, law)
        _orbits(panel, edges, number, colors)
        _edges(panel, edges, number)
        panel.set_xlabel("$a$")
        if place < len(laws):
            begin_at_zero(panel)
            show_all(panel, attractors["a"].values)
            if (law["branch"] < 0).all():
                say_nothing(panel, "no attractor was found")
        else:
            _stops(panel, edges, number)
            panel.set_xlim(*ROAD[0])
            panel.set_ylim(*ROAD[1])
    for panel in panels[:: len(laws)]:
        panel.set_ylabel(r"$\langle J\rangle$")
    _legend(figure, edges, colors, branch_names(attractors))
    label_panels(panels, [f"{law} law{end}" for end in ("", ", the road to chaos")[:rows] for law in laws])
    return figure


def _covers_road(attractors: xarray.Dataset, edges: xarray.Dataset) -> bool:
    """Tell whether the values of a reach beyond the road, and orbits of every law lie on it."""
    a, mean, law = (edges[f"orbit_{name}"].values for name in ("a", "mean_distance", "law"))
    inside = (a > ROAD[0][0]) & (a < ROAD[0][1]) & (mean > ROAD[1][0]) & (mean < ROAD[1][1])
    return bool(attractors["a"].values[-1] >= ROAD[0][1] and len(np.unique(law[inside])) == attractors.sizes["law"])


def _attractors(panel: Axes, attractors: xarray.Dataset) -> None:
    there = attractors["branch"].values >= 0
    a = np.broadcast_to(attractors["a"].values[:, None], there.shape)[there]
    panel.plot(a, attractors["mean_distance"].values[there], ".", color="#bbbbbb", markersize=2.0, zorder=0)


def _orbits(panel: Axes, edges: xarray.Dataset, law: int, colors: dict[int, str]) -> None:
    own = edges["orbit_law"].values == law
    number, branch = edges["orbit_stretch"].values, edges["orbit_branch"].values
    a, mean, stable = (edges[f"orbit_{name}"].values for name in ("a", "mean_distance", "stable"))
    for one in np.unique(number[own]):
        chosen = np.flatnonzero(own & (number == one))
        color = colors.get(int(branch[chosen[0]]), OTHER_COLOR)
        ends = np.flatnonzero(np.diff(stable[chosen])) + 1
        for first, last in zip([0, *ends], [*ends, len(chosen)], strict=True):
            # An unstable piece is drawn from the stable orbit before it to the one after it.
            piece = chosen[first:last] if stable[chosen[first]] else chosen[max(first - 1, 0) : last + 1]
            style, width = ("-", 1.3) if stable[chosen[first]] else ("--", 0.7)
            panel.plot(a[piece], mean[piece], linestyle=style, linewidth=width, color=color, zorder=1)


def _edges(panel: Axes, edges: xarray.Dataset, law: int) -> None:
    own = edges["law"].values == law
    a, mean, kind = edges["a"].values, edges["mean_distance"].values, edges["kind"].values
    for one, (marker, _) in MARKS.items():
        chosen = own & (kind == one) & np.isfinite(mean)
        panel.plot(
            a[chosen],
            mean[chosen],
            marker,
            color="black",
            markersize=3.6,
            markerfacecolor="white",
            markeredgewidth=0.7,
            zorder=3,
        )
    for one, (look, _) in UNLOCATED.items():
        for value, error in np.unique(np.stack([a, edges["a_error"].values], 1)[own & (kind == one)], axis=0):
            panel.axvspan(value - error, value + error, 0.0, 0.05, **look, **BAR, zorder=0)


def _stops(panel: Axes, edges: xarray.Dataset, law: int) -> None:
    """Write how often each block stops in a period beside the longer stretches of stable orbits."""
    own = (edges["orbit_law"].values == law) & (edges["orbit_stable"].values == 1)
    number, a, mean = (edges[f"orbit_{name}"].values for name in ("stretch", "a", "mean_distance"))
    for one in np.unique(number[own]):
        chosen = np.flatnonzero(own & (number == one))
        inside = chosen[(mean[chosen] > ROAD[1][0]) & (mean[chosen] < ROAD[1][1]) & (a[chosen] > ROAD[0][0])]
        inside = inside[a[inside] < ROAD[0][1]]
        if not len(inside) or np.ptp(a[inside]) < NAMED:
            continue
        middle = inside[np.abs(a[inside] - a[inside].mean()).argmin()]
        stops = ", ".join(str(count) for count in edges["orbit_stops"].values[middle])
        panel.annotate(stops, (a[middle], mean[middle]), (6, -9), textcoords="offset points", ha="left", fontsize=7.5)


def _legend(figure: Figure, edges: xarray.Dataset, colors: dict[int, str], names: dict[int, str]) -> None:
    """Put a legend of what is drawn below all panels."""
    drawn = {int(number): colors.get(int(number), OTHER_COLOR) for number in edges["orbit_branch"].values}
    kind, stable = edges["kind"].values, edges["orbit_stable"].values
    located = kind[np.isfinite(edges["mean_distance"].values)]
    orbits: Any = [(1, 1.3, "-", "stable orbits"), (0, 0.7, "--", "unstable orbits")]
    handles = [
        *(
            Line2D([], [], color="#555555", linewidth=width, linestyle=line, label=name)
            for number, width, line, name in orbits
            if number in stable
        ),
        *(
            Line2D(
                [], [], color="black", linestyle="", marker=marker, markersize=4, markerfacecolor="white", label=name
            )
            for one, (marker, name) in MARKS.items()
            if one in located
        ),
        *(Patch(label=name, **look, **BAR) for one, (look, name) in UNLOCATED.items() if one in kind),
        *(Line2D([], [], color=color, linewidth=1.3, label=name) for name, color in named_colors(drawn, names).items()),
    ]
    legend_below(figure, handles)
