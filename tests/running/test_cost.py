"""The estimate of what a run costs."""

import time

import numpy as np
import pytest

from burridge_knopoff import Chain, InitialState, Model, Settings, law_of
from burridge_knopoff.running.cost import cost_of
from burridge_knopoff.running.simulation import run


@pytest.mark.parametrize(("blocks", "exponents"), [(1500, 0), (700, 3)])
def test_it_is_what_a_run_takes_within_a_factor_of_ten(blocks, exponents):
    model = Model(Chain(blocks), law_of("nonlinear", 0.3))
    state = InitialState("drawn", tuple(np.random.default_rng(3).uniform(-1.0, -0.9, blocks)), 0.1)
    settings = Settings(
        transient=0.0, window=4.0, batches=2, events="none", trajectory=1.0, lyapunov_exponents=exponents
    )
    expected, _ = cost_of(model, model.begin(state), settings)
    begin = time.process_time()
    run(model, state, settings)
    taken = (time.process_time() - begin) / settings.duration
    assert expected / 10 < taken < 10 * expected


def test_blocks_that_stick_share_no_event_without_exponents():
    model = Model(Chain(1000), law_of("nonlinear", 0.3))
    begun = model.begin(InitialState("drawn", -0.5, 0.0), "tested")
    assert begun.stuck.all()
    assert cost_of(model, begun, Settings(lyapunov_exponents=0))[0] == 0.0
    assert cost_of(model, begun, Settings())[0] > 0.05
