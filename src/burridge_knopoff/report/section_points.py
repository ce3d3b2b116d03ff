"""Section points W' as counts on a grid: a run has thousands of them, and a page must not hold a million."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray

from burridge_knopoff.report.numbers import rounded
from burridge_knopoff.summaries.bifurcation_diagram import ROUNDING

BINS = 300


def section_counts(bifurcation: xarray.Dataset) -> dict[str, Any]:
    """Return how many crossings of each run fall into each bin of W'; upward ones count positive, downward negative.

    `edges` are the first and the last edge of BINS equal bins. For every (law, initial): `index` are the differences
    of the flat indices a·BINS + bin of the bins that are not empty, `count` their signed numbers. Upward crossings have
    W' ≥ 0 and downward ones W' ≤ 0, so that a bin holds one kind only, but for the one with W' = 0: that one is edge.
    Crossings that are rounding are not counted.
    """
    velocity, counts = bifurcation["crossing_velocity"].values, bifurcation["crossing_count"].values
    # Sums of the stored type, one byte, would overflow.
    directions = np.where(np.abs(velocity) > ROUNDING, bifurcation["crossing_direction"].values.astype(float), 0.0)
    low, high = _edges(velocity)
    edges = np.linspace(low, high, BINS + 1)
    laws, states = (bifurcation[name].attrs["flag_meanings"].split() for name in ("law", "initial"))
    # Points come in the order law, initial, a.
    a_size = len(counts) // (len(laws) * len(states))
    stops = np.cumsum(counts)
    columns = np.zeros((len(counts), BINS), dtype=int)
    for n, (stop, count) in enumerate(zip(stops, counts, strict=True)):
        own = slice(stop - count, stop)
        columns[n] = np.histogram(velocity[own], edges, weights=directions[own])[0]
    runs = columns.reshape(len(laws), len(states), a_size * BINS)
    return {"bifurcations": rounded([low, high]), "bins": BINS, "runs": [[_sparse(run) for run in law] for law in runs]}


def _edges(velocity: np.ndarray) -> tuple[float, float]:
    """Return the range of the bins, widened so that W' = 0 is an edge if it lies inside."""
    low, high = float(velocity.min(initial=0.0)), float(velocity.max(initial=0.0))
    span = (high - low) or 1.0
    # At least one bin on each side on which there is anything.
    below = min(max(round(BINS * -low / span), int(low < 0.0)), BINS - int(high > 0.0))
    # A little wider, so that rounding leaves no value outside.
    width = 1.00001 * max(-low / max(below, 1), high / max(BINS - below, 1), 1e-300)
    return -below * width, (BINS - below) * width


def _sparse(counts: np.ndarray) -> dict[str, list[int]]:
    filled = np.flatnonzero(counts)
    return {"index": np.diff(filled, prepend=0).tolist(), "count": counts[filled].tolist()}
