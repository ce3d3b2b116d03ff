"""Linearized against nonlinear friction law, for each initial state and a: do they agree, and where do they part?"""

from __future__ import annotations

import io
from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray
from scipy.stats import wasserstein_distance

from burridge_knopoff.dataset.summary import axes, summary
from burridge_knopoff.dataset.variables import Variable, flag
from burridge_knopoff.paper import PAPER_LAWS
from burridge_knopoff.stability.motion import KINDS, UNDETERMINED
from burridge_knopoff.summaries.event_order import common_order
from burridge_knopoff.summaries.points import EVENTS, Grid, all_events, read_point

# The last bit of a product of vectors depends on where in memory they lie.
DIGITS = 12

_POINT = ("law", "initial", "a")
_PAIR = ("initial", "a")
_VERDICT = {-1: "undetermined", 0: "no", 1: "yes"}
_YES_NO = flag("i1", _VERDICT)
VARIABLES = {
    "mean_distance": Variable(_POINT, "f8", "time average <J> of the phase-space distance between the end blocks"),
    "mean_distance_error": Variable(_POINT, "f8", "standard error of <J> from the batch means"),
    "kind": Variable(_POINT, "i1", "kind of motion", flag("i1", KINDS)),
    "difference": Variable(_PAIR, "f8", "<J> of the nonlinear law minus <J> of the linearized law"),
    "difference_error": Variable(_PAIR, "f8", "standard error of the difference of <J>"),
    "section_distance": Variable(
        _PAIR, "f8", "Wasserstein distance between the distributions of W' on upward crossings of both laws"
    ),
    "event_order_time": Variable(_PAIR, "f8", "time tau until which the order of events is the same under both laws"),
    "event_order_count": Variable(_PAIR, "i8", "number of events that come in the same order under both laws"),
    "same_kind": Variable(_PAIR, "i1", "whether both laws lead to the same kind of motion", _YES_NO),
    "agrees": Variable(_PAIR, "i1", "whether kind of motion and <J> agree", _YES_NO),
    "parting_a": Variable(("initial",), "f8", "least a of the grid at which the laws disagree, NaN if there is none"),
}
_READ = [
    *("end_time", "mean_distance", "mean_distance_error", "crossing_velocity", "crossing_direction"),
    *EVENTS,
]


def summarize(
    grid: Grid, lyapunov: xarray.Dataset, synchronization_threshold: float, agreement: Mapping[str, Any]
) -> xarray.Dataset:
    """Compare both laws at every grid point.

    lyapunov : the summary of that name, for the kinds of motion
    agreement : the config's section of that name: relative_tolerance, standard_errors
    """
    values = {}
    shapes = {_POINT: (len(PAPER_LAWS), *grid.shape[1:]), _PAIR: grid.shape[1:]}
    for name, item in VARIABLES.items():
        shape = shapes.get(item.dimensions, grid.shape[1:2])
        values[name] = np.zeros(shape, dtype=item.dtype)
    for j, initial in enumerate(grid.initial):
        for k, a in enumerate(grid.a):
            pair = [read_point(grid, law, initial, a, _READ) for law in PAPER_LAWS]
            upward = [point["crossing_velocity"][point["crossing_direction"] > 0] for point in pair]
            for i, point in enumerate(pair):
                values["mean_distance"][i, j, k] = point["mean_distance"]
                values["mean_distance_error"][i, j, k] = point["mean_distance_error"]
            values["section_distance"][j, k] = _section_distance(*upward)
            count, until = common_order(*(all_events(point) for point in pair))
            values["event_order_count"][j, k] = count
            values["event_order_time"][j, k] = min(until, *(float(point["end_time"]) for point in pair))
    values["kind"][...] = lyapunov["kind"].sel(law=list(PAPER_LAWS)).values
    judge(values, np.array(list(grid.a.values())), synchronization_threshold, agreement)
    return summary(
        "Agreement of the linearized and the nonlinear friction law",
        VARIABLES,
        values,
        axes(list(grid.initial), list(grid.a.values()), PAPER_LAWS),
        {"synchronization_threshold": synchronization_threshold, **agreement},
        module=__name__,
    )


