"""The margin of a verdict: which other choices and grids would change it.

A tolerance is a choice. A reader should see which other sensible choices would change a verdict, or leave too little
data to judge. The claim is judged again with other values of each of its choices (`choice`); with every second value of
a; at the neighbour of a named value of a; and without one of the values of a at which solvers are compared. If the
claim depends on convention or reading, the verdicts under each count as well.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from burridge_knopoff.claims.claim import Claim
from burridge_knopoff.claims.evidence import Evidence
from burridge_knopoff.claims.verdict import CONVENTION, NOT_TESTABLE, OPEN, READING, Verdict

# Returns the changed verdict of a claim from evidence and parameters; "" if it is unchanged.
ChangedVerdict = Callable[[Evidence, Mapping[str, Any]], str]


def changing_choices(
    claim: Claim,
    judge: Callable[[Evidence, Mapping[str, Any]], Verdict],
    evidence: Evidence,
    verdict: Verdict,
) -> list[str]:
    """Return the choices that would change a verdict, each as «verdict if condition»; empty if none does.

    judge : judges the claim from evidence and parameters; verdict : its verdict for the claim's own
    """
    if verdict.verdict in OPEN:
        return []
    parameters = claim.parameters

    def changed_verdict(evidence: Evidence, parameters: Mapping[str, Any]) -> str:
        return difference(verdict, judge(evidence, parameters))

    def conditions(name: str) -> Iterator[str]:
        def verdict_with(value: Any) -> str:
            return changed_verdict(evidence, {**parameters, name: value})

        return claim.choices[name].conditions(parameters[name], verdict_with, evidence.summaries)

    without = _solver_choices if "solvers" in claim.reads else _grid_choices
    return [
        *(text for name in claim.choices for text in conditions(name)),
        *without(changed_verdict, evidence, parameters),
        *_neighbour_choices(changed_verdict, evidence, parameters),
    ]


def difference(verdict: Verdict, other: Verdict) -> str:
    """Return the other verdict if it differs, also under some convention or reading only; "" if it is the same."""
    if other.verdict != verdict.verdict:
        return other.verdict
    if verdict.verdict not in (CONVENTION, READING):
        return ""
    conventions = verdict.conventions
    changed = [f"{name}: {judged}" for name, judged in other.conventions.items() if judged != conventions.get(name)]
    changed += [f"{name}: cannot be judged" for name in conventions if name not in other.conventions]
    return f"still {verdict.verdict}, but {'; '.join(changed)}," if changed else ""


def _grid_choices(changed_verdict: ChangedVerdict, evidence: Evidence, parameters: Mapping[str, Any]) -> Iterator[str]:
    """Judge on both halves of the grid."""
    halves = {}
    for half, first in zip(evidence.halves, ("first", "second"), strict=True):
        # A single value has no second half.
        if not all(dataset.sizes.get("a", 1) for dataset in half.summaries.values()):
            continue
        other = changed_verdict(half, parameters)
        # If one half lacks the only value of a in a claim, this is not another choice.
        if other != NOT_TESTABLE or "at" not in parameters:
            halves[first] = other
    verdicts = set(halves.values())
    if len(halves) == 2 and len(verdicts) == 1:
        yield from (f"{other} if only every second value of a were used" for other in verdicts if other)
    else:
        for first, other in halves.items():
            if other:
                yield f"{other} if only every second value of a were used, starting with the {first}"


def _solver_choices(
    changed_verdict: ChangedVerdict, evidence: Evidence, parameters: Mapping[str, Any]
) -> Iterator[str]:
    """Judge without each of the few values of a at which solvers are compared."""
    if "solvers" not in evidence.summaries:
        return
    solvers = evidence.summaries["solvers"]
    for a in solvers["a"].values.tolist():
        without = {**evidence.summaries, "solvers": solvers.sel(a=solvers["a"] != a)}
        other = changed_verdict(replace(evidence, summaries=without), parameters)
        if other:
            yield f"{other} if a = {a:g} were left out"


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
        if other and other not in OPEN:
            yield f"{other} at a = {value:g}"
