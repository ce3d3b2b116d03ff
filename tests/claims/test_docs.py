"""docs/claims.md shows the ledger that lies beside it, and that is of the claims as they stand now."""

from __future__ import annotations

import json
import re
import runpy
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from burridge_knopoff.figures.branches import COLORS
from tests.claims.said import CLAIMS

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def content() -> dict:
    return json.loads((ROOT / "docs/claims.json").read_text(encoding="utf-8"))


def test_the_page_shows_the_ledger(content: dict) -> None:
    page = runpy.run_path(str(ROOT / "docs/refresh.py"))["page"]
    text = (ROOT / "docs/claims.md").read_text(encoding="utf-8")
    assert page(text, content) == text
    content["claims"][0]["verdict"] = "not testable"
    assert page(text, content) != text


def test_the_ledger_is_of_the_claims_as_they_stand(content: dict) -> None:
    shown = [(claim["name"], claim["statement"], claim["figure"]) for claim in content["claims"]]
    assert shown == [(claim.name, claim.statement, claim.figure) for claim in CLAIMS.values()]
    assert content["study"] == "paper"


def test_every_figure_of_the_page_is_there(content: dict) -> None:
    for claim in content["claims"]:
        assert (ROOT / f"docs/figures/{claim['figure']}.png").exists()


def test_the_colours_of_the_branches_survive() -> None:
    picture = np.asarray(Image.open(ROOT / "docs/figures/basin_fractions.png").convert("RGB"), dtype=int).reshape(-1, 3)
    for name in COLORS:
        wanted = np.array([int(name[k : k + 2], 16) for k in (1, 3, 5)])
        assert (np.abs(picture - wanted).sum(axis=1) <= 24).sum() > 100, name


def test_the_page_on_edges_counts_what_precedes_chaos(content: dict) -> None:
    reason = next(claim["reason"] for claim in content["claims"] if claim["name"] == "locking_precedes_chaos")
    counts = re.findall(r"\d+ of \d+ \(\w+\)", reason)
    assert len(counts) == 2
    text = " ".join((ROOT / "docs/edges.md").read_text(encoding="utf-8").split())
    assert f"a closed orbit comes before chaos at {' and '.join(counts)} places" in text


def test_the_readme_counts_what_is_independent(content: dict) -> None:
    readme = runpy.run_path(str(ROOT / "docs/refresh.py"))["readme"]
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    assert readme(text, content) == text
    content["independent_counts"]["fails"] += 1
    assert readme(text, content) != text
