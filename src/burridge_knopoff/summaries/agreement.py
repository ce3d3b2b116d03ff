"""Agreement of each friction law of a study with the first one, for each initial state and a.

The laws agree if the kind of motion is the same and ⟨J⟩ differs by no more than a tolerance. Periodic and quasiperiodic
motion count as one kind, since a torus is locked to periodic orbits on a dense set of a. If ⟨J⟩ differs by more, the
laws disagree, whatever the kinds. The answer is undetermined if a run did not complete, if its kind is undetermined, or
if the difference of ⟨J⟩ equals the tolerance within its error. Two events within 1e-9 may occur in either order.
"""

from __future__ import annotations

import io
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import scipy
import xarray

from burridge_knopoff.attractors.lookup import reached_attractors
from burridge_knopoff.dataset.summary import axes, summary
from burridge_knopoff.dataset.variables import ANSWER, PERIOD, Answer, Variable, flag
from burridge_knopoff.motion.kind import (
    CHAOS,
    REGULAR,
    SYNCHRONOUS,
    UNDECIDED_KINDS,
    MotionKind,
    is_same_result,
)
from burridge_knopoff.study.formatting import format_count
from burridge_knopoff.study.study import Study
from burridge_knopoff.summaries.event_order import common_order
from burridge_knopoff.summaries.judgement import compare_laws, pair_variables
from burridge_knopoff.summaries.points import EVENTS, all_events, point_axes, read_point
from burridge_knopoff.summaries.runs import RUN, over_runs

# Significant digits: the last bits of a product of vectors depend on their alignment in memory.
DIGITS = 12

_PAIR = ("other_law", "initial", "a")
# Relative difference of ⟨J⟩ that is allowed between a run and its attractor even if their errors are smaller.
MEAN_TOLERANCE = 0.01
KIND_COMMENT = (
    "kind of the attractor that the run has reached, which was followed for longer than the run; a run that approaches "
    "synchrony counts as synchronized; if the run has reached no known attractor, the kind that the run alone shows"
)
POINT_VARIABLES = {
    "mean_distance": Variable(
        RUN, "f8", "mean distance <J>: time average of the phase-space distance between the end blocks"
    ),
    "mean_distance_error": Variable(RUN, "f8", "standard error of <J>: from the batch means"),
    "kind": Variable(RUN, "i1", "kind of motion", flag("i1", MotionKind) | {"comment": KIND_COMMENT}),
}
RUN_VARIABLES = {
    "period": Variable(RUN, "f8", *PERIOD),
    "settled": Variable(
        RUN,
        "i1",
        "on the attractor: whether the run ended on the attractor that its initial state reaches",
        ANSWER | {"comment": "no: the transient was too short, or the chaos ended within the window"},
    ),
}
SECTION_DISTANCE = Variable(
    _PAIR,
    "f8",
    "distance of the section points: Wasserstein distance between the distributions of W' on upward crossings of both "
    "laws",
)
PAIR_VARIABLES = pair_variables(_PAIR, section_distance=SECTION_DISTANCE)
#: The variables that follow from the events of two runs.
EVENT_VARIABLES = {name: PAIR_VARIABLES[name] for name in ("section_distance", "event_order_time", "event_order_count")}
VARIABLES = {**POINT_VARIABLES, **RUN_VARIABLES, **PAIR_VARIABLES}
_EVENTS_READ = ["end_time", "crossing_velocity", "crossing_direction", *EVENTS]


def summarize(
    runs: xarray.Dataset,
    lyapunov: xarray.Dataset,
    events: xarray.Dataset,
    attractors: xarray.Dataset | None = None,
    *,
    synchronization_threshold: float,
    agreement: Mapping[str, Any],
) -> xarray.Dataset:
    """Compare each law with the first one at every grid point.

    runs, lyapunov : the summaries of these names, for ⟨J⟩ and the kinds of motion of runs
    events : see `compare_events`
    attractors : the summary of that name, for the attractors that the initial states reach; without it `settled` is
        undetermined
    agreement : the config's section of that name: relative_tolerance, standard_errors
    """
    with xarray.set_options(arithmetic_join="exact"):
        motion = runs[["mean_distance", "mean_distance_error"]].assign(
            kind=lyapunov["run_kind"],
            period=lyapunov["period"],
            settled=xarray.full_like(lyapunov["run_kind"], Answer.UNDETERMINED),
        )
        if attractors is not None:
            reached = reached_attractors(attractors)
            motion = motion.assign(settle(motion, reached, synchronization_threshold, agreement))
        comparison = compare_laws(motion, synchronization_threshold, agreement)
    values = motion.assign({**comparison, **events})
    return summary(
        "Agreement of each friction law with the first one",
        VARIABLES,
        values,
        axes(law=runs["law"], other_law=runs["law"][1:], initial=runs["initial"], a=runs["a"]),
        {"synchronization_threshold": synchronization_threshold, **agreement},
        module=__name__,
    )


