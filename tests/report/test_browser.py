"""The report in a browser, read as its readers do: with a pointer, with the keyboard, on a phone, in print."""

import json
import unicodedata
from dataclasses import replace

import netCDF4
import pytest
from playwright import sync_api as playwright

from burridge_knopoff.report.page import render
from tests.optional import launch_chromium, needs

pytestmark = [pytest.mark.slow, needs("BK_CHROMIUM")]

# Text of every element whose contrast with what lies behind it is below WCAG AA, and none that a chart draws.
LOW_CONTRAST = """() => {
  const parse = (color) => (color.match(/[\\d.]+/g) ?? []).map(Number);
  const light = ([r, g, b]) => [r, g, b].map((c) => (c /= 255) <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4)
    .reduce((sum, c, n) => sum + c * [0.2126, 0.7152, 0.0722][n], 0);
  const behind = (node) => {
    for (; node; node = node.parentElement) {
      const color = parse(getComputedStyle(node).backgroundColor);
      if (color.length === 3 || color[3] > 0.99) return color;
    }
    return [255, 255, 255];
  };
  return [...document.querySelectorAll("body *")].filter((node) => {
    if (node.closest(".chart, svg, script, dialog") || !node.checkVisibility()) return false;
    if (![...node.childNodes].some((child) => child.nodeType === 3 && child.textContent.trim())) return false;
    const [one, two] = [light(parse(getComputedStyle(node).color)), light(behind(node))].sort((a, b) => b - a);
    return (one + 0.05) / (two + 0.05) < 4.5;
  }).map((node) => node.textContent.trim().slice(0, 40));
}"""

# Whether the frame of a chart holds all its points and the bars above them.
FRAMED = """(box) => box._fullData.filter((trace) => trace.error_y?.visible).every((trace) =>
  trace.y.every((y, n) => !(y + trace.error_y.array[n] > box._fullLayout.yaxis.range[1])))"""

# After the last element, focus goes to the browser or, in some runs, to the first element at once.
FOCUSED = """() => {
  const node = document.activeElement;
  const style = getComputedStyle(node);
  const box = node.getBoundingClientRect();
  const end = node === document.body || node === window.firstReached;
  window.firstReached ??= node;
  return {
    name: node.getAttribute("aria-label") || node.id || node.textContent.trim().slice(0, 40) || node.tagName,
    end,
    visible: style.outlineStyle !== "none" && parseFloat(style.outlineWidth) >= 2 && box.width > 0 && box.height > 0
      && node.checkVisibility({ opacityProperty: true }),
  };
}"""


@pytest.fixture(scope="module")
def browser():
    with playwright.sync_playwright() as tools:
        browser = launch_chromium(tools)
        yield browser
        browser.close()


class Reader:
    """A window on a report; collects everything that goes wrong in it."""

    def __init__(self, browser, path, **window):
        self.wrong, self.requests = [], []
        self.context = browser.new_context(**{"viewport": {"width": 1280, "height": 900}, **window})
        self.page = self.context.new_page()
        self.page.on("console", lambda message: self.wrong.append(f"{message.type}: {message.text}"))
        self.page.on("pageerror", lambda error: self.wrong.append(str(error)))
        self.page.on("request", lambda request: self.requests.append(request.url))
        self.url = path.as_uri()
        self.page.goto(self.url)

    def draw_everything(self):
        """Scroll to every chart, and wait until it is drawn; return how many there are."""
        charts = self.page.locator(".chart").all()
        for chart in charts:
            chart.scroll_into_view_if_needed()
            chart.and_(self.page.locator("[data-drawn]")).wait_for(timeout=20_000)
            assert chart.locator(".main-svg").count() >= 1
            assert chart.evaluate("box => box._fullData.some((trace) => (trace.x ?? []).length)"), chart
            assert chart.evaluate(FRAMED), chart
        return len(charts)

    def close(self):
        """Close the window; nothing may have been written to the console, and no other file asked for."""
        asked = {url for url in self.requests if not url.startswith(("data:", "blob:"))}
        assert self.wrong == []
        assert asked == {self.url}
        self.context.close()


def detail(page):
    """Return what the panel of one run says: {name: text}."""
    return dict(
        zip(
            page.locator("#run-detail dt").all_inner_texts(),
            page.locator("#run-detail dd").all_inner_texts(),
            strict=True,
        )
    )


