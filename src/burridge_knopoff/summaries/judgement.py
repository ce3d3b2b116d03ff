"""When two friction laws agree: the verdict from motions and mean distances under both."""

from __future__ import annotations

from collections.abc import Mapping
from enum import IntEnum
from typing import Any

import numpy as np

from burridge_knopoff.stability.motion import MotionKind, same_result


class Answer(IntEnum):
    """Whether two laws agree, numbered as in netCDF files."""

    UNDETERMINED = -1
    NO = 0
    YES = 1


def judge(values: dict[str, np.ndarray], a: np.ndarray, threshold: float, agreement: Mapping[str, Any]) -> None:
    """Fill in differences and verdicts: the laws agree where the motion is of one kind and ⟨J⟩ within a tolerance.

    A torus and a closed orbit without synchrony are one kind here: which of them a value of a shows, one beside it need
    not (`motion.REGULAR`). Where the kind of one of the two motions is not determined, only ⟨J⟩ beyond the tolerance is
    a verdict.
    values : mean_distance, its error and kind of both laws, the first and the other, shape (2, …, a); the rest is
        filled in
    a : ascending, shape (a,)
    """
    first, other = values["mean_distance"]
    kind = values["kind"]
    values["difference"][...] = other - first
    values["difference_error"][...] = np.hypot(*values["mean_distance_error"])
    determined = (kind != MotionKind.UNDETERMINED).all(axis=0)
    values["same_kind"][...] = np.where(determined, same_result(*kind), Answer.UNDETERMINED)
    tolerance = np.maximum.reduce(
        [
            agreement["relative_tolerance"] * np.maximum(first, other),
            agreement["standard_errors"] * values["difference_error"],
            np.full_like(first, threshold),
        ]
    )
    apart = np.abs(values["difference"]) > tolerance
    disagrees = apart | (values["same_kind"] == Answer.NO)
    open_kind = ~determined | np.isnan(values["difference"]) | np.isnan(tolerance)
    values["agrees"][...] = np.where(disagrees, Answer.NO, np.where(open_kind, Answer.UNDETERMINED, Answer.YES))
    for j, agrees in enumerate(values["agrees"]):
        apart = a[agrees == Answer.NO]
        values["parting_a"][j] = apart[0] if len(apart) else np.nan
