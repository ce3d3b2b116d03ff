"""Colours that stand for different things differ for every kind of colour vision, computed and not judged by eye.

Kinds of colour vision: Machado, Oliveira and Fernandes, IEEE Trans. Vis. Comput. Graph. 15, 1291 (2009), their
matrices at full severity. Differences: CIE76, the distance in CIELAB.
"""

from itertools import combinations

import numpy as np
import pytest
from matplotlib.colors import to_rgb

from burridge_knopoff.figures.palette import BRANCHES, KINDS, OTHER_BRANCHES, UNDETERMINED, light

VISIONS = {
    "normal": np.eye(3),
    "protanopia": [
        [0.152286, 1.052583, -0.204868],
        [0.114503, 0.786281, 0.099216],
        [-0.003882, -0.048116, 1.051998],
    ],
    "deuteranopia": [
        [0.367322, 0.860646, -0.227968],
        [0.280085, 0.672501, 0.047413],
        [-0.011820, 0.042940, 0.968881],
    ],
    "tritanopia": [
        [1.255528, -0.076749, -0.178779],
        [-0.078411, 0.930809, 0.147602],
        [0.004733, 0.691367, 0.303900],
    ],
}
TO_XYZ = np.array(
    [[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750], [0.0193339, 0.119192, 0.9503041]]
)

#: Least difference of two colours that can touch or are in one legend.
LEAST = 20.0

WHITE = "#FFFFFF"


def lab(color: str, vision: str = "normal") -> np.ndarray:
    """Return a colour in CIELAB as eyes of a kind see it."""
    rgb = np.array(to_rgb(color))
    linear = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    xyz = TO_XYZ @ np.clip(np.array(VISIONS[vision]) @ linear, 0.0, 1.0) / TO_XYZ.sum(axis=1)
    x, y, z = np.where(xyz > 216 / 24389, np.cbrt(xyz), (24389 / 27 * xyz + 16) / 116)
    return np.array([116 * y - 16, 500 * (x - y), 200 * (y - z)])


def least_difference(colors, vision: str) -> float:
    places = [lab(color, vision) for color in colors]
    return min(float(np.linalg.norm(first - second)) for first, second in combinations(places, 2))


def test_differences_are_those_of_cielab():
    """Against values of colour tables: red, and white, whose lightness is 100."""
    assert lab("#FF0000") == pytest.approx([53.24, 80.09, 67.20], abs=0.02)
    assert lab(WHITE) == pytest.approx([100.0, 0.0, 0.0], abs=1e-6)
    # Eyes without one kind of cones still see greys as greys.
    for vision in VISIONS:
        assert lab("#808080", vision) == pytest.approx(lab("#808080"), abs=0.01)


@pytest.mark.parametrize("vision", VISIONS)
def test_any_two_branches_differ(vision):
    assert least_difference([*BRANCHES, OTHER_BRANCHES, UNDETERMINED, WHITE], vision) >= LEAST


@pytest.mark.parametrize("vision", VISIONS)
def test_any_two_kinds_of_motion_differ(vision):
    # Undetermined motion is white, with an outline in legends.
    assert least_difference([color for code, color in KINDS.items() if code >= 0], vision) >= LEAST


@pytest.mark.parametrize("vision", VISIONS)
def test_two_mirror_images_differ(vision):
    assert all(least_difference([color, light(color)], vision) >= LEAST for color in BRANCHES[:13])


@pytest.mark.parametrize("vision", VISIONS)
def test_the_parts_of_the_default_map_of_mirror_pairs_differ_most_where_they_fill_most(vision):
    """At a = 0.15, both images of branch 3 and branch 1 fill it; both images of branch 4 lie between them."""
    most, all_parts = [BRANCHES[1], BRANCHES[3], light(BRANCHES[3])], [BRANCHES[4], light(BRANCHES[4])]
    assert least_difference(most, vision) >= 2.3 * LEAST
    assert least_difference([*most, *all_parts], vision) >= 1.8 * LEAST


def test_the_first_branches_and_the_kinds_that_touch_differ_in_print_without_colour():
    for colors in (BRANCHES[:4], [KINDS[code] for code in (0, 1, 2, 3)]):
        lightness = sorted(lab(color)[0] for color in colors)
        assert min(np.diff(lightness)) >= LEAST
