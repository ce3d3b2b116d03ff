"""The tori in `bifurcations.nc`: each with its interval of a, and the motion at some values inside."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
import xarray

from burridge_knopoff.continuation.tori import VALUES, Torus
from burridge_knopoff.dataset.columns import Column, column_values
from burridge_knopoff.dataset.variables import PERIOD, Variable, flag
from burridge_knopoff.motion.kind import MotionKind
from burridge_knopoff.periodic_orbits.bifurcation_kind import BifurcationKind

_TORUS, _VALUE = ("torus",), ("torus", "torus_value")
_INSIDE = "NaN beyond the last value that was reached"

#: Columns of a torus, from its `Torus`.
TORI = {
    "torus_branch": Column(_TORUS, "i2", "branch that moves on the torus", value=lambda torus: torus.branch),
    "torus_low": Column(
        _TORUS, "f8", "smallest a of the torus: where it begins, or the next orbit does", value=lambda torus: torus.low
    ),
    "torus_high": Column(
        _TORUS, "f8", "largest a of the torus: where it begins, or the next orbit does", value=lambda torus: torus.high
    ),
    "torus_end": Column(
        _TORUS,
        "i1",
        "kind of the bifurcation: where an orbit ends and the torus begins",
        flag("i1", BifurcationKind),
        value=lambda torus: torus.end.kind,
    ),
    "torus_a": Column(
        _VALUE,
        "f8",
        "friction parameter a: inside the torus",
        {"comment": _INSIDE},
        value=lambda torus: [point.a for point in torus.points],
    ),
    "torus_kind": Column(
        _VALUE,
        "i1",
        "kind of motion: periodic where the torus is locked",
        flag("i1", MotionKind),
        value=lambda torus: [point.kind for point in torus.points],
    ),
    "torus_period": Column(_VALUE, "f8", *PERIOD, value=lambda torus: [point.period for point in torus.points]),
    "torus_rotation_number": Column(
        _VALUE,
        "f8",
        "rotation number: turns about the orbit that has ended, in a period of it",
        {"comment": "NaN if the motion does not turn about this orbit"},
        value=lambda torus: [point.rotation for point in torus.points],
    ),
}
#: Significant digits of rotation numbers.
ROTATION_DIGITS = 6
VARIABLES: dict[str, Variable] = {"torus_law": Variable(_TORUS, "U", "friction law"), **TORI}


def torus_values(tori: Sequence[Torus]) -> dict[str, np.ndarray]:
    """Return the values of TORI, one row for each torus."""
    return column_values(
        TORI, {(k,): torus for k, torus in enumerate(tori)}, {"torus": len(tori), "torus_value": VALUES}
    )


def torus_lines(dataset: xarray.Dataset) -> Iterator[str]:
    """Yield a line for each torus: its interval, its motion and its rotation numbers."""
    for number in range(dataset.sizes["torus"]):
        row = {name: dataset[name].values[number] for name in VARIABLES}
        inside = np.isfinite(row["torus_a"])
        locked, rotation = row["torus_kind"][inside] == MotionKind.PERIODIC, row["torus_rotation_number"]
        text = (
            f"{row['torus_law']}, a = {row['torus_low']:.10g} to {row['torus_high']:.10g}: torus; branch "
            f"{row['torus_branch']}; locked at {np.count_nonzero(locked)} of {len(locked)} values"
        )
        if np.isfinite(rotation).any():
            text += f"; rotation number {np.nanmin(rotation):.5f} to {np.nanmax(rotation):.5f}"
        yield text
