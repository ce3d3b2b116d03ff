"""Synchronized orbits: a panel without any says so."""

import xarray as xr

from burridge_knopoff import Chain, Model, law_of
from burridge_knopoff.figures.orbits import draw
from burridge_knopoff.study.paper import PAPER_LAWS
from burridge_knopoff.summaries.orbits import summarize


def test_that_there_are_none_is_said():
    figure = draw(summarize([Model(Chain(2), law_of(law, 0.1)) for law in PAPER_LAWS], [0.1]), xr.Dataset())
    assert [panel.texts[0].get_text() for panel in figure.axes] == ["no synchronized orbit found"] * 4
