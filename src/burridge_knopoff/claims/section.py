"""Claims on the section W = 0 along a: where the line of one state begins in the section of another."""

from __future__ import annotations

import numpy as np

from burridge_knopoff.claims.evidence import Evidence
from burridge_knopoff.claims.verdict import FAILS, Measured, NotTestableError, Verdict, at_values, by_interval
from burridge_knopoff.summaries.bifurcation import section_points


def line_returns(
    evidence: Evidence,
    initial: tuple[str, str],
    law: str,
    claimed: float,
    near: float,
    tolerance: float,
    loose: float,
) -> Verdict:
    """Judge the a from which on the section of one state, crossed upward, has points on the line of another.

    initial : the state with the line, the state from which it is missing below
    claimed : a from which on the line is there; it is that of the other state at the last a below
    near : share of its W' within which a point is on the line
    """
    for name in initial:
        evidence.of_state("lyapunov", name)
    bifurcation = evidence.summary("bifurcation")
    (line_a, line), (grid, velocity) = (section_points(bifurcation, law, name, 1) for name in initial)
    below = line_a[(line_a > 0.0) & (line_a < claimed)]
    values = np.unique(grid[grid > 0.0])
    above = np.flatnonzero(values > claimed)
    if not len(below) or not len(above):
        raise NotTestableError(f"no run crosses the section on both sides of a = {claimed:g}")
    height = float(line[line_a == below.max()].mean())
    there = np.array([(np.abs(velocity[grid == a] - height) <= near * height).any() for a in values])
    measured = [Measured(f"W' of the line from {initial[0]} at a = {below.max():g}", height)]
    first = int(above[0])
    if there[first]:
        while first and there[first - 1]:
            first -= 1
    elif there[first:].any():
        first += int(np.argmax(there[first:]))
    else:
        return Verdict(FAILS, f"Above a = {claimed:g} no point from {initial[1]} ({law}) lies on the line.", measured)
    low, high = (float(values[first - 1]) if first else 0.0), float(values[first])
    measured.append(Measured("a from which on the line is there", 0.5 * (low + high), 0.5 * (high - low)))
    reason = (
        f"From {initial[1]} ({law}) the section has points on the line from between a = {low:g} and {high:g} on; the "
        f"claim says {claimed:g}."
    )
    gone = ~there & (values > high)
    changes = f"it is missing again {at_values(values, gone)}" if gone.any() else ""
    return Verdict(by_interval(low, high, claimed, tolerance, loose), reason, measured, changes)
