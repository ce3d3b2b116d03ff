"""The site of `make site`: built without warnings, complete, without dead links, readable offline and on a phone."""

import re
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

import pytest
from playwright import sync_api as playwright

import burridge_knopoff
from tests.conftest import made_once
from tests.optional import launch_chromium, needs

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[1]


def build(folder):
    recipe = re.search(r"^site: .*\n\t\$\(BIN\)/sphinx-build (.*) build/site$", (ROOT / "Makefile").read_text(), re.M)[
        1
    ]
    options = recipe.replace("build/doctrees", str(folder / "doctrees")).split()
    command = [sys.executable, "-m", "sphinx", *options, str(folder / "site")]
    run = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    assert (run.returncode, run.stderr) == (0, "")


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    return made_once(tmp_path_factory, "site", build) / "site"


class Page(HTMLParser):
    """The links of a page, the files that it loads, and its link targets."""

    def __init__(self, path):
        super().__init__()
        self.links, self.loads, self.places = set(), set(), {""}
        self.feed(path.read_text())

    def handle_starttag(self, tag, attributes):
        values = dict(attributes)
        self.places |= {values[key] for key in ("id", "name") if key in values}
        if "href" in values:
            (self.links if tag == "a" else self.loads).add(values["href"])
        if "src" in values:
            self.loads.add(values["src"])


def test_no_link_is_dead_and_nothing_is_loaded_from_elsewhere(site):
    pages = {path: Page(path) for path in site.rglob("*.html")}
    assert len(pages) > 20
    for path, page in pages.items():
        for link in page.links | page.loads:
            parts = urlsplit(link)
            if parts.scheme:
                assert link in page.links - page.loads, f"{path}: {link}"
                continue
            target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            assert target.is_file(), f"{path}: {link}"
            if target in pages:
                assert unquote(parts.fragment) in pages[target].places, f"{path}: {link}"
    assert not [path for path in site.rglob("*.css") if re.search(r"url\([\"']?(https?:)?//", path.read_text())]


def test_every_page_and_every_public_name_is_there(site):
    for source in [*ROOT.glob("*.md"), *ROOT.glob("docs/*.md"), *ROOT.glob("config/*.md")]:
        assert (site / source.relative_to(ROOT)).with_suffix(".html").is_file()
    page = (site / "docs/api.html").read_text()
    for name in burridge_knopoff.__all__:
        assert f'id="burridge_knopoff.{name}"' in page
    assert "time before the averaging window" in page


@needs("BK_CHROMIUM")
def test_the_site_on_a_phone_without_a_network(site):
    wrong = []
    with playwright.sync_playwright() as tools:
        browser = launch_chromium(tools)
        page = browser.new_page(viewport={"width": 360, "height": 740}, color_scheme="dark")
        page.on("console", lambda message: wrong.append(message.text))
        page.on("pageerror", lambda error: wrong.append(str(error)))
        page.on("request", lambda request: wrong.append(request.url) if request.url.startswith("http") else None)
        for path in sorted(site.rglob("*.html")):
            page.goto(path.as_uri())
            assert page.evaluate("document.documentElement.scrollWidth") == 360, path
        assert wrong == []
        # Without a server it shows no excerpts, and says so in the console.
        page.goto(f"{(site / 'search.html').as_uri()}?q=pitchfork")
        page.locator("#search-results li", has_text="Why synchrony is lost").wait_for(timeout=20_000)
        browser.close()
