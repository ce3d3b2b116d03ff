"""Friction against speed: the curves are the laws', and the legend has their formulas."""

import numpy as np
import pytest
import xarray as xr

from burridge_knopoff.figures.friction_laws import draw
from burridge_knopoff.laws import law_of
from burridge_knopoff.running.status import Status
from burridge_knopoff.study.paper import PAPER_LAWS


def runs(laws, least):
    """Runs from one state, whose least friction is that of each law and a."""
    friction = xr.DataArray(least, {"law": list(laws), "initial": ["plus"], "a": [0.0, 0.3]}, ("law", "initial", "a"))
    return friction.to_dataset(name="least_friction").assign(status=xr.zeros_like(friction, dtype="i1"))


def test_friction_laws_are_the_models():
    least = np.array([[[1.0, 0.7]], [[1.0, np.nan]]])
    laws, seen = draw(runs(PAPER_LAWS, least), {law: {} for law in PAPER_LAWS}, 0.3).axes
    for number, law in enumerate(PAPER_LAWS):
        drawn = seen.get_lines()[number].get_ydata()
        assert np.array_equal(drawn, least[number, 0], equal_nan=True)
        speed, friction = laws.get_lines()[number].get_data()
        assert np.allclose(friction, {"linearized": 1.0 - 0.3 * speed, "nonlinear": 1.0 / (1.0 + 0.3 * speed)}[law])
    # As fast as runs are that feel 0.7 under the linearized law, and a little faster.
    assert speed[-1] == pytest.approx(1.1, rel=0.01)


def test_a_run_that_did_not_complete_sets_no_scale():
    dataset = runs(PAPER_LAWS, np.array([[[1.0, -3e9]], [[1.0, 0.8]]]))
    dataset["status"][0, 0, 1] = Status.DIVERGED
    laws, seen = draw(dataset, {law: {} for law in PAPER_LAWS}, 0.3).axes
    assert seen.get_ylim()[0] > 0.7
    assert laws.get_xlim()[1] < 2.0


def test_a_law_without_a_is_not_labelled_by_it():
    for formula, labels in (("1 - c*tanh(u)", 0), ("1 - c*tanh(a*u)", 2)):
        laws = {"own": {"formula": formula, "c": 0.1}}
        (upper, _) = draw(runs(laws, np.array([[[1.0, 0.95]]])), laws, 0.0).axes
        assert sum("a=" in text.get_text() for text in upper.texts) == labels


def test_the_legend_of_the_laws_has_their_formulas_and_numbers():
    laws = {
        "linearized": {},
        "drop": {"law": "carlson_langer", "sigma": 0.02},
        "own": {"formula": "1 - c*tanh(a*u/c)" + " + 0*u" * 60, "c": 0.1},
    }
    figure = draw(runs(laws, np.ones((3, 1, 2))), laws, 0.2)
    entries = [text.get_text() for text in figure.legends[0].get_texts()]
    assert entries[:2] == [
        "linearized: Φ = 1 − $aU$′",
        "drop: Φ = (1 − $σ$)/(1 + $aU$′/(1 − $σ$)), $σ$ = 0.02",
    ]
    assert entries[2].startswith("own: Φ = 1 - $c$*tanh($a$*$u$/$c$)")
    assert entries[2].count("\n") == 2
    assert entries[-1] == "stuck block"
    assert law_of({"own": {"formula": "1 - c*u", "c": 0.1}}).words.count("c = 0.1") == 1
