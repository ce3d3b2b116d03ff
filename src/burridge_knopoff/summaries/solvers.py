"""Comparison of independent solvers of the same equations: ⟨J⟩, cost and order of events for each law."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import xarray

from burridge_knopoff.dataset.summary import summary
from burridge_knopoff.dataset.variables import Variable, flag
from burridge_knopoff.running.settings import SOLVERS
from burridge_knopoff.running.status import STATUS_WORDS
from burridge_knopoff.study.study import Study
from burridge_knopoff.summaries.event_order import common_order
from burridge_knopoff.summaries.points import EVENTS, Grid, all_events, read_point

NO_RUN = -1

_AXES = ("law", "solver", "initial", "a")
VARIABLES = {
    "mean_distance": Variable(
        _AXES,
        "f8",
        "time average <J> of the phase-space distance between the end blocks",
        {"ancillary_variables": "mean_distance_error status"},
    ),
    "mean_distance_error": Variable(_AXES, "f8", "standard error of <J> from the batch means"),
    "status": Variable(_AXES, "i1", "how the run ended", flag("i1", {NO_RUN: "no_such_solver", **STATUS_WORDS})),
    "step_count": Variable(_AXES, "i8", "number of solver steps in the whole run, -1 if there is no run"),
    "end_time": Variable(_AXES, "f8", "time tau at which the run ended"),
    "difference": Variable(_AXES, "f8", "<J> minus <J> of the solver of the study's points"),
    "difference_error": Variable(
        _AXES,
        "f8",
        "standard error of the difference of <J>, for two independent runs; 0 for the solver of the study's points",
    ),
    "event_order_time": Variable(
        _AXES, "f8", "time tau until which the order of events agrees with the solver of the study's points"
    ),
    "event_order_count": Variable(
        _AXES,
        "i8",
        "number of events in the same order as with the solver of the study's points, -1 if there is no run",
    ),
}
SOLVER = Variable(("solver",), "O", "solver", coordinate=True)
_COPIED = ("mean_distance", "mean_distance_error", "status", "step_count", "end_time")
_READ = [*_COPIED, *EVENTS]


def compare_solvers(config: Mapping[str, Any], results: Path) -> xarray.Dataset:
    """Return the comparison of a study's points at a few values of a with their repetitions.

    config : the keys of the study's config that define these runs; results : folder of the study
    """
    study = Study.of_keys({**config, "a": config["solvers"]["a"]})
    settings = {
        solver: {law: study.settings(law, solver) for law in study.laws if solver in study.other_solvers(law)}
        for solver in SOLVERS
    }
    grid = Grid.from_points(results / "points", study.points)
    others = {solver: grid.copy_with(results / "solvers" / solver, of) for solver, of in settings.items()}
    return summarize(grid, others, config["solvers"]["step"])


def summarize(grid: Grid, others: Mapping[str, Grid], step: float) -> xarray.Dataset:
    """Compare the solvers of each law at every point of a grid.

    grid : the study's points at the values of a that are compared
    others : {solver: its runs of the same points, with settings for each law whose points another solver computes}
    step : of rk4 in these runs, unless rk4 computes the study's points
    """
    shape = (grid.shape[0], len(SOLVERS), *grid.shape[1:])
    values = {name: np.full(shape, NO_RUN if item.dtype[0] == "i" else np.nan) for name, item in VARIABLES.items()}
    for (i, j, k), (law, initial, a) in grid:
        reference: dict[str, np.ndarray] = {}
        known = {solver: runs for solver, runs in others.items() if law in runs.settings}
        for solver, runs in {grid.settings[law].solver: grid, **known}.items():
            run = read_point(runs, (law, initial, a), _READ)
            reference = reference or run
            index = (i, SOLVERS.index(solver), j, k)
            for name in _COPIED:
                values[name][index] = run[name]
            values["difference"][index] = run["mean_distance"] - reference["mean_distance"]
            error = np.hypot(run["mean_distance_error"], reference["mean_distance_error"])
            values["difference_error"][index] = error if run is not reference else 0.0 * error
            count, until = common_order(all_events(run), all_events(reference))
            values["event_order_count"][index] = count
            values["event_order_time"][index] = min(until, float(run["end_time"]), float(reference["end_time"]))
    shared = grid.axes()
    names = ("solver", np.array(SOLVERS, dtype=object), SOLVER.all_attributes())
    return summary(
        "Independent solvers of the same equations",
        VARIABLES,
        values,
        {"law": shared["law"], "solver": names, **shared},
        {**{f"solver_{law}": grid.settings[law].solver for law in grid.laws}, "step": step},
        module=__name__,
    )
