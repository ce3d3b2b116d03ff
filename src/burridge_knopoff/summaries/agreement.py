"""Agreement of each friction law of a study with the first one, for each initial state and a."""

from __future__ import annotations

import io
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
import scipy
import xarray

from burridge_knopoff.attractors.lookup import reached_values
from burridge_knopoff.dataset.summary import summary
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
from burridge_knopoff.summaries.event_order import common_order
from burridge_knopoff.summaries.judgement import compare
from burridge_knopoff.summaries.points import EVENTS, Grid, all_events, read_point

# Significant digits: the last bits of a product of vectors depend on their alignment in memory.
DIGITS = 12

_POINT = ("law", "initial", "a")
_PAIR = ("other_law", "initial", "a")
# Relative difference of ⟨J⟩ that is allowed between a run and its attractor even if their errors are smaller.
MEAN_TOLERANCE = 0.01
KIND_COMMENT = (
    "kind of the attractor that the run has reached, which was followed for longer than the run; a run that approaches "
    "synchrony counts as synchronized; if the run has reached no known attractor, the kind that the run alone shows"
)
POINT_VARIABLES = {
    "mean_distance": Variable(_POINT, "f8", "time average <J> of the phase-space distance between the end blocks"),
    "mean_distance_error": Variable(_POINT, "f8", "standard error of <J> from the batch means"),
    "kind": Variable(_POINT, "i1", "kind of motion", flag("i1", MotionKind) | {"comment": KIND_COMMENT}),
}
RUN_VARIABLES = {
    "period": Variable(_POINT, "f8", *PERIOD),
    "settled": Variable(
        _POINT,
        "i1",
        "whether the run ended on the attractor that its initial state reaches",
        ANSWER | {"comment": "no: the transient was too short, or the chaos ended within the window"},
    ),
}
PAIR_VARIABLES = {
    "difference": Variable(_PAIR, "f8", "<J> of the other law minus <J> of the first law"),
    "difference_error": Variable(_PAIR, "f8", "standard error of the difference of <J>"),
    "section_distance": Variable(
        _PAIR, "f8", "Wasserstein distance between the distributions of W' on upward crossings of both laws"
    ),
    "event_order_time": Variable(_PAIR, "f8", "time tau until which the order of events is the same under both laws"),
    "event_order_count": Variable(_PAIR, "i8", "number of events that occur in the same order under both laws"),
    "same_kind": Variable(
        _PAIR,
        "i1",
        "whether both laws lead to the same kind of motion, periodic and quasiperiodic motion being one",
        ANSWER,
    ),
    "agrees": Variable(_PAIR, "i1", "whether the kind of motion and <J> agree", ANSWER),
    "parting_a": Variable(_PAIR[:2], "f8", "smallest a of the grid at which the laws disagree, NaN if there is none"),
}
VARIABLES = {**POINT_VARIABLES, **RUN_VARIABLES, **PAIR_VARIABLES}
OTHER_LAW = Variable(("other_law",), "O", "friction law compared with the first one", coordinate=True)
_READ = [
    *("end_time", "mean_distance", "mean_distance_error", "crossing_velocity", "crossing_direction"),
    *EVENTS,
]


def summarize(
    grid: Grid,
    lyapunov: xarray.Dataset,
    attractors: xarray.Dataset | None = None,
    *,
    synchronization_threshold: float,
    agreement: Mapping[str, Any],
) -> xarray.Dataset:
    """Compare each law with the first one at every grid point.

    lyapunov : the summary of that name, for the kinds of motion of runs
    attractors : the summary of that name, for the attractors that the initial states reach; without it `settled` is
        undetermined
    agreement : the config's section of that name: relative_tolerance, standard_errors
    """
    sizes = dict(zip(_POINT, grid.shape, strict=True), other_law=len(grid.laws) - 1)
    values = {name: np.zeros([sizes[key] for key in item.dimensions], item.dtype) for name, item in VARIABLES.items()}
    for j, initial in enumerate(grid.initial):
        for k, a in enumerate(grid.a):
            runs = [read_point(grid, (law, initial, a), _READ) for law in grid.laws]
            for i, run in enumerate(runs):
                values["mean_distance"][i, j, k] = run["mean_distance"]
                values["mean_distance_error"][i, j, k] = run["mean_distance_error"]
            for i, run in enumerate(runs[1:]):
                values["section_distance"][i, j, k] = _section_distance(
                    _upward_crossings(runs[0]), _upward_crossings(run)
                )
                count, until = common_order(all_events(runs[0]), all_events(run))
                values["event_order_count"][i, j, k] = count
                values["event_order_time"][i, j, k] = min(until, float(runs[0]["end_time"]), float(run["end_time"]))
    of_runs = lyapunov.sel(law=list(grid.laws))
    values["kind"][...], values["period"][...] = of_runs["run_kind"].values, of_runs["period"].values
    values["settled"][...] = Answer.UNDETERMINED
    if attractors is not None:
        _fill_settled(values, attractors, agreement, synchronization_threshold)
    for i in range(sizes["other_law"]):
        pair = {name: values[name][[0, i + 1]] for name in POINT_VARIABLES}
        compared = {name: values[name][i] for name in PAIR_VARIABLES}
        compare({**pair, **compared}, np.array(list(grid.a.values())), synchronization_threshold, agreement)
    shared = grid.axes()
    others = ("other_law", np.array(grid.laws[1:], dtype=object), OTHER_LAW.all_attributes())
    return summary(
        "Agreement of each friction law with the first one",
        VARIABLES,
        values,
        {"law": shared["law"], "other_law": others, **shared},
        {"synchronization_threshold": synchronization_threshold, **agreement},
        module=__name__,
    )


