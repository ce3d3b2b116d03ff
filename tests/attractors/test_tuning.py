"""The numbers of the search for attractors: its diagram names what there is, and another Tuning is obeyed."""

import re
from dataclasses import fields
from pathlib import Path

from burridge_knopoff import Chain, Model, SearchSettings, law_of
from burridge_knopoff.attractors import attractor, labels
from burridge_knopoff.attractors import capture_radius as radius
from burridge_knopoff.attractors import convergence as settling
from burridge_knopoff.attractors import search as attractors
from burridge_knopoff.attractors.search import find_attractors
from burridge_knopoff.continuation import along_a as continuation
from burridge_knopoff.motion import observables as steady
from burridge_knopoff.motion.tuning import Tuning

PAGE = Path(__file__).parents[2] / "docs" / "attractors.md"


def test_the_diagram_names_functions_and_settings():
    diagram = re.search(r"```mermaid\n(.*?)```", PAGE.read_text(), re.DOTALL)[1]
    known = {item.name for kind in (SearchSettings, Tuning) for item in fields(kind)}
    numbers = re.findall(r"<i>(\w+)</i>", diagram)
    assert len(numbers) > 15
    assert set(numbers) <= known
    places = [attractors.Search, settling.Settling, attractor, attractors, continuation, labels, radius, steady]
    names = {name for place in places for name in vars(place)}
    shown = {name for name in re.findall(r"\w+", diagram) if "_" in name} | {"label", "visit", "measure", "captured"}
    assert shown - known <= names


def test_another_tuning():
    model = Model(Chain(3), law_of("linearized", 0.08))
    settings = SearchSettings(samples=5, transient=500.0, window=500.0, time_limit=1000.0)
    found, reached = find_attractors(model, settings, tuning=Tuning(in_vain=0))
    assert (found, reached.tolist()) == ([], [-1] * 5)
    found, _ = find_attractors(model, settings, tuning=Tuning(close_returns=20, largest_radius=0.001))
    assert found
    assert all(item.close_returns >= 20 and item.radius <= 0.001 for item in found)
