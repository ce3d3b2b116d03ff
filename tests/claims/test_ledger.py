"""Claims, the ledger, and its files."""

from __future__ import annotations

import csv
import io
import json
import math
import re
from dataclasses import replace

import numpy as np
import pytest
import xarray

from burridge_knopoff.claims.choice import Along, Tolerance
from burridge_knopoff.claims.claim import Claim
from burridge_knopoff.claims.claim import claim as register
from burridge_knopoff.claims.evidence import Evidence
from burridge_knopoff.claims.formats import as_csv, as_json, as_markdown
from burridge_knopoff.claims.ledger import judge, ledger
from burridge_knopoff.claims.paper import CLAIMS, READS
from burridge_knopoff.claims.range import Range
from burridge_knopoff.claims.rounding import rounded_state_changes
from burridge_knopoff.claims.verdict import (
    HOLDS,
    NOT_TESTABLE,
    NotTestableError,
    Verdict,
    judge_interval,
    judge_value,
)
from burridge_knopoff.figures.description import title_and_caption
from burridge_knopoff.study.formatting import format_values
from tests.claims.alterations import judge_claim
from tests.claims.cases import CASES
from tests.claims.worlds import CONFIG, A, evidence, paper_world
from tests.conftest import quick_first
from tests.refused import refused


@pytest.mark.parametrize("claim", CLAIMS.values(), ids=CLAIMS)
def test_a_claim_says_what_the_paper_says_and_where(claim: Claim) -> None:
    assert claim.statement.endswith(".")
    assert claim.place
    assert title_and_caption(claim.figure, True)
    assert claim.depends_on == tuple(name for name in CLAIMS if name in claim.depends_on) or claim.topic == "history"
    assert claim.name not in claim.depends_on
    assert {*claim.depends_on} <= {*CLAIMS}


def test_the_parameters_of_a_claim_are_those_of_its_function() -> None:
    @register("Fig. 1", "orbits", "agreement", depends_on=("minus_periodic",))
    def speed(evidence: Evidence, *, at: float = 0.08, tolerance: Tolerance = 0.01) -> Verdict:
        """Blocks move
        fast.

        Not slow.

        Holds within
        {tolerance:g}, above -1.
        """
        return Verdict(HOLDS, f"{evidence.summary('agreement').sizes['a']} values, {at:g}, {tolerance:g}.")

    try:
        assert CLAIMS["speed"] is speed
        assert (speed.name, speed.topic, speed.statement) == ("speed", "test_ledger", "Blocks move fast.")
        assert speed.rule == "Holds within 0.01, above −1."
        assert (speed.place, speed.figure, speed.reads) == ("Fig. 1", "orbits", ("agreement",))
        assert speed.depends_on == ("minus_periodic",)
        assert speed.parameters == {"at": 0.08, "tolerance": 0.01}
        assert list(speed.choices) == ["tolerance"]
        assert judge(speed, evidence(paper_world())).reason == "64 values, 0.08, 0.01."
        assert judge(speed, evidence(paper_world()), {"tolerance": 0.02, "at": 0.1}).reason == "64 values, 0.1, 0.02."
    finally:
        del CLAIMS["speed"]


@pytest.mark.parametrize("claim", CLAIMS.values(), ids=CLAIMS)
def test_a_claim_has_a_rule_that_names_its_choices(claim: Claim) -> None:
    assert claim.rule.startswith("Holds")
    for name in ("tolerance", "loose", "near", "points", "samples", "much", "level", "relative", "correlation"):
        if name in claim.choices:
            assert re.sub("^-", "−", f"{claim.parameters[name]:g}") in claim.rule
    if "loose_share" in claim.parameters:
        assert "nine in ten" in claim.rule


@pytest.fixture(scope="module")
def content() -> dict:
    """The ledger of two topics, with and without figures."""
    claims = [claim for claim in CLAIMS.values() if claim.topic in ("synchronization", "motion")]
    return ledger("test", claims, evidence(paper_world()), ["orbits"])


