"""The verdict on every claim from altered data; no verdict is written by hand."""

from __future__ import annotations

import numpy as np
import pytest

from burridge_knopoff.claims.ledger import judge
from burridge_knopoff.claims.paper import CLAIMS
from burridge_knopoff.claims.verdict import CONVENTION, FAILS, HOLDS, LOOSELY, NOT_TESTABLE, READING
from tests.claims.alterations import ONE_OF_MANY, Alteration, at, judge_altered
from tests.claims.cases import CASES
from tests.claims.worlds import evidence, paper_world

JUDGED = [*((name, HOLDS, lambda world: None) for name in CLAIMS), *CASES]


@pytest.mark.parametrize(("name", "expected", "alteration"), JUDGED, ids=[f"{case[0]}-{case[1]}" for case in JUDGED])
def test_altered_data_alter_the_verdict(name: str, expected: str, alteration: Alteration) -> None:
    """Every claim holds where the paper is right."""
    verdict = judge_altered(name, alteration)
    assert verdict.verdict == expected, verdict.reason
    assert expected != HOLDS or verdict.measured
    shares = [item.value for item in verdict.measured if item.quantity.startswith("share of")]
    assert not any(share < 0.0 or share > 1.0 for share in shares)
    if expected in (HOLDS, LOOSELY) and verdict.own == expected and not verdict.conventions:
        assert "(fails)" not in verdict.reason
    if expected in (CONVENTION, READING):
        verdicts = set(verdict.conventions.values())
        assert FAILS in verdicts
        assert verdicts & {HOLDS, LOOSELY}


def test_every_claim_that_reads_data_fails_in_some_case() -> None:
    reading = {name for name, claim in CLAIMS.items() if claim.reads or claim.depends_on}
    assert {name for name, verdict, _ in CASES if verdict in (FAILS, CONVENTION, READING)} == reading


def test_runs_that_did_not_complete_are_not_evidence() -> None:
    world = paper_world()
    for name, value in {"status": 1, "synchronized": 0, "mean_distance": np.nan}.items():
        at(world["mean_distance"], name, value, a=ONE_OF_MANY)
    assert judge(CLAIMS["minus_synchronizes"], evidence(world)).verdict == HOLDS
    at(world["mean_distance"], "status", 1)
    assert judge(CLAIMS["minus_synchronizes"], evidence(world)).verdict == NOT_TESTABLE
