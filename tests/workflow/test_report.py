"""`snakemake --report`: every figure and text with its category and caption, offline."""

import base64
import html
import json
import re
import zipfile

import pytest
from docutils.core import publish_doctree
from playwright.sync_api import sync_playwright

from burridge_knopoff.figures.description import figure_descriptions
from tests.optional import launch_chromium, needs
from tests.workflow.faults import without_times

CATEGORIES = {
    "Claims": ["claims.csv"],
    "Model": ["equilibrium.png", "friction_laws.png", "sketch.png"],
    "Runs": ["distance.png", "motion_minus.png", "motion_plus.png", "stick_slip.png"],
    "Synchronization": ["bifurcation_diagram.png", "lyapunov.png", "mean_distance.png", "orbits.png", "proof.txt"],
    "Attractors": [
        *("attractor_kinds.png", "attractors.txt", "basin_fractions.png", "basins.png", "basins.txt"),
        *("bifurcations.png", "bifurcations.txt", "branches_reached.png"),
        *("detuning.png", "phases.png", "rotation.png"),
    ],
    "Friction laws": ["agreement.csv", "agreement.png", "agreement.txt", "solvers.png", "two_blocks.png"],
}


def embedded_variable(page, name):
    """Return a variable of the page's script."""
    start = re.search(rf"^ *var {name} = (?=[\"{{])", page, re.MULTILINE)
    return json.JSONDecoder().raw_decode(page, start.end())[0]


@pytest.fixture(scope="module")
def report(finished, tmp_path_factory):
    path = tmp_path_factory.mktemp("report") / "report.html"
    output = finished.ok("--report", str(path))
    assert "warning" not in output.lower()
    assert "study tiny" not in output
    return path


def test_every_figure_and_text_has_its_category_and_caption(report, finished, repository):
    page = report.read_text()
    results = embedded_variable(page, "results")
    listed = {
        category: sorted(path.rsplit("/", 1)[1] for paths in parts.values() for path in paths)
        for category, parts in embedded_variable(page, "categories").items()
    }
    assert listed == CATEGORIES
    pictures = {path.name for path in (finished.folder / "results" / "tiny" / "figures").glob("*.png")}
    assert pictures == {name for names in CATEGORIES.values() for name in names if name.endswith(".png")}
    captions = {entry["caption"] for entry in results.values()}
    # Both motions have one caption, which names the initial state.
    assert len(captions) == len(results)
    for path, entry in results.items():
        words = re.sub(r"<[^>]+>", "", entry["caption"]).split()
        assert len(words) > 8, path
        assert "{{" not in entry["caption"]
        assert entry["labels"]["result"]
        content = base64.b64decode(entry["data_uri"].partition("base64,")[2])
        assert content == (finished.folder / path).read_bytes()
    assert "Study <strong>tiny</strong>" in embedded_variable(page, "workflow_desc")
    caption_text = " ".join(re.sub(r"<[^>]+>", "", html.unescape(" ".join(captions))).split())
    written = {path.stem: path.read_text() for path in (repository / "workflow" / "report").glob("*.rst")}
    unused = {name for name, text in written.items() if " ".join(text.split()[:6]) not in caption_text}
    # The stage of edge states is off.
    assert unused == {"figure", "workflow", "edges_txt"}


def test_every_caption_is_valid(repository):
    """This includes captions of optional stages."""
    texts = [path.read_text() for path in (repository / "workflow" / "report").glob("*.rst")]
    for text in (*texts, *(figure.caption_of({"initial": "minus"}, True) for figure in figure_descriptions())):
        assert publish_doctree(text, settings_overrides={"halt_level": 2}).astext()


def test_the_zip_contains_the_same_files(finished, tmp_path):
    finished.ok("--report", str(tmp_path / "report.zip"))
    with zipfile.ZipFile(tmp_path / "report.zip") as archive:
        names = [name.rsplit("/", 1)[1] for name in archive.namelist()]
    assert sorted(names) == sorted(["report.html", *(name for names in CATEGORIES.values() for name in names)])


@needs("BK_CHROMIUM")
def test_a_browser_without_a_network_shows_it(report):
    with sync_playwright() as playwright:
        browser = launch_chromium(playwright)
        page = browser.new_context(offline=True).new_page()
        errors = []
        page.on("pageerror", lambda error: errors.append(str(error)))
        page.on("requestfailed", lambda request: errors.append(request.url))
        page.goto(report.as_uri())
        page.get_by_text("Synchronization", exact=True).click()
        row = page.get_by_role("row").filter(has_text="Lyapunov exponents")
        row.locator("a").first.click()
        picture = page.locator("img[src^='data:image/png']").first
        picture.wait_for()
        width = picture.evaluate("image => image.naturalWidth")
        browser.close()
    assert errors == []
    assert width > 1500


def test_the_report_of_the_study_differs_between_runs_only_in_what_the_jobs_took(finished, copy):
    page = copy.folder / "results/tiny/report.html"
    before = page.read_bytes()
    for times in (page.parent / "benchmarks").rglob("*.tsv"):
        names, values = (line.split("\t") for line in times.read_text().splitlines()[:2])
        times.write_text("\n".join(["\t".join(names), "\t".join(["12345.6", *values[1:]]), ""]))
    page.unlink()
    copy.ok("results/tiny/report.html")
    assert b"12345.6" in page.read_bytes()
    assert page.read_bytes() != before
    pages = (study.folder / "results/tiny/report.html" for study in (copy, finished))
    assert len({*map(without_times, pages)}) == 1
