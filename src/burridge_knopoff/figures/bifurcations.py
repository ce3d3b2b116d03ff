"""The bifurcations of the branches of attractors, on ⟨J⟩ of periodic orbits versus a."""

from __future__ import annotations

from operator import attrgetter
from typing import Any

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.transforms import blended_transform_factory

from burridge_knopoff.attractors.lookup import branch_names
from burridge_knopoff.continuation.branch_changes import Change
from burridge_knopoff.figures.branches import branch_colors, named_colors
from burridge_knopoff.figures.palette import OTHER_BRANCHES, pale
from burridge_knopoff.figures.strips import cells, show_all
from burridge_knopoff.figures.style import (
    begin_at_zero,
    label_panels,
    legend_below,
    legend_inside,
    page_width,
    say_nothing,
    styled,
)
from burridge_knopoff.periodic_orbits.bifurcation_kind import BifurcationKind

TITLE = "Bifurcations of the attractors"
CATEGORY = "Attractors"
INPUTS = ("attractors", "bifurcations")
CAPTION = """\
Top: ⟨J⟩ of periodic orbits versus a for each law, in the colour of their branch of attractors: solid where stable,
dashed where unstable and continued a little beyond a bifurcation. Pale points: all attractors. Branches that the fewest
states reach, over all a, share a colour. Below: the number of bifurcations at which branches begin, end or change, in
fifteen parts of the range of a, a row for each type. Crises and undetermined changes count in the middle of the range
in which they lie.
"""

MARK: Any = {"color": "black", "markersize": 3.6, "markerfacecolor": "white", "markeredgewidth": 0.7}
#: Look of the curves of stable and of unstable orbits.
ORBITS: dict[bool, Any] = {True: {"linewidth": 1.3, "linestyle": "-"}, False: {"linewidth": 0.7, "linestyle": "--"}}
#: Rows of the middle panels: what is not known comes last. Hopf bifurcations have a row if there are any.
ROWS = sorted(BifurcationKind, key=lambda kind: kind < 0)

#: Number of parts of the range of a in which bifurcations are counted.
BINS = 15

#: Ranges of a and ⟨J⟩ in the lower panels.
ROUTE = ((0.108, 0.182), (0.0412, 0.0488))

# Stable orbits that extend at least this far in a are labelled with their stops there.
NAMED = 0.01


@styled
def draw(attractors: xarray.Dataset, bifurcations: xarray.Dataset) -> Figure:
    """Draw ⟨J⟩ of stable and unstable orbits over the attractors, and count the bifurcations by type, for each law."""
    laws = [str(law) for law in attractors["law"].values]
    rows = 2 + _covers_route(attractors, bifurcations)
    heights = [3.0, 1.3, 2.6][:rows]
    figure = Figure(figsize=(page_width(len(laws)), 0.9 + sum(heights)), layout="constrained")
    panels = figure.subplots(rows, len(laws), sharey="row", squeeze=False, height_ratios=heights)
    colors = branch_colors(attractors)
    for number, column in enumerate(panels.T):
        law = attractors.sel(law=laws[number])
        for panel in (column[0], *column[2:]):
            _attractors(panel, law, colors)
            _orbits(panel, bifurcations, laws[number], colors)
        begin_at_zero(column[0])
        show_all(column[0], attractors["a"].values)
        if (law["branch"] < 0).all():
            say_nothing(column[0], "no attractor was found")
        elif number == 0:
            legend_inside(column[0], orbit_handles(bifurcations["orbit_stable"].values == 1))
        of_law = bifurcations.isel(bifurcation=bifurcations["law"].values == laws[number])
        _counts(column[1], attractors["a"].values, of_law, is_first=number == 0)
        column[1].sharex(column[0])
        column[0].tick_params(labelbottom=False)
        for panel in column[2:]:
            _marks(panel, bifurcations, laws[number])
            _stops(panel, bifurcations, laws[number])
            panel.set(xlim=ROUTE[0], ylim=ROUTE[1])
            words = "symbols: bifurcations\nnumbers: stops of each\nblock in a period"
            panel.text(0.03, 0.96, words, va="top", fontsize=7.5, transform=panel.transAxes)
        for panel in column[1:]:
            panel.set_xlabel("$a$")
    for panel in (panels[0, 0], *panels[2:, 0]):
        panel.set_ylabel(r"$\langle J\rangle$")
    figure.align_ylabels(panels[::2, 0])
    _legend(figure, attractors, bifurcations, colors)
    contents = ("", ": number of bifurcations", ": route from period one to chaos")
    label_panels(panels.flat, [f"{law} law{content}" for content in contents[:rows] for law in laws])
    return figure


