"""Cells and strips of an axis: the parts of it that stand for single values of a parameter."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Patch

# Colour of shaded strips.
SHADE = "0.9"

# Largest width of a strip that stands for one value, as a fraction of the range of all values.
STRIP = 0.025


def cells(values: np.ndarray) -> np.ndarray:
    """Return the edges of the cells of ascending values, shape (n + 1,): a cell is what lies nearest to its value.

    The first and last cell extend as far to the outside as to the inside.
    """
    if len(values) == 1:
        half = 0.1 * abs(values[0]) or 0.5
        return np.array([values[0] - half, values[0] + half])
    middle = 0.5 * (values[1:] + values[:-1])
    return np.concatenate([2.0 * values[:1] - middle[:1], middle, 2.0 * values[-1:] - middle[-1:]])


def map_cells(values: np.ndarray) -> np.ndarray:
    """Return the edges of the cells of ascending values in a map, which ends at the first and the last of them."""
    return np.clip(cells(values), values[0], values[-1])


def strips(values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the left and right ends of strips that stand for ascending values.

    A strip is the cell of its value, except that it is no wider than STRIP of the range of all cells: strips of closely
    spaced values meet, and those of a coarse grid leave a gap, since nothing is known in between.
    """
    edges = cells(values)
    half = 0.5 * STRIP * (edges[-1] - edges[0])
    return np.maximum(edges[:-1], values - half), np.minimum(edges[1:], values + half)


def strips_meet(values: np.ndarray) -> bool:
    """Return whether ascending values are so close that their strips meet."""
    left, right = strips(values)
    return bool((left[1:] <= right[:-1]).all())


def strip_range(values: np.ndarray) -> tuple[float, float]:
    """Return the ends of an axis that shows the strips of all ascending values, with a margin."""
    first, last = cells(values)[[0, -1]] if len(values) == 1 else (strips(values)[0][0], strips(values)[1][-1])
    margin = 0.015 * (last - first)
    return float(first - margin), float(last + margin)


def show_all(panel: Axes, values: np.ndarray) -> None:
    """Extend the horizontal axis of a panel over the strips of all values, and a little more."""
    panel.set_xlim(*strip_range(values))
    if len(values) == 1:
        # Other numbers would tell of a range.
        panel.set_xticks(values)


def strip_columns(values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the edges of columns that are the strips of ascending values and the gaps between them.

    The second array has the index of the value of each column, −1 for a gap.
    """
    left, right = strips(values)
    inner, index = np.column_stack([left, right]).ravel(), np.full(2 * len(values) - 1, -1)
    index[::2] = np.arange(len(values))
    mask = np.append(np.diff(inner) > 0.0, True)
    return inner[mask], index[mask[:-1]]


def draw_strips(panel: Axes, values: np.ndarray, colors: np.ndarray, bottom: float = 0.0) -> None:
    """Draw a strip for each value, in rows of height 1 from `bottom` on; colors : shape (row, value, 3)."""
    edges, index = strip_columns(values)
    picture = np.where((index < 0)[:, None], 1.0, colors[:, index])
    panel.pcolormesh(edges, bottom + np.arange(len(colors) + 1), picture, rasterized=True)


def shade(panel: Axes, values: np.ndarray, where: np.ndarray) -> None:
    """Shade the strips of the ascending values at which `where` is true; the panel shows all strips."""
    left, right = strips(values)
    show_all(panel, values)
    for k in np.flatnonzero(where):
        panel.axvspan(left[k], right[k], color=SHADE, linewidth=0, zorder=0)


def shade_entry(words: str) -> Patch:
    """Return the legend entry for `shade`."""
    return Patch(facecolor=SHADE, edgecolor="0.6", label=words)
