"""Colours of the charts: those of the style sheet, and those of curves seen on the dark background."""

import pytest

from burridge_knopoff.figures.palette import BLOCKS, BRANCHES, LAWS, OTHER_BRANCHES
from burridge_knopoff.report.charts.theme import CONTRAST, INK, dark, dark_colors, fixed


def luminance(color):
    parts = [int(color[k : k + 2], 16) / 255 for k in (1, 3, 5)]
    linear = [part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4 for part in parts]
    return sum(weight * part for weight, part in zip((0.2126, 0.7152, 0.0722), linear, strict=True))


@pytest.mark.parametrize("color", [*BRANCHES, *BLOCKS, *LAWS, OTHER_BRANCHES, INK["text"], INK["muted"], INK["focus"]])
def test_what_is_drawn_is_seen_in_the_dark_theme(color):
    behind = luminance(dark(INK["background"]))
    assert (luminance(dark(color)) + 0.05) / (behind + 0.05) >= CONTRAST
    # An opacity stays as it is.
    assert dark(color + "59") == dark(color) + "59"


def test_the_page_replaces_only_colours_that_differ():
    text = f'{{"a": "{INK["text"]}", "b": "#E69F00", "c": "{fixed("#000000")}", "d": "#00000059", "e": "#1 of 4"}}'
    assert dark_colors(text) == {INK["text"]: dark(INK["text"]), "#00000059": dark("#000000") + "59"}
    assert dark(fixed("#0072B2")) == fixed("#0072B2") == "rgb(0,114,178)"
