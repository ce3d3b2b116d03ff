"""docs/claims.md shows the ledger that lies beside it, and that is of the claims as they stand now."""

from __future__ import annotations

import json
import re
import runpy
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from burridge_knopoff.figures.palette import BRANCHES
from burridge_knopoff.study.config import CONFIG
from burridge_knopoff.study.yaml_file import read_config
from tests.claims.said import CLAIMS

ROOT = Path(__file__).parents[2]


@pytest.fixture
def content() -> dict:
    return json.loads((ROOT / "docs/claims.json").read_text(encoding="utf-8"))


@pytest.fixture
def depths() -> dict:
    return json.loads((ROOT / "docs/depths.json").read_text(encoding="utf-8"))


def test_the_page_shows_the_ledger(content: dict, depths: dict) -> None:
    page = runpy.run_path(str(ROOT / "docs/refresh.py"))["page"]
    text = (ROOT / "docs/claims.md").read_text(encoding="utf-8")
    assert page(text, content, depths) == text
    content["claims"][0]["verdict"] = "not testable"
    assert page(text, content, depths) != text


def test_a_closer_look_leaves_all_verdicts_but_those_that_the_config_names(depths: dict) -> None:
    """The default study looks less closely than the other one: its config says which verdicts it leaves open."""
    first, *closer = depths
    assert first == "paper"
    assert set(closer) <= {"paper_fine"}
    for study in depths.values():
        assert [*study["claims"]] == [*CLAIMS]
    for name in closer:
        assert depths[name]["depth"] != depths[first]["depth"]
    text = (ROOT / "config/paper.yaml").read_text(encoding="utf-8")
    named = {claim for claim in CLAIMS if re.search(rf"\b{claim}\b", text)}
    open_ones = {name for name, claim in depths[first]["claims"].items() if claim["verdict"] == "not testable"}
    assert named == open_ones
    for name in closer:
        claims = depths[name]["claims"].items()
        assert {key for key, claim in claims if claim["verdict"] != depths[first]["claims"][key]["verdict"]} <= named


def test_the_depths_are_those_of_the_configs(depths: dict) -> None:
    for name, study in depths.items():
        config = CONFIG.form(read_config(ROOT / f"config/{name}.yaml"), "")
        half, refine = 100.0 * config["attractors"]["fraction_width"], config["refine"]
        for words in (f"±{half:g} %", f"within {refine['resolution']:g}", f"period of {refine['longest_period']:g}"):
            assert words in study["depth"]


def test_the_ledger_is_of_the_claims_as_they_stand(content: dict) -> None:
    shown = [(claim["name"], claim["statement"], claim["figure"]) for claim in content["claims"]]
    assert shown == [(claim.name, claim.statement, claim.figure) for claim in CLAIMS.values()]
    assert content["study"] == "paper"


def test_the_ledger_is_that_of_the_first_depth(content: dict, depths: dict) -> None:
    found = {claim["name"]: {key: claim[key] for key in ("verdict", "reason")} for claim in content["claims"]}
    assert found == depths["paper"]["claims"]
    assert content["depth"] == depths["paper"]["depth"]


def test_every_figure_of_the_page_is_there(content: dict) -> None:
    for claim in content["claims"]:
        assert (ROOT / f"docs/figures/{claim['figure']}.png").exists()


def test_the_colours_of_the_branches_survive() -> None:
    picture = np.asarray(Image.open(ROOT / "docs/figures/basin_fractions.png").convert("RGB"), dtype=int).reshape(-1, 3)
    for name in BRANCHES:
        wanted = np.array([int(name[k : k + 2], 16) for k in (1, 3, 5)])
        assert (np.abs(picture - wanted).sum(axis=1) <= 24).sum() > 100, name


def test_the_page_on_edges_counts_what_precedes_chaos(depths: dict) -> None:
    """Its numbers are those of the study that looks closest."""
    if "paper_fine" not in depths:
        pytest.skip("docs/ was refreshed from the default study alone")
    reason = depths["paper_fine"]["claims"]["locking_precedes_chaos"]["reason"]
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
