"""Reading the ledger, and its files."""

from __future__ import annotations

import csv
import io
import json
import math
from pathlib import Path

import pytest

from burridge_knopoff.claims.ledger import as_csv, as_json, as_markdown, ledger, measured_text, read_claims
from burridge_knopoff.claims.verdict import Range, by_value, spans, with_error
from burridge_knopoff.config import ConfigError
from tests.claims.worlds import A, evidence, paper_world

ROOT = Path(__file__).parents[2]
SCHEMA = ROOT / "workflow/schemas/claims.schema.yaml"
GOOD = """
edge:
  statement: Synchrony ends at 0.08.
  place: Fig. 3
  judge: synchronization.edge_of_synchrony
  parameters: {initial: minus, upper: true, claimed: 0.08, tolerance: 0.005, loose: 0.01}
  figure: orbits
"""


def read(tmp_path: Path, text: str) -> list:
    file = tmp_path / "claims.yaml"
    file.write_text(text)
    return read_claims(file, SCHEMA)


def test_a_claim_knows_its_judge(tmp_path: Path) -> None:
    (claim,) = read(tmp_path, GOOD)
    assert (claim.name, claim.topic, claim.judge.__name__) == ("edge", "synchronization", "edge_of_synchrony")


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("edge_of_synchrony", "edge_of_chaos", "judge: 'synchronization.edge_of_chaos' is not allowed: one of"),
        ("edge_of_synchrony", "spans", "judge: 'synchronization.spans' is not allowed: one of"),
        ("synchronization.edge", "chaos.edge", "judge: 'chaos.edge_of_synchrony' is not allowed"),
        (", loose: 0.01", "", "parameters.loose: missing; needed by synchronization.edge_of_synchrony"),
        ("loose: 0.01", "loose: 0.01, share: 1", "parameters.share: unknown key; allowed here: initial, upper"),
        ("tolerance: 0.005", "tolerance: -1", "tolerance: -1 is not allowed"),
        ("upper: true", "upper: 1", "upper: 1 is not allowed"),
        ("initial: minus", "initial: middle", "initial: 'middle' is not allowed"),
        ("  place: Fig. 3\n", "", "place: missing"),
        ("figure: orbits", "figure: ../orbits", "figure: '../orbits' is not allowed"),
        ("  figure", "  verdict: holds\n  figure", "verdict: unknown key"),
        ("  figure", "  place: Fig. 4\n  figure", "place: stands twice"),
    ],
)
def test_what_is_not_allowed_is_said_in_one_line(tmp_path: Path, old: str, new: str, expected: str) -> None:
    assert old in GOOD
    with pytest.raises(ConfigError) as error:
        read(tmp_path, GOOD.replace(old, new))
    assert expected in str(error.value)
    assert "claims.yaml" in str(error.value)
    assert "\n" not in str(error.value)


@pytest.fixture(scope="module")
def content() -> dict:
    return ledger("test", read_claims(ROOT / "config/claims.yaml", SCHEMA), evidence(paper_world()), ["orbits"])


def test_json_is_strict_and_whole(content: dict) -> None:
    def refuse(name: str) -> None:
        raise AssertionError(name)

    assert json.loads(as_json(content), parse_constant=refuse) == content
    assert as_json(content) == as_json(content)


def test_csv_has_a_line_for_each_figure(content: dict) -> None:
    rows = list(csv.DictReader(io.StringIO(as_csv(content))))
    assert len(rows) == sum(max(1, len(claim["measured"])) for claim in content["claims"])
    assert [row["claim"] for row in rows if row["claim"] == "antiphase"]
    (row,) = (row for row in rows if row["claim"] == "antiphase")
    assert float(row["value"]) == -0.9


def test_markdown_has_a_row_for_each_claim(content: dict) -> None:
    text = as_markdown(content, "figures")
    rows = [line for line in text.splitlines() if line.startswith("| ") and "claim | verdict" not in line]
    assert len(rows) == len(content["claims"])
    # A bar inside a cell is escaped.
    assert all(row.replace("\\|", "").count("|") == 6 for row in rows)
    assert "[orbits](figures/orbits.png)" in text


def test_numbers_are_shown_with_the_digits_that_their_errors_leave() -> None:
    assert with_error(0.140640595, 9.5e-6) == "0.1406406 ± 0.0000095"
    assert with_error(5.7, 0.2) == "5.70 ± 0.20"
    assert with_error(123.4, 20.0) == "123 ± 20"
    assert with_error(0.25) == with_error(0.25, 0.0) == with_error(0.25, math.nan) == "0.25"
    assert with_error(math.nan) == "nan"
    assert measured_text({"value": None, "error": None}) == "unknown"


def test_spans_join_neighbours_and_count_many() -> None:
    assert spans(A, (A > 0.0) & (A < 0.025)) == "0.0025 to 0.02"
    assert spans(A, (A == 0.05) | (A > 0.285)) == "0.05, 0.29 to 0.3"
    assert spans(A, A < 0.0) == ""
    assert spans(A, [k % 3 == 0 for k in range(len(A))]) == "21 values from 0 to 0.295"


def test_ranges_have_open_and_closed_ends() -> None:
    assert A[Range(first=0.01, below=0.02).choose(A)].tolist() == [0.01, 0.015]
    assert A[Range(above=0.01, last=0.02).choose(A)].tolist() == [0.015, 0.02]
    assert Range().choose(A).all()
    assert [str(Range(first=0.005, last=0.08)), str(Range(above=0.1)), str(Range(below=0.1))] == [
        "0.005 ≤ a ≤ 0.08",
        "a > 0.1",
        "a < 0.1",
    ]


def test_a_number_is_granted_its_error() -> None:
    assert by_value(0.15, 0.14, 0.005, 0.01) == "holds loosely"
    assert by_value(0.15, 0.14, 0.005, 0.01, error=0.006) == "holds"
    assert by_value(0.16, 0.14, 0.005, 0.01) == by_value(math.nan, 0.14, 0.005, 0.01) == "fails"
