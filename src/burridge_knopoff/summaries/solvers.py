"""Comparison of independent solvers of the same equations: ⟨J⟩, cost and order of events for each law."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import xarray

from burridge_knopoff.dataset.summary import axes, summary
from burridge_knopoff.dataset.variables import Variable, flag
from burridge_knopoff.running.settings import SOLVERS
from burridge_knopoff.running.status import STATUS_WORDS, Status
from burridge_knopoff.study.formatting import format_count
from burridge_knopoff.study.study import Study
from burridge_knopoff.summaries.event_order import common_order
from burridge_knopoff.summaries.points import EVENTS, Grid, all_events, read_point
from burridge_knopoff.summaries.runs import RUN, over_runs
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
#: Variables of single runs, compared with the solver of the study's points.
RUN_VARIABLES = {
    name: replace(item, dimensions=RUN) for name, item in VARIABLES.items() if not name.startswith("difference")
}
_MISSING = {name: item.missing for name, item in RUN_VARIABLES.items()}
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
    other_grids = {solver: grid.copy_with(results / "solvers" / solver, of) for solver, of in settings.items()}
    return summarize(grid, other_grids, config["solvers"]["step"])


def summarize(grid: Grid, other_grids: Mapping[str, Grid], step: float) -> xarray.Dataset:
    """Compare the solvers of each law at every point of a grid.

    grid : the study's points at the values of a that are compared
    other_grids : {solver: its runs of the same points, with settings for each law whose points another solver computes}
    step : of rk4 in these runs, unless rk4 computes the study's points
    """
    solver_of_law = {law: grid.settings[law].solver for law in grid.laws}
    parts = []
    for solver in SOLVERS:
        of_solver = [_runs_by(solver, runs, grid) for runs in (grid, other_grids.get(solver)) if runs]
        parts.append(xarray.concat(of_solver, "law").reindex(law=list(grid.laws), fill_value=_MISSING))
    runs = xarray.concat(parts, "solver").assign_coords(axes({"solver": SOLVER}, solver=SOLVERS))
    solvers = xarray.DataArray(list(solver_of_law.values()), {"law": list(grid.laws)}, "law")
    reference = runs.sel(solver=solvers).drop_vars("solver")
    error = xarray.apply_ufunc(np.hypot, runs["mean_distance_error"], reference["mean_distance_error"])
    values = runs.assign(
        difference=runs["mean_distance"] - reference["mean_distance"],
        # A run does not differ from itself.
        difference_error=error * (runs["solver"] != solvers),
    ).transpose("law", "solver", "initial", "a")
    return summary(
        "Independent solvers of the same equations",
        VARIABLES,
        values,
        {"law": values["law"], "solver": values["solver"], **grid.axes()},
        {**{f"solver_{law}": solver for law, solver in solver_of_law.items()}, "step": step},
        module=__name__,
    )


def _runs_by(solver: str, runs: Grid, reference: Grid) -> xarray.Dataset:
    """Return RUN_VARIABLES for the laws whose runs in a grid are by one solver, over (law, initial, a).

    reference : the study's points
    """

    def compare(run: Mapping[str, np.ndarray], point: Sequence[str]) -> dict[str, Any]:
        reference_run = read_point(reference, point, _READ)
        count, until = common_order(all_events(run), all_events(reference_run))
        until = min(until, float(run["end_time"]), float(reference_run["end_time"]))
        return {**{name: run[name] for name in _COPIED}, "event_order_count": count, "event_order_time": until}

    chosen = runs.of_laws([law for law, settings in runs.settings.items() if settings.solver == solver])
    values = over_runs(chosen, RUN_VARIABLES, _READ, compare)
    return xarray.Dataset({name: (RUN, array) for name, array in values.items()}, chosen.axes())


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