def check_number(text, value, error):
    """Hold a number with its error against the file: it is rounded to a tenth of its error, and no coarser."""
    number, _, power = unicodedata.normalize("NFKC", text).replace("−", "-").replace("∞", "inf").partition(" × 10")
    parts = [float(part) * 10.0 ** int(power or 0) for part in number.strip("()").split(" ± ")]
    if len(parts) == 1 or not error > 0.0:
        assert parts[0] == value
        return
    assert parts[0] == pytest.approx(value, rel=0.0, abs=0.055 * error)
    assert parts[1] == pytest.approx(error, rel=0.06)


def check_run(page, results, law, initial, a):
    """Hold the panel against the point file of this run."""
    path = f"points/{law}/{initial}/a{a:.4f}.nc"
    fields = detail(page)
    assert page.locator("#run-file").get_attribute("href") == path
    with netCDF4.Dataset(results / path) as point:
        assert (point.law, point.initial, float(point["a"][...])) == (law, initial, a)
        mean, error = (float(point[name][...]) for name in ("mean_distance", "mean_distance_error"))
        exponents = point["lyapunov_exponent"][:].tolist()
        errors = point["lyapunov_error"][:].tolist()
    check_number(fields["⟨J⟩"], mean, error)
    lines = fields["Lyapunov exponents"].splitlines()
    for line, value, spread in zip(lines, exponents, errors, strict=True):
        check_number(line.split(" = ")[1], value, spread)
    assert unicodedata.normalize("NFKC", fields["Run"]) == f"{law} law, initial state {initial}, a = {a!r}"
    assert page.locator("#run-snakemake").inner_text() == (
        f"snakemake -c1 --force results/tiny/{path} --configfile study.yaml"
    )
    words = page.locator("#run-simulate").inner_text().split()
    assert words[:7] == ["bk", "simulate", "--law", law, "--a", repr(a), "--initial"]
    assert words[-2:] == ["--out", f"{law}_{initial}_a{a:.4f}.nc"]


def click_run(page, law, initial, a):
    """Click on a point of a curve of ⟨J⟩."""
    chart = page.locator(f'.chart[data-chart="distance"][data-law="{law}"]')
    chart.scroll_into_view_if_needed()
    x, y = chart.evaluate(
        """(box, [initial, a]) => {
          const trace = box._fullData.filter((trace) => trace.meta === "run")[initial];
          const { xaxis, yaxis } = box._fullLayout;
          const place = box.getBoundingClientRect();
          return [place.x + xaxis._offset + xaxis.d2p(trace.x[a]), place.y + yaxis._offset + yaxis.d2p(trace.y[a])];
        }""",
        [initial, a],
    )
    page.mouse.move(x - 1, y)
    page.mouse.move(x, y)
    # A click is on what is under the pointer, which Plotly looks up a little later.
    page.wait_for_function("box => box._hoverdata?.length", arg=chart.element_handle())
    page.mouse.down()
    page.mouse.up()


def under_pointer(page, kind):
    """Return what the first point of the first chart of that kind says under the pointer."""
    chart = page.locator(f'.chart[data-chart="{kind}"]').first
    chart.scroll_into_view_if_needed()
    chart.locator(".scatterlayer .point").first.hover(force=True)
    return chart.locator(".hoverlayer").text_content()


def check_blocks(page):
    """Hold the moving blocks against what is said of them: they play, pause, and stop when a reader wants no motion."""
    page.locator("#blocks").scroll_into_view_if_needed()
    text = "document.getElementById('moment-text').textContent"
    page.wait_for_function("() => document.getElementById('play').textContent === 'Pause'")
    page.wait_for_function(f"(before) => {text} !== before", arg=page.evaluate(text))
    page.locator("#play").press("Enter")
    assert page.locator("#play").inner_text() == "Play"
    at = []
    for moment in (0, 0, 7.3):
        page.locator("#moment").evaluate(
            "(range, moment) => { range.value = moment; range.dispatchEvent(new Event('input')); }", moment
        )
        at.append(page.locator("#blocks rect").evaluate_all("all => all.map((one) => one.x.baseVal.value)"))
    assert at[0] == at[1] != at[2]
    assert len(at[0]) == 3
    assert page.locator("#blocks path.spring").count() == 5


