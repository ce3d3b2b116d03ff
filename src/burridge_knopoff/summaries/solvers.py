"""Comparison of independent solvers of the same equations: ⟨J⟩, cost and order of events for each law.

The solver of the study's points is the attribute `solver_<law>`. `rk4` finds events at the ends of its steps, so that
two events within a step or two may occur in the opposite order. Without chaos `difference_error` is far too large.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import xarray

from burridge_knopoff.dataset.columns import empty_columns
from burridge_knopoff.dataset.summary import axes, summary
from burridge_knopoff.dataset.variables import Variable, flag
from burridge_knopoff.running.solvers import RUN_SOLVERS
from burridge_knopoff.running.status import STATUS_WORDS, Status
from burridge_knopoff.study.formatting import format_count
from burridge_knopoff.study.study import Study, all_points
from burridge_knopoff.summaries.event_order import common_order
from burridge_knopoff.summaries.points import EVENTS, all_events, point_axes, read_point
from burridge_knopoff.summaries.sentences import incomplete

NO_RUN = -1

_AXES = ("law", "solver", "initial", "a")
VARIABLES = {
    "mean_distance": Variable(
        _AXES,
        "f8",
        "mean distance <J>: time average of the phase-space distance between the end blocks",
        {"ancillary_variables": "mean_distance_error status"},
    ),
    "mean_distance_error": Variable(_AXES, "f8", "standard error of <J>: from the batch means"),
    "status": Variable(_AXES, "i1", "how the run ended", flag("i1", {NO_RUN: "no_such_solver", **STATUS_WORDS})),
    "step_count": Variable(_AXES, "i8", "number of steps: solver steps in the whole run, -1 if there is no run"),
    "end_time": Variable(_AXES, "f8", "time tau at which the run ended"),
    "difference": Variable(_AXES, "f8", "difference of <J>: from <J> of the solver of the study's points"),
    "difference_error": Variable(
        _AXES,
        "f8",
        "standard error of the difference of <J>: for two independent runs; 0 for the solver of the study's points",
    ),
    "event_order_time": Variable(
        _AXES,
        "f8",
        "time of equal event order: time tau until which the order of events agrees with the solver of "
        "the study's points",
    ),
    "event_order_count": Variable(
        _AXES,
        "i8",
        "events in equal order: number of events in the same order as with the solver of the study's "
        "points, -1 if there is no run",
    ),
}
SOLVER = Variable(("solver",), "O", "solver", coordinate=True)
_COPIED = ("mean_distance", "mean_distance_error", "status", "step_count", "end_time")
_READ = [*_COPIED, *EVENTS]


def compare_solvers(config: Mapping[str, Any], results: Path) -> xarray.Dataset:
    """Return the comparison of a study's points at a few values of a with their repetitions by other solvers.

    config : the keys of the study's config that define these runs; results : folder of the study
    """
    study = Study.of_keys({**config, "a": config["solvers"]["a"]})
    solvers = config["solver"]
    coordinates = {**axes({"solver": SOLVER}, solver=RUN_SOLVERS), **point_axes(study)}
    values = empty_columns(VARIABLES, {name: len(coordinates[name][1]) for name in _AXES})
    indices = np.ndindex(len(study.laws), len(study.initial), len(study.grid))
    for (i, *place), point in zip(indices, all_points(study), strict=True):
        law = point["law"]
        reference = read_point(study, results, point, _READ)
        runs = {solvers[law]: reference}
        for solver in study.other_solvers(law):
            runs[solver] = read_point(study, results, {**point, "solver": solver}, _READ)
        for solver, run in runs.items():
            for name, value in _compare(run, reference).items():
                values[name][i, RUN_SOLVERS.index(solver), *place] = value
    return summary(
        "Independent solvers of the same equations",
        VARIABLES,
        values,
        coordinates,
        {**{f"solver_{law}": solvers[law] for law in study.laws}, "step": config["solvers"]["step"]},
        module=__name__,
    )


def _compare(run: Mapping[str, np.ndarray], reference: Mapping[str, np.ndarray]) -> dict[str, Any]:
    """Return VARIABLES for one run; reference : the run of the study's points."""
    count, until = common_order(all_events(run), all_events(reference))
    error = np.hypot(run["mean_distance_error"], reference["mean_distance_error"])
    return {
        **{name: run[name] for name in _COPIED},
        "difference": run["mean_distance"] - reference["mean_distance"],
        # A run does not differ from itself.
        "difference_error": error * (run is not reference),
        "event_order_time": min(until, float(run["end_time"]), float(reference["end_time"])),
        "event_order_count": count,
    }


def digest(data: xarray.Dataset) -> str:
    """Return how far ⟨J⟩ and the order of events of other solvers differ from those of the study's points."""
    lines = []
    for law in data["law"].values:
        main_solver = data.attrs[f"solver_{law}"]
        reference = data.sel(law=law, solver=main_solver)
        for solver in data["solver"].values:
            part = data.sel(law=law, solver=solver)
            status = part["status"].values
            if solver == main_solver or (status == NO_RUN).all():
                continue
            runs = status != NO_RUN
            completed = (status == Status.COMPLETED) & (reference["status"].values == Status.COMPLETED)
            difference = np.where(completed, np.abs(part["difference"].values), np.nan)
            words = []
            if np.isfinite(difference).any():
                i, k = np.unravel_index(np.nanargmax(difference), difference.shape)
                largest, error = f"{difference[i, k]:.2g}", part["difference_error"].values[i, k]
                where = f"{part['initial'].values[i]}, a = {part['a'].values[k]:g}"
                words.append(f"<J> differs by at most {largest}{f' +- {error:.2g}' if error > 0.0 else ''} ({where})")
            until = part["event_order_time"].values
            end = np.fmin(part["end_time"].values, reference["end_time"].values)
            same = runs & (until >= end)
            order = f"the order of events is the same in {np.count_nonzero(same)} of {format_count(runs.sum(), 'run')}"
            if (runs & ~same).any():
                order += f" and in the others at least until tau = {until[runs & ~same].min():.4g}"
            words.append(order)
            lines.append(
                f"{law}, {solver} compared with {main_solver}: {'; '.join([*words, *incomplete(completed[runs])])}"
            )
    return "\n".join(lines)
