"""Pictures of one panel: in a figure of their own, over an earlier picture, or in the axes of a user."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

import matplotlib as mpl
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from burridge_knopoff.figures.style import MOST_ENTRIES, STYLE, StyledFigure, legend_below, new_figure

#: Size in inches of a figure with one panel.
SIZE = (4.6, 3.3)

# Differences of values that are rounding, as a fraction of the values, and of values near 0.
ROUNDING, TINY = 1e-6, 1e-9


def draw_panel(draw: Callable[[Axes], str], axes: Axes | None, size: tuple[float, float] = SIZE) -> Figure:
    """Draw a panel, and return the figure.

    draw : draws the panel and returns its title
    axes : of a user, whose legend is left to the user; by default those of a new figure of this size in inches
    """
    if axes is None:
        with mpl.rc_context(STYLE):
            _, (axes,) = new_figure(*size)
    figure = axes.get_figure(root=True)
    assert figure is not None
    if not isinstance(figure, StyledFigure):
        # The axes of a user keep the look of the other ones.
        axes.set_title(draw(axes), loc="left")
        return figure
    with mpl.rc_context(STYLE):
        axes.set_title(draw(axes), loc="left")
        for legend in [*figure.legends]:
            legend.remove()
        legend_below(figure, legend_entries(figure.axes))
    return figure


def widen_constant_axes(panel: Axes) -> None:
    """Extend each axis on which all values are the same up to rounding, by a tenth of them to both sides."""
    values = panel.dataLim
    for (low, high), extend, is_free in (
        (values.intervalx, panel.set_xlim, panel.get_autoscalex_on()),
        (values.intervaly, panel.set_ylim, panel.get_autoscaley_on()),
    ):
        size = max(abs(low), abs(high))
        if is_free and 0.0 <= high - low <= max(ROUNDING * size, TINY):
            half = 0.1 * size if size > TINY else 0.01
            # A later picture over this one scales the axis anew.
            extend(0.5 * (low + high) - half, 0.5 * (low + high) + half, auto=True)


def legend_entries(panels: Iterable[Axes]) -> list[Artist]:
    """Return the legend entries of panels, each label once, shortened if there are too many."""
    entries: dict[str, Artist] = {}
    for panel in panels:
        for handle, label in zip(*panel.get_legend_handles_labels(), strict=True):
            entries.setdefault(label, handle)
    return shortened([*entries.values()])


def shortened(handles: Sequence[Artist], most: int = MOST_ENTRIES) -> list[Artist]:
    """Return the entries of a legend; if there are more than `most`, the first ones and a count of the others."""
    if len(handles) <= most:
        return [*handles]
    return [*handles[: most - 1], Line2D([], [], linestyle="", label=f"and {len(handles) - most + 1} more")]
