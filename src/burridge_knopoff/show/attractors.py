"""A table of the attractors of one law at one a."""

from __future__ import annotations

import numpy as np
import xarray

from burridge_knopoff.attractors.lookup import branch_names, side_name
from burridge_knopoff.motion.kind import MotionKind
from burridge_knopoff.show.formatting import table
from burridge_knopoff.study.formatting import to_ascii, with_error


def branch_label(found: xarray.Dataset, branch: int, side: int) -> str:
    """Return the name of a branch on one of its sides."""
    return side_name(branch_names(found)[branch], side)


def attractor_table(found: xarray.Dataset, columns: dict[str, list[str]]) -> list[str]:
    """Return the lines of a table of the attractors of one law and one a.

    columns : {head: a text for each attractor}, appended to the table
    """
    rows = []
    for slot in np.flatnonzero(found["branch"].values[0, 0] >= 0):
        one = found.isel(law=0, a=0, attractor=slot)
        points, period, kind = one["section_period"].item(), one["period"].item(), MotionKind(one["kind"].item())
        locked = kind == MotionKind.QUASIPERIODIC and np.isfinite(period)
        rows.append(
            (
                branch_label(found, one["branch"].item(), one["side"].item()),
                f"{kind.words}{f' {points}' if points else f', locked: period {period:.5g}' if locked else ''}",
                to_ascii(with_error(one["mean_distance"].item(), one["mean_distance_error"].item())),
                " ".join(f"{value:z7.4f}" for value in one["lyapunov_exponent"].values),
                *(column[slot] for column in columns.values()),
            )
        )
    return table(("attractor", "motion, section points", "<J>", "Lyapunov exponents", *columns), rows)
