"""What was found about a statement: one sentence with one number, of the quantities that its verdict measures."""

import re

import pytest

from burridge_knopoff.claims import paper
from burridge_knopoff.claims.verdict import NOT_TESTABLE
from burridge_knopoff.report.findings import FINDINGS, finding
from tests.claims.alterations import judge_claim
from tests.claims.worlds import evidence, paper_world


def claim(name, *measured, reason="At 3 of 4 values it holds. The rest does not matter."):
    return {
        "name": name,
        "reason": reason,
        "measured": [{"quantity": quantity, "value": value, "error": None} for quantity, value in measured],
    }


def test_a_sentence_is_about_a_statement_of_the_paper_and_has_one_number():
    assert set(FINDINGS) <= set(paper.CLAIMS)
    for entry in FINDINGS.values():
        for sentence in filter(None, (entry.sentence, entry.none)):
            assert re.fullmatch(r"[A-ZJUTI⟨][^.]*\.", sentence.replace("{}", "number")), sentence
        assert entry.sentence.count("{}") == 1
        assert not re.search(r"\d", entry.sentence.replace("is 0 within its error", "").replace("no more than", ""))


@pytest.mark.parametrize(
    ("record", "sentence"),
    [
        (
            claim("first_block_decides", ("share of a at which the outcome differs, one", 0.74194), ("share", 0.1)),
            "The outcomes of minus and plus differ at 74.2 % or more of these values of a.",
        ),
        (
            claim("minus_synchronizes", ("share of a with synchrony, one", 1.0), ("share of a with synchrony, two", 1)),
            "They do at 100 % of these values of a.",
        ),
        (
            claim("equilibrium", ("largest difference from the formula", 2.2e-16)),
            "The difference from the formula is 0, up to rounding.",
        ),
        (claim("transition", ("smallest a with a chaotic attractor", None)), "At 3 of 4 values it holds."),
        (claim("unheard_of", ("any", 1.0)), "At 3 of 4 values it holds."),
    ],
)
def test_the_number_is_that_of_the_study(record, sentence):
    assert finding(record) == sentence


def test_every_verdict_measures_the_quantity_of_its_sentence():
    data = evidence(paper_world())
    verdicts = {name: judge_claim(name, data) for name in FINDINGS}
    judged = [name for name, verdict in verdicts.items() if verdict.verdict != NOT_TESTABLE]
    assert len(judged) > 40
    for name in judged:
        measured = [(item.quantity, item.value) for item in verdicts[name].measured]
        sentence = finding(claim(name, *measured, reason="No number."))
        assert sentence != "No number.", (name, measured)
        assert len(re.findall(r"(?<![₁-₉\w])\d[\d.]*", sentence.replace("is 0 within", ""))) <= 1, sentence
