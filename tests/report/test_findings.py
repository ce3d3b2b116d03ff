"""What was found about a statement: one sentence with one number, of the quantities that its verdict measures."""

import re

import pytest

from burridge_knopoff.claims import paper
from burridge_knopoff.report.findings import FINDINGS, finding


def claim(name, *measured, reason="At 3 of 4 values it holds. The rest does not matter."):
    return {
        "name": name,
        "reason": reason,
        "measured": [{"quantity": quantity, "value": value, "error": None} for quantity, value in measured],
    }


def test_each_statement_of_the_paper_has_a_sentence_with_one_number():
    assert set(FINDINGS) == set(paper.CLAIMS)
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
