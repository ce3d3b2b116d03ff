"""A picture of a result, whatever function returned it."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from burridge_knopoff.attractors.attractor import Attractor
from burridge_knopoff.basins.edge_state import EdgeState
from burridge_knopoff.library.catalogue import Catalogue
from burridge_knopoff.library.run import Run
from burridge_knopoff.messages import refusal
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.periodic_orbits.bifurcation_curve import BifurcationCurve
from burridge_knopoff.periodic_orbits.bifurcations import Bifurcation
from burridge_knopoff.periodic_orbits.branch import Branch
from burridge_knopoff.periodic_orbits.periodic import PeriodicOrbit
from burridge_knopoff.periodic_orbits.pseudo_arclength import BranchOrbit
from burridge_knopoff.values import each_instance_of

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

#: What can be drawn, in words.
DRAWN = (
    "a Run, Catalogue, PeriodicOrbit, BifurcationCurve or EdgeState, a Dataset or file of runs, maps or attractors, "
    "or what basin_map, find_attractors or follow returns"
)


def plot(result: Any, axes: Axes | None = None) -> Figure:
    """Return a figure of a result, drawn like the figures of a study.

    result : one of
        a `Run`: J(τ) and the velocities U_i'(τ); its `to_dataset()`, or a point of a study, also the section W = 0
        a `Catalogue`: slips in space and time, recurrence, rates, extents and intervals
        the Dataset of `sweep`: ⟨J⟩ with three standard errors over one parameter, a map over two, panels for more
        what `basin_map` returns, or its first Dataset alone: the basins, with the paper's initial states that lie in
            the plane
        the Dataset of `continue_attractors`, the second of `basin_map`, or `attractors.nc` of a study: ⟨J⟩ and the
            basin fraction of each branch, and the ranges in which a branch begins or ends
        what `find_attractors` returns, or the list alone, and an `EdgeState`: positions x_1 and x_N at the returns, the
            stops of one block
        a `PeriodicOrbit`: U_i'(τ) in a period, and U_i' versus U_i − vτ
        the `Branch` that `follow` returns, or a list of its `BranchOrbit`s, or (either, its `Bifurcation`s): ⟨J⟩ along
            the parameter, solid where the orbit is stable; the period T if all orbits are synchronized
        a `BifurcationCurve`: the curve over its two parameters
        a file of a study in place of a Dataset: what `open_study` gives for its path
    axes : matplotlib axes to draw into, for a picture of one panel, such as those of an earlier picture

    Titles name a and the parameters that are not the paper's. All quantities are dimensionless, see `Model`. The figure
    has vector lines; `figure.savefig` writes it. matplotlib is imported by the first picture. Raises ValueError, one
    line, for anything else, and for axes where the picture has several panels.

    >>> from burridge_knopoff import Model, plot, sweep
    >>> runs = sweep(Model("linearized"), "plus", a=[0.05, 0.1, 0.15], transient=1000, window=500)
    >>> (panel,) = plot(runs).axes
    >>> panel.get_xlabel(), len(panel.lines) > 0
    ('$a$', True)
    """
    # Imported here so that matplotlib is loaded only for a picture.
    from matplotlib.axes import Axes

    if axes is not None and not isinstance(axes, Axes):
        raise refusal("axes", axes, "matplotlib axes")
    return _drawing(result)(axes)


def _drawing(result: Any) -> Callable[[Axes | None], Figure]:
    """Return the function that draws a result into axes, or into a new figure; raises ValueError for anything else."""
    import xarray

    from burridge_knopoff.figures import attractor_returns, branch_orbits, periodic_orbit

    first, second = map(_dataset, result if isinstance(result, tuple) and len(result) == 2 else (result, None))
    if isinstance(first, xarray.Dataset) and (second is None or isinstance(second, xarray.Dataset)):
        if drawing := _dataset_drawing(first, second):
            return drawing
    elif isinstance(result, Run | Catalogue):
        return _without_axes(result.plot)
    elif isinstance(result, PeriodicOrbit):
        return _without_axes(partial(periodic_orbit.draw, result))
    elif isinstance(result, BifurcationCurve):
        return partial(branch_orbits.draw_curve, result)
    elif isinstance(result, EdgeState):
        return partial(attractor_returns.draw_edge, result)
    elif _each(first, BranchOrbit):
        located = [] if second is None else [*second] if isinstance(second, Iterable) else [second]
        return partial(branch_orbits.draw, first, each_instance_of(located, Bifurcation, "result[1]"))
    elif _each(first, Attractor) or (isinstance(first, list) and not first and isinstance(second, np.ndarray)):
        return partial(attractor_returns.draw, first, second)
    raise refusal("result", result, DRAWN)


def _dataset(result: Any) -> Any:
    """Return the Dataset of a tree without children, as `open_study` returns a file; any other value as it is."""
    import xarray

    return result.to_dataset() if isinstance(result, xarray.DataTree) and not result.children else result


def _dataset_drawing(data: xarray.Dataset, attractors: xarray.Dataset | None) -> Callable[[Axes | None], Figure] | None:
    """Return the function that draws a Dataset, a map with its attractors if they are there; None for another one."""
    from burridge_knopoff.figures import basins, coexisting_attractors, motion, sweep

    if "first_position" in data.dims and "branch" in data:
        maps = data if "map" in data.dims else data.expand_dims("map")
        if maps.sizes["map"] > 1:
            return _without_axes(partial(basins.draw, maps, {}))
        return partial(basins.draw_single, maps, _paper_states(maps))
    if attractors is not None:
        return None
    if {"branch", "basin_count"} <= {*data}:
        return _without_axes(partial(coexisting_attractors.draw, data))
    if {"crossing", "trajectory_time"} <= {*data.dims}:
        return _without_axes(partial(motion.draw, {"": data}))
    if {"mean_distance", "mean_distance_error"} <= {*data}:
        return partial(sweep.draw, data)
    return None


def _each(values: Any, kind: type) -> bool:
    """Return whether a value is a list, or a branch, of at least one object, all of a class."""
    return isinstance(values, list | Branch) and bool(values) and all(isinstance(value, kind) for value in values)


def _without_axes(draw: Callable[[], Figure]) -> Callable[[Axes | None], Figure]:
    """Return a function that draws a picture of several panels, and refuses axes."""

    def drawn(axes: Axes | None) -> Figure:
        if axes is not None:
            raise ValueError("axes: got axes, expected None for a picture of several panels")
        return draw()

    return drawn


def _paper_states(basins: xarray.Dataset) -> dict[str, np.ndarray]:
    """Return U_1(0) and U_N(0) of the paper's initial states that lie in the plane of a map, by name."""
    if "last_position" not in basins.dims:
        return {}
    position, velocity = (basins.attrs[f"plane_{name}"] for name in ("position", "velocity"))
    states = {name: state.coordinates(3) for name, state in PAPER_STATES.items()}
    return {
        name: u[[0, -1]]
        for name, (u, w) in states.items()
        if np.array_equal(u[1:-1], position[1:-1]) and np.array_equal(w, velocity)
    }
