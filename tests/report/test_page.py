"""The page of a study that lacks most of what a report can show: whole HTML, and a line for what is not there."""

import json
import re
from dataclasses import replace
from html.parser import HTMLParser
from itertools import pairwise

import pytest
import xarray

from burridge_knopoff.claims import paper
from burridge_knopoff.claims.formats import TITLES
from burridge_knopoff.continuation.branch_changes import Change
from burridge_knopoff.dataset.summary import write_summary
from burridge_knopoff.motion.kind import MotionKind
from burridge_knopoff.report.page import Sources, render
from burridge_knopoff.report.verdicts import MAIN, MEANINGS, SIGNS
from tests.conftest import quick_first
from tests.report.conftest import CLAIMS
from tests.report.test_tables import bifurcations
from tests.small_study import run_study

PAPER = "https://arxiv.org/abs/nlin/0310030"
VOID = {"area", "base", "br", "col", "embed", "hr", "img", "input", "link", "meta", "source", "track", "wbr"}


class Page(HTMLParser):
    """Elements of a page in order, as (name, attributes), and whether they are nested as they should be."""

    def __init__(self, html):
        super().__init__()
        self.elements, self.open, self.text = [], [], []
        self.feed(html)
        assert self.open == []
        self.whole_text = " ".join(" ".join(self.text).split())

    def handle_starttag(self, tag, attrs):
        self.elements.append((tag, dict(attrs)))
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attrs):
        self.elements.append((tag, dict(attrs)))

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        if self.open and self.open[-1] not in ("script", "style"):
            self.text.append(data)


@pytest.fixture(scope="module")
def html(poor):
    return render(poor.study, poor.sources, ["--configfile", "poor.yaml"])


@pytest.fixture(scope="module")
def page(html):
    return Page(html)


def test_what_is_missing_is_said_in_a_line(page):
    for line in (
        "Only in chains of three blocks is the synchronized orbit continued along a , stable or not.",
        "This study does not search for bifurcations of its attractors.",
        "This study has no maps of basins.",
        "W never crosses 0 upward: the section is never reached in any run.",
        "The results folder has no benchmark files of Snakemake.",
    ):
        assert line in page.whole_text
    charts = [attributes["data-chart"] for _, attributes in page.elements if "data-chart" in attributes]
    assert set(charts) == {"distance", "exponents"}


@pytest.mark.parametrize(
    ("ends", "words"),
    [
        (True, "linearized 0.01000000000 ± 1.0 × 10⁻¹⁰ pitchfork branch 0 ends, synchronized"),
        (False, "No branch of synchronized attractors was seen to begin, end or change between the values of a"),
    ],
)
def test_a_chain_without_an_orbit_has_the_bifurcations_of_its_synchronized_attractors(poor, tmp_path, ends, words):
    row = (Change.END, 0, 4, MotionKind.SYNCHRONIZED, MotionKind.PERIODIC)
    path = tmp_path / "bifurcations.nc"
    write_summary(bifurcations([row] if ends else [(Change.PASSED, *row[1:])]), path)
    summaries = {**poor.sources.summaries, "bifurcations": path}
    text = Page(render(poor.study, replace(poor.sources, summaries=summaries))).whole_text
    assert words in text
    assert "This study does not search for bifurcations" not in text
    assert ("bifurcations.txt" in text) == ends


def test_three_sections_stand_open_and_every_statement_has_its_place(poor):
    html = render(poor.study, replace(poor.sources, claims=CLAIMS), [])
    page = Page(html)
    sections = [attributes["id"] for tag, attributes in page.elements if tag == "section"]
    assert sections[:5] == ["distance", "run", "numbers", "verdicts", "model"]
    folded = re.findall(r'<section id="([\w-]+)"[^>]*>\s*<details class="fold', html)
    assert folded == sections[4:]
    assert not any("open" in attributes for tag, attributes in page.elements if tag == "details")
    assert [*MEANINGS] == [*SIGNS]
    assert "History‑dependent synchronization" in page.whole_text
    assert PAPER in [attributes["href"] for tag, attributes in page.elements if tag == "a"]
    rows = [attributes["id"] for tag, attributes in page.elements if attributes.get("id", "").startswith("claim-")]
    names = [claim["name"] for claim in json.loads(CLAIMS.read_text())["claims"]]
    assert sorted(rows) == sorted(f"claim-{name}" for name in names)


