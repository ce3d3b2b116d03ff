"""Lyapunov exponents over (law, initial, a), or the study's parameters in place of a, and the kind of motion.

The kind follows from the exponents, the repetition of the state, ⟨J⟩, and whether the motion still changes.

A run from a symmetric state may stay on an unstable orbit (`unstable`). On an orbit that is its own mirror image, W'
alone may repeat after half of `section_period`. The thresholds are attributes; in a study of several parameters they
scale with the v of each point.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

import numpy as np
import xarray

from burridge_knopoff.dataset.summary import summary
from burridge_knopoff.dataset.variables import PERIOD, YES_OR_NO, Variable, flag
from burridge_knopoff.motion.evidence import Evidence
from burridge_knopoff.motion.kind import (
    CHAOS,
    Motion,
    MotionKind,
    is_zero_exponent,
    motion_of_evidence,
    synchronization_distance,
)
from burridge_knopoff.motion.period import Repetition
from burridge_knopoff.motion.settings import MotionSettings
from burridge_knopoff.running.status import Status
from burridge_knopoff.study.formatting import format_count
from burridge_knopoff.summaries import runs as all_runs
from burridge_knopoff.summaries.runs import RUN
from burridge_knopoff.summaries.sentences import RUN as LINE
from burridge_knopoff.summaries.sentences import at_value, incomplete, largest, lines_of, values_where

_UNCLEAR = "undetermined at {} of a from the run alone (agreement.nc has the kind of the attractor)"

_OF_RUNS = ("lyapunov_exponent", "lyapunov_error", "lyapunov_infinite_count", "mean_distance", "status")
#: The variables that follow from the kind of motion.
MOTION_VARIABLES = {
    "run_kind": Variable(
        RUN,
        "i1",
        "kind of motion that the run alone shows",
        flag("i1", MotionKind) | {"comment": "agreement.nc has the kind of the attractor that the run has reached"},
    ),
    "unstable": Variable(RUN, "i1", "unstable: whether the run has stayed on an unstable periodic orbit", YES_OR_NO),
    "section_period": Variable(
        RUN,
        "i2",
        "period in section points: number of upward section points after which the state of all blocks "
        "repeats, 0 if it does not",
    ),
    "period": Variable(RUN, "f8", *PERIOD),
    "zero_exponent_count": Variable(
        RUN, "i2", "number of exponents of 0: computed exponents that cannot be distinguished from 0"
    ),
}
VARIABLES = {**{name: all_runs.VARIABLES[name] for name in _OF_RUNS}, **MOTION_VARIABLES}

#: Variables of `runs` from which the kind of motion follows.
_EVIDENCE = (
    *("status", "mirror_symmetric", "v", "mean_distance"),
    *("repetition_points", "repetition_period", "repetition_divergence", "stops", "drifts", "settles"),
    *("lyapunov_exponent", "lyapunov_error"),
)


def summarize(runs: xarray.Dataset, settings: MotionSettings) -> xarray.Dataset:
    """Return Lyapunov exponents and kinds of motion with the evidence for them.

    runs : the summary of that name
    """
    about = settings if runs["v"].ndim else settings.scaled_to_velocity(runs["v"].item())
    return summary(
        "Lyapunov exponents and kinds of motion",
        VARIABLES,
        runs.assign(motion_of_runs(runs, settings)),
        runs.drop_dims("level").coords,
        {"history": "snakemake, from runs.nc", **about.attributes},
        module=__name__,
    )


def motion_of_runs(runs: xarray.Dataset, settings: MotionSettings) -> dict[str, xarray.DataArray]:
    """Return the variables of MOTION_VARIABLES for all runs; runs : the summary of that name."""
    values = xarray.apply_ufunc(
        partial(_motion_of_run, settings=settings),
        *(runs[name] for name in _EVIDENCE),
        input_core_dims=[["exponent"] if name.startswith("lyapunov") else [] for name in _EVIDENCE],
        output_core_dims=[[] for _ in MOTION_VARIABLES],
        vectorize=True,
    )
    return dict(zip(MOTION_VARIABLES, values, strict=True))


def _motion_of_run(
    status: int,
    symmetric: int,
    v: float,
    mean_distance: float,
    points: int,
    period: float,
    divergence: float,
    stops: int,
    drifts: int,
    settles: int,
    exponent: np.ndarray,
    error: np.ndarray,
    settings: MotionSettings,
) -> tuple[int, bool, int, float, int]:
    """Return the values of MOTION_VARIABLES for one run."""
    scaled = settings.scaled_to_velocity(float(v))
    motion = Motion(MotionKind.UNDETERMINED)
    if status == Status.COMPLETED:
        repetition = Repetition(int(points), float(period), float(divergence))
        evidence = Evidence(repetition, bool(stops), bool(drifts), bool(settles))
        distance = synchronization_distance(float(mean_distance), bool(symmetric))
        motion = motion_of_evidence(evidence, distance, exponent, error, scaled)
    zeros = int(np.count_nonzero(is_zero_exponent(exponent, error, scaled)))
    return motion.kind, motion.unstable, motion.section_period, motion.period, zeros


def digest(data: xarray.Dataset) -> str:
    """Return where the runs of each law and initial state are chaotic or undetermined, and the largest exponent.

    Over several parameters all kinds of motion are counted.
    """

    def sentence(part: xarray.Dataset) -> str:
        kind = part["run_kind"]
        top = largest("exponent", part["lyapunov_exponent"].max("exponent")) if part.sizes["exponent"] else []
        words = _chaotic_values(kind) if kind.ndim == 1 else [_kind_counts(kind.values)]
        return "; ".join([*words, *top, *incomplete(part["status"].values == Status.COMPLETED)])

    return lines_of(data, LINE, sentence)


def _chaotic_values(kind: xarray.DataArray) -> Iterator[str]:
    is_chaotic = kind.isin(CHAOS).values
    a = kind["a"].values
    if len(a) == 1:
        yield f"chaotic {values_where(is_chaotic, a)}"
    else:
        first = f", first{at_value(a, int(is_chaotic.argmax()))}" if is_chaotic.any() else ""
        yield f"chaotic at {is_chaotic.sum()} of {kind.size} values of a{first}"
    if unclear := int((kind == MotionKind.UNDETERMINED).sum()):
        yield _UNCLEAR.format(format_count(unclear, "value"))


def _kind_counts(kinds: np.ndarray) -> str:
    counts = [f"{kind.words} {count}" for kind in MotionKind if (count := np.count_nonzero(kinds == kind))]
    return f"{format_count(kinds.size, 'point')}: {', '.join(counts)}"