def _covers_route(attractors: xarray.Dataset, bifurcations: xarray.Dataset) -> bool:
    """Return whether the values of a reach beyond the route to chaos, and orbits of every law lie on it."""
    a, mean, law = (bifurcations[f"orbit_{name}"].values for name in ("a", "mean_distance", "law"))
    inside = (a > ROUTE[0][0]) & (a < ROUTE[0][1]) & (mean > ROUTE[1][0]) & (mean < ROUTE[1][1])
    return bool(attractors["a"].values[-1] >= ROUTE[0][1] and len(np.unique(law[inside])) == attractors.sizes["law"])


def _attractors(panel: Axes, attractors: xarray.Dataset, colors: dict[int, str]) -> None:
    branch = attractors["branch"].values
    for number in np.unique(branch[branch >= 0]).tolist():
        there = branch == number
        a = np.broadcast_to(attractors["a"].values[:, None], there.shape)[there]
        hue = pale(colors[number])
        panel.plot(a, attractors["mean_distance"].values[there], ".", color=hue, markersize=3.0, zorder=0)


def _orbits(panel: Axes, bifurcations: xarray.Dataset, law: str, colors: dict[int, str]) -> None:
    mask = bifurcations["orbit_law"].values == law
    number, branch = bifurcations["orbit_segment"].values, bifurcations["orbit_branch"].values
    a, mean, stable = (bifurcations[f"orbit_{name}"].values for name in ("a", "mean_distance", "stable"))
    for segment in np.unique(number[mask]):
        chosen = np.flatnonzero(mask & (number == segment))
        draw_branch(panel, a[chosen], mean[chosen], stable[chosen], colors.get(int(branch[chosen[0]]), OTHER_BRANCHES))


def draw_branch(panel: Axes, a: np.ndarray, values: np.ndarray, stable: np.ndarray, color: str) -> None:
    """Draw a quantity along one branch of orbits, solid where they are stable, dashed elsewhere."""
    ends = np.flatnonzero(np.diff(stable)) + 1
    for first, last in zip([0, *ends], [*ends, len(a)], strict=True):
        # An unstable piece is drawn from the stable orbit before it to the stable orbit after it.
        piece = slice(first, last) if stable[first] else slice(max(first - 1, 0), last + 1)
        panel.plot(a[piece], values[piece], color=color, zorder=1, **ORBITS[bool(stable[first])])


def _counts(panel: Axes, a: np.ndarray, bifurcations: xarray.Dataset, *, is_first: bool) -> None:
    """Write how many bifurcations of each type lie in each of BINS equal parts of the range of a, shaded by number.

    a : values of the study, ascending
    is_first : whether it is the first panel of its row, which has the symbols next to the names of the types
    """
    kind = bifurcations["kind"].values
    rows = [row for row in ROWS if row != BifurcationKind.HOPF or row in kind]
    low, high = a[[0, -1]] if len(a) > 1 else cells(a)
    edges = np.linspace(low, high, BINS + 1)
    counts = np.array([np.histogram(bifurcations["a"].values[kind == row], edges)[0] for row in rows])
    # The darkest shade leaves the numbers legible.
    shade = np.sqrt(counts / max(1, counts.max()))
    panel.pcolormesh(edges, np.arange(len(rows) + 1) - 0.5, shade, cmap="Greys", vmin=0.0, vmax=2.0)
    for row, bin_number in np.argwhere(counts).tolist():
        middle = 0.5 * (edges[bin_number] + edges[bin_number + 1])
        words = f"{counts[row, bin_number]}"
        panel.text(middle, row, words, ha="center", va="center_baseline", fontsize=6.5, clip_on=True)
    panel.set_yticks(range(len(rows)), [bifurcation.words for bifurcation in rows], fontsize=7.0)
    panel.tick_params(axis="y", length=0, pad=11)
    panel.tick_params(axis="x", direction="out", top=False)
    if is_first:
        outside = blended_transform_factory(panel.transAxes, panel.transData)
        for row, bifurcation in enumerate(rows):
            panel.plot(-0.022, row, bifurcation.mark or "None", transform=outside, clip_on=False, **MARK)
    panel.set_ylim(len(rows) - 0.5, -0.5)


