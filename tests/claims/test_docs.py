"""The generated parts of docs/ and the README show the present claims, and the default study if it has run."""

from __future__ import annotations

import json
import re
import runpy
from pathlib import Path

import numpy as np
import pytest
import xarray
from PIL import Image

from burridge_knopoff.claims import ledger
from burridge_knopoff.claims.paper import CLAIMS
from burridge_knopoff.claims.paper.locking import CLOSED
from burridge_knopoff.figures.palette import BRANCHES, OTHER_BRANCHES
from burridge_knopoff.provenance.sources import provenance
from burridge_knopoff.study.config import CONFIG
from burridge_knopoff.study.yaml_file import read_config
from tests.pages import claim_sections

ROOT = Path(__file__).parents[2]
SUMMARY = ROOT / "results/paper/summary"
REFRESH = runpy.run_path(str(ROOT / "docs/refresh.py"))


def text_of(name: str) -> str:
    return (ROOT / name).read_text(encoding="utf-8")


def words_of(name: str) -> str:
    return " ".join(text_of(name).split())


@pytest.mark.skipif(not SUMMARY.exists(), reason="the default study has not run")
@pytest.mark.parametrize("name", ["docs/verdicts.md", "README.md", "docs/attractors.md"])
def test_a_page_shows_the_results_of_the_default_study(name: str) -> None:
    claims = json.loads((SUMMARY / "claims.json").read_text(encoding="utf-8"))
    with xarray.open_dataset(SUMMARY / "attractors.nc") as attractors:
        made_by = {ledger.__name__: claims, attractors.attrs["source_module"]: attractors.attrs}
    key = "source_fingerprint"
    if any(attributes.get(key) != provenance(module)[key] for module, attributes in made_by.items()):
        pytest.skip("results/paper is out of date")
    text = text_of(name)
    assert REFRESH["replace_block"](text, REFRESH["pages"](SUMMARY)[ROOT / name]) == text


def test_the_ledger_contains_the_present_claims() -> None:
    sections = claim_sections(ROOT)
    assert {*sections} == {*CLAIMS}
    for name, claim in CLAIMS.items():
        assert sections[name].startswith(f"*{claim.statement}* ({claim.place})")
        assert f"Figure: [{claim.figure}](figures/{claim.figure}.png)." in sections[name]


def test_the_readme_counts_the_verdicts_of_the_ledger() -> None:
    counts = re.search(r"Of \d+ independent statements, .*? or follow from them\.", words_of("docs/verdicts.md"))
    assert counts
    assert counts[0] in words_of("README.md").replace("**", "")


def test_the_depth_is_that_of_the_default_config() -> None:
    config = CONFIG.form(read_config(ROOT / "config/paper.yaml"), "")
    half, refine = 100.0 * config["attractors"]["fraction_width"], config["refine"]
    text = words_of("docs/verdicts.md")
    depth = re.search(r"Depth of the search for attractors: .*? up to a period of [\d.]+\.", text)
    assert depth
    for words in (f"±{half:g} %", f"within {refine['resolution']:g}", f"period of {refine['longest_period']:g}"):
        assert words in depth[0]


def test_the_page_on_bifurcations_counts_what_precedes_chaos() -> None:
    counts = re.findall(r"\d+ of \d+ \(\w+\)", claim_sections(ROOT)["locking_precedes_chaos"].partition(CLOSED)[2])[:2]
    assert len(counts) == 2
    assert all(count in words_of("docs/bifurcations.md") for count in counts)


def test_the_figure_of_basin_fractions_shows_the_colours_of_the_branches() -> None:
    picture = np.asarray(Image.open(ROOT / "docs/figures/basin_fractions.png").convert("RGB"), dtype=int).reshape(-1, 3)
    colors = [np.array([int(name[k : k + 2], 16) for k in (1, 3, 5)]) for name in (*BRANCHES[:4], OTHER_BRANCHES)]
    assert all((np.abs(picture - color).sum(axis=1) <= 24).sum() > 100 for color in colors)


def test_the_page_on_claims_counts_where_the_laws_agree() -> None:
    shares = re.search(
        r"of the value at each a, at ([\d.]+) % \(minus\) and ([\d.]+) %", claim_sections(ROOT)["laws_agree"]
    )
    counts = re.search(r"at each a \| at (\d+) of (\d+) values \| at (\d+) of \2 values \|", words_of("docs/claims.md"))
    assert shares
    assert counts
    minus, values, plus = map(int, counts.groups())
    assert (f"{100 * minus / values:.1f}", f"{100 * plus / values:.1f}") == shares.groups()
