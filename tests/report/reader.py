"""A window on a report in a browser, what a reader does in it, and what must be seen then."""

import unicodedata

import netCDF4
import pytest
from playwright.sync_api import expect

from burridge_knopoff.report.verdicts import SIGNS

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
        """Open every fold, scroll to every chart, and wait until it is drawn; return how many there are."""
        self.page.evaluate("document.querySelectorAll('details').forEach((fold) => { fold.open = true; })")
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
    expect(page.locator("#run-file")).to_have_attribute("href", path, timeout=20_000)
    fields = detail(page)
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
    assert page.locator("#run-snakemake").text_content() == (
        f"snakemake -c1 --force results/tiny/{path} --configfile study.yaml"
    )
    words = page.locator("#run-simulate").text_content().split()
    assert words[:7] == ["bk", "simulate", "--law", law, "--a", repr(a), "--initial"]
    assert words[-2:] == ["--out", f"{law}_{initial}_a{a:.4f}.nc"]


def click_run(page, law, initial, a):
    """Click on a point of a curve of ⟨J⟩."""
    chart = page.locator(f'.chart[data-chart="distance"][data-law="{law}"]')
    x, y = chart.evaluate(
        """(box, [initial, a]) => {
          const trace = box._fullData.filter((trace) => trace.meta === "run")[initial];
          const { xaxis, yaxis } = box._fullLayout;
          return [xaxis._offset + xaxis.d2p(trace.x[a]), yaxis._offset + yaxis.d2p(trace.y[a])];
        }""",
        [initial, a],
    )
    # These wait until the chart has come to rest.
    chart.hover(position={"x": x, "y": y})
    # A click is on what is under the pointer, which Plotly looks up a little later.
    page.wait_for_function(
        """([box, initial, a]) => box._hoverdata?.some(({ data, customdata, pointNumber }) =>
          data.meta === "run" && customdata[0] === initial && pointNumber === a)""",
        arg=[chart.element_handle(), initial, a],
    )
    chart.click(position={"x": x, "y": y})


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
    """Statements and their counts are shown by verdict, at first the independent ones; a link opens its folds.

    content : the file of verdicts
    """
    cards = page.locator("#verdicts [data-verdict][id]:visible")
    assert cards.count() == 0
    only = page.locator("#independent-only")
    assert only.is_checked()
    verdict = next(name for name, count in content["independent_counts"].items() if count and name != "not testable")
    page.locator(f'[data-shows="{verdict}"]').click()
    for checked, key in ((False, "counts"), (True, "independent_counts")):
        only.set_checked(checked)
        counts = [f"{SIGNS[name]} {name}: {count}" for name, count in content[key].items() if count]
        assert page.locator("[data-shows]:visible").all_inner_texts() == counts
        assert cards.count() == content[key][verdict]
    # A statement that is hidden is shown if a link leads to it.
    others = [claim for claim in content["claims"] if claim["verdict"] not in (verdict, "not testable")]
    name = max(others, key=lambda claim: len(claim["depends_on"]))["name"]
    page.evaluate("(name) => { location.hash = `#claim-${name}`; }", name)
    card = page.locator(f"#claim-{name}")
    card.locator("details[open]").wait_for()
    assert card.bounding_box()["width"] > 0.9 * page.locator("#verdicts").bounding_box()["width"]
    assert page.locator(".topic[open]").count() == 1


def check_address(page, results):
    """The run that is picked is in the address: with it the page opens, and back and forward lead through the runs."""
    page.goto("about:blank")
    page.goto((results / "report.html").as_uri() + "#run=nonlinear/plus/0.2")
    check_run(page, results, "nonlinear", "plus", 0.2)
    page.locator("#run-previous").press("Enter")
    page.wait_for_url("**#run=nonlinear/plus/0.08")
    page.locator("#run-initial").select_option("minus")
    page.wait_for_url("**#run=nonlinear/minus/0.08")
    for move, state, a in ((page.go_back, "plus", 0.08), (page.go_back, "plus", 0.2), (page.go_forward, "plus", 0.08)):
        move()
        page.locator("#run-detail").get_by_text(f"state {state}, a\u00a0=\u00a0{a}").wait_for()
    # What is no run of the study changes nothing, and a place of the page opens.
    page.evaluate("location.hash = '#run=nonlinear/elsewhere/0.08'")
    page.evaluate("location.hash = '#provenance'")
    page.locator("#provenance details[open]").wait_for()
    check_run(page, results, "nonlinear", "plus", 0.08)


def check_branches(page):
    """Branches of attractors are drawn if they are asked for, with a legend of what is on each chart."""
    shown = """(box) => box._fullData.filter((trace) => trace.meta === "branch" && trace.visible === true).length"""
    chart, legends = page.locator('.chart[data-law="0"]'), page.locator(".legend.branches")
    assert (chart.evaluate(shown), legends.first.is_visible()) == (0, False)
    page.locator("#branches").check()
    page.wait_for_function(f"(box) => ({shown})(box) > 0", arg=chart.element_handle())
    assert chart.evaluate(shown) == legends.first.locator("li").count() <= 8
    page.locator("#branches").uncheck()
    page.wait_for_function(f"(box) => ({shown})(box) === 0", arg=chart.element_handle())
    assert legends.first.is_hidden()


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
