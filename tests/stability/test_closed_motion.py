"""Returns of a motion that has settled, from which its periodic orbit is found."""

import numpy as np
import pytest

from burridge_knopoff import Chain, Model, law_of
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.orbits.symmetry import Symmetry
from burridge_knopoff.running.runner import Runner
from burridge_knopoff.stability.closed_motion import _returns


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
