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
from burridge_knopoff.study.config import CONFIG
from burridge_knopoff.study.yaml_file import read_config
from tests.claims.said import CLAIMS

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def content() -> dict:
    return json.loads((ROOT / "docs/claims.json").read_text(encoding="utf-8"))


@pytest.fixture(scope="module")
def depths() -> dict:
    return json.loads((ROOT / "docs/depths.json").read_text(encoding="utf-8"))


def test_the_page_shows_the_ledger(content: dict, depths: dict) -> None:
    page = runpy.run_path(str(ROOT / "docs/refresh.py"))["page"]
    text = (ROOT / "docs/claims.md").read_text(encoding="utf-8")
    assert page(text, content, depths) == text
    content["claims"][0]["verdict"] = "not testable"
    assert page(text, content, depths) != text


def test_both_depths_give_the_same_verdicts(content: dict, depths: dict) -> None:
    """The default study looks less closely than the one that docs/ is printed from: it may leave a verdict open."""
    assert set(depths) == {"paper_fine", "paper"}
    for study in depths.values():
        assert [*study["verdicts"]] == [*CLAIMS]
    assert depths["paper_fine"]["depth"] == content["depth"] != depths["paper"]["depth"]
    for name, verdict in depths["paper_fine"]["verdicts"].items():
        assert depths["paper"]["verdicts"][name] in (verdict, "not testable"), name


def test_the_depths_are_those_of_the_configs(depths: dict) -> None:
    for name, study in depths.items():
        config = CONFIG.form(read_config(ROOT / f"config/{name}.yaml"), "")
        half, refine = 100.0 * config["attractors"]["fraction_width"], config["refine"]
        for words in (f"±{half:g} %", f"within {refine['resolution']:g}", f"period of {refine['longest_period']:g}"):
            assert words in study["depth"]


def test_the_ledger_is_of_the_claims_as_they_stand(content: dict) -> None:
    shown = [(claim["name"], claim["statement"], claim["figure"]) for claim in content["claims"]]
    assert shown == [(claim.name, claim.statement, claim.figure) for claim in CLAIMS.values()]
    assert content["study"] == "paper_fine"


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
    text = " ".join((ROOT / "docs/bifurcations.md").read_text(encoding="utf-8").split())
    assert f"a periodic orbit precedes chaos at {' and '.join(counts)} places" in text


def test_the_readme_counts_what_is_independent(content: dict) -> None:
    readme = runpy.run_path(str(ROOT / "docs/refresh.py"))["readme"]
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    assert readme(text, content) == text
    content["independent_counts"]["fails"] += 1
    assert readme(text, content) != text