class Recorded(dict):
    """Summaries that record which of them are requested."""

    def __init__(self, summaries: dict[str, xarray.Dataset]) -> None:
        super().__init__(summaries)
        self.read: set[str] = set()

    def __getitem__(self, name: str) -> xarray.Dataset:
        self.read.add(name)
        return super().__getitem__(name)

    def __contains__(self, name: object) -> bool:
        self.read.add(str(name))
        return super().__contains__(name)

    def get(self, name: str, default: object = None) -> object:
        self.read.add(name)
        return super().get(name, default)


@pytest.mark.parametrize("claim", CLAIMS.values(), ids=CLAIMS)
def test_a_claim_reads_what_it_declares(claim: Claim) -> None:
    """It can read no others. A declared summary that it does not read would outdate the verdicts needlessly."""
    cases = [lambda world: None, *(alteration for name, _, alteration in CASES if name == claim.name)]
    unread = set(claim.reads)
    while unread and cases:
        world = paper_world()
        cases.pop(0)(world)
        summaries = Recorded(world)
        judge_claim(claim.name, evidence(summaries))
        unread -= summaries.read
    assert not unread


def test_a_summary_that_a_claim_does_not_declare_is_refused() -> None:
    """This includes a summary that the study does not have, since another study may."""
    for read in (lambda data: data.summary("basins"), lambda data: "basins" in data.summaries):
        with refused("basins", "upper_edge"):
            replace(CLAIMS["upper_edge"], function=read)(evidence(paper_world()))


def test_the_ledger_itself_reads_only_what_some_claim_declares() -> None:
    """It reads the attractors that rounded states reach, and the depth of the search."""
    summaries = Recorded(paper_world())
    known = evidence(summaries)
    ledger("test", [], known, [])
    rounded_state_changes(known, ["minus"], ["linearized"], Range())
    assert summaries.read == {"attractors", "refined"}
    assert summaries.read <= {*READS}


@pytest.mark.parametrize("claim", CLAIMS.values(), ids=CLAIMS)
def test_a_claim_declares_the_summaries_of_its_choices(claim: Claim) -> None:
    assert {item.summary for item in claim.choices.values() if isinstance(item, Along)} <= {*claim.reads}


def test_json_is_strict_and_complete(content: dict) -> None:
    read = json.loads(as_json(content), parse_constant=pytest.fail)
    assert as_json(content).startswith(
        '{\n "study": "test",\n "v": 0.1,\n "contact": "one_sided",\n "start": "moving",\n'
    )
    assert read == content


def test_csv_has_a_line_for_each_figure(content: dict) -> None:
    rows = list(csv.DictReader(io.StringIO(as_csv(content))))
    assert len(rows) == sum(max(1, len(claim["measured"])) for claim in content["claims"])
    for claim in content["claims"]:
        own = [row for row in rows if row["claim"] == claim["name"]]
        measured = claim["measured"] or [{"quantity": "", "value": None, "error": None, "proved": False}]
        for row, item in zip(own, measured, strict=True):
            shown_claim = {**claim, "changing_choices": "; ".join(claim["changing_choices"])}
            others = [key for key in row if key not in ("claim", *item)]
            assert [row[key] for key in others] == [shown_claim[key] for key in others]
            shown = {**item, "proved": "proved" if item["proved"] else None}
            assert [row[key] for key in item] == ["" if value is None else str(value) for value in shown.values()]


