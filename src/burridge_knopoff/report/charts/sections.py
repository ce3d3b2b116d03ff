"""Bifurcation diagrams: how many section points W' of a run fall into each bin. A run has thousands of them."""

from __future__ import annotations

import numpy as np
import plotly.graph_objects as go
import xarray

from burridge_knopoff.report.charts.look import a_axis, axis, chart, strip_map
from burridge_knopoff.report.charts.theme import INK
from burridge_knopoff.study.formatting import text
from burridge_knopoff.summaries.bifurcation_diagram import ROUNDING

#: So few that each takes a line of pixels.
BINS = 240

#: The shares of the crossings of a run that the shades span: 1 in 10^DECADES is pale, all in one bin is full.
DECADES = 4


def section_counts(bifurcation: xarray.Dataset) -> tuple[np.ndarray, np.ndarray]:
    """Return the edges of BINS equal bins of W', and how many crossings of each run fall into each of them.

    The counts have the shape (law, initial, bin, a); upward ones count positive, downward ones negative. Upward
    crossings have W' ≥ 0 and downward ones W' ≤ 0, and W' = 0 is an edge: a bin holds one kind only.
    Crossings that are rounding are not counted.
    """
    velocity, counts = bifurcation["crossing_velocity"].values, bifurcation["crossing_count"].values
    # Sums of the stored type, one byte, would overflow.
    directions = np.where(np.abs(velocity) > ROUNDING, bifurcation["crossing_direction"].values.astype(float), 0.0)
    edges = np.linspace(*_range(velocity), BINS + 1)
    laws, states = (set(bifurcation[name].values.tolist()) for name in ("law", "initial"))
    columns = np.zeros((len(counts), BINS), dtype="i4")
    stops = np.cumsum(counts)
    for n, (stop, count) in enumerate(zip(stops, counts, strict=True)):
        segment = slice(stop - count, stop)
        columns[n] = np.histogram(velocity[segment], edges, weights=directions[segment])[0]
    # Points come in the order law, initial, a.
    return edges, np.swapaxes(columns.reshape(len(laws), len(states), -1, BINS), 2, 3)


def _range(velocity: np.ndarray) -> tuple[float, float]:
    """Return the range of the bins, widened so that W' = 0 is an edge if it lies inside."""
    low, high = float(velocity.min(initial=0.0)), float(velocity.max(initial=0.0))
    span = (high - low) or 1.0
    # At least one bin on each side on which there is anything.
    below = min(max(round(BINS * -low / span), int(low < 0.0)), BINS - int(high > 0.0))
    # A little wider, so that rounding leaves no value outside.
    width = 1.00001 * max(-low / max(below, 1), high / max(BINS - below, 1), 1e-300)
    return -below * width, (BINS - below) * width


def sections(a: np.ndarray, edges: np.ndarray, counts: np.ndarray) -> go.Figure:
    """Return the bifurcation diagram of the runs of one law and initial state; counts of shape (bin, a)."""
    number = np.abs(counts)
    totals = number.sum(axis=0)
    with np.errstate(divide="ignore", invalid="ignore"):
        shade = np.clip(DECADES + np.log10(number / totals), 1e-3, None)
    words = np.full(counts.shape, "", dtype=object)
    for n, k in zip(*np.nonzero(counts), strict=True):
        side = "upward" if counts[n, k] > 0 else "downward"
        words[n, k] = f"a = {text(a[k])}<br>{number[n, k]} of {totals[k]} crossings, {side}"
    ink = INK["text"]
    trace = strip_map(
        a,
        np.where(counts, shade, np.nan),
        words,
        y=0.5 * (edges[1:] + edges[:-1]),
        zmin=0.0,
        zmax=DECADES,
        colorscale=[[0, f"{ink}59"], [0.5, ink], [1, ink]],
        showscale=False,
        hovertemplate="W′ = %{y:.4f}<br>%{text}<extra></extra>",
    )
    margin = 8 * (edges[1] - edges[0])
    yaxis = axis("<i>W</i>′ at <i>W</i> = 0", range=[edges[0] - margin, edges[-1] + margin])
    return chart([trace], xaxis=a_axis(a), yaxis=yaxis)
