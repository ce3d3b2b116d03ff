"""Panels of a study over several parameters: a map over two of them, or a curve over one."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import product
from typing import Any

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.collections import QuadMesh
from matplotlib.figure import Figure
from matplotlib.ticker import NullLocator

from burridge_knopoff.figures.model_words import fixed_numbers, parameter_words, symbol
from burridge_knopoff.figures.strips import map_cells, show_all
from burridge_knopoff.figures.style import ACROSS, COLUMN, PAGE, even_indices, label_panels, new_figure

#: Most values of each further parameter that have panels.
MOST = 6

# Most ticks of a logarithmic axis.
TICKS = 6

#: Number of letters of a title for each inch of a panel with its share of the numbers and colours beside it.
LETTERS = 14


def draw_panels(
    grid: xarray.Dataset,
    label: str,
    curve: Callable[[Axes, np.ndarray, xarray.Dataset], object],
    colors: Callable[[xarray.Dataset], np.ndarray],
    **look: Any,
) -> tuple[Figure, list[Axes], QuadMesh | None]:
    """Draw a panel for each law, initial state and value of further parameters; return figure, panels and the last map.

    The first two parameters with several values are the axes of a map, which is logarithmic along a parameter whose
    values are about in geometric progression; a single one is the axis of a curve. Of further parameters at most MOST
    values are shown, which are evenly spaced in the list of all.

    label : of the vertical axis of a curve
    curve : draws one panel, from the values of the parameter and the Dataset over it
    colors : values or colours of a map, of a Dataset over two parameters, shape (second, first, …)
    look : arguments of `pcolormesh`
    """
    varied, parts = varied_parameters(grid), list(panel_parts(grid))
    across = panels_across(len(parts), len(parts) // grid.sizes["law"])
    down = -(-len(parts) // across)
    size = COLUMN if across == 1 else PAGE, 0.6 + (2.3 if across < ACROSS else 2.0) * down
    empty = range(len(parts), down * across)
    figure, panels = new_figure(*size, down, across, share_columns=False, empty=empty)
    first, drawn = grid[varied[0]].values, None
    for number, (panel, (_, part)) in enumerate(zip(panels, parts, strict=True)):
        panel.set_xlabel(f"${symbol(varied[0])}$")
        if len(varied) > 1:
            drawn = draw_map(panel, part, varied, colors, **look)
        else:
            show_all(panel, first)
            curve(panel, first, part)
        if number % across == 0:
            panel.set_ylabel(f"${symbol(varied[1])}$" if len(varied) > 1 else label)
    label_panels(panels, [title for title, _ in parts], LETTERS)
    return figure, panels, drawn


def draw_map(
    panel: Axes,
    part: xarray.Dataset,
    varied: Sequence[str],
    colors: Callable[[xarray.Dataset], np.ndarray],
    **look: Any,
) -> QuadMesh:
    """Draw a map over the first two of the parameters; other arguments are those of `draw_panels`."""
    first, second = varied[:2]
    edges = [_edges(part[name].values) for name in (first, second)]
    drawn = panel.pcolormesh(*edges, colors(part.transpose(second, first, ...)), rasterized=True, **look)
    if is_geometric(part[first].values):
        panel.set_xscale("log")
        _set_ticks(panel.xaxis, part[first].values)
    if is_geometric(part[second].values):
        panel.set_yscale("log")
        _set_ticks(panel.yaxis, part[second].values)
    panel.set(xlim=edges[0][[0, -1]], ylim=edges[1][[0, -1]])
    return drawn


def is_geometric(values: np.ndarray) -> bool:
    """Return whether the ratios of ascending values vary less than their differences."""
    if len(values) < 3 or values[0] <= 0.0:
        return False
    steps, ratios = np.diff(values), np.diff(np.log(values))
    return bool(np.ptp(ratios) / ratios.mean() < np.ptp(steps) / steps.mean() - 1e-9)


def _edges(values: np.ndarray) -> np.ndarray:
    return np.exp(map_cells(np.log(values))) if is_geometric(values) else map_cells(values)


def _set_ticks(axis: Axis, values: np.ndarray) -> None:
    shown = values[even_indices(len(values), TICKS)]
    axis.set_minor_locator(NullLocator())
    axis.set_ticks(shown, [f"{value:g}" for value in shown])


def panels_across(count: int, of_law: int) -> int:
    """Return how many panels are side by side: those of a law if they fit, else as many as leave no panel alone.

    Two panels stand one above the other, in the width of a journal column.

    count, of_law : numbers of all panels and of those of one law
    """
    if count <= 2:
        return 1
    if 1 < of_law <= ACROSS or count <= ACROSS:
        return min(of_law if of_law > 1 else count, ACROSS)
    return 2 if count % ACROSS and not count % 2 else ACROSS


def _parameters(grid: xarray.Dataset) -> list[str]:
    return [f"{name}" for name in grid["mean_distance"].dims if name not in ("law", "initial")]


def varied_parameters(grid: xarray.Dataset) -> list[str]:
    """Return the parameters with several values, of which the first two are the axes of panels; at least one."""
    parameters = _parameters(grid)
    return [name for name in parameters if grid.sizes[name] > 1] or parameters[:1]


def panel_parts(grid: xarray.Dataset) -> Iterator[tuple[str, xarray.Dataset]]:
    """Yield the title of each panel, with formulas between dollar signs, and its part of the Dataset."""
    further = [name for name in _parameters(grid) if name not in varied_parameters(grid)[:2]]
    chosen = [even_indices(grid.sizes[name], MOST) for name in further]
    fixed = fixed_numbers(grid, varied_parameters(grid))
    for law, initial in product(grid["law"].values, grid["initial"].values):
        for places in product(*chosen):
            part = grid.sel(law=law, initial=initial).isel(dict(zip(further, places, strict=True)))
            values = [parameter_words(name, part[name].item()) for name in further if grid.sizes[name] > 1]
            yield ", ".join([f"{law} law, {initial}", *values, *fixed]), part
