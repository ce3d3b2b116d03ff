"""The basins of attraction in a plane of initial states."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.patheffects import withStroke
from numpy.typing import ArrayLike

from burridge_knopoff.figures.branches import MapPart, map_parts
from burridge_knopoff.figures.model_words import fixed_numbers
from burridge_knopoff.figures.single_panel import draw_panel
from burridge_knopoff.figures.style import COLUMN, PAGE, StyledFigure, label_panels, legend_below, styled

TITLE = "Basins of attraction"
CATEGORY = "Attractors"
INPUTS = ("basins",)
FROM_STUDY = ("marked_states",)
CAPTION = """\
Basins of attraction in the plane of the initial positions U_1(0) and U_N(0) of the end blocks, or, for one block, of
its initial position and velocity. Each pixel has the colour of the branch that its state reaches; branches with the
fewest pixels share a colour. Where the motions of a branch are mirror images of each other, its number has + or −, and
− has a light shade. The study's initial states in this plane are marked with their names.
"""

COLUMNS = 2

# Number of letters of a title for each inch of a panel, of which the axis label takes a part.
LETTERS = 14


@styled
def draw(basins: xarray.Dataset, marked_states: Mapping[str, ArrayLike]) -> Figure:
    """Draw each map in the colours of the branches reached: mirror images in a light shade, undetermined in black.

    marked_states : coordinates, by name, of the initial states in the plane of the maps, shape (2,), or (maps, 2)
        if they differ between maps
    """
    count = basins.sizes["map"]
    columns = COLUMNS if count > COLUMNS else 1
    rows = -(-count // columns)
    figure = StyledFigure(figsize=(PAGE if columns > 1 else COLUMN, 3.2 * rows + 0.5), layout="constrained")
    panels = figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
    parts, marks = map_parts(basins), _marks_inside(basins, marked_states)
    titles = []
    for number, panel in enumerate(panels.flat):
        if number >= count:
            panel.set_axis_off()
            continue
        titles.append(_title(basins.isel(map=number)))
        _map(panel, basins, parts, number)
        for name, points in marks.items():
            _mark(panel, name, points[number], _extent(basins))
        if number < count - columns:
            panel.set_xlabel("")
        else:
            panel.tick_params(labelbottom=True)
        if number % columns:
            panel.set_ylabel("")
    legend_below(
        figure, [Patch(facecolor=part.color, edgecolor="0.3", linewidth=0.4, label=part.name) for part in parts]
    )
    label_panels(list(panels.flat)[:count], titles, LETTERS)
    return figure


def draw_single(basins: xarray.Dataset, marked_states: Mapping[str, ArrayLike], axes: Axes | None = None) -> Figure:
    """Draw a single map as `draw` does, into axes if there are any."""
    if axes is None:
        return draw(basins, marked_states)

    def draw_into(panel: Axes) -> str:
        parts = map_parts(basins)
        _map(panel, basins, parts, 0)
        for part in parts:
            panel.plot([], [], "s", color=part.color, markeredgecolor="0.3", label=part.name)
        for name, points in _marks_inside(basins, marked_states).items():
            _mark(panel, name, points[0], _extent(basins))
        return _title(basins.isel(map=0))

    return draw_panel(draw_into, axes)


def _marks_inside(basins: xarray.Dataset, marked_states: Mapping[str, ArrayLike]) -> dict[str, np.ndarray]:
    """Return the states that lie inside every map, each of shape (maps, 2), by name."""
    marks = {name: np.broadcast_to(points, (basins.sizes["map"], 2)) for name, points in marked_states.items()}
    left, right, bottom, top = _extent(basins)
    low, high = (left, bottom), (right, top)
    return {name: points for name, points in marks.items() if ((points >= low) & (points <= high)).all()}


def _extent(basins: xarray.Dataset) -> tuple[float, float, float, float]:
    rows = "last_range" if "last_position" in basins.dims else "velocity_range"
    return *basins.attrs["first_range"], *basins.attrs[rows]


def _title(basin_map: xarray.Dataset) -> str:
    return ", ".join([f"{basin_map['law'].item()} law", *fixed_numbers(basin_map)])


def _map(panel: Axes, basins: xarray.Dataset, parts: Sequence[MapPart], number: int) -> None:
    """Draw the map of a number, with its axis labels."""
    picture = np.zeros((*basins["branch"].shape[1:], 3))
    for part in parts:
        picture[part.members[number]] = to_rgb(part.color)
    panel.imshow(picture, origin="lower", extent=_extent(basins), interpolation="nearest", aspect="auto")
    panel.set_box_aspect(1.0)
    # The layout takes the place above a panel from its top.
    panel.set_anchor("N")
    blocks = np.size(basins.attrs["plane_position"])
    panel.set(xlabel="$U_1(0)$", ylabel=f"$U_{{{blocks}}}(0)$" if blocks > 1 else "$U_1'(0)$")


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
