"""Point files of a study, original or altered."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import xarray

from burridge_knopoff.dataset.point import write_point
from burridge_knopoff.motion.settings import MotionSettings
from burridge_knopoff.running.simulation import run
from burridge_knopoff.running.trajectory import Trajectory
from burridge_knopoff.study.study import Study, all_points
from burridge_knopoff.summaries import lyapunov, mean_distance, runs


def write_points(
    study: Study, results: Path, alter: Callable[[Trajectory], Trajectory] = lambda trajectory: trajectory
) -> tuple[Study, Path]:
    """Run the points of a study, write them after an alteration, and return the study and the folder of its results."""
    for point in all_points(study):
        write_point(alter(run(*study.run_of(**point))), results / study.run_file(**point))
    return study, results


def scalars(study: Study, results: Path, motion: MotionSettings | None = None) -> xarray.Dataset:
    """Return the scalars of the points of a study."""
    motion = motion or MotionSettings()
    names = ("period_tolerance", "longest_period", "synchronization_threshold")
    return runs.summarize(study, results, **{name: getattr(motion, name) for name in names})


def kinds(
    study: Study, results: Path, motion: Mapping[str, Any] | None = None, threshold: float = 1e-6
) -> xarray.Dataset:
    """Return the Lyapunov exponents and kinds of motion of the points of a study."""
    section = study.settings(study.laws[0]).section
    settings = MotionSettings(**{**(motion or {}), "synchronization_threshold": threshold, "section": section})
    return lyapunov.summarize(scalars(study, results, settings), settings)


def means(study: Study, results: Path, threshold: float = 1e-6) -> xarray.Dataset:
    """Return the mean distances of the points of a study."""
    return mean_distance.summarize(scalars(study, results), threshold)
