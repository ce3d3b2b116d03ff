"""Take the picture of the report in docs/results.md: `python docs/screenshot.py PROGRAM`, the path of a Chromium.

It shows ⟨J⟩ and the run that is picked in results/paper/report.html, in a window 1440 pixels wide.
"""

import sys
from pathlib import Path

from PIL import Image
from playwright.sync_api import sync_playwright

ROOT = Path(__file__).parents[1]
REPORT = ROOT / "results" / "paper" / "report.html"
PICTURE = ROOT / "docs" / "figures" / "report.png"


def main(program: str) -> None:
    """Write the picture."""
    with sync_playwright() as tools:
        browser = tools.chromium.launch(executable_path=program, args=["--no-sandbox"])
        page = browser.new_page(viewport={"width": 1440, "height": 1270}, color_scheme="light")
        page.goto(REPORT.as_uri())
        page.locator("#distance").scroll_into_view_if_needed()
        page.locator(".chart[data-drawn]").nth(1).wait_for()
        page.locator("#distance").screenshot(path=PICTURE)
        browser.close()
    colors = Image.open(PICTURE).convert("RGB").quantize(256, Image.Quantize.FASTOCTREE, dither=Image.Dither.NONE)
    colors.save(PICTURE, optimize=True)


if __name__ == "__main__":
    main(sys.argv[1])
