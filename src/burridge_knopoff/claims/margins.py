"""The margin of a verdict: which other tolerances and grids would change it.

A tolerance is a choice. A reader should see which other sensible choices would change a verdict, or leave too little
data to judge. The claim is judged again with each tolerance of the claim or of the study within a factor of two; with
every second value of a; at the neighbour of a named value of a; without one of the values of a at which solvers are
compared; and with other amplitudes of the inner blocks, detunings, levels of J, or parts of the runs for which there
are data. If the claim depends on convention or reading, the verdicts under each count as well.

Every parameter of a judge is in one of the tables below: tried, or in STATED.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from burridge_knopoff.claims.evidence import Evidence
from burridge_knopoff.claims.verdict import CONVENTION, NOT_TESTABLE, READING, Verdict

# Parameters of judges that are our choice, with descriptions. Others may choose values that differ by up to FACTOR.
TOLERANCES = {
    "tolerance": "the tolerance",
    "loose": "the loose tolerance",
    "near": "the distance that counts as near",
    "relative": "the relative tolerance",
    "much": "the ratio that counts as large",
}
FACTOR = 2.0

# The same for whole numbers.
COUNTS = {
    "points": "the largest number of section points that is no cloud",
    "samples": "the number of sampled states that show whether an attractor is the only one",
}

# The same for parameters whose distance from 1 is the choice.
SHARES = {
    "share": "the required share of states",
    "loose_share": "the share from which the claim holds loosely",
    "correlation": "the correlation that counts as antiphase",
    "mode_share": "the share of the energy that makes an oscillation one of a mode",
}

# The same for bounds of a coordinate with few values: a bound is tried at each value within FACTOR. Their description,
# the summary, and its coordinate.
BOUNDS = {
    "close": ("the phase difference up to which phases are close", "phases", "phase_difference"),
    "opposite": ("the phase difference from which phases are opposite", "phases", "phase_difference"),
}

# Parameters with data for a few values only: their description, and the summary whose coordinate lists these values.
LISTED = {
    "inner_share": ("the amplitude of the inner block over A", "phases"),
    "level": ("the level below which J counts as 0", "mean_distance"),
    "detuning": ("the detuning", "rotation"),
}

#: The parts of a run that can judge a claim: the averaging window, or the whole run with its transient.
PARTS = {"window": "the window", "run": "the whole run"}

# Parameters that are not tried, since they are the paper's and no choice of ours: what a statement is about, and its
# numbers. With another value it would be another statement.
STATED = frozenset(
    {
        *("initial", "law", "laws", "a", "synchrony", "shown", "end"),
        *("claimed", "low", "high", "by", "coefficients", "steps"),
        *("synchronized", "kinds", "claims"),
    }
)

# Number of bisections of the exponent of FACTOR at which a verdict changes, which determine the tolerance to 0.3 %.
BISECTIONS = 8

Judge = Callable[[Evidence, Mapping[str, Any]], Verdict]
# Returns the changed verdict of a claim from evidence and parameters; "" if it is unchanged.
ChangedVerdict = Callable[[Evidence, Mapping[str, Any]], str]


def changing_choices(
    judge: Judge,
    evidence: Evidence,
    parameters: Mapping[str, Any],
    verdict: Verdict,
    others: Iterable[tuple[str, Evidence]] = (),
) -> list[str]:
    """Return the choices that would change a verdict, each as «verdict if condition»; empty if none does.

    judge : judges the claim from evidence and parameters; verdict : its verdict for the given ones
    others : evidence for other tolerances of the study, each with its description, see `choices`
    """
    if verdict.verdict == NOT_TESTABLE:
        return []

    def changed_verdict(evidence: Evidence, parameters: Mapping[str, Any]) -> str:
        return difference(verdict, judge(evidence, parameters))

    return [
        *_tolerance_choices(changed_verdict, evidence, parameters),
        *_bound_choices(changed_verdict, evidence, parameters),
        *_grid_choices(changed_verdict, evidence, parameters),
        *_neighbour_choices(changed_verdict, evidence, parameters),
        *_listed_choices(changed_verdict, evidence, parameters),
        *(f"{found} if {name}" for name, other in others if (found := changed_verdict(other, parameters))),
    ]


def difference(verdict: Verdict, other: Verdict) -> str:
    """Return the other verdict if it differs, also under some convention or reading only; "" if it is the same."""
    if other.verdict != verdict.verdict:
        return other.verdict
    if verdict.verdict not in (CONVENTION, READING):
        return ""
    known = verdict.conventions
    changed = [f"{name}: {found}" for name, found in other.conventions.items() if found != known.get(name)]
    changed += [f"{name}: {NOT_TESTABLE}" for name in known if name not in other.conventions]
    return f"{verdict.verdict} ({'; '.join(changed)})" if changed else ""


def _tolerance_choices(
    changed_verdict: ChangedVerdict, evidence: Evidence, parameters: Mapping[str, Any]
) -> Iterator[str]:
    for name, words in {**TOLERANCES, **COUNTS, **SHARES}.items():
        if name not in parameters:
            continue

        def verdict_at(exponent: float, name: str = name) -> str:
            return changed_verdict(evidence, {**parameters, name: _scaled(parameters[name], name, exponent)})

        found = [_nearest_change(verdict_at, side) for side in (-1.0, 1.0)]
        if len({other for _, other in found if other}) == 1 and all(abs(end) <= 2.0**-BISECTIONS for end, _ in found):
            yield f"{found[0][1]} if {words} is not exactly {parameters[name]:g}"
            continue
        for end, other in found:
            if other:
                last = _scaled(parameters[name], name, end)
                is_larger = last > parameters[name]
                limit = f"at {'least' if is_larger else 'most'} {_rounded(last, up=is_larger):g}"
                yield f"{other} if {words} is {limit} (here {parameters[name]:g})"


def _bound_choices(changed_verdict: ChangedVerdict, evidence: Evidence, parameters: Mapping[str, Any]) -> Iterator[str]:
    for name, (words, summary, coordinate) in BOUNDS.items():
        if name not in parameters or summary not in evidence.summaries:
            continue
        current, values = parameters[name], np.unique(evidence.summaries[summary][coordinate].values)
        smaller = values[(values >= current / FACTOR) & (values < current)][::-1]
        larger = values[(values > current) & (values <= current * FACTOR)]
        for side, candidates in (("most", smaller), ("least", larger)):
            for value in candidates.tolist():
                if other := changed_verdict(evidence, {**parameters, name: value}):
                    yield f"{other} if {words} is at {side} {value:g} (here {current:g})"
                    break


def _rounded(value: float, *, up: bool) -> float:
    """Return a value to three digits, rounded up or down."""
    unit = 10.0 ** (math.floor(math.log10(abs(value))) - 2) if value else 1.0
    return float(f"{(math.ceil if up else math.floor)(value / unit) * unit:.3g}")


def _nearest_change(verdict_at: Callable[[float], str], side: float) -> tuple[float, str]:
    """Return the exponent nearest to 0, towards a side, at which the verdict is found to change, and the verdict there.

    "" if the verdict is unchanged at the side itself.
    """
    same, end, other = 0.0, side, verdict_at(side)
    if not other:
        return side, ""
    for _ in range(BISECTIONS):
        middle = 0.5 * (same + end)
        found = verdict_at(middle)
        if found:
            end, other = middle, found
        else:
            same = middle
    return end, other


def _scaled(value: float, name: str, exponent: float) -> float:
    """Return a tolerance, or the distance of a share from 1, multiplied by a power of FACTOR."""
    factor = FACTOR**exponent
    if name in COUNTS:
        return round(value * factor)
    if name not in SHARES:
        return value * factor
    return math.copysign(min(max(1.0 - factor * (1.0 - abs(value)), 0.0), 1.0), value)


def _grid_choices(changed_verdict: ChangedVerdict, evidence: Evidence, parameters: Mapping[str, Any]) -> Iterator[str]:
    """Judge on both halves of the grid, or without each of the few values at which solvers are compared."""
    if "relative" in parameters:
        if "solvers" in evidence.summaries:
            yield from _solver_choices(changed_verdict, evidence, parameters)
        return
    halves = {}
    for half, first in zip(evidence.halves, ("first", "second"), strict=True):
        # A single value has no second half.
        if not all(dataset.sizes.get("a", 1) for dataset in half.summaries.values()):
            continue
        other = changed_verdict(half, parameters)
        # If one half lacks the only value of a in a claim, this is not another choice.
        if other != NOT_TESTABLE or "at" not in parameters:
            halves[first] = other
    found = set(halves.values())
    if len(halves) == 2 and len(found) == 1:
        yield from (f"{other} if only every second value of a is used" for other in found if other)
    else:
        for first, other in halves.items():
            if other:
                yield f"{other} if only every second value of a is used, starting with the {first}"


def _solver_choices(
    changed_verdict: ChangedVerdict, evidence: Evidence, parameters: Mapping[str, Any]
) -> Iterator[str]:
    solvers = evidence.summaries["solvers"]
    for a in solvers["a"].values.tolist():
        without = {**evidence.summaries, "solvers": solvers.sel(a=solvers["a"] != a)}
        other = changed_verdict(replace(evidence, summaries=without), parameters)
        if other:
            yield f"{other} if a = {a:g} is left out"


def _neighbour_choices(
    changed_verdict: ChangedVerdict, evidence: Evidence, parameters: Mapping[str, Any]
) -> Iterator[str]:
    """Judge a claim about one value of a at the neighbouring values of the grid."""
    if "at" not in parameters:
        return
    grids = [dataset["a"].values for dataset in evidence.summaries.values() if "a" in dataset.dims]
    grid = max((values for values in grids if parameters["at"] in values), key=len, default=np.array([]))
    place = int(np.searchsorted(grid, parameters["at"]))
    for value in grid[[k for k in (place - 1, place + 1) if 0 <= k < len(grid)]].tolist():
        other = changed_verdict(evidence, {**parameters, "at": value})
        if other and other != NOT_TESTABLE:
            yield f"{other} if a is {value:g} (here {parameters['at']:g})"


def _listed_choices(
    changed_verdict: ChangedVerdict, evidence: Evidence, parameters: Mapping[str, Any]
) -> Iterator[str]:
    for name, (words, summary) in LISTED.items():
        if name not in parameters or summary not in evidence.summaries:
            continue
        for value in evidence.summaries[summary][name].values.tolist():
            other = changed_verdict(evidence, {**parameters, name: value})
            if other:
                yield f"{other} if {words} is {value:g} (here {parameters[name]:g})"
    for part, words in PARTS.items() if "part" in parameters else ():
        other = changed_verdict(evidence, {**parameters, "part": part})
        if other:
            yield f"{other} if {words} is used (here {PARTS[parameters['part']]})"
