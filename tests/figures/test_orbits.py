"""Synchronized orbits: a panel without any says so, and a_c of an unstable one is not drawn as an end of synchrony."""

import numpy as np
import pytest
import xarray as xr

from burridge_knopoff import Model
from burridge_knopoff.figures import mean_distance
from burridge_knopoff.figures.orbits import draw
from burridge_knopoff.study.paper import PAPER_LAWS
from burridge_knopoff.summaries.orbit_flags import CriticalStability
from burridge_knopoff.summaries.orbits import summarize


def test_that_there_are_none_is_said():
    figure = draw(summarize([Model(law, a=0.1, blocks=2) for law in PAPER_LAWS], [0.1]), xr.Dataset())
    assert [panel.texts[0].get_text() for panel in figure.axes] == ["no synchronized orbit"] * 4


def runs_at(a):
    """Return runs with ⟨J⟩ = 0 at some values of a."""
    names = ("law", "initial", "a")
    values = {name: (names, np.full((1, 1, len(a)), value)) for name, value in RUN.items()}
    return xr.Dataset(values, {"law": ["linearized"], "initial": ["plus"], "a": a})


RUN = {"mean_distance": 0.1, "mean_distance_error": 0.001, "least_friction": 0.9}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("stability", "styles", "marked"),
    [
        (CriticalStability.LOST, ["-", ":"], True),
        (CriticalStability.GAINED, [":", "-"], True),
        (CriticalStability.UNSTABLE, [":", ":"], False),
        (CriticalStability.UNDETERMINED, ["None", "None"], True),
    ],
)
def test_the_end_of_synchrony_is_drawn_where_the_orbit_attracts(stability, styles, marked):
    orbits = summarize([Model("linearized", a=0.1)], [0.02, 0.14])
    assert orbits["critical_stability"].item() == CriticalStability.LOST
    orbits["critical_stability"].values[:] = stability
    runs = runs_at([0.02, 0.14])
    figure = draw(orbits, runs)
    assert [line.get_linestyle() for line in figure.axes[1].get_lines()[:2]] == styles
    assert figure.axes[0].get_lines()[2].get_fillstyle() == ("full" if marked else "none")
    panel = mean_distance.draw(runs, orbits).axes[0]
    assert ("$a_c$" in [text.get_text() for text in panel.texts]) == marked


def test_the_transverse_multiplier_passes_1_at_the_loss_of_synchrony():
    orbits = summarize([Model("linearized", a=0.1)], [0.02, 0.14])
    figure = draw(orbits, runs_at([0.02, 0.14]))
    curve, _, dot = figure.axes[0].get_lines()[:3]
    assert (dot.get_xdata()[0], dot.get_ydata()[0]) == (orbits["critical_a"].item(), 1.0)
    assert curve.get_xdata().tolist() == [0.02, orbits["critical_a"].item(), 0.14]
    assert curve.get_ydata()[1] == 1.0
    assert [line.get_linestyle() for line in figure.axes[1].get_lines()[:2]] == ["-", ":"]
    # Of the runs none lies near, and no legend names them.
    assert [text.get_text() for text in figure.axes[1].get_legend().get_texts()] == ["stable orbit", "unstable orbit"]
