"""Whether two friction laws agree: the verdict from the kinds of motion and mean distances under both."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray
from numpy.typing import ArrayLike

from burridge_knopoff.dataset.variables import ANSWER, Answer, Variable
from burridge_knopoff.model.sampling import fraction_interval
from burridge_knopoff.motion.kind import SYNCHRONOUS, MotionKind, is_same_result


def pair_variables(pair: tuple[str, ...], **further: Variable) -> dict[str, Variable]:
    """Return the variables of a comparison of each other law with the first one.

    pair : their dimensions, of which the last is a; further : variables of one summary only
    """
    return {
        "difference": Variable(pair, "f8", "difference of <J>: that of the other law minus that of the first law"),
        "difference_error": Variable(pair, "f8", "standard error of the difference of <J>"),
        **further,
        "event_order_time": Variable(
            pair,
            "f8",
            "time of equal event order: time tau until which the order of events is the same under both laws",
        ),
        "event_order_count": Variable(
            pair, "i8", "events in equal order: number of events that occur in the same order under both laws"
        ),
        "same_kind": Variable(
            pair,
            "i1",
            "same kind of motion: whether both laws lead to the same kind of motion, periodic and quasiperiodic motion "
            "being one",
            ANSWER,
        ),
        "same_mean_distance": Variable(
            pair,
            "i1",
            "same <J>: whether <J> agrees within the tolerance",
            ANSWER | {"comment": "two synchronized motions agree"},
        ),
        "agrees": Variable(pair, "i1", "agreement: whether the kind of motion and <J> agree", ANSWER),
        "parting_a": Variable(
            pair[:-1],
            "f8",
            "smallest a with disagreement: smallest a of the grid at which the laws disagree, NaN if there is none",
        ),
    }


def compare_laws(motion: xarray.Dataset, threshold: float, agreement: Mapping[str, Any]) -> xarray.Dataset:
    """Return differences and verdicts: laws agree if the kind of motion is the same and ⟨J⟩ within a tolerance.

    Periodic and quasiperiodic motion count as the same kind, because they alternate along a (`motion.REGULAR`). If one
    kind is undetermined, the verdict can only be that the laws disagree, namely if ⟨J⟩ differs by more than the
    tolerance. If the difference of ⟨J⟩ lies within its error of the tolerance, the verdict is undetermined, except that
    two synchronized motions always agree.

    motion : mean_distance, its error and kind over (law, …, a); each further law is compared with the first

    Returned are difference, difference_error, same_kind, same_mean_distance, agrees and the excess of the difference
    over the tolerance, over (other_law, …, a), and parting_a, the smallest a at which the laws disagree.
    """
    first, other = law_pairs(motion[["mean_distance", "mean_distance_error", "kind"]])
    difference = other["mean_distance"] - first["mean_distance"]
    error = xarray.apply_ufunc(np.hypot, other["mean_distance_error"], first["mean_distance_error"])
    scale = np.maximum(other["mean_distance"], first["mean_distance"])
    synchronous = other["kind"].isin(SYNCHRONOUS) & first["kind"].isin(SYNCHRONOUS)
    determined = (other["kind"] != MotionKind.UNDETERMINED) & (first["kind"] != MotionKind.UNDETERMINED)
    same_kind = xarray.apply_ufunc(is_same_result, other["kind"], first["kind"])
    same_kind = xarray.where(determined, same_kind, Answer.UNDETERMINED)
    margin = excess(difference, scale, threshold, agreement)
    same = same_mean(margin, error, synchronous, agreement)
    disagree = (same_kind == Answer.NO) | (same == Answer.NO)
    agree = determined & (same == Answer.YES)
    agrees = xarray.where(disagree, Answer.NO, xarray.where(agree, Answer.YES, Answer.UNDETERMINED))
    return xarray.Dataset(
        {
            "difference": difference,
            "difference_error": error,
            "same_kind": same_kind,
            "same_mean_distance": same,
            "agrees": agrees,
            "parting_a": motion["a"].where(agrees == Answer.NO).min("a"),
            "excess": margin,
        }
    )


def compare_states(motion: xarray.Dataset, threshold: float, agreement: Mapping[str, Any]) -> xarray.Dataset:
    """Return what `compare_laws` does, the margin of ⟨J⟩ in errors, and the fractions of the states that agree.

    motion : mean_distance, its error and kind over (…, law, state, a)
    """
    comparison = compare_laws(motion, threshold, agreement)
    fraction, low, high = xarray.apply_ufunc(
        agreeing_fraction,
        comparison["agrees"],
        input_core_dims=[["state"]],
        output_core_dims=[[], [], []],
        vectorize=True,
        output_dtypes=3 * [float],
    )
    margin = comparison["excess"] / comparison["difference_error"]
    return comparison.assign(margin=margin, agreeing_fraction=fraction, agreeing_low=low, agreeing_high=high)


def agreeing_fraction(agrees: np.ndarray) -> tuple[float, float, float]:
    """Return the fraction of the states for which the laws are known to agree, and its confidence interval.

    agrees : Answer for each state, shape (states,)

    Undetermined states count as disagreeing at the lower end of the interval and as agreeing at the upper end.
    """
    agreeing, possible = (int(np.count_nonzero(such)) for such in (agrees == Answer.YES, agrees != Answer.NO))
    fraction, low, _ = fraction_interval(agreeing, len(agrees))
    return fraction, low, fraction_interval(possible, len(agrees))[2]


def law_pairs(dataset: xarray.Dataset) -> tuple[xarray.Dataset, xarray.Dataset]:
    """Return the part of a Dataset under the first law, and those under each other law, over other_law."""
    first, other = dataset.isel(law=0, drop=True), dataset.isel(law=slice(1, None))
    return first, other.rename(law="other_law")


def excess(difference: ArrayLike, scale: ArrayLike, threshold: float, agreement: Mapping[str, Any]) -> Any:
    """Return by how much differences of ⟨J⟩ exceed the tolerance: a fraction of a scale, at least the threshold."""
    return np.abs(difference) - np.maximum(agreement["relative_tolerance"] * scale, threshold)


def same_mean(excess: ArrayLike, error: ArrayLike, synchronous: ArrayLike, agreement: Mapping[str, Any]) -> Any:
    """Return an Answer to whether ⟨J⟩ agrees.

    It agrees for two synchronized motions. It is undetermined if the difference lies within its error of the tolerance.

    excess : as `excess` returns it; error : of the difference; synchronous : whether both motions are synchronized
    """
    margin = agreement["standard_errors"] * error
    within = (excess <= -margin) | synchronous
    return xarray.where(excess > margin, Answer.NO, xarray.where(within, Answer.YES, Answer.UNDETERMINED))
