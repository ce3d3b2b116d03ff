"""The table of the paper's numbers: ours come from the judges, and a number that a study lacks has no row."""

import pytest

from burridge_knopoff.claims.comparison import ROWS, compare
from tests.claims.alterations import judge_claim
from tests.claims.worlds import evidence, paper_world


@pytest.fixture(scope="module")
def claims():
    data = evidence(paper_world())
    names = [name for _, _, name, _ in ROWS]
    return [{"name": name, "measured": [vars(item) for item in judge_claim(name, data).measured]} for name in names]


def test_every_number_of_the_paper_has_its_row(claims):
    rows = compare(claims)
    assert [(words, paper, name) for words, paper, _, name in rows] == [row[:3] for row in ROWS]
    assert next(ours for *_, ours, name in rows if name == "plus_mean_distance") == "0.14005"


def test_a_number_that_a_study_lacks_has_no_row(claims):
    without = [{**claim, "measured": [] if claim["name"] == "cycle_time" else claim["measured"]} for claim in claims]
    assert [name for *_, name in compare(without)] == [name for *_, name, _ in ROWS if name != "cycle_time"]
    one_law = [
        {**claim, "measured": [item for item in claim["measured"] if "nonlinear" not in item["quantity"]]}
        for claim in claims
    ]
    assert {name for *_, name in compare(one_law)}.isdisjoint({"upper_edge", "transition"})
    assert compare([]) == []
