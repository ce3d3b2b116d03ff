"""The scalars of all runs over (law, initial, a), or over the parameters of the study in place of a.

Each point file is checked and read once for all of them; `mean_distance`, `lyapunov` and `agreement` are expressions
over this file.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import xarray

from burridge_knopoff.dataset.columns import over_grid
from burridge_knopoff.dataset.point import POINT_VARIABLES
from burridge_knopoff.dataset.summary import axes, summary
from burridge_knopoff.dataset.variables import YES_OR_NO, Variable
from burridge_knopoff.motion.evidence import RECORD, evidence_of
from burridge_knopoff.motion.kind import synchronization_distance
from burridge_knopoff.motion.period import count_distinct
from burridge_knopoff.motion.settings import MotionSettings
from burridge_knopoff.running.settling import LEVELS
from burridge_knopoff.running.status import Status
from burridge_knopoff.study.study import Study, all_points
from burridge_knopoff.summaries.points import point_axes, read_point
from burridge_knopoff.summaries.sentences import RUN as LINE
from burridge_knopoff.summaries.sentences import incomplete, lines_of

#: Dimensions of a scalar of all runs.
RUN = ("law", "initial", "a")

_COPIED = {
    name: replace(item, dimensions=(*RUN, *item.dimensions))
    for name, item in POINT_VARIABLES.items()
    if item.dimensions in ((), ("exponent",), ("level",)) and not item.coordinate
}
VARIABLES = {
    **_COPIED,
    "section_count": Variable(
        RUN, "i4", "number of section points: distinct W' at upward crossings of W = 0 in the second half of the window"
    ),
    "section_velocity_mean": Variable(RUN, "f8", "mean W' of the section: at all upward crossings of W = 0"),
    "section_velocity_min": Variable(RUN, "f8", "smallest W' of the section: at upward crossings of W = 0"),
    "section_velocity_max": Variable(RUN, "f8", "largest W' of the section: at upward crossings of W = 0"),
    "repetition_points": Variable(
        RUN, "i4", "section points until the state repeats: upward ones; 0 if the state does not repeat"
    ),
    "repetition_period": Variable(
        RUN,
        "f8",
        "time until the state repeats: NaN if it does not, or if nothing recorded tells it from its mirror image",
    ),
    "repetition_divergence": Variable(
        RUN,
        "f8",
        "divergence of cycles: factor by which the distance of successive cycles grows, at most 1 if these converge",
    ),
    "stops": Variable(RUN, "i1", "stops: whether a block stops among the recorded events of the window", YES_OR_NO),
    "drifts": Variable(
        RUN,
        "i1",
        "change of regular motion: whether <J> or, without stops, the amplitude differs between parts of the window",
        YES_OR_NO,
    ),
    "settles": Variable(
        RUN, "i1", "end of chaos: whether section points repeat in the last eighth of the window only", YES_OR_NO
    ),
    "mirror_symmetric": Variable(RUN, "i1", "mirror symmetry: whether the chain is its own mirror image", YES_OR_NO),
}


def over_runs(
    study: Study,
    results: Path,
    variables: Mapping[str, Variable],
    read: Sequence[str],
    function: Callable[[Mapping[str, np.ndarray], Mapping[str, str]], Mapping[str, Any]],
    **sizes: int,
) -> dict[str, np.ndarray]:
    """Return the values that a function computes from each run, in arrays over (law, initial, parameters).

    results : folder of the study
    variables : the first three dimensions of each are those of RUN, of which `a` stands for all parameters
    read : names of the variables of a point file that the function needs
    function : takes these variables and the wildcards of the point; variables that it leaves out are missing
    sizes : of the further dimensions
    """
    grid = {name: len(values) for name, (_, values, _) in point_axes(study).items()}
    own = {name: replace(item, dimensions=item.dimensions[len(RUN) :]) for name, item in variables.items()}
    points = zip(np.ndindex(*grid.values()), all_points(study), strict=True)
    rows = ((place, function(read_point(study, results, point, read), point)) for place, point in points)
    return over_grid(own, grid, rows, **sizes)


def summarize(
    study: Study, results: Path, *, period_tolerance: float, longest_period: float, synchronization_threshold: float
) -> xarray.Dataset:
    """Return the scalars of all runs.

    results : folder of the study
    period_tolerance, longest_period, synchronization_threshold : see `MotionSettings`
    Raises BadFile, one line, for a point that is missing, corrupt or out of date.
    """
    motion = MotionSettings(
        period_tolerance=period_tolerance,
        longest_period=longest_period,
        synchronization_threshold=synchronization_threshold,
    )

    def scalars(run: Mapping[str, np.ndarray], point: Mapping[str, str]) -> dict[str, Any]:
        values: dict[str, Any] = {name: run[name] for name in _COPIED}
        symmetric = study.run_of(**point)[0].chain.is_mirror_symmetric
        values["mirror_symmetric"] = symmetric
        if run["status"] == Status.COMPLETED:
            upward = run["crossing_velocity"][run["crossing_direction"] > 0]
            values["section_count"] = count_distinct(upward[len(upward) // 2 :])
            if len(upward):
                values |= {f"section_velocity_{name}": getattr(upward, name)() for name in ("mean", "min", "max")}
            distance = synchronization_distance(float(run["mean_distance"]), symmetric)
            evidence = evidence_of(run, distance, motion.scaled_to_velocity(float(run["v"])))
            values |= {f"repetition_{name}": value for name, value in vars(evidence.repetition).items()}
            values |= {name: getattr(evidence, name) for name in ("stops", "drifts", "settles")}
        return values

    settings = study.settings(study.laws[0])
    sizes = {"exponent": settings.exponent_count(study.chain), "level": len(LEVELS)}
    values = over_runs(study, results, VARIABLES, [*_COPIED, *RECORD, "v"], scalars, **sizes)
    parameters = point_axes(study)
    coordinates = {**parameters, **axes({"level": POINT_VARIABLES["level"]}, level=LEVELS)}
    # A parameter of the grid has a coordinate of its own.
    if "v" not in parameters:
        coordinates["v"] = ((), study.config["v"], POINT_VARIABLES["v"].all_attributes())
    thresholds = ("period_tolerance", "longest_period", "synchronization_threshold")
    about = {"section": str(settings.section), **{name: motion.attributes[name] for name in thresholds}}
    variables = {
        name: replace(item, dimensions=(*parameters, *item.dimensions[len(RUN) :])) for name, item in VARIABLES.items()
    }
    return summary("Scalars of all runs", variables, values, coordinates, about, module=__name__)


def digest(data: xarray.Dataset) -> str:
    """Return how many runs of each law and initial state completed."""

    def sentence(part: xarray.Dataset) -> str:
        completed = part["status"].values == Status.COMPLETED
        return next(incomplete(completed), f"all {completed.size} runs completed")

    return lines_of(data, LINE, sentence)
