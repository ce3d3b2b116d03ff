"""Point files of a grid, original or altered."""

from __future__ import annotations

from collections.abc import Callable

from burridge_knopoff.dataset.point import write_point
from burridge_knopoff.running.simulation import run
from burridge_knopoff.running.trajectory import Trajectory
from burridge_knopoff.summaries.points import Grid


def write_points(grid: Grid, alter: Callable[[Trajectory], Trajectory] = lambda trajectory: trajectory) -> Grid:
    """Run the points of a grid, write them after an alteration, and return the grid."""
    for _, (law, initial, *names) in grid:
        if law in grid.settings:
            values = {key: named[name] for (key, named), name in zip(grid.parameters.items(), names, strict=True)}
            trajectory = run(grid.model(law, **values), grid.initial[initial], grid.settings[law])
            write_point(alter(trajectory), grid.path(law, initial, *names))
    return grid