def settle(
    motion: xarray.Dataset, reached: xarray.Dataset, threshold: float, agreement: Mapping[str, Any]
) -> dict[str, xarray.DataArray]:
    """Return kind, period and whether each run has the ⟨J⟩ and kind of motion of the attractor that its state reaches.

    If ⟨J⟩ agrees, the run is given the kind of the attractor, which was followed for longer, so that all runs on one
    attractor have the same kind.

    motion : mean_distance, its error, kind and period of the runs; reached : see `reached_attractors`
    """
    mean, has_attractor = motion["mean_distance"], reached["known"]
    larger = np.maximum(reached["mean_distance"], mean)
    error = xarray.apply_ufunc(np.hypot, reached["mean_distance_error"], motion["mean_distance_error"])
    allowed = np.maximum(agreement["standard_errors"] * error, np.maximum(MEAN_TOLERANCE * larger, threshold))
    agrees = has_attractor & (np.abs(reached["mean_distance"] - mean) <= allowed)
    # Transient chaos that outlasts the run is chaos in the run.
    lasting = xarray.where(reached["mean_distance"] < threshold, MotionKind.SYNCHRONIZED_CHAOS, MotionKind.CHAOTIC)
    finer = xarray.where(reached["kind"] == MotionKind.TRANSIENT_CHAOS, lasting, reached["kind"])
    same = xarray.apply_ufunc(is_same_result, motion["kind"], finer)
    is_kind = finer.isin((*REGULAR, *CHAOS, MotionKind.SLIDING))
    replaced = agrees & is_kind & (motion["kind"].isin(UNDECIDED_KINDS) | same)
    replaced |= (
        has_attractor & finer.isin(SYNCHRONOUS) & (mean < reached.attrs["resolution"] * reached.attrs["v"] / 0.1)
    )
    kind = xarray.where(replaced, finer, motion["kind"])
    agrees &= (finer == MotionKind.UNDETERMINED) | xarray.apply_ufunc(is_same_result, kind, finer)
    # If the errors exceed the tolerance between laws, agreement of ⟨J⟩ does not show that the motions are the same.
    is_accurate = allowed <= np.maximum(agreement["relative_tolerance"] * larger, threshold)
    decided = has_attractor & np.isfinite(mean) & (kind != MotionKind.UNDETERMINED) & (is_accurate | ~agrees)
    return {
        "kind": kind,
        "period": xarray.where(replaced, reached["period"], motion["period"]),
        "settled": xarray.where(decided, agrees, Answer.UNDETERMINED),
    }


def compare_events(study: Study, results: Path) -> xarray.Dataset:
    """Return the variables of EVENT_VARIABLES, from the point files of each other law and of the first law.

    results : folder of the study
    """

    def compare(run: Mapping[str, np.ndarray], point: Mapping[str, str]) -> dict[str, float]:
        first = read_point(study, results, {**point, "law": study.laws[0]}, _EVENTS_READ)
        count, until = common_order(all_events(first), all_events(run))
        return {
            "section_distance": _section_distance(_upward_crossings(first), _upward_crossings(run)),
            "event_order_count": count,
            "event_order_time": min(until, float(first["end_time"]), float(run["end_time"])),
        }

    others = study.of_laws(study.laws[1:])
    values = over_runs(others, results, EVENT_VARIABLES, _EVENTS_READ, compare)
    coordinates = {**point_axes(study), **axes(other_law=others.laws)}
    del coordinates["law"]
    return xarray.Dataset({name: (_PAIR, array) for name, array in values.items()}, coordinates)


def _upward_crossings(run: Mapping[str, np.ndarray]) -> np.ndarray:
    """Return W' of the upward crossings of a run."""
    return run["crossing_velocity"][run["crossing_direction"] > 0]


def _section_distance(one: np.ndarray, other: np.ndarray) -> float:
    """Return the Wasserstein distance of two samples, NaN if one is empty."""
    if not len(one) or not len(other):
        return np.nan
    return float(f"{scipy.stats.wasserstein_distance(one, other):.{DIGITS}g}")


