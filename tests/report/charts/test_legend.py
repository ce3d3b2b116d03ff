"""Legends: every mark of the charts can be drawn beside its name."""

import pytest

from burridge_knopoff.report.charts.branches import _SHAPES, run_legend
from burridge_knopoff.report.charts.legend import Entry

NAMES = [f"name {number}" for number in range(10)]


@pytest.mark.parametrize("entry", [*run_legend(NAMES, True), *(Entry("branch", "#0072B2", shape) for shape in _SHAPES)])
def test_every_mark_is_drawn_in_the_colours_of_both_themes(entry):
    assert entry.mark.startswith("<svg ")
    assert "light-dark(" in entry.mark
