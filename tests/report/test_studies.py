"""The report of studies of one law, of four laws, of a ring, of blocks that are not alike, and of one block."""

import base64
import json
import re
import zlib

import plotly.graph_objects as go
import pytest

from burridge_knopoff.dataset.summary import write_summary
from burridge_knopoff.report import overview
from burridge_knopoff.report.page import Sources, render
from burridge_knopoff.study.load import load_study
from burridge_knopoff.study.study import Study
from tests.report.conftest import CLAIMS
from tests.report.test_page import Page
from tests.small_study import ALL_STUDIES, SMALL, STUDIES

STORED = (
    "mean_distance",
    "bifurcation_diagram",
    "lyapunov",
    "agreement",
    "orbits",
    "attractors",
    "basins",
)


@pytest.fixture(scope="module", params=ALL_STUDIES)
def small(request, small_studies):
    return small_studies(request.param)


def rendered(study, summaries, claims, names, folder):
    """Return the report of a study that has these summaries, without figures."""
    for name in names:
        write_summary(summaries[name], folder / f"{name}.nc")
    return render(study, Sources(claims, {name: folder / f"{name}.nc" for name in names}, {}))


@pytest.fixture(scope="module")
def html(small, tmp_path_factory):
    return rendered(small.study, small.summaries, CLAIMS, STORED, tmp_path_factory.mktemp("summaries"))


def test_every_law_has_its_charts_and_its_formula(small, html):
    page = Page(html)
    laws, states = small.study.laws, small.study.initial
    charts = [attributes for _, attributes in page.elements if "data-chart" in attributes]
    for name, count in {
        # J of one block is 0.
        "distance": len(laws) if small.study.has_end_blocks else 0,
        "exponents": len(laws) * len(states),
    }.items():
        assert sum(chart["data-chart"] == name for chart in charts) == count, name
    # Symbols in italics are elements of their own.
    text = "".join(page.whole_text.split())
    for law, model in zip(laws, small.models, strict=True):
        assert "".join(f"{law}, {model.law.text}".split()) in text
    assert ("is the only one of the study" in page.whole_text) == (len(laws) == 1)


def replace_chain(study):
    """Return a study with springs between the blocks that are twice as strong."""
    return Study({**study.config, "chain": {**study.config["chain"], "coupling": 2.0}}, study.parameters)


def test_a_study_of_curves_alone(small_studies, tmp_path):
    """No attractors, no verdicts: what was left out is said, and no link leads to a file that is not there."""
    small = small_studies("one_law")
    study = load_study({**SMALL, **STUDIES["one_law"], "without": ["attractors", "claims"]}, "small.yaml")
    html = rendered(study, small.summaries, None, STORED[:5], tmp_path)
    text = Page(html).whole_text
    assert "Left out by the config attractors, bifurcations, edges, basins, phases, claims" in text
    assert "This study does not search for attractors" in text
    assert "No statement of the paper was judged." in text
    other = rendered(replace_chain(study), small.summaries, None, STORED[:5], tmp_path)
    assert "of the paper was judged" not in Page(other).whole_text
    assert 'href="#verdicts"' not in other
    assert not re.search(r'href="summary/(attractors|basins|claims)', html)


def test_what_does_not_hold_in_the_chain_is_said(small, html):
    chain = small.models[0].chain
    assert ("The chain is not its own mirror image." in html) == (not chain.is_mirror_symmetric and chain.blocks > 1)
    assert ("is 0 in a chain of one block" in html) == (chain.blocks == 1)
    assert ("a ring; coupling 1;" in html) == (chain.ends == "ring")
    words = "coupling 1, 1.3; pulling 1.5; static friction 1, 1.1, 1.2"
    assert (words in html) == (not chain.is_mirror_symmetric and chain.blocks > 1)
    assert ("coupling" in overview.chain_text(chain)) == (chain.blocks > 1)
    if not chain.is_mirror_symmetric:
        assert (small.summaries["mean_distance"]["synchronized"] == 0).all()
        assert (small.summaries["agreement"]["kind"] != 0).all()
        assert (small.summaries["attractors"]["side"] == 0).all()


def test_the_embedded_runs_are_over_the_laws_of_the_study(small, html):
    data = json.loads(re.search(r'<script type="application/json" id="data">(.*?)</script>', html, re.DOTALL)[1])
    laws, states = small.study.laws, small.study.initial
    assert data["runs"]["laws"] == list(laws)
    assert len(data["runs"]["mean_distance"]) == len(laws)
    assert len(data["runs"]["agrees"]) == len(laws) - 1
    assert all(len(row) == len(states) for row in data["runs"]["agrees"])


def test_every_chart_is_a_figure_of_plotly(html):
    """Each has something to show, and its colours in the dark theme are in the page."""
    dark = json.loads(re.search(r'<script type="application/json" id="data">(.*?)</script>', html, re.DOTALL)[1])[
        "dark"
    ]
    packed = re.findall(r'data-figure="([^"]+)"', html)
    assert packed
    for text in packed:
        content = zlib.decompress(base64.b64decode(text)).decode()
        figure = go.Figure(json.loads(content))
        assert any(trace.y is not None and len(trace.y) for trace in figure.data)
        assert figure.layout.template.layout.font.color in dark


@pytest.mark.parametrize(("varied", "drawn"), [("coupling", False), ("coupling[1]", False), ("v", True)])
def test_no_spring_is_drawn_with_a_stiffness_that_varies(varied, drawn):
    study = load_study({"study": "plane", "grid": {"a": [0.1], varied: [0.5, 1.0]}, "initial": {"plus": {}}}, "p.yaml")
    assert study.has_one_chain == drawn
