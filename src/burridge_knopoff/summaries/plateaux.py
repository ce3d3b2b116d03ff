"""Plateaux of a rotation number, and the share of a that is locked, from `rotation.nc`."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np

from burridge_knopoff.model.sampling import fraction_interval

if TYPE_CHECKING:
    import xarray

# Denominators of the fractions that rotation numbers of closed orbits are told by, at most.
LARGEST_DENOMINATOR = 1000

# Only rotation numbers as exact as this can be seen to be the same.
LARGEST_ERROR = 1e-6

# What rounding leaves of a rotation number.
ROUNDING = 1e-9


@dataclass(frozen=True)
class Plateau:
    """A range of a in which the motion is locked: from the first to the last value that shows it.

    ratio : the rotation number as a fraction, the simplest one within its error
    """

    first: float
    last: float
    ratio: Fraction


def plateaux(rotation: xarray.Dataset) -> list[Plateau]:
    """Return the plateaux of one law: successive values of a that are locked and have one rotation number.

    Values at which the motion was not looked at are passed over: between those of the grid only what changes is.
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
    """Return the fraction with the least denominator within the error of a number."""
    for denominator in range(1, LARGEST_DENOMINATOR + 1):
        numerator = round(number * denominator)
        if abs(numerator / denominator - number) <= error + ROUNDING:
            return Fraction(numerator, denominator)
    return Fraction(number).limit_denominator(LARGEST_DENOMINATOR)


def locked_share(rotation: xarray.Dataset, inside: np.ndarray) -> tuple[float, float, float]:
    """Return the share of a at which one law is locked, and the ends of its 95 % Wilson interval; NaN if none is known.

    inside : which values of a are looked at, shape (value,)

    By the values of the grid alone: those put in between lie where something changes.
    """
    locked = rotation["locked"].values[inside & (rotation["in_grid"].values == 1)]
    locked = locked[locked >= 0]
    if not len(locked):
        return np.nan, np.nan, np.nan
    return fraction_interval(int(np.count_nonzero(locked)), len(locked))
