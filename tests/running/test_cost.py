"""The estimate of the cost of a run."""

import pytest

from burridge_knopoff import Chain, InitialState, Model, Settings, law_of
from burridge_knopoff.running.cost import cost_of


@pytest.mark.parametrize("exponents", [0, 3])
def test_the_cost_of_blocks_that_slip_together_grows_with_their_square(exponents):
    costs = []
    for blocks in (500, 1000):
        model = Model(Chain(blocks), law_of("nonlinear", 0.3))
        begun = model.begin(InitialState("alike", -0.9, 0.1))
        costs.append(cost_of(model, begun, Settings(lyapunov_exponents=exponents)))
    assert costs[1][0] == pytest.approx(4.0 * costs[0][0])
    assert costs[1][1] == pytest.approx(2.0 * costs[0][1])


def test_blocks_that_stick_share_no_event_without_exponents():
    model = Model(Chain(1000), law_of("nonlinear", 0.3))
    begun = model.begin(InitialState("drawn", -0.5, 0.0), "tested")
    assert begun.stuck.all()
    assert cost_of(model, begun, Settings(lyapunov_exponents=0))[0] == 0.0
    assert cost_of(model, begun, Settings())[0] > 0.05