def test_a_proved_number_is_marked() -> None:
    proof = xarray.Dataset({"critical_a": (("law", "end"), [[0.0800999, 0.0801001]])}, {"law": ["linearized"]})
    world = paper_world()
    world["proof"] = proof
    world["orbits"]["critical_a"].values[:] = 0.0801, 0.0802
    claims = [CLAIMS["upper_edge"]]
    content = ledger("test", claims, evidence(world), [])
    (claim,) = content["claims"]
    proved = [item for item in claim["measured"] if item["proved"]]
    assert [(item["quantity"].split(", ")[-1], item["value"]) for item in proved] == [("linearized", 0.0801)]
    assert abs(proved[0]["error"] - 2e-7) < 1e-12
    assert "loses stability, at a_c = 0.0801 (linearized, proved) and a_c = 0.0802 (nonlinear)" in claim["reason"]
    rows = [row for row in csv.DictReader(io.StringIO(as_csv(content))) if row["proved"]]
    assert [(row["value"], row["proved"]) for row in rows] == [("0.0801", "proved")]
    world["orbits"]["critical_a"].values[0] += 1e-6
    with refused("critical_a", "0.080101", "0.0800999", "proof.nc"):
        ledger("test", claims, evidence(world), [])


@pytest.mark.slow
def test_markdown_has_a_row_and_a_section_for_each_claim() -> None:
    content = ledger("test", CLAIMS.values(), evidence(paper_world()), ["orbits"])
    text = as_markdown(content, "figures")
    rows = [line for line in text.splitlines() if line.startswith("| ")][2:]
    assert len(rows) == len(content["claims"]) == len(CLAIMS)
    sections = [line.removeprefix("#### ") for line in text.splitlines() if line.startswith("#### ")]
    assert [row.split("](#")[1] for row in rows] == [f"{name}) |" for name in sections]
    assert {*sections} == {*CLAIMS}
    assert all(len(line) <= 120 for line in text.splitlines() if not line.startswith("|"))
    independent = sum(not claim.depends_on for claim in CLAIMS.values())
    assert 30 < independent < len(CLAIMS)
    assert text.startswith(
        f"Of {independent} independent statements, {independent} hold; twelve more repeat these or follow from them."
        "\n\nDepth of the search for attractors: 95 % intervals of basin fractions ±2 %, changes along a located "
        "within 0.0006,\nperiodic orbits up to a period of 500.\n\n| statement"
    )
    assert text.count("Depends on ") == len(CLAIMS) - independent


def test_a_section_has_the_evidence_of_its_claim(content: dict) -> None:
    claim = next(claim for claim in content["claims"] if claim["figure"]).copy()
    claim |= {
        "statement": "A|B.",
        "verdict": "ambiguous",
        "reason": "Why.",
        "rule": "Holds if so.",
        "changes": "here; not other_claim",
    }
    claim |= {"changing_choices": ["holds if c"], "depends_on": ["other_claim"]}
    lines = as_markdown({**content, "claims": [claim]}, "figures").split("\n\n")
    assert f"| A\\|B. | ambiguous (dependent) | [{claim['name']}](#{claim['name']}) |" in "\n".join(lines).splitlines()
    assert lines[lines.index(f"#### {claim['name']}") + 1 :] == [
        f"*A|B.* ({claim['place']})",
        "**Ambiguous** (under the first reading: holds). Why.",
        "Rule: holds if so.",
        "Exceptions and other cases:",
        "- here\n- not [other_claim](#other_claim)",
        "What would change the verdict:",
        "- holds if c",
        "Depends on [other_claim](#other_claim). Figure: [orbits](figures/orbits.png).\n",
    ]


def test_claims_that_cannot_be_tested_are_listed_by_reason(content: dict) -> None:
    claim = {**content["claims"][0], "verdict": NOT_TESTABLE, "reason": "Short runs.", "place": "Fig. 1"}
    claims = [{**claim, "name": name, "statement": f"{name}."} for name in ("one", "two")]
    text = as_markdown({**content, "claims": claims}, "figures")
    assert text.endswith("\n\n### Not testable\n\n- Short runs.\n  - one. *Fig. 1* (one)\n  - two. *Fig. 1* (two)\n")
    assert "|" not in text


