"""The generated parts of docs/ and the README agree with the ledger, the branches and the results of the study."""

from __future__ import annotations

import json
import re
import runpy
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray
from PIL import Image

from burridge_knopoff.claims import ledger
from burridge_knopoff.claims.paper import CLAIMS
from burridge_knopoff.claims.paper.locking import CLOSED
from burridge_knopoff.figures.palette import BRANCHES
from burridge_knopoff.provenance.sources import provenance
from burridge_knopoff.study.config import CONFIG
from burridge_knopoff.study.yaml_file import read_config

ROOT = Path(__file__).parents[2]
SUMMARY = ROOT / "results/paper/summary"
REFRESH = runpy.run_path(str(ROOT / "docs/refresh.py"))


def read(name: str) -> Any:
    return json.loads((ROOT / "docs" / name).read_text(encoding="utf-8"))


@pytest.fixture
def content() -> dict:
    return read("claims.json")


@pytest.fixture
def branches() -> list[dict]:
    return read("branches.json")


@pytest.mark.parametrize("name", ["docs/claims.md", "README.md", "docs/attractors.md"])
def test_pages_show_the_ledger_and_the_branches(content: dict, branches: list[dict], name: str) -> None:
    page = ROOT / name
    text = page.read_text(encoding="utf-8")
    assert REFRESH["replace_block"](text, REFRESH["pages"](content, branches)[page]) == text
    content["independent_counts"]["fails"] += 1
    branches[0]["last_a"] += 0.01
    assert REFRESH["replace_block"](text, REFRESH["pages"](content, branches)[page]) != text


def test_the_ledger_contains_the_present_claims(content: dict) -> None:
    shown = [(claim["name"], claim["statement"], claim["figure"]) for claim in content["claims"]]
    assert shown == [(claim.name, claim.statement, claim.figure) for claim in CLAIMS.values()]
    assert content["study"] == "paper"


def test_the_depth_is_that_of_the_default_config(content: dict) -> None:
    config = CONFIG.form(read_config(ROOT / "config/paper.yaml"), "")
    half, refine = 100.0 * config["attractors"]["fraction_width"], config["refine"]
    for words in (f"±{half:g} %", f"within {refine['resolution']:g}", f"period of {refine['longest_period']:g}"):
        assert words in content["depth"]


def needs_results(module: str, attrs: dict) -> None:
    """Skip a test unless the results of the default study are there, made by the current sources."""
    key = "source_fingerprint"
    if attrs.get(key) != provenance(module)[key]:
        pytest.skip("results/paper is out of date")


@pytest.mark.skipif(not SUMMARY.exists(), reason="the default study has not run")
def test_the_ledger_is_that_of_the_default_study(content: dict) -> None:
    needs_results(ledger.__name__, json.loads((SUMMARY / "claims.json").read_text(encoding="utf-8")))
    assert REFRESH["published_ledger"](SUMMARY.parent) == content


@pytest.mark.skipif(not SUMMARY.exists(), reason="the default study has not run")
def test_the_branches_are_those_of_the_default_study(branches: list[dict]) -> None:
    with xarray.open_dataset(SUMMARY / "attractors.nc") as attractors:
        needs_results(attractors.attrs["source_module"], attractors.attrs)
        assert REFRESH["branches"](attractors) == branches


def test_the_page_on_bifurcations_counts_what_precedes_chaos(content: dict) -> None:
    (claim,) = (claim for claim in content["claims"] if claim["name"] == "locking_precedes_chaos")
    if claim["verdict"] == "not testable":
        pytest.skip("the default study does not decide it")
    counts = re.findall(r"\d+ of \d+ \(\w+\)", claim["reason"].rpartition(CLOSED)[2])
    assert len(counts) == 2
    text = " ".join((ROOT / "docs/bifurcations.md").read_text(encoding="utf-8").split())
    assert all(count in text for count in counts)


def test_every_figure_of_the_page_is_there(content: dict) -> None:
    for claim in content["claims"]:
        assert (ROOT / f"docs/figures/{claim['figure']}.png").exists()


def test_the_figure_of_basin_fractions_shows_the_colours_of_the_branches() -> None:
    picture = np.asarray(Image.open(ROOT / "docs/figures/basin_fractions.png").convert("RGB"), dtype=int).reshape(-1, 3)
    colors = [np.array([int(name[k : k + 2], 16) for k in (1, 3, 5)]) for name in BRANCHES]
    visible = [(np.abs(picture - color).sum(axis=1) <= 24).sum() > 100 for color in colors]
    # The others are those of branches at one or two values of a, a few pixels each.
    assert visible[:6] == [True] * 6
    assert sum(visible) >= 10
