"""Plateaux of the rotation number, and the fraction of a at which the motion is locked, from `rotation.nc`."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    import xarray

# Largest denominator of the fractions that describe rotation numbers of periodic orbits.
LARGEST_DENOMINATOR = 1000

# Rotation numbers with larger errors are not compared with each other.
LARGEST_ERROR = 1e-6

# Rounding error of a rotation number.
ROUNDING = 1e-9


@dataclass(frozen=True)
class Plateau:
    """A range of a in which the motion is locked, from the first to the last locked value.

    ratio : the rotation number as the simplest fraction within its error
    """

    first: float
    last: float
    ratio: Fraction


def plateaux(rotation: xarray.Dataset) -> list[Plateau]:
    """Return the plateaux of one law: successive locked values of a with the same rotation number.

    Values without a rotation number are skipped; between values of the grid only changes are resolved.
    """
    number, error, a = (rotation[name].values for name in ("rotation_number", "rotation_error", "a"))
    locked = rotation["locked"].values
    runs: list[list[int]] = []
    last = -1
    for k in np.flatnonzero((locked >= 0) & np.isfinite(number)).tolist():
        if locked[k]:
            sharp = max(error[k], error[last]) <= LARGEST_ERROR
            if runs and runs[-1][-1] == last and sharp and abs(number[k] - number[last]) <= 2.0 * LARGEST_ERROR:
                runs[-1].append(k)
            else:
                runs.append([k])
        last = k
    return [
        Plateau(float(a[run[0]]), float(a[run[-1]]), _simplest_fraction(*_best(number[run], error[run])))
        for run in runs
    ]


def _best(number: np.ndarray, error: np.ndarray) -> tuple[float, float]:
    return number[error.argmin()], error.min()


def _simplest_fraction(number: float, error: float) -> Fraction:
    """Return the fraction with the smallest denominator within the error of a number."""
    for denominator in range(1, LARGEST_DENOMINATOR + 1):
        numerator = round(number * denominator)
        if abs(numerator / denominator - number) <= error + ROUNDING:
            return Fraction(numerator, denominator)
    return Fraction(number).limit_denominator(LARGEST_DENOMINATOR)


def locked_share(rotation: xarray.Dataset, inside: np.ndarray) -> float:
    """Return the share of the values of a at which the motion is locked; NaN if none is known.

    inside : which values of a count, shape (value,)

    Only values of the grid count, since values are inserted where the motion changes.
    """
    locked = rotation["locked"].values[inside & (rotation["in_grid"].values == 1)]
    locked = locked[locked >= 0]
    return float(locked.mean()) if len(locked) else np.nan
