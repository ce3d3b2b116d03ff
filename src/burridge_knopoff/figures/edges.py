"""The edges of branches of attractors, on ⟨J⟩ of periodic orbits against a, and what happens at each edge."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from burridge_knopoff.figures.branches import OTHER_COLOR, branch_colors, named_colors
from burridge_knopoff.figures.style import (
    begin_at_zero,
    label_panels,
    legend_below,
    page_width,
    say_nothing,
    show_all,
    styled,
)
from burridge_knopoff.periodic_orbits.edge_kind import EdgeKind
from burridge_knopoff.summaries.branch_changes import Change
from burridge_knopoff.summaries.slots import branch_names

TITLE = "Edges of the attractors"
CATEGORY = "Attractors"
INPUTS = ("attractors", "edges")
CAPTION = """\
Above: ⟨J⟩ of periodic orbits against a for each law, in the colours of the branches of attractors that they belong to:
solid where they are stable, dashed where they are not and were followed a little beyond an edge. Grey points: all
attractors. In the middle: the edges, a row for each thing that happens there, in the colour of the branch that begins,
ends or changes; crises and what is undetermined are only known to lie in a range of a, the width of the bar. Below,
where the study covers it: the road from one period to chaos, enlarged, with the edges as symbols on the orbits and the
stops of all blocks in a period.
"""

# Marker and name of each kind of edge that is located.
MARKS = {
    EdgeKind.GRAZING: ("v", "grazing"),
    EdgeKind.FOLD: ("s", "fold"),
    EdgeKind.FLIP: ("D", "flip"),
    EdgeKind.NEIMARK_SACKER: ("o", "Neimark–Sacker"),
    EdgeKind.PITCHFORK: ("P", "pitchfork"),
}
MARK: Any = {"color": "black", "markersize": 3.6, "markerfacecolor": "white", "markeredgewidth": 0.7}
# Rows of the panels of edges.
ROWS = {
    **{kind: name for kind, (_, name) in MARKS.items()},
    EdgeKind.CRISIS: "crisis",
    EdgeKind.UNDETERMINED: "unknown",
}

#: Ranges of a and ⟨J⟩ of the panels below.
ROAD = ((0.108, 0.182), (0.0412, 0.0488))

# Stretches of stable orbits at least this long in a have their stops beside them there.
NAMED = 0.01


@styled
def draw(attractors: xarray.Dataset, edges: xarray.Dataset) -> Figure:
    """Draw ⟨J⟩ of stable and unstable orbits over the attractors, and below it the edges by kind, for each law."""
    laws = [str(law) for law in attractors["law"].values]
    rows = 2 + _covers_road(attractors, edges)
    heights = [3.0, 1.3, 2.6][:rows]
    figure = Figure(figsize=(page_width(len(laws)), 1.2 + sum(heights)), layout="constrained")
    panels = figure.subplots(rows, len(laws), sharey="row", squeeze=False, height_ratios=heights)
    colors = branch_colors(attractors)
    for number, column in enumerate(panels.T):
        law = attractors.sel(law=laws[number])
        for panel in (column[0], *column[2:]):
            _attractors(panel, law)
            _orbits(panel, edges, number, colors)
        begin_at_zero(column[0])
        show_all(column[0], attractors["a"].values)
        if (law["branch"] < 0).all():
            say_nothing(column[0], "no attractor was found")
        _edges(column[1], edges, number, colors)
        column[1].sharex(column[0])
        column[0].tick_params(labelbottom=False)
        for panel in column[2:]:
            _marks(panel, edges, number)
            _stops(panel, edges, number)
            panel.set(xlim=ROAD[0], ylim=ROAD[1])
        for panel in column[1:]:
            panel.set_xlabel("$a$")
    for panel in (panels[0, 0], *panels[2:, 0]):
        panel.set_ylabel(r"$\langle J\rangle$")
    figure.align_ylabels()
    _legend(figure, edges, colors, branch_names(attractors), rows > 2)
    label_panels(panels.flat, [f"{law} law{end}" for end in ("", ": edges", ": road to chaos")[:rows] for law in laws])
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


def _edges(panel: Axes, edges: xarray.Dataset, law: int, colors: dict[int, str]) -> None:
    """Draw each edge into the row of its kind: a line where it is located, else the range of a in which it lies."""
    a, error, kind = (edges[name].values for name in ("a", "a_error", "kind"))
    # What begins is above the edge, all else below.
    branch = np.where(edges["change"] == Change.BEGINNING, edges["to_branch"], edges["from_branch"])
    for row, one in enumerate(ROWS):
        for k in np.flatnonzero((edges["law"].values == law) & (kind == one)):
            color = colors.get(int(branch[k]), OTHER_COLOR)
            width = 0.0 if one in MARKS else 2.0 * error[k]
            panel.barh(row, width, 0.8, a[k] - 0.5 * width, color=color, edgecolor=color, linewidth=0.6, alpha=0.8)
    panel.set_yticks(range(len(ROWS)), list(ROWS.values()), fontsize=7.0)
    panel.tick_params(axis="y", length=0)
    panel.set_ylim(len(ROWS) - 0.4, -0.6)


def _marks(panel: Axes, edges: xarray.Dataset, law: int) -> None:
    """Draw a symbol at each edge that is located."""
    own, kind = edges["law"].values == law, edges["kind"].values
    a, mean = edges["a"].values, edges["mean_distance"].values
    for one, (marker, _) in MARKS.items():
        chosen = own & (kind == one) & np.isfinite(mean)
        panel.plot(a[chosen], mean[chosen], marker, zorder=3, **MARK)


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


def _legend(figure: Figure, edges: xarray.Dataset, colors: dict[int, str], names: dict[int, str], marked: bool) -> None:
    """Put a legend of what is drawn below all panels; marked : whether there are symbols of edges."""
    drawn = {int(number): colors.get(int(number), OTHER_COLOR) for number in edges["orbit_branch"].values}
    stable = edges["orbit_stable"].values
    located = edges["kind"].values[np.isfinite(edges["mean_distance"].values)]
    orbits: Any = [(1, 1.3, "-", "stable orbits"), (0, 0.7, "--", "unstable orbits")]
    handles = [
        *(
            Line2D([], [], color="#555555", linewidth=width, linestyle=line, label=name)
            for number, width, line, name in orbits
            if number in stable
        ),
        *(
            Line2D([], [], linestyle="", marker=marker, label=name, **MARK)
            for one, (marker, name) in MARKS.items()
            if marked and one in located
        ),
        *(Line2D([], [], color=color, linewidth=1.3, label=name) for name, color in named_colors(drawn, names).items()),
    ]
    legend_below(figure, handles)