def table(dataset: xarray.Dataset) -> str:
    """Return the comparison as CSV, one line for each initial state and a.

    If several laws are compared with the first, the columns of each comparison end with the name of the other law.
    """
    laws, other_laws = (dataset[name].values.tolist() for name in ("law", "other_law"))
    end = {other: f"_{other}" if len(other_laws) > 1 else "" for other in other_laws}
    compared = ("difference", "difference_error", "section_distance", "event_order_time")
    names = ["initial", "a", *(f"mean_distance_{law}" for law in laws)]
    names += [f"{name}{end[other]}" for other in other_laws for name in compared]
    names += [*(f"{name}_{law}" for name in ("kind", "settled") for law in laws)]
    names += [f"agrees{end[other]}" for other in other_laws]
    lines = io.StringIO()
    lines.write(",".join(names) + "\n")
    for initial in dataset["initial"].values:
        for a in dataset["a"].values:
            row = dataset.sel(initial=initial, a=a)
            cells = [initial, f"{a:.10g}", *(f"{mean:.8e}" for mean in row["mean_distance"].values)]
            for other in other_laws:
                difference, error, section, order = (row[name].sel(other_law=other).item() for name in compared)
                cells += [f"{difference:.8e}", f"{error:.2e}", f"{section:.6e}", f"{order:.3f}"]
            cells += [MotionKind(kind).words for kind in row["kind"].values]
            cells += [Answer(answer).name.lower() for name in ("settled", "agrees") for answer in row[name].values]
            lines.write(",".join(cells) + "\n")
    return lines.getvalue()


def digest(dataset: xarray.Dataset) -> str:
    """Return a line for each other law and initial state: at how many a it agrees with the first, and where not."""
    first, other_laws = dataset["law"].values[0], dataset["other_law"].values
    lines = [] if len(other_laws) else [f"The {first} law is the only one: there is nothing to compare."]
    for other in other_laws:
        for initial in dataset["initial"].values:
            comparison = _agreement_text(dataset.sel(other_law=other, initial=initial, law=[first, other]))
            lines.append(f"{initial}, {other} law compared with the {first} law: {comparison}")
    for law in dataset["law"].values:
        for initial in dataset["initial"].values:
            settled = dataset["settled"].sel(law=law, initial=initial)
            unsettled = settled["a"].values[settled.values == Answer.NO]
            if len(unsettled):
                where = ", ".join(f"{a:g}" for a in unsettled)
                lines.append(
                    f"{initial}, {law} law: the run has not reached the attractor of its initial state at a = {where}"
                )
    return "\n".join(lines) + "\n"


def _agreement_text(row: xarray.Dataset) -> str:
    """Return as text where two laws agree and where they disagree, from one initial state; row : of both laws."""
    verdict = row["agrees"].values
    a = row["a"].values[verdict >= 0]
    different = row["a"].values[verdict == 0]
    if not len(a):
        text = "no value of a could be compared."
    elif not len(different):
        several = f"all {len(a)} values of a that were compared, {a[0]:g} to {a[-1]:g}"
        text = f"they agree at {several if len(a) > 1 else f'the only value of a that was compared, {a[0]:g}'}."
    else:
        first, last = different[[0, -1]]
        where = f"first at a = {first:g} and last at {last:g}" if first < last else f"at a = {first:g}"
        other_kind = np.count_nonzero(row["same_kind"].values == 0)
        kinds = f"; the kind of motion differs at {other_kind}" if other_kind else ""
        text = f"they agree at {len(a) - len(different)} of {len(a)} values of a and disagree {where}{kinds}."
    if undetermined := int((verdict < 0).sum()):
        text += (
            f" At {format_count(undetermined, 'value')} of a the comparison is undetermined: "
            f"{' or '.join(_undetermined_reasons(row))}."
        )
    return text


def _undetermined_reasons(row: xarray.Dataset) -> Iterator[str]:
    """Yield why the comparison of two laws is undetermined where it is."""
    undetermined = row["agrees"].values < 0
    incomplete = row["mean_distance"].isnull().any("law").values
    unclear = (row["kind"] == MotionKind.UNDETERMINED).any("law").values & ~incomplete
    for holds, words in (
        (incomplete, "a run did not complete"),
        (unclear, "the kind of motion of a run is undetermined"),
        (~incomplete & ~unclear, "the difference of <J> is close to the tolerance"),
    ):
        if (undetermined & holds).any():
            yield words