def _fill_settled(
    values: Mapping[str, np.ndarray], attractors: xarray.Dataset, agreement: Mapping[str, Any], threshold: float
) -> None:
    """Fill in whether each run has the ⟨J⟩ and the kind of motion of the attractor that its initial state reaches.

    If ⟨J⟩ agrees, the run is given the kind of the attractor, which was followed for longer, so that all runs on one
    attractor have the same kind.
    """
    relative_tolerance, standard_errors = agreement["relative_tolerance"], agreement["standard_errors"]
    own = attractors.sel(contact=attractors.attrs["contact"], start=attractors.attrs["start"])
    for law, initial in np.ndindex(values["settled"].shape[:2]):
        names = str(own["initial"].values[initial]), str(own["law"].values[law])
        known, mean = reached_values(own, *names, "mean_distance")
        _, error = reached_values(own, *names, "mean_distance_error")
        mine, my_error = (values[name][law, initial] for name in ("mean_distance", "mean_distance_error"))
        allowed = np.maximum(
            standard_errors * np.hypot(error, my_error), np.maximum(MEAN_TOLERANCE * np.maximum(mean, mine), threshold)
        )
        there = known & (np.abs(mean - mine) <= allowed)
        kind, (_, finer), (_, period) = (
            values["kind"][law, initial],
            *(reached_values(own, *names, k) for k in ("kind", "period")),
        )
        # Transient chaos that outlasts the run is chaos in the run.
        lasting = np.where(mean < threshold, MotionKind.SYNCHRONIZED_CHAOS, MotionKind.CHAOTIC)
        finer = np.where(finer == MotionKind.TRANSIENT_CHAOS, lasting, finer)
        replaced = (
            there & np.isin(finer, (*REGULAR, *CHAOS)) & (np.isin(kind, UNDECIDED_KINDS) | is_same_result(kind, finer))
        )
        replaced |= (
            known & np.isin(finer, SYNCHRONOUS) & (mine < attractors.attrs["resolution"] * attractors.attrs["v"] / 0.1)
        )
        kind[...] = np.where(replaced, finer, kind)
        values["period"][law, initial] = np.where(replaced, period, values["period"][law, initial])
        there &= (finer == MotionKind.UNDETERMINED) | is_same_result(kind, finer)
        # If the errors exceed the tolerance between laws, agreement of ⟨J⟩ does not show that the motions are the same.
        is_accurate = allowed <= np.maximum(relative_tolerance * np.maximum(mean, mine), threshold)
        known &= np.isfinite(mine) & (kind != MotionKind.UNDETERMINED) & (is_accurate | ~there)
        values["settled"][law, initial] = np.where(known, there, Answer.UNDETERMINED)


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
    laws, others = (dataset[name].values.tolist() for name in ("law", "other_law"))
    end = {other: f"_{other}" if len(others) > 1 else "" for other in others}
    compared = ("difference", "difference_error", "section_distance", "event_order_time")
    names = ["initial", "a", *(f"mean_distance_{law}" for law in laws)]
    names += [f"{name}{end[other]}" for other in others for name in compared]
    names += [*(f"{name}_{law}" for name in ("kind", "settled") for law in laws)]
    names += [f"agrees{end[other]}" for other in others]
    lines = io.StringIO()
    lines.write(",".join(names) + "\n")
    for initial in dataset["initial"].values:
        for a in dataset["a"].values:
            row = dataset.sel(initial=initial, a=a)
            cells = [initial, f"{a:.10g}", *(f"{mean:.8e}" for mean in row["mean_distance"].values)]
            for other in others:
                difference, error, section, order = (row[name].sel(other_law=other).item() for name in compared)
                cells += [f"{difference:.8e}", f"{error:.2e}", f"{section:.6e}", f"{order:.3f}"]
            cells += [MotionKind(kind).words for kind in row["kind"].values]
            cells += [Answer(answer).name.lower() for name in ("settled", "agrees") for answer in row[name].values]
            lines.write(",".join(cells) + "\n")
    return lines.getvalue()


def digest(dataset: xarray.Dataset) -> str:
    """Return a line for each other law and initial state: at how many a it agrees with the first, and where not."""
    first, others = dataset["law"].values[0], dataset["other_law"].values
    lines = [] if len(others) else [f"The {first} law is the only one: there is nothing to compare."]
    for other in others:
        for initial in dataset["initial"].values:
            found = _agreement_text(dataset.sel(other_law=other, initial=initial, law=[first, other]))
            lines.append(f"{initial}, {other} law compared with the {first} law: {found}")
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
