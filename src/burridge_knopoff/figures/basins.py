"""The basins of attraction in a plane of initial states."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.patheffects import withStroke
from numpy.typing import ArrayLike

from burridge_knopoff.attractors.lookup import branch_names
from burridge_knopoff.figures.branches import map_colors, map_parts
from burridge_knopoff.figures.style import COLUMN, PAGE, label_panels, legend_below, styled

TITLE = "Basins of attraction"
CATEGORY = "Attractors"
INPUTS = ("basins", "attractors")
FROM_STUDY = ("marked_states",)
CAPTION = """\
Basins of attraction in the plane of the initial positions U_1(0) and U_N(0) of the end blocks. Each pixel has the
colour of the branch that its state reaches. Where the motions of a branch are mirror images of each other, its number
has + or −, and − has a lighter shade. The study's initial states in this plane are marked with their names.
"""

COLUMNS = 2


@styled
def draw(basins: xarray.Dataset, attractors: xarray.Dataset, marked_states: Mapping[str, ArrayLike]) -> Figure:
    """Draw each map in the colours of the branches reached: mirror images in a lighter shade, undetermined in black.

    marked_states : U_1(0) and U_N(0), by name, of the initial states in the plane of the maps, shape (2,), or (maps, 2)
        if they differ between maps
    """
    count = basins.sizes["map"]
    columns = min(COLUMNS, count)
    rows = -(-count // columns)
    figure = Figure(figsize=(PAGE if columns > 1 else COLUMN, 3.2 * rows + 0.5), layout="constrained")
    panels = figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
    colors = map_colors(attractors, np.unique(basins["branch"]).tolist())
    names = branch_names(attractors)
    extent = (*basins.attrs["first_range"], *basins.attrs["last_range"])
    marks = {name: np.broadcast_to(points, (count, 2)) for name, points in marked_states.items()}
    there = {
        name: points
        for name, points in marks.items()
        if all(extent[0] <= x <= extent[1] and extent[2] <= y <= extent[3] for x, y in points)
    }
    titles = []
    patches: dict[tuple[int, int], Patch] = {}
    for number, panel in enumerate(panels.flat):
        if number >= count:
            panel.set_axis_off()
            continue
        basin_map = basins.isel(map=number)
        titles.append(f"{basin_map['law'].item()} law, $a={basin_map['a'].item():g}$")
        picture = np.zeros((*basin_map["branch"].shape, 3))
        for part in map_parts(basin_map, colors, names):
            picture[part.members] = to_rgb(part.color)
            patches[part.branch, -part.side] = Patch(
                facecolor=part.color, edgecolor="0.3", linewidth=0.4, label=part.name
            )
        panel.imshow(picture, origin="lower", extent=extent, interpolation="nearest", aspect="auto")
        panel.set_box_aspect(1.0)
        for name, points in there.items():
            _mark(panel, name, points[number], extent)
        if number >= count - columns:
            panel.set_xlabel("$U_1(0)$")
            panel.tick_params(labelbottom=True)
        if number % columns == 0:
            panel.set_ylabel(f"$U_{{{basins.attrs['plane_position'].size}}}(0)$")
    legend_below(figure, [patches[key] for key in sorted(patches, key=lambda key: (key[0] < 0, *key))])
    label_panels(list(panels.flat)[:count], titles)
    return figure


def _mark(panel: Axes, name: str, point: np.ndarray, extent: tuple[float, ...]) -> None:
    """Mark an initial state with a point and its name, on the side of the point that has more room."""
    x, y = point.tolist()
    is_left = x > 0.5 * (extent[0] + extent[1])
    panel.plot(x, y, "o", markersize=4.5, markerfacecolor="white", markeredgecolor="black", markeredgewidth=0.8)
    text = panel.annotate(
        name,
        (x, y),
        (-5 if is_left else 5, 0),
        textcoords="offset points",
        ha="right" if is_left else "left",
        va="center",
        fontsize=8.0,
    )
    text.set_path_effects([withStroke(linewidth=2.0, foreground="white")])
