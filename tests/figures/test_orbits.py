"""Synchronized orbits: a panel without any says so."""

import numpy as np
import pytest
import xarray as xr

from burridge_knopoff import Chain, Model, law_of
from burridge_knopoff.figures.orbits import _attracts, draw
from burridge_knopoff.study.paper import PAPER_LAWS
from burridge_knopoff.summaries.orbits import summarize


def test_that_there_are_none_is_said():
    figure = draw(summarize([Model(Chain(2), law_of(law, 0.1)) for law in PAPER_LAWS], [0.1]), xr.Dataset())
    assert [panel.texts[0].get_text() for panel in figure.axes] == ["no synchronized orbit"] * 4


@pytest.mark.parametrize(
    ("multiplier", "below", "above"),
    [
        ([0.9, 1.1], True, False),
        ([1.1, 0.9], False, True),
        ([-0.9, -1.1], True, False),
        ([np.nan, np.nan], True, False),
    ],
)
def test_synchrony_may_be_lost_or_gained_as_a_grows(multiplier, below, above):
    dataset = xr.Dataset(
        {"transverse_multiplier": ("a", [5.0, *multiplier, 5.0]), "critical_a": 0.03}, {"a": [0.01, 0.02, 0.04, 0.05]}
    )
    dataset = dataset if np.isfinite(multiplier[0]) else dataset.isel(a=slice(1, 3))
    assert (_attracts(dataset, below=True), _attracts(dataset, below=False)) == (below, above)


def test_the_transverse_multiplier_passes_1_at_the_loss_of_synchrony():
    orbits = summarize([Model(Chain(3), law_of("linearized", 0.1))], [0.02, 0.14])
    names = ("law", "initial", "a")
    runs = xr.Dataset(
        {"mean_distance": (names, np.zeros((1, 1, 2)))},
        {"law": ["linearized"], "initial": ["plus"], "a": [0.02, 0.14]},
    )
    figure = draw(orbits, runs)
    curve, _, dot = figure.axes[0].get_lines()[:3]
    assert (dot.get_xdata()[0], dot.get_ydata()[0]) == (orbits["critical_a"].item(), 1.0)
    assert curve.get_xdata().tolist() == [0.02, orbits["critical_a"].item(), 0.14]
    assert curve.get_ydata()[1] == 1.0
    assert [line.get_linestyle() for line in figure.axes[1].get_lines()[:2]] == ["-", ":"]
    # Of the runs none lies near, and no legend names them.
    assert [text.get_text() for text in figure.axes[1].get_legend().get_texts()] == ["stable orbit", "unstable orbit"]