def _branch(bifurcations: xarray.Dataset) -> np.ndarray:
    """Return the branch that begins, ends or changes at each bifurcation."""
    begins = bifurcations["change"] == Change.BEGINNING
    return np.where(begins, bifurcations["to_branch"], bifurcations["from_branch"])


def _marks(panel: Axes, bifurcations: xarray.Dataset, law: str) -> None:
    """Draw a symbol at each located bifurcation of the branches that are curves: of more than one orbit."""
    orbits, count = np.unique(
        bifurcations["orbit_branch"].values[bifurcations["orbit_law"].values == law], return_counts=True
    )
    kind = bifurcations["kind"].values
    mask = (bifurcations["law"].values == law) & np.isin(_branch(bifurcations), orbits[count > 1])
    draw_marks(panel, bifurcations["a"].values[mask], bifurcations["mean_distance"].values[mask], kind[mask])


def draw_marks(panel: Axes, a: np.ndarray, values: np.ndarray, kind: np.ndarray) -> None:
    """Draw the symbol of its kind at each located bifurcation."""
    for bifurcation in filter(attrgetter("mark"), BifurcationKind):
        chosen = (kind == bifurcation) & np.isfinite(values)
        panel.plot(a[chosen], values[chosen], bifurcation.mark, zorder=3, **MARK)


def _stops(panel: Axes, bifurcations: xarray.Dataset, law: str) -> None:
    """Write the number of stops of each block in a period next to the longer pieces of stable orbits."""
    mask = (bifurcations["orbit_law"].values == law) & (bifurcations["orbit_stable"].values == 1)
    number, a, mean = (bifurcations[f"orbit_{name}"].values for name in ("segment", "a", "mean_distance"))
    for segment in np.unique(number[mask]):
        chosen = np.flatnonzero(mask & (number == segment))
        inside = chosen[(mean[chosen] > ROUTE[1][0]) & (mean[chosen] < ROUTE[1][1]) & (a[chosen] > ROUTE[0][0])]
        inside = inside[a[inside] < ROUTE[0][1]]
        if not len(inside) or np.ptp(a[inside]) < NAMED:
            continue
        middle = inside[np.abs(a[inside] - a[inside].mean()).argmin()]
        stops = ", ".join(str(count) for count in bifurcations["orbit_stops"].values[middle])
        panel.annotate(stops, (a[middle], mean[middle]), (6, -9), textcoords="offset points", ha="left", fontsize=7.5)


def _legend(figure: Figure, attractors: xarray.Dataset, bifurcations: xarray.Dataset, colors: dict[int, str]) -> None:
    numbers = np.unique([*attractors["branch"].values.ravel(), *bifurcations["orbit_branch"].values])
    drawn = {number: colors.get(number, OTHER_BRANCHES) for number in numbers[numbers >= 0].tolist()}
    names = named_colors(drawn, branch_names(attractors))
    legend_below(figure, [Line2D([], [], color=color, linewidth=1.3, label=name) for name, color in names.items()])


def orbit_handles(stable: np.ndarray) -> list[Line2D]:
    """Return the legend entries of stable and unstable orbits, if there are any."""
    return [
        Line2D([], [], color="black", label=f"{'' if is_stable else 'un'}stable orbits", **look)
        for is_stable, look in ORBITS.items()
        if (stable == is_stable).any()
    ]
