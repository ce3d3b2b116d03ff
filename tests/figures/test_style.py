"""The common look: legends below the panels."""

import pytest
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from burridge_knopoff.figures.style import legend_below, styled


@pytest.mark.parametrize(("width", "rows"), [(20.0, 1), (4.0, 3), (0.5, 6)])
def test_a_legend_has_as_many_columns_as_fit(width, rows):
    @styled
    def draw() -> Figure:
        figure = Figure((width, 3.0), layout="constrained")
        figure.subplots()
        legend_below(figure, [Line2D([], [], label=f"a name of some length ({k})") for k in range(6)])
        return figure

    figure = draw()
    figure.draw_without_rendering()
    (legend,) = figure.legends
    tops = {round(text.get_window_extent().y0) for text in legend.get_texts()}
    assert len(legend.get_texts()) == 6
    assert len(tops) == rows
    assert rows == 6 or legend.get_window_extent().width <= figure.bbox.width
