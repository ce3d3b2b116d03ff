"""Reduction of orbits to forms of more symmetry or of a shorter period."""

from types import SimpleNamespace

import numpy as np
import pytest

from burridge_knopoff import Chain, ChainState, Model, Symmetry, law_of
from burridge_knopoff.periodic_orbits import minimal_orbit
from burridge_knopoff.periodic_orbits.minimal_orbit import minimal_form

STILL = np.zeros(2, dtype=bool)
#: This chain is not its own mirror image.
UNEQUAL = Chain(2, threshold=(1.0, 1.1))


@pytest.mark.parametrize(
    ("away", "scale", "time", "stops", "is_repeat"),
    [
        (0.9e-4, 1.0, 1.0, (1, 2), True),
        (1.1e-4, 1.0, 1.0, (1, 2), False),
        # Distances grow with v.
        (9e-4, 10.0, 1.0, (1, 2), True),
        (0.9e-4, 0.1, 1.0, (1, 2), False),
        # Newton's method has converged to another orbit.
        (0.0, 1.0, 1.04, (1, 2), True),
        (0.0, 1.0, 1.06, (1, 2), False),
        (0.0, 1.0, 0.94, (1, 2), False),
        (0.0, 1.0, 1.0, (2, 1), False),
        (0.0, 1.0, 1.0, (2, 4), False),
    ],
)
def test_a_repetition_of_a_simpler_orbit_is_recognized_by_place_stops_and_period(
    monkeypatch, away, scale, time, stops, is_repeat
):
    model = Model(UNEQUAL, law_of("linearized", 0.05), 0.1 * scale)
    reference, end = (ChainState(np.array([0.3, x]), np.full(2, 0.1), STILL) for x in (0.2, 0.2 + away))

    def an_orbit(time, stops):
        return SimpleNamespace(
            model=model,
            reference=reference,
            symmetry=Symmetry.ASYMMETRIC,
            period=time,
            return_time=time,
            stop_counts=stops,
        )

    orbit, single = an_orbit(2.0, (2, 4)), an_orbit(time, stops)
    monkeypatch.setattr(minimal_orbit, "ReturnMap", lambda *_: SimpleNamespace(end=lambda start, after: end))
    monkeypatch.setattr(minimal_orbit, "find_periodic_orbit", lambda *_: single)
    assert minimal_form(orbit, 1e-4) is (single if is_repeat else orbit)