def check_filter(page, content):
    """Statements are shown by verdict, and without those that follow from others; a link opens its details.

    content : the file of verdicts
    """
    rows = page.locator(".verdicts tr[data-verdict][id]:visible")
    everything = rows.count()
    verdict = next(name for name, count in content["counts"].items() if count and name != "not testable")
    page.locator(f'[data-shows="{verdict}"]').click()
    assert rows.count() == content["counts"][verdict]
    page.locator("#independent-only").check()
    assert rows.count() == content["independent_counts"][verdict]
    # A statement that is hidden is shown if a link leads to it.
    name = next(claim["name"] for claim in content["claims"] if claim["verdict"] not in (verdict, "not testable"))
    page.evaluate("(name) => { location.hash = `#claim-${name}`; }", name)
    details = page.locator(f'[data-claim="{name}"][open]')
    details.wait_for()
    assert rows.count() == everything
    assert details.bounding_box()["width"] > 0.9 * page.locator(".verdicts").bounding_box()["width"]
    page.evaluate("window.scrollTo(0, 0)")


def tab_through(page):
    """Press Tab from the top to the end; return the names of all that was reached. Each must show that it has focus."""
    page.evaluate(
        "() => { document.body.tabIndex = -1; document.body.focus(); document.body.removeAttribute('tabindex'); }"
    )
    reached = []
    for _ in range(600):
        page.keyboard.press("Tab")
        focused = page.evaluate(FOCUSED)
        if focused["end"]:
            return reached
        assert focused["visible"], focused["name"]
        reached.append(focused["name"])
    raise AssertionError(f"a keyboard trap: {reached[-5:]}")


def check_contrast(page):
    """Hold every text against what lies behind it."""
    low = page.evaluate(LOW_CONTRAST)
    assert low == [], low


def test_the_report_of_a_study(browser, reported):
    results = reported.folder / "results" / "tiny"
    path = results / "report.html"
    assert path.stat().st_size < 5e6

    reader = Reader(browser, path, color_scheme="light")
    page = reader.page
    # Charts wait until they are scrolled to.
    assert page.locator(".chart[data-drawn]").count() < page.locator(".chart").count()
    assert reader.draw_everything() == 10
    assert page.locator(".picture.fallback").first.is_hidden()
    page.locator(".recompute summary").click()
    assert page.locator(".meanings .badge").first.inner_text() == "✓ holds"
    titles = page.locator("main > section > h2").all_inner_texts()
    assert titles[:6] == [
        "The paper's claims, tested",
        "The model",
        "Mean distance ⟨J⟩",
        "Attractors and basins",
        "Bifurcation diagrams",
        "Floquet multipliers and the loss of synchrony",
    ]
    # The panel of one run is beside the charts on which it is picked.
    chart, panel = (page.locator(place).bounding_box() for place in ('.chart[data-law="0"]', "#run"))
    assert chart["x"] + chart["width"] <= panel["x"]
    assert abs(chart["y"] - panel["y"]) < 300
    check_filter(page, json.loads((results / "summary" / "claims.json").read_text()))

    # A run by pointer, by arrow keys, by the buttons and by the lists.
    check_run(page, results, "linearized", "minus", 0.08)
    click_run(page, law=1, initial=1, a=3)
    check_run(page, results, "nonlinear", "plus", 0.22)
    page.locator('.chart[data-chart="distance"][data-law="0"]').focus()
    page.keyboard.press("ArrowLeft")
    check_run(page, results, "linearized", "plus", 0.2)
    page.keyboard.press("ArrowUp")
    check_run(page, results, "linearized", "minus", 0.2)
    page.locator("#run-previous").press("Enter")
    check_run(page, results, "linearized", "minus", 0.08)
    page.locator("#run-law").select_option("nonlinear")
    page.locator("#run-a").select_option("0.05")
    check_run(page, results, "nonlinear", "minus", 0.05)
    assert page.locator("#run-previous").is_disabled()
    assert page.locator("#run-detail").get_attribute("aria-live") == "polite"
    page.locator('[data-copies="run-snakemake"]').click()
    page.locator("#copied").get_by_text("opied").or_(page.locator("#copied").get_by_text("Selected")).wait_for()

    check_blocks(page)

    # Numbers under the pointer.
    assert "λ₁ = " in under_pointer(page, "exponents")

    # A chart is saved as a picture, and none can be sent anywhere.
    buttons = page.locator(".modebar-btn").evaluate_all("all => [...new Set(all.map((one) => one.dataset.title))]")
    assert set(buttons) == {"Download plot as a PNG", "Zoom", "Pan", "Zoom in", "Zoom out", "Reset axes"}
    with page.expect_download() as download:
        page.locator(".modebar-btn").first.press("Enter")
    assert download.value.path().read_bytes().startswith(b"\x89PNG")

    # A figure at its full size, opened and closed with the keyboard.
    page.locator(".verdicts .opens-picture").first.press("Enter")
    assert page.locator("#viewer").is_visible()
    assert page.locator("#viewer img").evaluate("image => image.decode().then(() => image.naturalWidth)") == 2100
    page.keyboard.press("Escape")
    assert page.locator("#viewer").is_hidden()

    reached = tab_through(page)
    assert reached[0] == "Skip to the content"
    assert {"run-law", "run-initial", "run-a", "run-next"} <= set(reached)
    assert sum(name.startswith("⟨J⟩ against a, ") for name in reached) == 2

    # Both themes: readable, and the charts follow.
    paper = "getComputedStyle(document.body).backgroundColor"
    ink = "document.querySelector('.chart')._fullLayout.font.color"
    light = page.evaluate(paper), page.evaluate(ink)
    check_contrast(page)
    page.get_by_label("dark", exact=True).check()
    page.wait_for_function(f"(before) => {ink} !== before", arg=light[1])
    assert page.evaluate(paper) != light[0]
    check_contrast(page)
    page.emulate_media(media="print")
    assert page.evaluate(paper) == light[0]
    assert page.locator(".chart").first.is_hidden()
    assert page.locator("#further").is_hidden()
    for picture in page.locator(
        "section:not(#further) > .panel .picture img, section:not(#further) > .picture img"
    ).all():
        assert picture.is_visible()
        assert picture.evaluate("image => image.decode().then(() => image.naturalWidth)") >= 900
    reader.close()

    for width in (360, 320):
        phone = Reader(
            browser, path, viewport={"width": width, "height": 700}, has_touch=True, is_mobile=True, color_scheme="dark"
        )
        phone.draw_everything()
        assert phone.page.evaluate("document.documentElement.scrollWidth") <= width
        for stacked in phone.page.locator(".scroll:has(.stacked)").all():
            assert stacked.evaluate("box => box.scrollWidth - box.clientWidth") == 0
        for badge in phone.page.locator(".badge:visible").all():
            assert badge.evaluate("box => box.getBoundingClientRect().right") <= width
        assert phone.page.evaluate(paper) != light[0]
        phone.close()

    plain = Reader(browser, path, java_script_enabled=False)
    for picture in plain.page.locator(".picture img").all():
        assert picture.is_visible()
    assert plain.page.locator(".js-only").first.is_hidden()
    plain.close()


