"""When two friction laws agree: the verdict from motions and mean distances under both."""

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
    """Fill in differences and verdicts: the laws agree where the motion is of one kind and ⟨J⟩ within a tolerance.

    Periodic and quasiperiodic motion are one kind here: which of them a value of a shows, one beside it need not
    (`motion.REGULAR`). Where the kind of one of the two motions is not determined, only ⟨J⟩ beyond the tolerance is
    a verdict; where the difference is within its errors of the tolerance there is none, but for motions that both are
    synchronized.
    values : mean_distance, its error and kind of both laws, the first and the other, shape (2, …, a); the rest is
        filled in
    a : ascending, shape (a,)
    """
    first, other = values["mean_distance"]
    kind = values["kind"]
    values["difference"][...] = other - first
    values["difference_error"][...] = np.hypot(*values["mean_distance_error"])
    determined = (kind != MotionKind.UNDETERMINED).all(axis=0)
    values["same_kind"][...] = np.where(determined, is_same_result(*kind), Answer.UNDETERMINED)
    same = same_mean(values, threshold, agreement)
    apart = (values["same_kind"] == Answer.NO) | (same == Answer.NO)
    together = determined & (same == Answer.YES)
    values["agrees"][...] = np.select([apart, together], [Answer.NO, Answer.YES], Answer.UNDETERMINED)
    for j, agrees in enumerate(values["agrees"]):
        parted = a[agrees == Answer.NO]
        values["parting_a"][j] = parted[0] if len(parted) else np.nan


def same_mean(values: Mapping[str, np.ndarray], threshold: float, agreement: Mapping[str, Any]) -> np.ndarray:
    """Return whether ⟨J⟩ agrees, an Answer each, shape (…, a); values as in `compare`, with difference and its error.

    Of two motions that are synchronized it does. Within its errors of the tolerance it is undetermined.
    """
    beyond, margin = excess(values, threshold, agreement), agreement["standard_errors"] * values["difference_error"]
    within = (beyond <= -margin) | np.isin(values["kind"], SYNCHRONOUS).all(axis=0)
    return np.select([beyond > margin, within], [Answer.NO, Answer.YES], Answer.UNDETERMINED)


def excess(values: Mapping[str, np.ndarray], threshold: float, agreement: Mapping[str, Any]) -> np.ndarray:
    """Return by how much differences of ⟨J⟩ lie beyond the tolerance, shape (…, a); values as in `compare`."""
    tolerance = np.maximum(agreement["relative_tolerance"] * np.maximum(*values["mean_distance"]), threshold)
    return np.abs(values["difference"]) - tolerance
