"""The branches of attractors as a table in a text."""

from __future__ import annotations

from collections.abc import Iterable

import xarray

from burridge_knopoff.summaries.branch_rows import branch_rows
from burridge_knopoff.summaries.text_table import UNLIMITED, table, wrap_line

HEAD = ("branch", "a", "count", "<J>", "motion", "basin")
#: What the columns mean that are not plain.
ABOUT = (
    "a: smallest and largest value at which the branch exists; count: number of values of a at which it exists; "
    "basin: largest fraction of the sampled states at one a that reach it, both sides of a mirror pair together."
)


def branch_lines(attractors: xarray.Dataset, width: int = UNLIMITED) -> list[str]:
    """Return the branches under each law, in lines of at most a width.

    A branch has a row with its range of a, its ⟨J⟩, its kinds of motion and its largest basin fraction.
    """
    lines, every = wrap_line(ABOUT, width), list(branch_rows(attractors))
    for law in attractors["law"].values:
        rows = [
            (
                row.name,
                _ends(f"{value:g}" for value in row.a[[0, -1]]),
                str(len(row.a)),
                _ends(f"{value:.4f}" for value in row.distance),
                row.kinds,
                f"{row.fraction[0]:.3f}" if row.fraction else "not sampled",
            )
            for row in every
            if row.law == law
        ]
        count = attractors.sizes["a"]
        head = f"{law} law: {len(rows)} branch{'es' * (len(rows) != 1)}{f' at {count} values of a' * (count > 1)}"
        lines += ["", *wrap_line(f"{head}; {_exceptions(attractors.sel(law=law))}", width)]
        lines += table(HEAD, rows, width) if rows else []
    return lines


def _ends(numbers: Iterable[str]) -> str:
    """Return a range of numbers without blanks, so that a narrow column does not divide it."""
    return "-".join(dict.fromkeys(numbers))


def _exceptions(part: xarray.Dataset) -> str:
    """Return how many sampled states are undetermined, and at which a no attractor was found, as text."""
    words = [
        f"{int(part['undetermined_count'].sum())} of {int(part['sample_count'].sum())} sampled states are undetermined"
    ]
    sliding = part["sliding_attracts"].values == 1
    for where, problem in (
        (part["branch"].values.max(axis=1) < 0, "no attractor"),
        (sliding, "uniform sliding attracts"),
    ):
        if where.any():
            a = part["a"].values
            words.append(problem + (f" at a = {', '.join(f'{value:g}' for value in a[where])}" if len(a) > 1 else ""))
    return "; ".join(words)
