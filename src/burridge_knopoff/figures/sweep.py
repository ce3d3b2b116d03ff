"""⟨J⟩ of many runs: curves over one parameter, maps over two."""

from __future__ import annotations

from itertools import product
from typing import Any

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import AutoLocator

from burridge_knopoff.figures import grid_distance
from burridge_knopoff.figures.mean_distance import draw_runs
from burridge_knopoff.figures.model_words import constant, fixed_numbers, symbol
from burridge_knopoff.figures.palette import dashes, law_color, law_symbol, state_symbol
from burridge_knopoff.figures.parameter_panels import draw_map, panel_parts, varied_parameters
from burridge_knopoff.figures.single_panel import draw_panel
from burridge_knopoff.figures.strips import show_all
from burridge_knopoff.figures.style import SideBySide, begin_at_zero, say

LABEL = r"$\langle J\rangle$"

# Size of the symbols of the first law, and by how much those of every further law are larger.
SYMBOL, GROWTH = 2.6, 2.0


def draw(runs: xarray.Dataset, axes: Axes | None = None) -> Figure:
    """Draw ⟨J⟩ with three standard errors over one parameter, or as maps over two in panels for all further values.

    runs : with `mean_distance` and its error over the parameters, and over `law` and `initial` if they vary

    Raises ValueError, one line, if there are axes for a picture of several panels.
    """
    grid = _grid(runs)
    if len(varied_parameters(grid)) < 2:
        return draw_panel(lambda panel: _curves(panel, grid), axes)
    if axes is None:
        return grid_distance.draw(grid)
    (title, part), *others = panel_parts(grid)
    if others:
        raise ValueError(
            f"axes: got axes for {1 + len(others)} maps, expected None, or one law, state and two parameters"
        )
    return draw_panel(lambda panel: _map(panel, part, title), axes)


def _grid(runs: xarray.Dataset) -> xarray.Dataset:
    """Return the runs over law, initial state and at least one parameter, with ascending values."""
    for name in ("initial", "law"):
        if name not in runs.dims:
            runs = runs.assign_coords({name: constant(runs, name).item()}).expand_dims(name)
    if runs["mean_distance"].ndim == 2:
        runs = runs.expand_dims("a", 2)
    return runs.sortby([name for name in runs["mean_distance"].dims if name not in ("law", "initial")])


def _curves(panel: Axes, grid: xarray.Dataset) -> str:
    """Draw a curve for each law and initial state, and return the title."""
    (parameter,), laws, states = varied_parameters(grid), grid["law"].values, grid["initial"].values
    for (n, law), (k, state) in product(enumerate(laws), enumerate(states)):
        run = grid.sel(law=law, initial=state).squeeze(drop=False)
        draw_runs(panel, run if parameter in run.dims else run.expand_dims(parameter), parameter, **_look(n, k, grid))
    many: Any = {"law": len(laws) > 1, "initial": len(states) > 1}
    for n, law in enumerate(laws if many["law"] else ()):
        panel.plot([], [], **_look(n, 0, grid) | ({"marker": ""} if many["initial"] else {}), label=f"{law} law")
    for k, state in enumerate(states if many["initial"] else ()):
        symbols = [
            Line2D([], [], **_look(n, k, grid) | ({"linestyle": ""} if many["law"] else {})) for n in range(len(laws))
        ]
        panel.add_container(SideBySide(symbols, label=f"from {state}"))
    panel.set(xlabel=f"${symbol(parameter)}$", ylabel=LABEL)
    _scale_to(panel, grid[parameter].values)
    if np.isfinite(grid["mean_distance"].values).any():
        begin_at_zero(panel)
        panel.set_ylim(bottom=min(panel.get_ylim()[0], 1.1 * panel.dataLim.y0))
        panel.errorbar([], [], [], fmt="none", ecolor="0.3", elinewidth=0.5, label="three standard errors")
    else:
        say(panel, "no run completed")
    return _title(grid, parameter)


def _scale_to(panel: Axes, values: np.ndarray) -> None:
    """Scale the horizontal axis to values of the parameter, and those of earlier pictures in the same axes."""
    ends = panel.dataLim.intervalx
    places = np.unique([*values, *ends[np.isfinite(ends)]])
    show_all(panel, places)
    if len(places) > 1 and len(panel.get_xticks()) == 1:
        panel.xaxis.set_major_locator(AutoLocator())


def _look(law: int, state: int, grid: xarray.Dataset) -> dict[str, Any]:
    """Return the look of the runs of a law from a state, by their numbers: a law has a shade, a state a symbol."""
    if grid.sizes["initial"] == 1:
        look = law_symbol(law, SYMBOL)
    else:
        look = state_symbol(state, SYMBOL + GROWTH * law) | {"color": law_color(law)}
        # Those of the first law, on top, must not hide them.
        look |= {"markerfacecolor": "none", "markeredgewidth": 0.5} if law else {}
    return look | {"linestyle": dashes(law), "linewidth": 0.5, "zorder": 3 - 0.1 * law}


def _map(panel: Axes, part: xarray.Dataset, title: str) -> str:
    """Draw a map with its colours, and return its title."""
    values = part["mean_distance"].values
    varied = varied_parameters(part)
    highest = np.nanmax(values, initial=0.0) or 1.0
    drawn = draw_map(panel, part, varied, lambda runs: runs["mean_distance"].values, vmin=0.0, vmax=highest)
    panel.set(xlabel=f"${symbol(varied[0])}$", ylabel=f"${symbol(varied[1])}$")
    panel.figure.colorbar(drawn, ax=panel, label=LABEL)
    return title


def _title(grid: xarray.Dataset, parameter: str) -> str:
    """Return what is the same for all runs: the law, the initial state, a, and the numbers that are not the paper's."""
    words = [f"{grid['law'].item()} law"] if grid.sizes["law"] == 1 else []
    words += [f"from {grid['initial'].item()}"] if grid.sizes["initial"] == 1 else []
    return ", ".join([*words, *fixed_numbers(grid, [parameter])])