def test_neighbouring_values_become_ranges_and_many_are_counted() -> None:
    assert format_values(A, (A > 0.0) & (A < 0.025)) == "at a = 0.0025 to 0.02"
    assert format_values(A, (A == 0.05) | (A > 0.285)) == "at a = 0.05, 0.29 to 0.3"
    assert format_values(A, (A == 0.05) | (A > 0.29)) == "at a = 0.05, 0.295, 0.3"
    assert format_values(A, [k % 3 == 0 for k in range(len(A))]) == "at 22 of the 64 values of a from 0 to 0.3"
    assert format_values(np.arange(20.0), np.arange(20) % 2 == 0) == "at 10 of the 19 values of a from 0 to 18"
    assert format_values(np.arange(17.0), np.arange(17) % 2 == 1) == "at a = 1, 3, 5, 7, 9, 11, 13, 15"
    assert format_values(A, A > 1.0) == "at a = "


def test_a_coarse_grid_neither_helps_nor_harms_a_claim() -> None:
    assert judge_interval(0.138, 0.142, 0.14, 0.005, 0.01) == "holds"
    assert judge_interval(0.146, 0.148, 0.14, 0.005, 0.01) == "holds loosely"
    assert judge_interval(0.2, math.inf, 0.14, 0.005, 0.01) == judge_interval(0.0, 0.1, 0.14, 0.005, 0.01) == "fails"
    for low, high in ((0.1, 0.2), (0.14, 0.148), (0.146, 0.2), (0.13, math.inf)):
        with pytest.raises(NotTestableError, match="coarse"):
            judge_interval(low, high, 0.14, 0.005, 0.01)


def test_ranges_have_open_and_closed_ends() -> None:
    assert A[Range(first=0.01, below=0.02).choose(A)].tolist() == [0.01, 0.015]
    assert A[Range(above=0.01, last=0.02).choose(A)].tolist() == [0.015, 0.02]
    assert Range().choose(A).all()
    for text, ends in {
        "0.005 ≤ a ≤ 0.08": {"first": 0.005, "last": 0.08},
        "0 < a < 0.1": {"above": 0.0, "below": 0.1},
        "0 < a ≤ 0.1": {"above": 0.0, "last": 0.1},
        "0.1 ≤ a": {"first": 0.1},
        "a > 0.1": {"above": 0.1},
        "a < 0.1": {"below": 0.1},
        "a ≤ 0.1": {"last": 0.1},
        "a": {},
    }.items():
        assert str(Range(**ends)) == text


def test_a_number_holds_within_its_tolerance() -> None:
    assert judge_value(0.144, 0.14, 0.005, 0.01) == "holds"
    assert judge_value(0.148, 0.14, 0.005, 0.01) == "holds loosely"
    assert judge_value(0.16, 0.14, 0.005, 0.01) == judge_value(math.nan, 0.14, 0.005, 0.01) == "fails"
    assert judge_value(math.inf, 0.14, 0.005, math.inf) == "fails"


@pytest.mark.parametrize("missing", quick_first([{"minus", "plus"}, {"minus"}, {"plus"}], 1))
def test_a_study_without_the_papers_states_is_judged_without_an_error(missing: set[str]) -> None:
    """Its states have other names: claims on the paper's states are not testable, with that reason."""
    names = {name: f"other_{name}" if name in missing else name for name in ("minus", "plus")}
    summaries = {}
    for key, dataset in paper_world().items():
        if "initial" in dataset.dims:
            dataset = dataset.assign_coords(initial=[names[name] for name in dataset["initial"].values])
        elif "initial" in dataset:
            dataset = dataset.assign_coords(initial=("point", [names[name] for name in dataset["initial"].values]))
        summaries[key] = dataset
    states = {names[name]: state for name, state in CONFIG["initial"].items()}
    found = ledger("other", CLAIMS.values(), evidence(summaries, initial=states), [])
    reasons = [claim["reason"] for claim in found["claims"] if claim["verdict"] == NOT_TESTABLE]
    for name in missing:
        assert f"Not testable here: the study has no initial state {name}." in reasons
    assert len(reasons) < len(found["claims"])
