"""The report in a browser, read as its readers do: with a pointer, with the keyboard, on a phone, in print."""

import json
import re
from dataclasses import replace

import pytest
from playwright import sync_api as playwright

from burridge_knopoff.report.page import render
from tests.optional import launch_chromium, needs
from tests.report.reader import (
    Reader,
    check_address,
    check_blocks,
    check_branches,
    check_contrast,
    check_filter,
    check_run,
    click_run,
    detail,
    tab_through,
    under_pointer,
)

pytestmark = [pytest.mark.slow, needs("BK_CHROMIUM")]


@pytest.fixture(scope="module")
def browser():
    with playwright.sync_playwright() as tools:
        browser = launch_chromium(tools)
        yield browser
        browser.close()


def test_the_report_of_a_study(browser, reported):
    results = reported.folder / "results" / "tiny"
    path = results / "report.html"
    assert path.stat().st_size < 5e6

    reader = Reader(browser, path, color_scheme="light", permissions=["clipboard-read", "clipboard-write"])
    page = reader.page
    # Charts wait until they are scrolled to, and those in folds until these are opened.
    page.locator('.chart[data-law="0"][data-drawn]').wait_for()
    assert page.locator(".chart[data-drawn]").count() <= 2
    assert page.locator(".picture.fallback").first.is_hidden()
    assert page.locator("main section > h2").all_inner_texts() == [
        "Mean distance ⟨J⟩",
        "The paper's numbers and main claims",
        "Verdicts by topic",
    ]
    # The charts are beside each other, and the panel of the run that is picked on them is below.
    first, second, panel = (
        page.locator(place).bounding_box() for place in ('[data-law="0"]', '[data-law="1"]', "#run")
    )
    assert first["x"] + first["width"] <= second["x"]
    assert first["y"] + first["height"] <= panel["y"] <= first["y"] + first["height"] + 100
    # Three screens before anything folds.
    assert page.locator("#more").bounding_box()["y"] < 3 * 900
    assert page.locator("[data-shows]").first.inner_text().startswith("✓ holds: ")
    reached = tab_through(page)
    assert reached[0] == "Skip to the content"
    assert {"run-law", "run-initial", "run-a", "run-next", "run-copy"} <= set(reached)
    assert sum(name.startswith("⟨J⟩ against a, ") for name in reached) == 2
    check_branches(page)
    content = json.loads((results / "summary" / "claims.json").read_text())
    check_filter(page, content)
    check_address(page, results)
    page.goto("about:blank")
    page.goto(reader.url)
    assert reader.draw_everything() == 10

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
    page.locator("#run-copy").click()
    page.locator("#copied").get_by_text("Copied.").wait_for()
    copied = page.evaluate("navigator.clipboard.readText()").splitlines()
    assert f"⟨J⟩: {detail(page)['⟨J⟩']}" in copied
    assert copied[-2:] == [page.locator(f"#run-{name}").text_content() for name in ("snakemake", "simulate")]

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
    page.locator(".card .opens-picture").first.press("Enter")
    assert page.locator("#viewer").is_visible()
    assert page.locator("#viewer img").evaluate("image => image.decode().then(() => image.naturalWidth)") == 1020
    page.keyboard.press("Escape")
    assert page.locator("#viewer").is_hidden()

    # Both themes: readable, and the charts follow.
    paper = "getComputedStyle(document.body).backgroundColor"
    ink = "document.querySelector('.chart')._fullLayout.font.color"
    light = page.evaluate(paper), page.evaluate(ink)
    check_contrast(page)
    page.get_by_label("dark", exact=True).check()
    page.wait_for_function(f"(before) => {ink} !== before", arg=light[1])
    assert page.evaluate(paper) != light[0]
    check_contrast(page)
    reader.close()

    # On paper there are pictures in the place of charts, and no fold that the reader has to open.
    paper_reader = Reader(browser, path, color_scheme="dark")
    page = paper_reader.page
    page.emulate_media(media="print")
    assert page.evaluate(paper) == light[0]
    assert page.locator(".chart").first.is_hidden()
    assert page.locator("#further").is_hidden()
    independent = content["independent_counts"]
    assert page.locator(".card:visible").count() == sum(independent.values()) - independent["not testable"]
    width = page.locator("main").bounding_box()["width"]
    for picture in page.locator(".picture:not(#further .picture) img").all():
        assert picture.bounding_box()["width"] > 0.59 * width
        assert picture.evaluate("image => image.decode().then(() => image.naturalWidth)") >= 900
    assert len(re.findall(rb"/Type\s*/Page\b", page.pdf(format="A4"))) < 10
    paper_reader.close()

    for width in (360, 320):
        phone = Reader(
            browser, path, viewport={"width": width, "height": 700}, has_touch=True, is_mobile=True, color_scheme="dark"
        )
        lines = phone.page.locator("nav li").evaluate_all("all => all.map((item) => item.getBoundingClientRect().top)")
        assert len(set(lines)) == 1
        phone.draw_everything()
        assert phone.page.evaluate("document.documentElement.scrollWidth") <= width
        for stacked in phone.page.locator(".scroll:has(.stacked)").all():
            assert stacked.evaluate("box => box.scrollWidth - box.clientWidth") == 0
        for badge in phone.page.locator(".badge:visible").all():
            assert badge.evaluate("box => box.getBoundingClientRect().right") <= width
        assert phone.page.evaluate(paper) != light[0]
        phone.close()

    plain = Reader(browser, path, java_script_enabled=False)
    assert plain.page.locator("#distance .picture img").is_visible()
    plain.page.locator("#model summary").click()
    assert plain.page.locator("#figure-sketch img").is_visible()
    assert plain.page.locator(".js-only").first.is_hidden()
    plain.close()


def test_blocks_rest_if_the_reader_wants_no_motion(browser, poor):
    path = poor.folder / "still.html"
    path.write_text(render(poor.study, replace(poor.sources, results=poor.folder)))
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
    assert page.locator("#distance .picture img").is_visible()
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
