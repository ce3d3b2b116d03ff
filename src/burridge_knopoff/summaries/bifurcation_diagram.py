"""All section points W' at W = 0 over a: the paper's Figs. 4a and 4b. The config's `section` defines W.

The file is a contiguous ragged array of the CF conventions.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import xarray

from burridge_knopoff.dataset.point import STATUS_FLAG
from burridge_knopoff.dataset.summary import AXES, axes, summary
from burridge_knopoff.dataset.variables import DIRECTION, Variable
from burridge_knopoff.running.status import Status
from burridge_knopoff.study.formatting import span
from burridge_knopoff.study.study import Study, all_points
from burridge_knopoff.summaries.points import read_point
from burridge_knopoff.summaries.sentences import incomplete

#: A slower crossing is a rounding error. In uniform sliding W = W' = 0 within 1e-12 at v = 5; the slowest crossing of
#: the default study has W' = 1e-4.
ROUNDING = 1e-9

#: Reasons why the bifurcation diagram of a law and an initial state is empty.
NONE_COMPLETED = "no run completed"
NEVER_UPWARD = "W never crosses 0 upward: the section is never reached"
STAYS = "W stays at 0: the blocks slide uniformly"

VARIABLES = {
    "crossing_velocity": Variable(("crossing",), "f8", "W' at a crossing of the section W = 0"),
    "crossing_direction": Variable(("crossing",), "i1", "direction in which W crosses 0", DIRECTION),
    "crossing_count": Variable(("point",), "i4", "number of crossings of the point", {"sample_dimension": "crossing"}),
    "status": Variable(("point",), "i1", "how the run ended", STATUS_FLAG),
}
OF_POINT = {name: replace(AXES[name], dimensions=("point",)) for name in ("law", "initial", "a")}


def summarize(study: Study, results: Path) -> xarray.Dataset:
    """Return the section points of all runs, one after another in the order (law, initial, a).

    results : folder of the study

    The points of run n are crossing_velocity[start:start + crossing_count[n]], where start is the sum of the previous
    counts; `section_points` selects them by law and initial state. A run that did not complete has none.
    """
    velocity, direction, count, status, law, initial, a = [], [], [], [], [], [], []
    for point in all_points(study):
        read = read_point(study, results, point, ["crossing_velocity", "crossing_direction", "status"])
        kept = slice(None if read["status"] == Status.COMPLETED else 0)
        velocity.append(read["crossing_velocity"][kept])
        direction.append(read["crossing_direction"][kept])
        count.append(len(velocity[-1]))
        status.append(read["status"])
        law.append(point["law"])
        initial.append(point["initial"])
        a.append(study.value(point["a"]))
    values = {
        "crossing_velocity": np.concatenate(velocity),
        "crossing_direction": np.concatenate(direction),
        "crossing_count": np.array(count),
        "status": np.array(status),
    }
    return summary(
        "Section points W' at W = 0",
        VARIABLES,
        values,
        axes(OF_POINT, law=law, initial=initial, a=a),
        {"section": str(study.settings(study.laws[0]).section)},
        module=__name__,
    )


def section_points(dataset: xarray.Dataset, law: str, initial: str, direction: int) -> tuple[np.ndarray, np.ndarray]:
    """Return (a, W') of all section points of one law and initial state crossed upward (1) or downward (-1)."""
    a = np.repeat(dataset["a"].values, dataset["crossing_count"].values)
    chosen = (dataset["law"].values == law) & (dataset["initial"].values == initial)
    chosen = np.repeat(chosen, dataset["crossing_count"].values)
    chosen &= dataset["crossing_direction"].values == direction
    return a[chosen], dataset["crossing_velocity"].values[chosen]


def has_completed(dataset: xarray.Dataset, law: str, initial: str) -> np.ndarray:
    """Return whether each run of one law and initial state completed."""
    chosen = (dataset["law"].values == law) & (dataset["initial"].values == initial)
    return dataset["status"].values[chosen] == Status.COMPLETED


def digest(data: xarray.Dataset) -> str:
    """Return the range of W' at upward crossings of the section for each law and initial state."""
    lines = []
    for law, initial in dict.fromkeys(zip(data["law"].values, data["initial"].values, strict=True)):
        a, velocity = section_points(data, law, initial, 1)
        completed = has_completed(data, law, initial)
        words = "W never crosses 0 upward" if completed.any() else NONE_COMPLETED
        if len(a):
            ends = span(f"{velocity.min():.4g}", f"{velocity.max():.4g}")
            words = f"W' at upward crossings is {ends}"
            if len(np.unique(data["a"])) > 1:
                words += f", largest at a = {a[velocity.argmax()]:g}"
        lines.append(f"{law}, {initial}: {'; '.join([words, *incomplete(completed)])}")
    return "\n".join(lines)
