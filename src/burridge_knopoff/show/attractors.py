"""A table of the attractors of one law at one a."""

from __future__ import annotations

import numpy as np
import xarray

from burridge_knopoff.attractors.attractor import Lifetime
from burridge_knopoff.attractors.lookup import branch_names, side_name
from burridge_knopoff.motion.kind import MotionKind
from burridge_knopoff.show.formatting import wrap_lines
from burridge_knopoff.study.formatting import to_ascii, with_error
from burridge_knopoff.summaries.branch_table import branch_lines
from burridge_knopoff.summaries.text_table import UNLIMITED, table


def branch_label(attractors: xarray.Dataset, branch: int, side: int) -> str:
    """Return the name of a branch on one of its sides."""
    return side_name(branch_names(attractors)[branch], side)


def attractor_table(attractors: xarray.Dataset, columns: dict[str, list[str]], width: int = UNLIMITED) -> list[str]:
    """Return the lines of a table of the attractors of one law and one a, wrapped to a width.

    columns : {head: a text for each attractor}, appended to the table
    """
    rows = []
    for slot in np.flatnonzero(attractors["branch"].values[0, 0] >= 0):
        attractor = attractors.isel(law=0, a=0, attractor=slot)
        points, period, kind = (
            attractor["section_period"].item(),
            attractor["period"].item(),
            MotionKind(attractor["kind"].item()),
        )
        exponent = attractor["lyapunov_exponent"].values
        locked = kind == MotionKind.QUASIPERIODIC and np.isfinite(period)
        depth = f", locked: period {period:.5g}" if locked else ""
        if attractor["lifetime_ends"].item() >= 0:
            depth = f", {Lifetime(attractor['lifetime_ends'].item(), attractor['lifetime_time'].item()).words}"
        rows.append(
            (
                branch_label(attractors, attractor["branch"].item(), attractor["side"].item()),
                f"{kind.words}{f' {points}' if points else depth}",
                to_ascii(with_error(attractor["mean_distance"].item(), attractor["mean_distance_error"].item())),
                " ".join(f"{value:z7.4f}" for value in exponent[~np.isnan(exponent)]),
                *(column[slot] for column in columns.values()),
            )
        )
    return table(("attractor", "motion, section points", "<J>", "Lyapunov exponents", *columns), rows, width)


def branches(attractors: xarray.Dataset, width: int) -> list[str]:
    """Return lines about the attractors at all values of a: a table of their branches.

    A file of one law has other numbers of branches than the summary of all laws, and no names; it has no table.
    """
    if "branch_name" in attractors:
        return branch_lines(attractors, width)
    branch = attractors["branch"].values
    count, numbers = (branch >= 0).sum(axis=-1)[0], np.unique(branch[branch >= 0])
    most = f"at most {count.max()} attractors coexist, mirror images counted separately"
    words = f"{attractors['law'].item()}: {len(numbers)} branch{'es' * (len(numbers) != 1)} of attractors; {most}"
    where = f", first at a = {attractors['a'].values[count.argmax()]:g}" if len(numbers) else ""
    all_laws = "summary/attractors.nc has the attractors of all laws, with the names of the branches"
    return wrap_lines([f"{words}{where}", all_laws], width)
