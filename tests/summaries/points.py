"""Point files of a grid, original or altered."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import xarray

from burridge_knopoff.dataset.point import write_point
from burridge_knopoff.motion.settings import MotionSettings
from burridge_knopoff.running.simulation import run
from burridge_knopoff.running.trajectory import Trajectory
from burridge_knopoff.summaries import lyapunov, mean_distance, runs
from burridge_knopoff.summaries.points import Grid


def write_points(grid: Grid, alter: Callable[[Trajectory], Trajectory] = lambda trajectory: trajectory) -> Grid:
    """Run the points of a grid, write them after an alteration, and return the grid."""
    for _, (law, initial, *names) in grid:
        if law in grid.settings:
            values = {key: named[name] for (key, named), name in zip(grid.parameters.items(), names, strict=True)}
            trajectory = run(grid.model(law, **values), grid.initial[initial], grid.settings[law])
            write_point(alter(trajectory), grid.path(law, initial, *names))
    return grid


def scalars(grid: Grid, motion: MotionSettings | None = None) -> xarray.Dataset:
    """Return the scalars of the points of a grid."""
    motion = motion or MotionSettings()
    return runs.summarize(grid, motion.period_tolerance, motion.longest_period)


def kinds(grid: Grid, motion: Mapping[str, Any] | None = None, threshold: float = 1e-6) -> xarray.Dataset:
    """Return the Lyapunov exponents and kinds of motion of the points of a grid."""
    settings = MotionSettings(**{**(motion or {}), "synchronization_threshold": threshold, "section": grid.section})
    return lyapunov.summarize(scalars(grid, settings), settings)


def means(grid: Grid, threshold: float = 1e-6) -> xarray.Dataset:
    """Return the mean distances of the points of a grid."""
    return mean_distance.summarize(scalars(grid), threshold)