def test_blocks_rest_if_the_reader_wants_no_motion(browser, poor):
    path = poor.folder / "still.html"
    path.write_text(render(poor.study, replace(poor.sources, points=poor.folder / "points")))
    reader = Reader(browser, path, reduced_motion="reduce")
    page = reader.page
    page.locator("#blocks").scroll_into_view_if_needed()
    page.wait_for_function("() => document.querySelectorAll('#blocks rect[x]').length === 2")
    assert page.locator("#play").inner_text() == "Play"
    page.locator("#play").press("Enter")
    page.wait_for_function("() => document.getElementById('moment-text').textContent[0] !== '0'")
    reader.close()


def test_without_decompression_there_are_pictures(browser, poor):
    path = poor.folder / "old.html"
    path.write_text(render(poor.study, poor.sources))
    context = browser.new_context()
    context.add_init_script("delete window.DecompressionStream")
    page = context.new_page()
    page.goto(path.as_uri())
    assert page.locator(".too-old").is_visible()
    assert all(picture.is_visible() for picture in page.locator(".picture img").all())
    assert page.locator("#run").is_hidden()
    context.close()


def test_the_report_of_a_study_that_lacks_most(browser, poor):
    path = poor.folder / "report.html"
    path.write_text(render(poor.study, poor.sources, ["--configfile", "poor.yaml"]))
    reader = Reader(browser, path)
    reader.draw_everything()
    reader.page.locator("#run-law").select_option("linearized")
    reader.page.locator("#run-a").select_option("0.2")
    fields = detail(reader.page)
    assert (fields["⟨J⟩"], fields["Status"]) == ("–", "diverged")
    assert fields["Kind of motion"] == "undetermined"
    reader.close()
