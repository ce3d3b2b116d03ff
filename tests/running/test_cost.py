"""The estimate of the cost of a run."""

import time
import warnings

import pytest

from burridge_knopoff import Chain, InitialState, Model, Settings, law_of, simulate, sweep
from burridge_knopoff.running.cost import cost_note, cost_of, is_stiff
from burridge_knopoff.running.simulation import run
from burridge_knopoff.study.load import load_study
from burridge_knopoff.study.remarks import remarks

STIFF = {
    "damping": {"damping": 1e4},
    "one damping": {"damping": [1e4, 0.0]},
    "pulling_damping": {"pulling_damping": [0.0, 1e4, 0.0]},
    "coupling": {"coupling": 1e6},
}


@pytest.mark.parametrize("exponents", [0, 3])
def test_the_cost_of_blocks_that_slip_together_grows_with_their_square(exponents):
    costs = []
    for blocks in (500, 1000):
        model = Model("nonlinear", a=0.3, blocks=blocks)
        begun = model.begin(InitialState("alike", -0.9, 0.1))
        costs.append(cost_of(model, begun, Settings(lyapunov_exponents=exponents)))
    assert costs[1][0] == pytest.approx(4.0 * costs[0][0])
    assert costs[1][1] == pytest.approx(2.0 * costs[0][1])


@pytest.mark.parametrize("exponents", [0, 3])
def test_blocks_that_stick_share_no_event(exponents):
    model = Model("nonlinear", a=0.3, blocks=1000)
    begun = model.begin(InitialState("drawn", -0.5, 0.0), "tested")
    assert begun.stuck.all()
    assert cost_of(model, begun, Settings(lyapunov_exponents=exponents))[0] == 0.0


@pytest.mark.parametrize("case", STIFF)
@pytest.mark.parametrize("exponents", [0, 3])
def test_the_cost_of_a_stiff_chain_is_that_measured(case, exponents):
    """Within a factor of six, on this machine; without the rate it is a thousand times too small."""
    model = Model("linearized", a=0.1, blocks=3, **STIFF[case])
    settings = Settings(transient=0.0, window=2e4 / model.chain.highest_rate, lyapunov_exponents=exponents)
    state = InitialState("apart", (-0.98, -0.95, -0.96), (0.1, 0.11, 0.105))
    times = []
    for _ in range(3):
        begun = time.process_time()
        assert run(model, state, settings).status == "completed"
        times.append(time.process_time() - begun)
    cost = cost_of(model, model.begin(state), settings)[0] * settings.duration
    assert is_stiff(model.chain)
    assert min(times) / 6.0 < cost < 6.0 * min(times)


@pytest.mark.parametrize(
    ("chain", "words"),
    [
        ({"damping": 1e6}, "the step is set by the highest decay rate of the dashpots, 4e+06"),
        ({"pulling_damping": [0.0, 1e6, 0.0]}, "the step is set by the highest decay rate of the dashpots, 1e+06"),
        ({"coupling": 1e6, "mass": 1e-6}, "the step is set by the highest frequency of the springs, 2e+06"),
    ],
)
def test_a_stiff_chain_is_announced_wherever_a_run_begins(chain, words):
    """In a study before it runs, and in a program; the time is that of the whole run."""
    settings = Settings(transient=0.0, window=1e-3, batches=2)
    model = Model("linearized", a=0.1, blocks=3, **chain)
    state = InitialState("apart", (-0.98, -0.95, -0.96), (0.1, 0.11, 0.105))
    assert cost_note(model, model.begin(state), settings) == ""
    long = cost_note(model, model.begin(state), Settings())
    assert long.startswith("3 blocks: about ")
    assert " per time unit, " in long
    assert long.endswith(f" for the run if they keep slipping: {words}")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        simulate(model, initial=state, settings=settings)
        with pytest.raises(UserWarning, match="step") as caught:
            simulate(model, initial=state)
        assert str(caught.value) == long
        with pytest.raises(UserWarning, match="step"):
            sweep(model, initial=state, v=[0.1, 0.2])
    states = {"apart": {"position": list(state.position), "velocity": list(state.velocity)}}
    study = load_study(
        {"study": "stiff", "a": [0.1], "initial": states, "chain": chain, "without": ["solvers"]}, "stiff.yaml"
    )
    costs = [line for line in remarks(study, {}) if line.startswith("each simulation: ")]
    assert costs == [f"each simulation: {long}"]


def test_nothing_is_said_of_the_chains_of_the_paper():
    for config in ({"a": [0.1]}, {"grid": {"a": [0.1], "coupling": [0.1, 10.0]}}):
        study = load_study({"study": "usual", "initial": {"minus": {}}, **config}, "usual.yaml")
        assert not [line for line in remarks(study, {}) if line.startswith("each")]
    grid = {"a": [0.1], "damping": [0.0, 1e6]}
    study = load_study({"study": "one", "initial": {"minus": {}}, "grid": grid}, "one.yaml")
    costs = [line for line in remarks(study, {}) if line.startswith("each simulation: ")]
    assert [line.rpartition(", ")[2] for line in costs] == ["4e+06"]


def test_the_cost_of_a_ring_has_no_jump_where_it_becomes_dense():
    """From eight neighbours to ten, while all blocks slip."""
    costs = []
    for cut_off in (4, 5):
        chain = Chain(1000, ends="ring", springs={"distance": "3/r", "cut_off": cut_off}, pulling=1.0)
        model = Model("nonlinear", a=0.3, chain=chain)
        begun = model.begin(InitialState("alike", -0.9, 0.1))
        costs.append(cost_of(model, begun, Settings(lyapunov_exponents=0))[0])
    assert costs[0] < costs[1] < 3.0 * costs[0]


def test_the_cost_of_a_dense_network_names_its_springs():
    """A grid of four neighbours is not dense; in a dense network an event costs something though all blocks stick."""
    law, state = law_of("carlson_langer", a=1.0, sigma=0.2), InitialState("alike", -0.9, 0.0)
    settings = Settings(start="tested", transient=0.0, window=1e6, lyapunov_exponents=0)
    notes = []
    for springs in (None, {"distance": "9/r**3"}):
        model = Model(law, grid=(16, 16), springs=springs, pulling=1.0, v=0.01)
        notes.append(cost_note(model, model.begin(state, "tested"), settings))
    assert notes[0] == ""
    assert notes[1].startswith("256 blocks, 32640 springs: about")