def _section_distance(one: np.ndarray, other: np.ndarray) -> float:
    """Return the Wasserstein distance of two samples, NaN if one is empty."""
    if not len(one) or not len(other):
        return np.nan
    return float(f"{wasserstein_distance(one, other):.{DIGITS}g}")


def judge(values: dict[str, np.ndarray], a: np.ndarray, threshold: float, agreement: Mapping[str, Any]) -> None:
    """Fill in differences and verdicts: the laws agree where the motion is of one kind and ⟨J⟩ within a tolerance.

    There is no verdict where the kind of one of the two motions is not determined.
    """
    linearized, nonlinear = values["mean_distance"]
    kind = values["kind"]
    values["difference"][...] = nonlinear - linearized
    values["difference_error"][...] = np.hypot(*values["mean_distance_error"])
    determined = (kind != UNDETERMINED).all(axis=0)
    values["same_kind"][...] = np.where(determined, kind[0] == kind[1], -1)
    tolerance = np.maximum.reduce(
        [
            agreement["relative_tolerance"] * np.maximum(linearized, nonlinear),
            agreement["standard_errors"] * values["difference_error"],
            np.full_like(linearized, threshold),
        ]
    )
    agrees = (values["same_kind"] == 1) & (np.abs(values["difference"]) <= tolerance)
    values["agrees"][...] = np.where(determined, agrees, -1)
    for j, agrees in enumerate(values["agrees"]):
        apart = a[agrees == 0]
        values["parting_a"][j] = apart[0] if len(apart) else np.nan


def table(dataset: xarray.Dataset) -> str:
    """Return the comparison as CSV, one line for each initial state and a."""
    lines = io.StringIO()
    lines.write(
        "initial,a,mean_distance_linearized,mean_distance_nonlinear,difference,difference_error,section_distance,"
        "event_order_time,kind_linearized,kind_nonlinear,agrees\n"
    )
    for initial in dataset["initial"].values:
        for a in dataset["a"].values:
            row = dataset.sel(initial=initial, a=a)
            mean = row["mean_distance"].values
            kind = [KINDS[int(value)] for value in row["kind"].values]
            lines.write(
                f"{initial},{a:.10g},{mean[0]:.8e},{mean[1]:.8e},{row['difference'].item():.8e},"
                f"{row['difference_error'].item():.2e},{row['section_distance'].item():.6e},"
                f"{row['event_order_time'].item():.3f},{kind[0]},{kind[1]},{_VERDICT[row['agrees'].item()]}\n"
            )
    return lines.getvalue()


def digest(dataset: xarray.Dataset) -> str:
    """Return, in a line for each initial state, the a at which the laws part."""
    lines = []
    for initial in dataset["initial"].values:
        row = dataset.sel(initial=initial)
        verdict = row["agrees"].values
        a = dataset["a"].values[verdict >= 0]
        apart = dataset["a"].values[verdict == 0]
        failed = np.count_nonzero(verdict < 0)
        undetermined = (
            f" {failed} values of a are undetermined: a run did not complete, or its kind of motion is not clear."
            if failed
            else ""
        )
        if not len(a):
            text = "no value of a could be compared."
        elif not len(apart):
            text = f"the laws agree at all {len(a)} values of a that were compared, {a[0]:g} to {a[-1]:g}."
        else:
            before = a[a < apart[0]]
            agree = f"agree up to a = {before[-1]:g} and part" if len(before) else "part"
            other_kind = np.count_nonzero(row["same_kind"].values == 0)
            kinds = f"; the kind of motion differs at {other_kind}" if other_kind else ""
            text = (
                f"the laws {agree} at a = {apart[0]:g}; they disagree at {len(apart)} of {len(a)} values of a, "
                f"the last {apart[-1]:g}{kinds}."
            )
        lines.append(f"{initial}: {text}{undetermined}")
    return "\n".join(lines) + "\n"
