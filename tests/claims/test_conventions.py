"""Verdicts under several conventions and readings."""

from __future__ import annotations

import numpy as np
import pytest
import xarray

from burridge_knopoff.attractors.lookup import reached_slots
from burridge_knopoff.claims.conventions import combine_readings, judge_conventions
from burridge_knopoff.claims.ledger import judge
from burridge_knopoff.claims.paper import CLAIMS
from burridge_knopoff.claims.verdict import (
    CONVENTION,
    FAILS,
    HOLDS,
    LOOSELY,
    NOT_TESTABLE,
    READING,
    SILENT,
    UNDECIDED,
    Measured,
    NotTestableError,
    Verdict,
    judge_shares,
)
from tests.claims.alterations import reached
from tests.claims.worlds import evidence, paper_world


@pytest.mark.parametrize(
    ("own", "others", "expected", "changes"),
    [
        (HOLDS, (HOLDS, HOLDS, HOLDS), HOLDS, ""),
        (HOLDS, (FAILS, HOLDS, HOLDS), CONVENTION, "; under (A) it fails: 1"),
        (FAILS, (LOOSELY, "", FAILS), CONVENTION, "; under (A) it holds loosely: 1; it cannot be judged under (B)"),
        # Another contact than the paper's does not decide.
        (HOLDS, (HOLDS, FAILS, HOLDS), HOLDS, "; under (B) it fails: 2"),
        (FAILS, (FAILS, "", LOOSELY), FAILS, "; under (C) it holds loosely: 3; it cannot be judged under (B)"),
        (FAILS, (FAILS, FAILS, FAILS), FAILS, ""),
        (LOOSELY, (HOLDS, "", ""), LOOSELY, "; under (A) it holds: 1; it cannot be judged under (B) and (C)"),
        # A statement that is about nothing under the other start is not false there.
        (FAILS, (SILENT, "", HOLDS), FAILS, "; under (C) it holds: 3; it is about nothing under (A); it cannot be "),
    ],
)
def test_a_claim_depends_on_convention_where_it_holds_and_fails(
    own: str, others: tuple[str, ...], expected: str, changes: str
) -> None:
    names = ["one_sided, tested", "symmetric, moving", "symmetric, tested"]
    for letter, name in zip("ABC", names, strict=True):
        changes = changes.replace(f"({letter})", f"({name})")
    figures = [Measured("number", 1.0)]

    def judge_attractors(attractors: xarray.Dataset) -> tuple[str, str]:
        number = names.index(f"{attractors['contact'].item()}, {attractors['start'].item()}")
        return others[number], str(number + 1)

    found = judge_conventions(evidence(paper_world()), own, "why", figures, ["but"], judge_attractors)
    judged = {name: verdict for name, verdict in zip(names, others, strict=True) if verdict not in ("", SILENT)}
    changes += "judged under (symmetric, moving)" * changes.endswith("it cannot be ")
    assert found == Verdict(expected, "why", figures, f"but{changes}", {"one_sided, moving": own, **judged}, own)


@pytest.mark.parametrize(
    ("own", "under", "expected"),
    [
        (HOLDS, ("one_sided, tested",), UNDECIDED),
        (FAILS, ("one_sided, tested", "symmetric, moving"), UNDECIDED),
        # Another contact than the paper's does not decide.
        (LOOSELY, ("symmetric, moving", "symmetric, tested"), LOOSELY),
    ],
)
def test_too_few_values_under_a_convention_leave_the_claim_undecided(own: str, under: tuple[str, ...], expected: str):
    def judge_attractors(attractors: xarray.Dataset) -> tuple[str, str]:
        name = f"{attractors['contact'].item()}, {attractors['start'].item()}"
        return (UNDECIDED, "8 of 9") if name in under else (own, "")

    figures = [Measured("number", 1.0)]
    found = judge_conventions(evidence(paper_world()), own, "Why.", figures, [], judge_attractors)
    assert (found.verdict, found.own, found.measured) == (expected, own, figures)
    assert found.changes == "; ".join(f"under ({name}) it is undecided: 8 of 9" for name in under)
    assert set(found.conventions.values()) == {own}
    start = "Undecided: there are too few values under (one_sided, tested). " if expected == UNDECIDED else ""
    assert found.reason == f"{start}Why."


