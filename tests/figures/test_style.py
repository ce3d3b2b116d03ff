"""The common look: legends below the panels, of what these show."""

from collections import Counter

import numpy as np
import pytest
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from burridge_knopoff.figures.strips import STRIP, cells, strip_columns, strips, strips_meet
from burridge_knopoff.figures.style import (
    ACROSS,
    COLUMN,
    begin_at_zero,
    label_panels,
    legend_below,
    legend_entries,
    panel_table,
    scale_to_decades,
    styled,
)


@pytest.mark.parametrize(("width", "rows"), [(20.0, 1), (8.0, 2), (4.0, 3), (0.5, 6)])
def test_a_legend_has_as_few_rows_as_fit_all_of_one_length(width, rows):
    @styled
    def draw() -> Figure:
        figure = Figure((width, 3.0), layout="constrained")
        figure.subplots()
        legend_below(figure, [Line2D([], [], label=f"a name of some length ({k})") for k in range(6)])
        return figure

    figure = draw()
    figure.draw_without_rendering()
    (legend,) = figure.legends
    tops = Counter(round(text.get_window_extent().y0) for text in legend.get_texts())
    assert len(legend.get_texts()) == 6
    in_rows = sorted(
        legend.get_texts(), key=lambda text: (-round(text.get_window_extent().y0), text.get_window_extent().x0)
    )
    assert [text.get_text()[-2] for text in in_rows] == list("012345")
    assert list(tops.values()) == [6 // rows] * rows
    assert rows == 6 or legend.get_window_extent().width <= figure.bbox.width


def test_each_group_of_a_legend_begins_a_row():
    @styled
    def draw() -> Figure:
        figure = Figure((6.0, 3.0), layout="constrained")
        figure.subplots()
        legend_below(figure, *([Line2D([], [], label=f"{name} {k}") for k in range(3)] for name in ("one", "two")))
        return figure

    figure = draw()
    figure.draw_without_rendering()
    (legend,) = figure.legends
    rows = {text.get_text(): round(text.get_window_extent().y0) for text in legend.get_texts()}
    assert rows["one 0"] == rows["one 2"] > rows["two 0"] == rows["two 2"]


def test_a_legend_names_what_some_panel_shows_a_point_of_once():
    panels = Figure().subplots(1, 2)
    for panel, low in zip(panels, (0.0, 2.0), strict=True):
        panel.plot([0.0, 1.0], [1.0, 3.0], label="both")
        panel.plot([0.0, 1.0], [2.5, 4.0], label="second")
        panel.errorbar([0.0, 1.0], [0.5, 0.5], 1.0, fmt="o", label="bars")
        panel.plot([0.0, 1.0], [float("nan"), 9.0], label="none")
        panel.plot([], [], label="empty")
        panel.set_ylim(low, low + 1.1)
    handles, labels = legend_entries(panels)
    assert labels == ["both", "bars", "second"]
    assert [handle.get_label() for handle in handles] == labels


def test_a_scale_begins_at_zero_and_hides_no_point_of_its_row():
    panels = Figure().subplots(1, 2, sharey=True)
    panels[0].plot([0.0, 1.0], [0.49, 0.53])
    panels[1].plot([0.0, 1.0], [0.1, 0.8])
    begin_at_zero(panels[0])
    low, high = panels[1].get_ylim()
    assert -0.05 < low < 0.0
    assert 0.8 < high < 0.9


def test_rounding_sets_no_scale():
    panel = Figure().subplots()
    panel.plot([0.0, 1.0], [0.0, 1e-14])
    begin_at_zero(panel)
    assert panel.get_ylim()[1] > 0.01


@pytest.mark.parametrize(
    ("drawn", "ends"),
    [([12.0, 24.0], (1.0, 2.0)), ([0.0, 1e-15, 10.0], (-15.0, 1.0)), ([1.0, 1.0], (0.0, 1.0)), ([np.nan], None)],
)
def test_a_logarithmic_scale_reaches_from_a_power_of_ten_to_another(drawn, ends):
    left, right = Figure().subplots(1, 2, sharey=True)
    left.set_yscale("log")
    right.plot(drawn)
    before = left.get_ylim()
    scale_to_decades(left)
    limits = np.log10(left.get_ylim())
    assert limits == pytest.approx(np.log10(before) if ends is None else (ends[0] - 0.155, ends[1] + 0.146), abs=1e-3)


def test_cells_meet_halfway_and_extend_as_far_to_the_outside_as_to_the_inside():
    assert cells(np.array([0.0, 0.1, 0.3])) == pytest.approx([-0.05, 0.05, 0.2, 0.4])


def test_strips_of_close_values_meet_and_those_of_a_coarse_grid_do_not():
    close, coarse = np.linspace(0.0, 0.3, 121), np.array([0.02, 0.08, 0.14])
    assert strips_meet(close)
    left, right = strips(close)
    assert [left[0], *right] == pytest.approx(cells(close))
    assert not strips_meet(coarse)
    left, right = strips(coarse)
    assert (left + right) / 2 == pytest.approx(coarse)
    assert right - left == pytest.approx([STRIP * 0.18] * 3)
    edges, index = strip_columns(coarse)
    assert index.tolist() == [0, -1, 1, -1, 2]
    assert edges == pytest.approx(np.column_stack([left, right]).ravel())


def test_only_several_panels_have_letters():
    panels = Figure().subplots(1, 2)
    label_panels(panels, ["one", "two"])
    assert [panel.get_title(loc="left") for panel in panels] == ["(a) one", "(b) two"]
    label_panels(panels[:1], ["one"])
    assert panels[0].get_title(loc="left") == "one"


def test_a_title_is_not_broken_between_a_name_and_its_number():
    panel = Figure((2.0, 2.0)).subplots()
    label_panels([panel], ["formula law, $v=1.4$, pulling damping 0.1, a title in words"], letters=16)
    assert panel.get_title(loc="left").split("\n") == [
        "formula law, $v=1.4$,",
        "pulling damping 0.1, a title in",
        "words",
    ]


@pytest.mark.usefixtures("no_collection")
@pytest.mark.parametrize("rows", [1, 2])
@pytest.mark.parametrize(
    "columns", [1, ACROSS, *(pytest.param(n, marks=pytest.mark.slow) for n in range(1, 13) if n not in (1, ACROSS))]
)
def test_a_table_of_any_number_of_panels_is_drawn_with_its_labels_aligned(columns, rows):
    @styled
    def draw() -> Figure:
        figure, table = panel_table(1.0, columns, "x", ["one", "two"][:rows])
        for number, panel in enumerate(table.flat):
            panel.plot([0.0, 1.0], [0.0, 10.0**number])
        return figure

    figure = draw()
    figure.draw_without_rendering()
    assert len(figure.axes) == rows * columns
    left = [panel.yaxis.label.get_window_extent().x1 for panel in figure.axes if panel.get_ylabel()]
    assert len(left) == rows * (columns if rows * columns <= 2 else -(-columns // ACROSS))
    assert left == pytest.approx([left[0]] * len(left), abs=0.5)


def test_two_panels_stand_one_above_the_other_in_the_width_of_a_journal_column():
    for columns, rows in ((2, 1), (1, 2)):
        figure, table = panel_table(1.0, columns, "x", ["one", "two"][:rows])
        upper, lower = table.flat
        assert figure.get_figwidth() == COLUMN
        assert upper.get_position().y0 > lower.get_position().y1
        assert upper.get_position().x0 == lower.get_position().x0
        assert (upper.get_xlabel(), lower.get_xlabel()) == ("", "x")


def test_a_row_of_many_panels_goes_on_in_the_next_line():
    figure, table = panel_table(1.0, 4, "x", ["one", "two"])
    assert [len(row) for row in table] == [4, 4]
    assert len(figure.axes) == 8
    assert [panel.get_xlabel() for panel in table[1]] == ["", "x", "x", "x"]
    assert [panel.get_ylabel() for panel in table[1]] == ["two", "", "", "two"]
    table[0, 0].set_ylim(3.0, 4.0)
    assert [panel.get_ylim()[0] for panel in table.flat] == [3.0] * 4 + [0.0] * 4
