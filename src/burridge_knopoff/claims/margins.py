"""How far a verdict is from turning: the claim is judged again with other tolerances and on other grids.

A tolerance is a choice. Whoever reads a verdict should see which other sensible choice would change it, or leave too
little to judge: a tolerance within a factor of two, every second value of the grid of a, a compared value of a less, or
another motion of the inner blocks or level of J for which there are data.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from typing import Any

from burridge_knopoff.claims.evidence import Evidence
from burridge_knopoff.claims.verdict import NOT_TESTABLE, Verdict

# Parameters of judges that are a choice of ours: by this factor others may choose them larger or smaller.
CHOSEN = ("tolerance", "loose", "near", "relative", "much")
FACTOR = 2.0

# The same for those whose distance from 1 is the choice.
SHARES = ("share", "loose_share", "correlation")

# Of these there are data for a few values only: the summary whose coordinate lists them.
LISTED = {"inner_share": "phases", "level": "mean_distance"}

# Halvings of the factor at which a verdict turns: it is then known to 2 %.
HALVINGS = 5

Judge = Callable[[Evidence, Mapping[str, Any]], Verdict]


def turns(judge: Judge, evidence: Evidence, parameters: Mapping[str, Any], verdict: Verdict) -> list[str]:
    """Return what would turn a verdict, each as «verdict: what it takes»; empty if nothing that is tried does.

    judge : judges the claim from evidence and parameters; verdict : what it gives for these
    """
    if verdict.verdict == NOT_TESTABLE:
        return []
    return [
        *_by_tolerance(judge, evidence, parameters, verdict.verdict),
        *_by_grid(judge, evidence, parameters, verdict.verdict),
        *_by_listed(judge, evidence, parameters, verdict.verdict),
    ]


def _by_tolerance(judge: Judge, evidence: Evidence, parameters: Mapping[str, Any], verdict: str) -> Iterator[str]:
    for name in (*CHOSEN, *SHARES):
        if name not in parameters:
            continue

        def judged(exponent: float, name: str = name) -> str:
            return judge(evidence, {**parameters, name: _changed(parameters[name], name, exponent)}).verdict

        found = [(side, *_nearest(judged, side, verdict)) for side in (-1.0, 1.0)]
        if len({other for _, _, other in found if other != verdict}) == 1 and not any(same for _, same, _ in found):
            yield f"{found[0][2]}: any other {name} ({parameters[name]:g})"
            continue
        for side, same, other in found:
            if other != verdict:
                last = _changed(parameters[name], name, same)
                relation = "above" if _changed(parameters[name], name, side) > parameters[name] else "below"
                yield f"{other}: {name} {relation} {last:.3g} ({parameters[name]:g})"


def _nearest(judged: Callable[[float], str], side: float, verdict: str) -> tuple[float, str]:
    """Return the farthest exponent towards a side at which a verdict is still seen, and the verdict beyond.

    The verdict itself if it is so at the side as well.
    """
    same, turned, other = 0.0, side, judged(side)
    if other == verdict:
        return side, verdict
    for _ in range(HALVINGS):
        middle = 0.5 * (same + turned)
        found = judged(middle)
        if found == verdict:
            same = middle
        else:
            turned, other = middle, found
    return same, other


def _changed(value: float, name: str, exponent: float) -> float:
    """Return a tolerance changed by FACTOR to a power."""
    factor = FACTOR**exponent
    if name not in SHARES:
        return value * factor
    return math.copysign(min(max(1.0 - factor * (1.0 - abs(value)), 0.0), 1.0), value)


def _by_grid(judge: Judge, evidence: Evidence, parameters: Mapping[str, Any], verdict: str) -> Iterator[str]:
    """Judge on both halves of the grid, or without each of the few values at which solvers are compared."""
    if "relative" in parameters:
        if "solvers" in evidence.summaries:
            yield from _by_solved(judge, evidence, parameters, verdict)
        return
    halves = {}
    for half, first in zip(evidence.halves, ("first", "second"), strict=True):
        # Of one value there is no second half.
        if not all(dataset.sizes.get("a", 1) for dataset in half.summaries.values()):
            continue
        other = judge(half, parameters).verdict
        # One of the halves does not have the only value of a that a claim is on: that is no other choice.
        if other != NOT_TESTABLE or "at" not in parameters:
            halves[first] = other
    found = set(halves.values())
    if len(halves) == 2 and len(found) == 1:
        yield from (f"{other}: every second value of a" for other in found if other != verdict)
    else:
        yield from (
            f"{other}: every second value of a, from the {first} on"
            for first, other in halves.items()
            if other != verdict
        )


def _by_solved(judge: Judge, evidence: Evidence, parameters: Mapping[str, Any], verdict: str) -> Iterator[str]:
    solvers = evidence.summaries["solvers"]
    for a in solvers["a"].values.tolist():
        without = {**evidence.summaries, "solvers": solvers.sel(a=solvers["a"] != a)}
        other = judge(replace(evidence, summaries=without), parameters).verdict
        if other != verdict:
            yield f"{other}: without a = {a:g}"


def _by_listed(judge: Judge, evidence: Evidence, parameters: Mapping[str, Any], verdict: str) -> Iterator[str]:
    for name, summary in LISTED.items():
        if name not in parameters or summary not in evidence.summaries:
            continue
        for value in evidence.summaries[summary][name].values.tolist():
            other = judge(evidence, {**parameters, name: value}).verdict
            if other != verdict:
                yield f"{other}: {name} = {value:g} ({parameters[name]:g})"
