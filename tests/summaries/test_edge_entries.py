"""Which closed orbits are followed, told of made-up ones."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

from burridge_knopoff import Chain, Model, MotionKind, Symmetry, find_periodic_orbit, law_of
from burridge_knopoff.stability.family import Family
from burridge_knopoff.stability.pseudo_arclength import begin_branch
from burridge_knopoff.stability.stretch import Stretch
from burridge_knopoff.summaries import edge_entries


def test_orbits_of_other_periods_are_followed_apart(monkeypatch):
    """At one a and with the same stops: periods a ten-thousandth apart are one, a hundredth two."""
    known = Family(Model(Chain(3), law_of("linearized", 0.0))).at(0.05)
    orbit = find_periodic_orbit(known.model, known.reference, known.period, Symmetry.SYNCHRONIZED)
    periods = iter([1.0, 1.0001, 1.01, 0.99])

    def next_orbit(*_):
        return replace(orbit, return_time=next(periods) * orbit.return_time)

    def alone(one, *_):
        return Stretch(*[[begin_branch(one, True)]] * 2)

    monkeypatch.setattr(edge_entries, "closed_motion", next_orbit)
    monkeypatch.setattr(edge_entries, "stretch", alone)
    slots = {"branch": [0, 1, 2, 3], "side": [0] * 4, "kind": [MotionKind.PERIODIC] * 4}
    one = xr.Dataset({name: ("attractor", values) for name, values in slots.items()}).expand_dims("value")
    state = ("value", "attractor", "block"), np.zeros((1, 4, 3))
    one = one.assign(a=("value", [0.05]), in_grid=("value", [1]), position=state, velocity=state)
    found, of_slot = edge_entries.followed(orbit.model, one, [])
    assert of_slot == {(0, 0): 0, (0, 1): 0, (0, 2): 1, (0, 3): 2}
    assert [item.upward[0].orbit.period / orbit.period for item in found] == pytest.approx([1.0, 1.01, 0.99])
