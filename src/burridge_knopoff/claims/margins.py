"""The margin of a verdict: the claim is judged again with other tolerances and on other grids.

A tolerance is a choice. A reader should see which other sensible choices would change a verdict, or leave too little
data to judge. Tried are: a tolerance of the claim or of the study within a factor of two; every second value of a; the
neighbour of a named value of a; one compared value of a less; and other amplitudes of the inner blocks, detunings,
levels of J, or parts of the runs for which there are data. If the claim depends on convention or reading, the verdicts
under each count as well.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from burridge_knopoff.claims.evidence import Evidence
from burridge_knopoff.claims.verdict import CONVENTION, NOT_TESTABLE, READING, Verdict

# Parameters of judges that are our choice; others may choose values larger or smaller by this factor.
CHOSEN = ("tolerance", "loose", "near", "relative", "much")
FACTOR = 2.0

# The same for parameters whose distance from 1 is the choice.
SHARES = ("share", "loose_share", "correlation")

# Parameters with data for a few values only, and the summary whose coordinate lists these.
LISTED = {"inner_share": "phases", "level": "mean_distance", "detuning": "rotation"}

#: The parts of a run that can judge a claim: the averaging window, or the whole run with its transient.
PARTS = ("window", "run")

# Number of halvings of the factor at which a verdict changes, which gives it to 2 %.
HALVINGS = 5

Judge = Callable[[Evidence, Mapping[str, Any]], Verdict]


def turns(
    judge: Judge,
    evidence: Evidence,
    parameters: Mapping[str, Any],
    verdict: Verdict,
    others: Iterable[tuple[str, Evidence]] = (),
) -> list[str]:
    """Return what would change a verdict, each as «verdict: condition»; empty if nothing tried does.

    judge : judges the claim from evidence and parameters; verdict : its verdict for the given ones
    others : evidence for other tolerances of the study, each with its name, see `choices`
    """
    if verdict.verdict == NOT_TESTABLE:
        return []

    def turned(evidence: Evidence, parameters: Mapping[str, Any]) -> str:
        return difference(verdict, judge(evidence, parameters))

    return [
        *_by_tolerance(turned, evidence, parameters),
        *_by_grid(turned, evidence, parameters),
        *_by_neighbour(turned, evidence, parameters),
        *_by_listed(turned, evidence, parameters),
        *(f"{found}: {name}" for name, other in others if (found := turned(other, parameters))),
    ]


def difference(verdict: Verdict, other: Verdict) -> str:
    """Return the other verdict if it differs, under some convention or reading; "" if it is the same.

    If only conventions or readings differ, they are listed.
    """
    if other.verdict != verdict.verdict:
        return other.verdict
    if verdict.verdict not in (CONVENTION, READING):
        return ""
    known = verdict.conventions
    changed = [f"{name} {found}" for name, found in other.conventions.items() if found != known.get(name)]
    changed += [f"{name} {NOT_TESTABLE}" for name in known if name not in other.conventions]
    return f"{verdict.verdict} ({', '.join(changed)})" if changed else ""


# Returns the changed verdict of a claim from evidence and parameters; "" if it is unchanged.
Turned = Callable[[Evidence, Mapping[str, Any]], str]


def _by_tolerance(turned: Turned, evidence: Evidence, parameters: Mapping[str, Any]) -> Iterator[str]:
    for name in (*CHOSEN, *SHARES):
        if name not in parameters:
            continue

        def at(exponent: float, name: str = name) -> str:
            return turned(evidence, {**parameters, name: _changed(parameters[name], name, exponent)})

        found = [(side, *_nearest(at, side)) for side in (-1.0, 1.0)]
        if len({other for _, _, other in found if other}) == 1 and not any(same for _, same, _ in found):
            yield f"{found[0][2]}: any other {name} ({parameters[name]:g})"
            continue
        for side, same, other in found:
            if other:
                last = _changed(parameters[name], name, same)
                relation = "above" if _changed(parameters[name], name, side) > parameters[name] else "below"
                yield f"{other}: {name} {relation} {last:.3g} ({parameters[name]:g})"


def _nearest(turned: Callable[[float], str], side: float) -> tuple[float, str]:
    """Return the largest exponent towards a side at which the verdict is unchanged, and the verdict beyond it.

    "" if the verdict is unchanged at the side itself.
    """
    same, end, other = 0.0, side, turned(side)
    if not other:
        return side, ""
    for _ in range(HALVINGS):
        middle = 0.5 * (same + end)
        found = turned(middle)
        if found:
            end, other = middle, found
        else:
            same = middle
    return same, other


def _changed(value: float, name: str, exponent: float) -> float:
    """Return a tolerance multiplied by a power of FACTOR."""
    factor = FACTOR**exponent
    if name not in SHARES:
        return value * factor
    return math.copysign(min(max(1.0 - factor * (1.0 - abs(value)), 0.0), 1.0), value)


def _by_grid(turned: Turned, evidence: Evidence, parameters: Mapping[str, Any]) -> Iterator[str]:
    """Judge on both halves of the grid, or without each of the few values at which solvers are compared."""
    if "relative" in parameters:
        if "solvers" in evidence.summaries:
            yield from _by_solved(turned, evidence, parameters)
        return
    halves = {}
    for half, first in zip(evidence.halves, ("first", "second"), strict=True):
        # A single value has no second half.
        if not all(dataset.sizes.get("a", 1) for dataset in half.summaries.values()):
            continue
        other = turned(half, parameters)
        # If one half lacks the only value of a in a claim, this is not another choice.
        if other != NOT_TESTABLE or "at" not in parameters:
            halves[first] = other
    found = set(halves.values())
    if len(halves) == 2 and len(found) == 1:
        yield from (f"{other}: every second value of a" for other in found if other)
    else:
        yield from (
            f"{other}: every second value of a, from the {first} on" for first, other in halves.items() if other
        )


def _by_solved(turned: Turned, evidence: Evidence, parameters: Mapping[str, Any]) -> Iterator[str]:
    solvers = evidence.summaries["solvers"]
    for a in solvers["a"].values.tolist():
        without = {**evidence.summaries, "solvers": solvers.sel(a=solvers["a"] != a)}
        other = turned(replace(evidence, summaries=without), parameters)
        if other:
            yield f"{other}: without a = {a:g}"


def _by_neighbour(turned: Turned, evidence: Evidence, parameters: Mapping[str, Any]) -> Iterator[str]:
    """Judge a claim about one value of a at the neighbouring values of the grid."""
    if "at" not in parameters:
        return
    grids = [dataset["a"].values for dataset in evidence.summaries.values() if "a" in dataset.dims]
    grid = max((values for values in grids if parameters["at"] in values), key=len, default=np.array([]))
    place = int(np.searchsorted(grid, parameters["at"]))
    for value in grid[[k for k in (place - 1, place + 1) if 0 <= k < len(grid)]].tolist():
        other = turned(evidence, {**parameters, "at": value})
        if other and other != NOT_TESTABLE:
            yield f"{other}: at a = {value:g} ({parameters['at']:g})"


def _by_listed(turned: Turned, evidence: Evidence, parameters: Mapping[str, Any]) -> Iterator[str]:
    for name, summary in LISTED.items():
        if name not in parameters or summary not in evidence.summaries:
            continue
        for value in evidence.summaries[summary][name].values.tolist():
            other = turned(evidence, {**parameters, name: value})
            if other:
                yield f"{other}: {name} = {value:g} ({parameters[name]:g})"
    for part in PARTS if "part" in parameters else ():
        other = turned(evidence, {**parameters, "part": part})
        if other:
            yield f"{other}: by the {'whole run' if part == 'run' else part}"