@pytest.mark.parametrize("own", [HOLDS, LOOSELY, FAILS])
def test_a_convention_that_could_change_the_verdict_is_not_left_out(own: str) -> None:
    def judge_contact(attractors: xarray.Dataset) -> tuple[str, str]:
        return (own, "") if attractors["contact"].item() == "symmetric" else ("", "")

    with pytest.raises(NotTestableError, match=r"\(one_sided, tested\)"):
        judge_conventions(evidence(paper_world()), own, "why", [], [], judge_contact)
    # Under another contact than the paper's each convention counts.
    with pytest.raises(NotTestableError, match=r"\(one_sided, moving\).*\(one_sided, tested\)"):
        judge_conventions(evidence(paper_world(), contact="symmetric"), own, "why", [], [], judge_contact)
    with pytest.raises(NotTestableError, match=r"attractors\.nc"):
        judge_conventions(evidence({}), own, "why", [], [], judge_contact)


def test_under_another_contact_than_the_papers_every_convention_counts() -> None:
    def judge_attractors(attractors: xarray.Dataset) -> tuple[str, str]:
        return FAILS if attractors["contact"].item() == "one_sided" else HOLDS, ""

    found = judge_conventions(evidence(paper_world(), contact="symmetric"), HOLDS, "why", [], [], judge_attractors)
    assert (found.verdict, found.own) == (CONVENTION, HOLDS)


def test_the_attractor_that_is_reached_is_known_by_branch_and_side() -> None:
    slots = ("law", "a", "attractor")
    attractors = xarray.Dataset(
        {
            "branch": (slots, [[[0, 2, 2], [0, 2, 2], [0, -1, -1], [0, 1, -1]]]),
            "side": (slots, [[[0, 1, -1], [0, 1, -1], [0, 0, 0], [0, 0, 0]]]),
            "value": (slots, np.arange(12.0).reshape(1, 4, 3)),
            "initial_branch": (("law", "initial", "a"), [[[2, 0, -1, 2]]]),
            "initial_side": (("law", "initial", "a"), [[[-1, 0, 0, 0]]]),
        },
        {"law": ["linearized"], "initial": ["plus"]},
    )
    is_known, slot = reached_slots(attractors)
    assert is_known.sel(law="linearized", initial="plus").values.tolist() == [True, True, False, False]
    assert attractors["value"].isel(attractor=slot).values[is_known.values].tolist() == [2.0, 3.0]
    assert judge_shares({}, 0.9) == ("", "")


@pytest.mark.parametrize(
    ("readings", "expected"),
    [
        ([HOLDS, HOLDS], HOLDS),
        ([HOLDS, LOOSELY], LOOSELY),
        ([FAILS, FAILS], FAILS),
        ([LOOSELY, FAILS], READING),
        # An open share does not matter if the others differ; if they agree, it may differ from them.
        ([HOLDS, NOT_TESTABLE, FAILS], READING),
        ([NOT_TESTABLE, HOLDS], UNDECIDED),
        ([FAILS, NOT_TESTABLE], UNDECIDED),
    ],
)
def test_a_reading_that_is_open_is_not_left_out(readings: list[str], expected: str) -> None:
    verdicts = {f"reading {number}": verdict for number, verdict in enumerate(readings)}
    reason = "why"
    if expected == UNDECIDED:
        of_reading = f"«reading {readings.index(NOT_TESTABLE)}»"
        reason = f"Undecided: there are too few values for the reading {of_reading}. why"
    found = Verdict(expected, reason, [], "but; and", verdicts, readings[0])
    assert combine_readings(verdicts, "why", [], ["but", "and"]) == found


def test_conventions_are_those_of_the_study() -> None:
    world = paper_world()
    reached(0, initial="plus", contact="symmetric", start="moving")(world)
    own = judge(CLAIMS["plus_does_not_synchronize"], evidence(world, contact="symmetric"))
    # Under its own convention a study is judged by its runs, in which plus does not synchronize here.
    assert own.verdict == HOLDS
    assert own.conventions == dict.fromkeys(sorted(own.conventions), HOLDS)
    assert len(own.conventions) == 4