def test_the_main_claims_are_quoted_with_their_verdicts(poor, tmp_path):
    content = json.loads(CLAIMS.read_text())
    chosen = content["claims"][: len(MAIN)]
    for name, record in zip(MAIN, chosen, strict=True):
        record["name"] = name
    (tmp_path / "claims.json").write_text(json.dumps(content))
    text = Page(render(poor.study, replace(poor.sources, claims=tmp_path / "claims.json"))).whole_text
    opening = text[text.index("main claims") : text.index("Verdicts by topic")]
    places = [opening.index(f"The paper: {record['statement'][:6]}") for record in chosen]
    assert places == sorted(places)
    for record in chosen:
        assert f"{SIGNS[record['verdict']]} {record['verdict']}" in opening


def test_every_main_claim_is_one_of_the_paper():
    assert {*MAIN} <= {*paper.CLAIMS}
    assert {claim.topic for claim in paper.CLAIMS.values()} <= {*TITLES}


def test_a_study_that_judges_nothing_does_not_open_with_the_paper(poor):
    page = Page(render(poor.study, replace(poor.sources, claims=None)))
    assert "Study poor : stick‑slip dynamics of 2 blocks" in page.whole_text
    assert "arXiv" not in page.whole_text


def test_a_summary_of_other_sources_is_shown(poor):
    """With its fingerprint."""
    dataset = xarray.load_dataset(poor.sources.summaries["orbits"]).assign_attrs(source_fingerprint="another")
    path = poor.folder / "old" / "orbits.nc"
    path.parent.mkdir(exist_ok=True)
    write_summary(dataset, path)
    page = render(poor.study, replace(poor.sources, summaries={**poor.sources.summaries, "orbits": path}))
    assert "<td><code>another</code></td>" in page


def test_a_failed_run_has_its_file_and_command(page):
    assert "did not complete: diverged" in page.whole_text
    path = "points/linearized/pair/a0.2000.nc"
    assert any(attributes.get("href") == path for _, attributes in page.elements)
    assert f"snakemake -c1 --force results/poor/{path} --configfile poor.yaml" in page.whole_text


def test_texts_of_others_are_escaped(page):
    for text in (
        "It </script><img src=x onerror=alert(1)>.",
        *("Sec. <b onclick=x>1</b>", "<i onmouseover=x>rate</i>", "<u onfocus=x>any</u>"),
    ):
        assert text in page.whole_text
    forbidden = {"onerror", "onclick", "onmouseover", "onfocus"}
    assert all(not forbidden & set(attributes) for _, attributes in page.elements)


def test_the_html_is_sound(page):
    ids = [attributes["id"] for _, attributes in page.elements if "id" in attributes]
    assert len(ids) == len(set(ids))
    targets = [attributes["href"] for tag, attributes in page.elements if tag in ("a", "use")]
    assert {target[1:] for target in targets if target.startswith("#")} <= set(ids)
    for tag, attributes in page.elements:
        assert set(attributes.get("aria-labelledby", "").split()) <= set(ids)
        for name in ("src", "href"):
            value = attributes.get(name, "")
            assert value.startswith(("data:", "#")) or not value or "//" not in value or (tag, value) == ("a", PAPER)
    levels = [int(tag[1]) for tag, _ in page.elements if tag in ("h1", "h2", "h3", "h4")]
    assert levels[0] == 1
    assert levels.count(1) == 1
    assert all(following <= level + 1 for level, following in pairwise(levels))
    assert all(attributes.get("alt") for tag, attributes in page.elements if tag == "img")


def test_the_same_inputs_give_the_same_page(poor, html):
    assert render(poor.study, poor.sources, ["--configfile", "poor.yaml"]) == html


@pytest.mark.parametrize(("values", "charts"), quick_first([([0.1], 0), ([0.1, 0.2], 2)], 1))
def test_a_study_of_two_parameters_begins_with_the_distance(tmp_path, values, charts):
    """As maps to point at if both have several values, else as a picture."""
    grid = {"a": values, "v": [0.1, 0.2]}
    config = {"study": "plane", "grid": grid, "initial": {"plus": {}}, "transient": 20, "window": 20, "batches": 2}
    small = run_study(tmp_path / "results/plane", config, ("points", "summary"))
    summaries = {name: small.folder / f"summary/{name}.nc" for name in ("runs", "lyapunov")}
    html = render(small.study, Sources(None, summaries, {}))
    assert html.count('data-chart="grid"') == charts
    assert ('id="plotly"' in html) == (charts > 0)
    page = Page(html)
    assert next(attributes["id"] for tag, attributes in page.elements if tag == "section") == "grid"
    assert [attributes["value"] for _, attributes in page.elements if attributes.get("name") == "theme"] == [
        "auto",
        "light",
        "dark",
    ]
    assert "paper" not in page.whole_text
