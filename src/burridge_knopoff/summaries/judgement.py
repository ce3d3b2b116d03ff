"""Whether two friction laws agree: the verdict from the kinds of motion and mean distances under both."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from burridge_knopoff.dataset.variables import Answer
from burridge_knopoff.motion.kind import SYNCHRONOUS, MotionKind, is_same_result


def compare(
    values: dict[str, np.ndarray],
    a: np.ndarray,
    threshold: float,
    agreement: Mapping[str, Any],
) -> None:
    """Fill in differences and verdicts: the laws agree if the kind of motion is the same and ⟨J⟩ within a tolerance.

    Periodic and quasiperiodic motion count as the same kind, because they alternate along a (`motion.REGULAR`). If one
    kind is undetermined, the verdict can only be that the laws disagree, namely if ⟨J⟩ differs by more than the
    tolerance. If the difference of ⟨J⟩ lies within its error of the tolerance, the verdict is undetermined, except that
    two synchronized motions always agree.

    values : mean_distance, its error and kind under the first and the other law, shape (2, …, a); the other variables
        are filled in
    a : ascending, shape (a,)
    """
    first, other = values["mean_distance"]
    kind = values["kind"]
    values["difference"][...] = other - first
    values["difference_error"][...] = np.hypot(*values["mean_distance_error"])
    determined = (kind != MotionKind.UNDETERMINED).all(axis=0)
    values["same_kind"][...] = np.where(determined, is_same_result(*kind), Answer.UNDETERMINED)
    same = same_mean(values, threshold, agreement)
    disagree = (values["same_kind"] == Answer.NO) | (same == Answer.NO)
    agree = determined & (same == Answer.YES)
    values["agrees"][...] = np.select([disagree, agree], [Answer.NO, Answer.YES], Answer.UNDETERMINED)
    for j, agrees in enumerate(values["agrees"]):
        different = a[agrees == Answer.NO]
        values["parting_a"][j] = different[0] if len(different) else np.nan


def same_mean(values: Mapping[str, np.ndarray], threshold: float, agreement: Mapping[str, Any]) -> np.ndarray:
    """Return an Answer to whether ⟨J⟩ agrees, shape (…, a); values as in `compare`, with difference and its error.

    It agrees for two synchronized motions. It is undetermined if the difference lies within its error of the tolerance.
    """
    beyond, margin = excess(values, threshold, agreement), agreement["standard_errors"] * values["difference_error"]
    within = (beyond <= -margin) | np.isin(values["kind"], SYNCHRONOUS).all(axis=0)
    return np.select([beyond > margin, within], [Answer.NO, Answer.YES], Answer.UNDETERMINED)


def excess(values: Mapping[str, np.ndarray], threshold: float, agreement: Mapping[str, Any]) -> np.ndarray:
    """Return by how much differences of ⟨J⟩ exceed the tolerance, shape (…, a); values as in `compare`."""
    tolerance = np.maximum(agreement["relative_tolerance"] * np.maximum(*values["mean_distance"]), threshold)
    return np.abs(values["difference"]) - tolerance
