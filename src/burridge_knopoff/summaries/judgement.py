"""When two friction laws agree: the verdict from motions and mean distances under both."""

from __future__ import annotations

from collections.abc import Mapping
from enum import IntEnum
from typing import Any

import numpy as np

from burridge_knopoff.stability.motion import MotionKind, same_result


class Answer(IntEnum):
    """Whether something is so, as whether two laws agree or a run has settled, numbered as in netCDF files."""

    UNDETERMINED = -1
    NO = 0
    YES = 1


def compare(
    values: dict[str, np.ndarray],
    a: np.ndarray,
    threshold: float,
    agreement: Mapping[str, Any],
    *,
    certain: bool = False,
) -> None:
    """Fill in differences and verdicts: the laws agree where the motion is of one kind and ⟨J⟩ within a tolerance.

    A torus and a closed orbit without synchrony are one kind here: which of them a value of a shows, one beside it need
    not (`motion.REGULAR`). Where the kind of one of the two motions is not determined, only ⟨J⟩ beyond the tolerance is
    a verdict.
    values : mean_distance, its error and kind of both laws, the first and the other, shape (2, …, a); the rest is
        filled in
    a : ascending, shape (a,)
    certain : whether a verdict that ⟨J⟩ decides is left open where its distance from the tolerance is within the errors
    """
    first, other = values["mean_distance"]
    kind = values["kind"]
    values["difference"][...] = other - first
    values["difference_error"][...] = np.hypot(*values["mean_distance_error"])
    determined = (kind != MotionKind.UNDETERMINED).all(axis=0)
    values["same_kind"][...] = np.where(determined, same_result(*kind), Answer.UNDETERMINED)
    tolerance = allowed(values, threshold, agreement)
    apart = np.abs(values["difference"]) > tolerance
    other_kind = values["same_kind"] == Answer.NO
    unknown = ~determined | np.isnan(values["difference"]) | np.isnan(tolerance)
    agrees = np.where(other_kind | apart, Answer.NO, np.where(unknown, Answer.UNDETERMINED, Answer.YES))
    if certain:
        margin = np.abs(np.abs(values["difference"]) - tolerance)
        chance = margin < agreement["standard_errors"] * values["difference_error"]
        agrees = np.where(chance & ~other_kind, Answer.UNDETERMINED, agrees)
    values["agrees"][...] = agrees
    for j, agrees in enumerate(values["agrees"]):
        apart = a[agrees == Answer.NO]
        values["parting_a"][j] = apart[0] if len(apart) else np.nan


def allowed(values: Mapping[str, np.ndarray], threshold: float, agreement: Mapping[str, Any]) -> np.ndarray:
    """Return how far ⟨J⟩ may differ where two laws agree, shape (…, a); values as `judge` has filled them in."""
    larger = np.maximum(*values["mean_distance"])
    return np.maximum.reduce(
        [
            agreement["relative_tolerance"] * larger,
            agreement["standard_errors"] * values["difference_error"],
            np.full_like(larger, threshold),
        ]
    )
