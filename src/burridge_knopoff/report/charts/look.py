"""The common look of the charts: axes, marks, and the form in which a chart is in the page."""

from __future__ import annotations

import base64
import zlib
from collections.abc import Sequence
from typing import Any

import numpy as np
import plotly.graph_objects as go

from burridge_knopoff.figures.strips import strip_columns, strip_range
from burridge_knopoff.report.charts.theme import FONT, INK, dark_colors

#: Plotly's names of matplotlib's markers.
SYMBOLS = {
    "o": "circle",
    "s": "square",
    "D": "diamond",
    "^": "triangle-up",
    "v": "triangle-down",
    "p": "pentagon",
    "h": "hexagon2",
    "*": "star",
    "+": "cross",
    "x": "x",
}

_AXIS = {
    "title": {"standoff": 8},
    "showline": True,
    "mirror": "ticks",
    "ticks": "inside",
    "zeroline": False,
    "linecolor": INK["muted"],
    "tickcolor": INK["muted"],
    "gridcolor": INK["line"],
    "gridwidth": 0.5,
    "minexponent": 4,
}

_TEMPLATE = go.layout.Template(
    layout={
        "font": {"family": FONT, "size": 13, "color": INK["text"]},
        "paper_bgcolor": "rgba(0,0,0,0)",
        "plot_bgcolor": "rgba(0,0,0,0)",
        "margin": {"l": 62, "r": 18, "t": 30, "b": 48},
        "showlegend": False,
        "hovermode": "closest",
        "hoverlabel": {
            "bgcolor": INK["background"],
            "bordercolor": INK["muted"],
            "font": {"color": INK["text"], "size": 13},
            "align": "left",
        },
        "modebar": {"bgcolor": "rgba(0,0,0,0)", "color": INK["muted"], "activecolor": INK["text"]},
        "xaxis": _AXIS,
        "yaxis": {**_AXIS, "automargin": True},
    }
)


def chart(traces: Sequence[Any], **layout: Any) -> go.Figure:
    """Return a chart in the common look."""
    return go.Figure(list(traces), {"template": _TEMPLATE, **layout})


def scatter(x: Any, y: Any, color: str, hover: str, **options: Any) -> go.Scatter:
    """Return a curve or marks of one colour; `hover` is what they say under the pointer, `options` is plotly's."""
    look = {"line_color": color, "marker_color": color, "hovertemplate": f"{hover}<extra></extra>"}
    return go.Scatter(x=x, y=y, **look, **options)


def bars(error: np.ndarray, color: str) -> dict[str, Any]:
    """Return the error bars of a curve."""
    return {"array": np.nan_to_num(error), "color": color, "thickness": 0.8, "width": 0}


def axis(title: str, **options: Any) -> dict[str, Any]:
    """Return an axis with a title."""
    return {"title": {"text": title}, **options}


def a_axis(a: np.ndarray, **options: Any) -> dict[str, Any]:
    """Return the axis of a, with room for what is drawn at the first and at the last value."""
    # Of a single value other numbers would tell of a range.
    ticks = {"tickvals": a} if len(a) == 1 else {"nticks": 8}
    return axis("<i>a</i>", range=list(strip_range(a)), **{**ticks, **options})


def strip_map(a: np.ndarray, values: np.ndarray, words: np.ndarray, **options: Any) -> go.Heatmap:
    """Return a heat map with a strip for each a, and gaps between the strips of a coarse grid.

    values, words : numbers, and what they say under the pointer, of shape (row, a)
    """
    edges, index = strip_columns(a)
    numbers = np.where(index < 0, np.nan, np.asarray(values, dtype="f4")[:, index])
    return go.Heatmap(x=edges, z=numbers, text=np.asarray(words)[:, index], hoverongaps=False, **options)


def steps(colors: Sequence[str]) -> dict[str, Any]:
    """Return the scale of a heat map whose values are positions in a list of colours."""
    size = max(2, len(colors))
    edges = np.clip((np.arange(size + 1) - 0.5) / (size - 1), 0.0, 1.0)
    edges[len(colors)] = 1.0
    scale = [[edge, color] for n, color in enumerate(colors) for edge in edges[n : n + 2].tolist()]
    return {"colorscale": scale, "zmin": 0, "zmax": size - 1, "showscale": False}


class Packer:
    """Puts charts into the page: as compressed JSON, for some of them are large.

    dark : {colour: colour in the dark theme} of the charts so far
    """

    def __init__(self) -> None:
        self.dark: dict[str, str] = {}

    def __call__(self, figure: go.Figure) -> str:
        """Return a chart as base64 of its compressed JSON."""
        text = figure.to_json()
        self.dark |= dark_colors(text)
        return base64.b64encode(zlib.compress(text.encode(), 9)).decode()
