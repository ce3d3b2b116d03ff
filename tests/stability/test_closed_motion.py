"""Returns of a motion that has settled, from which its periodic orbit is found."""

import numpy as np
import pytest

from burridge_knopoff import Chain, Model, law_of
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.model.model import Instant
from burridge_knopoff.orbits.family import synchronized_orbit
from burridge_knopoff.orbits.symmetry import Symmetry
from burridge_knopoff.running.runner import Runner
from burridge_knopoff.stability.closed_motion import _returns, closed_motion


@pytest.mark.parametrize(
    ("initial", "a", "symmetry"), [("minus", 0.08, Symmetry.SYNCHRONIZED), ("plus", 0.08, Symmetry.SYMMETRIC)]
)
def test_a_state_returns_after_the_time_that_is_told(initial, a, symmetry):
    model = Model(Chain(3), law_of("linearized", a))
    runner = Runner(model, keep_events=True, events_from=5000.0)
    runner.begin(model.begin(PAPER_STATES[initial]))
    runner.run(5500.0)
    found = list(_returns(model, runner.log.events.times(), runner.log.events.values()))
    assert {told for _, _, told, _ in found} == {symmetry}
    for start, time, _, size in found:
        assert time > 1.0
        end = Runner(model).after(start, time)
        image = end.mirrored() if symmetry == Symmetry.SYMMETRIC else end
        assert np.abs(image.vector() - start.vector()).max() <= 2.0 * size


@pytest.mark.parametrize("apart", [0.0, 1e-11, 1e-10, 1e-9, 3e-9, 1e-8])
def test_synchrony_that_is_not_exact_closes_all_the_same(apart):
    """The end blocks stop almost together, which is no return of one to the other."""
    model = Model(Chain(3), law_of("linearized", 0.0865))
    orbit = synchronized_orbit(model)
    start = orbit.reference
    position = start.position + np.array([0.5, 0.0, -0.5]) * apart
    found = closed_motion(model, Instant(position, start.velocity, start.stuck))
    assert found.period == pytest.approx(orbit.period, abs=1e-9)
    assert found.symmetry == Symmetry.SYNCHRONIZED


def test_an_orbit_of_a_long_period_is_found():
    model = Model(Chain(3), law_of("linearized", 0.0575))
    found = closed_motion(model, model.begin(PAPER_STATES["plus"]), settling=100_000.0)
    assert found.period == pytest.approx(2447.61, abs=0.01)
