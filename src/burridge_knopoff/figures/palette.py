"""The colours of figures and charts: a palette for each family of things, so that no colour has two meanings.

Branches of attractors, kinds of motion and blocks have hues of their own; the synchronized branch and synchronized
motion, which are the same, share one. Laws and solvers are black and grey, with line styles and markers. Ascending
values of one quantity are shades of a ramp. Colours of branches and of kinds differ for colour-blind
readers too, which `tests/figures/test_palette.py` computes.
"""

from __future__ import annotations

from colorsys import hls_to_rgb, rgb_to_hls
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.colors import ListedColormap, to_hex, to_rgb

SYNCHRONIZED = "#0A5AB6"

#: Branches of attractors: the synchronized branch has the first colour, branch 1 the second, and so on. Found by a
#: search: any two of them, and grey, differ by 20 in CIELAB for every kind of colour vision, the first four in print
#: without colour too, by their lightness.
BRANCHES = (
    *(SYNCHRONIZED, "#E86E00", "#FCC000", "#0C3000", "#E430FF", "#7800FF", "#3C9C60", "#E4183C", "#6C0078", "#54540C"),
    *("#30E478", "#6C003C", "#906090", "#D89CF0", "#3C009C"),
)
#: Branches that fill little of a picture, and states whose branch is undetermined.
OTHER_BRANCHES = "#999999"
UNDETERMINED = "#000000"

#: {number of a kind of motion: colour}. Undetermined motion is white; from periodic to chaotic motion colours darken.
KINDS = {
    **{-1: "#FFFFFF", 0: SYNCHRONIZED, 1: "#DECCDA", 2: "#9992C2", 3: "#3C0820", 4: "#D7936B", 5: "#062278"},
    6: "#BBEEBB",
}

#: Blocks. Of three, the end blocks have a light and a dark shade of one hue, the middle block another hue.
BLOCKS = ("#6CCBC0", "#E0457B", "#00423C", "#B08D57", "#7F9A20", "#8C6BB1", "#555555")

#: Ascending values of one quantity, from light to dark; without the yellow that a white page would hide.
RAMP = ListedColormap(mpl.colormaps["viridis_r"](np.linspace(0.2, 1.0, 256)))

#: Laws, together with `DASHES` and `law_marker`.
LAWS = ("#000000", "#8A8A8A", "#4D4D4D", "#B5B5B5")
DASHES: tuple[Any, ...] = (
    "-", "--", ":", "-.", (0, (6, 1.5, 1, 1.5, 1, 1.5)), (0, (10, 3)), (0, (1, 4)), (0, (5, 1, 5, 4))
)  # fmt: skip
MARKERS = ("o", "s", "^", "D", "v", "p", "h", "x")


# Lightness of light colours: a mirror pair that fills a map differs as much from its own image as from other branches.
LIGHT = 0.85

#: Initial states: a filled symbol, then open symbols that grow, so that one is seen around another.
STATE_MARKERS = "ovs^Dph*"


def law_color(index: int) -> str:
    """Return the shade of a law by its number in the study."""
    return LAWS[index % len(LAWS)]


def block_color(index: int) -> str:
    """Return the colour of a block by its number, from 0."""
    return BLOCKS[index % len(BLOCKS)]


def dashes(index: int) -> Any:
    """Return the line style of a law, or of another curve, by its number."""
    return DASHES[index % len(DASHES)]


def law_symbol(index: int, size: float = 3.0) -> dict[str, Any]:
    """Return the look of a law's points: small and filled for the first law, larger and open for others.

    size : of the symbol of the first law
    """
    look = {"color": law_color(index), "marker": MARKERS[max(0, index - 1) % len(MARKERS)], "markeredgewidth": 0.7}
    return look | ({"markerfacecolor": "none", "markersize": 1.5 * size} if index else {"markersize": size})


def state_symbol(index: int, size: float = 1.9) -> dict[str, Any]:
    """Return the look of the points of an initial state by its number: a black symbol, open except for the first state.

    size : of the symbol of the first state
    """
    look = {"color": "black", "marker": STATE_MARKERS[index % len(STATE_MARKERS)], "linestyle": ""}
    if index == 0:
        return look | {"markeredgewidth": 0.0, "markersize": size}
    return look | {"markerfacecolor": "none", "markeredgewidth": 0.45, "markersize": size + 0.8 + 0.9 * index}


def ramp(count: int) -> list[str]:
    """Return the colours of `count` ascending values of one quantity, from light to dark."""
    return [to_hex(RAMP(k / max(1, count - 1))) for k in range(count)]


def light(color: str) -> str:
    """Return a light colour of the same hue, both #rrggbb, for the mirror image of a part of a map."""
    hue, _, saturation = rgb_to_hls(*to_rgb(color))
    return to_hex(hls_to_rgb(hue, LIGHT, saturation))


def pale(color: str) -> str:
    """Return a lighter shade of a colour, both #rrggbb, for points on white."""
    parts = (int(color[k : k + 2], 16) for k in (1, 3, 5))
    return "#" + "".join(f"{round(0.45 * part + 0.55 * 255):02x}" for part in parts)
