"""Lyapunov exponents against a, and the kind of motion above them."""

from __future__ import annotations

import numpy as np
import plotly.graph_objects as go
import xarray

from burridge_knopoff.figures.palette import KINDS
from burridge_knopoff.motion.kind import MotionKind
from burridge_knopoff.report.charts.legend import Entry
from burridge_knopoff.report.charts.look import a_axis, axis, bars, chart, scatter, steps, strip_map
from burridge_knopoff.report.charts.theme import GREYS, INK, fixed
from burridge_knopoff.report.numbers import format_measured
from burridge_knopoff.study.formatting import text

_NAMES = ("λ₁", "λ₂")


def kind_legend(kinds: np.ndarray, exponents: int) -> list[Entry]:
    """Return the entries of the largest exponents, and of the kinds of motion that there are."""
    curves = [Entry(name, grey, "circle") for name, grey in zip(_NAMES[:exponents], GREYS, strict=False)]
    return curves + [
        Entry(MotionKind(kind).words, fixed(KINDS[kind]), edge=INK["muted"]) for kind in np.unique(kinds).tolist()
    ]


def exponents(run: xarray.Dataset, kinds: np.ndarray, frame: tuple[float, float]) -> go.Figure:
    """Return the two largest exponents of one law and initial state with three times their error, and the kinds.

    frame : ends of the axis of the exponents
    """
    a, order = run["a"].values, list(KINDS)
    traces: list[go.Scatter | go.Heatmap] = []
    for name, grey, value, error in zip(
        _NAMES, GREYS, run["lyapunov_exponent"].values.T, run["lyapunov_error"].values.T, strict=False
    ):
        traces.append(
            scatter(
                a,
                np.where(np.isfinite(value), value, np.nan),
                grey,
                f"a = %{{x}}<br>{name} = %{{text}}",
                mode="markers",
                text=[format_measured(*pair) for pair in zip(value.tolist(), error.tolist(), strict=True)],
                error_y=bars(3.0 * error, grey),
                marker_size=4,
            )
        )
    words = [f"a = {text(value)}: {MotionKind(kind).words}" for value, kind in zip(a, kinds, strict=True)]
    strip = strip_map(
        a,
        np.array([[order.index(kind) for kind in kinds]]),
        np.array([words]),
        y=[0, 1],
        yaxis="y2",
        hovertemplate="%{text}<extra></extra>",
        **steps([fixed(color) for color in KINDS.values()]),
    )
    low, high = frame
    margin = 0.02 * (high - low)
    zero = {"type": "line", "xref": "paper", "x0": 0, "x1": 1, "y0": 0, "y1": 0, "layer": "below"}
    return chart(
        [*traces, strip],
        xaxis=a_axis(a),
        yaxis=axis("Lyapunov exponents", range=[low, high + margin], domain=[0, 0.92]),
        yaxis2={"domain": [0.945, 1], "visible": False, "fixedrange": True},
        shapes=[{**zero, "line": {"color": INK["muted"], "width": 1}}],
    )
