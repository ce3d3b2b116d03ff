"""The closed form between events, solver `map`, against the series of the linearized law."""

import numpy as np
import pytest

from burridge_knopoff import Chain, InitialState, Model, simulate
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.model.model import CONTACTS
from burridge_knopoff.running.runner import Runner
from tests.flows import carry, check_events, directions, wave
from tests.refused import refused

SOLVERS = ("map", "series")
SCALED = [{"coupling": 2.5}, {"pulling": 0.7}, {"threshold": 1.6}, {"coupling": 0.4, "pulling": 1.3}]


@pytest.mark.parametrize(
    ("options", "blocks", "tolerance"),
    [*((options, blocks, 1e-10) for options in SCALED for blocks in (2, 3, 5)), *(({}, n, 1e-11) for n in (2, 5, 12))],
)
def test_events_of_uniform_chains(options, blocks, tolerance):
    model = Model("linearized", a=0.2, blocks=blocks, **options)
    assert model.has_closed_form
    start = model.begin(wave(blocks, 0.25))
    first, second = (carry(model, start, 30.0, solver=solver)[1] for solver in SOLVERS)
    assert len(first) > 8
    check_events(first, second, tolerance)


@pytest.mark.slow
@pytest.mark.parametrize("initial", ["minus", "plus"])
def test_mean_distance_outside_chaos(initial):
    """To 1e-11 on every grid value of a at which the run is not chaotic.

    Chaos is identified independently of the agreement: shifting the initial state by 1e-12 changes the mean distance.
    """
    state = PAPER_STATES[initial]
    shifted = InitialState("shifted", (state.position[0] + 1e-12, *state.position[1:]), state.velocity)
    compared = 0
    for a in np.arange(0.0, 0.3001, 0.02):
        first, second = (
            simulate(Model("linearized", a=a), initial, solver=solver, events="none") for solver in SOLVERS
        )
        if abs(simulate(Model("linearized", a=a), shifted, events="none").mean_distance - first.mean_distance) > 1e-9:
            continue
        compared += 1
        assert first.mean_distance == pytest.approx(second.mean_distance, rel=0, abs=1e-11), a
        assert first.mean_distance <= 1e-3 or len(first.crossing_time) == len(second.crossing_time)
    assert compared >= 7


@pytest.mark.parametrize(("initial", "a"), [("minus", 0.08), ("plus", 0.08), ("plus", 0.3)])
def test_exponents(initial, a):
    runs = [
        simulate(Model("linearized", a=a), initial, solver=solver, events="none", lyapunov_exponents=4)
        for solver in SOLVERS
    ]
    assert np.allclose(*(run.lyapunov_exponent for run in runs), rtol=0.0, atol=1e-8)


@pytest.mark.parametrize("contact", CONTACTS)
def test_perturbations(contact):
    model = Model("linearized", a=0.12, contact=contact)
    start = model.begin(PAPER_STATES["plus"])
    (first, events), (second, _) = (carry(model, start, 60.0, directions(start), solver) for solver in SOLVERS)
    assert len(events) > 40
    scale = np.abs(first.perturbations).max()
    assert np.allclose(first.perturbations, second.perturbations, rtol=0.0, atol=1e-10 * scale)


@pytest.mark.parametrize(
    ("law", "a", "chain"),
    [
        ("nonlinear", 0.1, Chain(3)),
        ("linearized", 0.1, Chain(3, ends="ring")),
        ("linearized", 0.1, Chain(2, threshold=[1.0, 2.0])),
        ("linearized", 2.0, Chain(3)),
    ],
)
def test_models_without_a_closed_form_are_refused(law, a, chain):
    with refused("solver: 'map'"):
        Runner(Model(law, a=a, chain=chain), "map")


def test_the_series_solver_needs_no_closed_form():
    assert simulate(Model("linearized", a=2.5), "minus", transient=5.0, window=20.0).status in ("completed", "diverged")
