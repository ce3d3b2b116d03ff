"""The table of the paper's numbers: ours are those of the ledger, and a number that a study lacks has no row."""

import json

import pytest

from burridge_knopoff.claims.comparison import ROWS, compare
from burridge_knopoff.claims.paper import CLAIMS


@pytest.fixture(scope="module")
def claims(repository):
    return json.loads((repository / "docs/claims.json").read_text(encoding="utf-8"))["claims"]


def test_every_number_of_the_paper_has_its_row(claims):
    rows = compare(claims)
    assert [(words, paper, name) for words, paper, _, name in rows] == [row[:3] for row in ROWS]
    assert {name for *_, name in rows} <= {*CLAIMS}
    assert next(ours for *_, ours, name in rows if name == "plus_mean_distance") == "0.14064"


def test_a_number_that_a_study_lacks_has_no_row(claims):
    without = [{**claim, "measured": [] if claim["name"] == "cycle_time" else claim["measured"]} for claim in claims]
    assert [name for *_, name in compare(without)] == [name for *_, name, _ in ROWS if name != "cycle_time"]
    one_law = [
        {**claim, "measured": [item for item in claim["measured"] if "nonlinear" not in item["quantity"]]}
        for claim in claims
    ]
    assert {name for *_, name in compare(one_law)}.isdisjoint({"upper_edge", "transition"})
    assert compare([]) == []
