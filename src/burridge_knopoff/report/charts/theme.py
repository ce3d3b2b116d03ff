"""Colours in both themes: charts are built in those of the light one, and the page replaces them in the dark one.

`rgb(r,g,b)` is the same in both themes; `#rrggbb` and `#rrggbbaa` are replaced by what `dark` returns.
"""

from __future__ import annotations

import re
from pathlib import Path

#: The style sheet of the page, which defines its colours and its font.
STYLE = (Path(__file__).parents[1] / "static" / "style.css").read_text(encoding="utf-8")

_INKS = {name: (light, dark) for name, light, dark in re.findall(r"--(\w+): light-dark\((#\w+), (#\w+)\)", STYLE)}

#: Colours of the page in the light theme, by name.
INK = {name: light for name, (light, _) in _INKS.items()}

FONT = re.findall(r"--font: (.*);", STYLE)[0].replace('"', "'")

#: Shades of grey from strong to weak, and the colours of a scale from 0 to 1.
GREYS = {"#000000": "#f2f4f6", "#5f666d": "#b4bac0", "#9aa1a8": "#7e868e"}
SCALE = {"#eef0f2": "#2a3036", "#cfe3f1": "#1d4f73", "#00446b": "#7cc4f5"}

_DARK = dict(_INKS.values()) | GREYS | SCALE

#: Least contrast with the background: that of WCAG for what is not text.
CONTRAST = 3.0


def dark(color: str) -> str:
    """Return a colour in the dark theme, lightened until it stands out from the background."""
    if not color.startswith("#"):
        return color
    plain, opacity = color[:7], color[7:]
    if plain in _DARK:
        return _DARK[plain] + opacity
    behind, share, mixed = _luminance(_DARK[INK["background"]]), 0.0, plain
    while (_luminance(mixed) + 0.05) / (behind + 0.05) < CONTRAST:
        share += 0.05
        mixed = "#" + "".join(f"{round(part + share * (255 - part)):02x}" for part in _parts(plain))
    return mixed + opacity


def dark_colors(text: str) -> dict[str, str]:
    """Return {colour: colour in the dark theme} of all colours in JSON that differ."""
    colors = {*re.findall(r'"(#(?:[0-9a-fA-F]{2}){3,4})"', text)}
    return {color: dark(color) for color in sorted(colors) if dark(color) != color}


def fixed(color: str) -> str:
    """Return a colour #rrggbb in the form that is the same in both themes."""
    return "rgb({},{},{})".format(*_parts(color))


def _parts(color: str) -> list[int]:
    return [int(color[k : k + 2], 16) for k in (1, 3, 5)]


def _luminance(color: str) -> float:
    """Return the relative luminance of WCAG."""
    linear = [
        part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4
        for part in (value / 255 for value in _parts(color))
    ]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]
