"""Initial states: the paper's, by name or numbers, which follow v, and refused ones."""

import pickle

import numpy as np
import pytest

from burridge_knopoff import Chain, FormulaLaw, InitialState, Model, Settings, law_of, simulate, sweep
from burridge_knopoff.model.initial import PAPER_STATES, PaperState, initial_state
from burridge_knopoff.running.command import simulate_command
from tests.refused import refused

LAWS = (
    law_of("linearized", a=0.08),
    law_of("linearized", a=0.2345),
    law_of("nonlinear", a=0.3),
    law_of("carlson_langer", a=0.1),
    FormulaLaw("1 - c*tanh(a*u/c)", a=0.1, c=0.2),
)
CHAINS = (
    Chain(3),
    Chain(3, mass=(1.0, 2.0, 0.5), damping=0.1, pulling_damping=0.05),
    Chain(3, coupling=(0.7, 1.3), pulling=(1.0, 0.0, 2.0), threshold=(1.0, 1.2, 0.9)),
)


def as_numbers(state):
    return InitialState(state.name, state.position, state.velocity)


def uniform_sliding(model):
    """Return e by its definition: a block at v is in balance, K e = −Φ(v) · threshold."""
    chain = model.chain
    c, d = chain.parameter_values("coupling"), chain.driving
    stiffness = np.diag(d) + np.array([[c[0], -c[0], 0.0], [-c[0], c.sum(), -c[1]], [0.0, -c[1], c[1]]])
    return np.linalg.solve(stiffness, -float(model.law(model.v)) * chain.thresholds)


def test_the_paper_states():
    minus, plus = PAPER_STATES["minus"], PAPER_STATES["plus"]
    assert minus.position[1:] == plus.position[1:] == (-0.993, -0.991)
    assert minus.position[0] == -plus.position[0] == -0.989
    assert minus.velocity == plus.velocity == (0.099, 0.1012, 0.1023)
    assert pickle.loads(pickle.dumps(plus)) == plus != as_numbers(plus)


def test_initial_state_by_name_or_numbers():
    assert initial_state("plus") is PAPER_STATES["plus"]
    assert initial_state("mine", (1.0, 2.0), (0.0, 0.1)) == InitialState("mine", (1.0, 2.0), (0.0, 0.1))
    plus = PAPER_STATES["plus"]
    assert initial_state("plus", plus.position, plus.velocity) == as_numbers(plus)
    for name, meant in (("Plus", "plus"), ("plsu", "plus"), ("MINUS", "minus"), ("mins", "minus")):
        with refused(f"initial: {name!r}", f"{meant}?"):
            initial_state(name)
    for numbers in ({}, {"position": (1.0, 2.0)}, {"velocity": (1.0, 2.0)}):
        with refused("initial: 'own'"):
            initial_state("own", **numbers)


@pytest.mark.parametrize("chain", CHAINS)
@pytest.mark.parametrize("law", LAWS, ids=str)
@pytest.mark.parametrize("state", PAPER_STATES.values(), ids=PAPER_STATES)
def test_at_the_v_of_the_paper_its_numbers_are_those_of_the_paper(state, law, chain):
    model = Model(law, chain=chain, v=0.1)
    followed, numbers = (model.initial_coordinates(initial) for initial in (state, as_numbers(state)))
    assert np.array_equal(followed, numbers)
    assert np.array_equal(numbers, [state.position, state.velocity])
    assert simulate_command(model, state, Settings()) == simulate_command(model, as_numbers(state), Settings())


@pytest.mark.parametrize("v", [1e-6, 0.003, np.nextafter(0.1, 0.0), np.nextafter(0.1, 1.0), 0.2, 0.7, 40.0])
@pytest.mark.parametrize("chain", CHAINS)
@pytest.mark.parametrize("law", LAWS, ids=str)
def test_velocities_and_distances_from_uniform_sliding_are_in_proportion_to_v(law, chain, v):
    model, at_paper = Model(law, chain=chain, v=v), Model(law, chain=chain, v=0.1)
    for state in PAPER_STATES.values():
        position, velocity = model.initial_coordinates(state)
        distance = np.array(state.position) - uniform_sliding(at_paper)
        np.testing.assert_allclose(position - uniform_sliding(model), v / 0.1 * distance, rtol=1e-13, atol=1e-15)
        np.testing.assert_allclose(velocity, v / 0.1 * np.array(state.velocity), rtol=1e-15)
        assert np.array_equal(model.initial_coordinates(as_numbers(state)), [state.position, state.velocity])
        commands = {simulate_command(model, initial, Settings()) for initial in (state, as_numbers(state))}
        assert len(commands) == 2


def test_the_mean_distance_is_in_proportion_to_v_under_the_linearized_law():
    """Twice the 0.14064 of a = 0.08 at the v of the paper is 0.28128."""
    v = [0.01, 0.1, 0.2, 3.0]
    runs = sweep(Model("linearized"), "plus", a=[0.05, 0.08], v=v)
    assert runs["mean_distance"].sel(a=0.08, v=0.2).item() == pytest.approx(0.28128, abs=1e-5)
    ratio = runs["mean_distance"] / runs["mean_distance"].sel(v=0.1)
    np.testing.assert_allclose(ratio.transpose("a", "v"), [np.array(v) / 0.1] * 2, rtol=1e-9)
    assert (sweep(Model("linearized"), "minus", a=0.08, v=v)["mean_distance"] < 1e-12).all()


@pytest.mark.parametrize("start", ["moving", "tested"])
@pytest.mark.parametrize("initial", PAPER_STATES)
def test_the_motion_is_in_proportion_to_v_under_the_linearized_law(initial, start):
    runs = [
        simulate(Model("linearized", a=0.15, v=v), initial, transient=0.0, window=150.0, events="all", start=start)
        for v in (0.1, 0.037)
    ]
    one, other = ((run.event_position - run.model.sliding_offset) / run.model.v for run in runs)
    assert runs[0].event_count == runs[1].event_count > 100
    np.testing.assert_allclose(one, other, atol=1e-8)
    np.testing.assert_allclose(runs[0].event_time, runs[1].event_time, atol=1e-8)
    assert np.array_equal(runs[0].initially_slipping, runs[1].initially_slipping)


def test_a_run_is_repeated_from_its_initial_state_and_stores_where_it_began():
    options = {"transient": 0.0, "window": 20.0, "events": "all"}
    run = simulate(Model("nonlinear", a=0.2, v=0.3), "plus", **options)
    again = simulate(run.model, initial=run.initial, **options)
    stored = run.to_dataset()
    numbers = (stored["initial_position"].values, stored["initial_velocity"].values)
    from_numbers = simulate(run.model, initial=numbers, **options)
    for other in (again, from_numbers):
        assert np.array_equal(run.event_time, other.event_time)
        assert np.array_equal(run.event_position, other.event_position)
    assert stored.attrs["history"] == again.to_dataset().attrs["history"]


GIVEN = {
    "a state of the paper": "plus",
    "one number": {"position": -0.9, "velocity": 0.3},
    "random": InitialState("rough", "random=uniform,low=-1.5,high=-0.5,seed=1", 0.3),
    "a state of a motion": Model("nonlinear", a=0.08, v=0.5).begin(PAPER_STATES["minus"], "tested"),
    "a run": simulate(Model("nonlinear", a=0.08, v=0.5), "plus", transient=0.0, window=7.5),
}


@pytest.mark.filterwarnings("ignore:start tested")
@pytest.mark.parametrize("start", ["moving", "tested"])
@pytest.mark.parametrize("form", GIVEN)
def test_the_initial_state_of_a_run_is_that_from_which_it_started(form, start):
    """It is where the recorded motion begins, whatever form was given; the command of the file names that form."""
    options = {"transient": 0.0, "window": 20.0, "trajectory": 20.0, "trajectory_sampling": 0.5, "start": start}
    run = simulate(Model("nonlinear", a=0.08, v=0.5), initial=GIVEN[form], **options)
    assert run.trajectory_time[0] == run.begin_time
    assert run.initial.position == pytest.approx(run.position[0], abs=1e-14)
    assert run.initial.velocity == pytest.approx(run.velocity[0], abs=1e-14)
    stored = run.to_dataset()
    assert tuple(stored["initial_velocity"].values) == run.initial.velocity
    assert stored.attrs["history"].startswith("bk simulate ") == (form not in ("a state of a motion", "a run"))
    again = simulate(run.model, initial=run.initial, **options)
    assert again.initial.position == run.initial.position
    # The name of a state of the paper does not go with other numbers.
    elsewhere = simulate(Model("linearized", a=0.08, v=0.2), run.initial, **options)
    assert elsewhere.initial.position == run.initial.position
    assert elsewhere.initial.name == ("own" if form == "a state of the paper" else run.initial.name)


def test_a_printed_run_tells_what_is_not_the_papers():
    """Of the paper's model only the law and a."""
    short = {"transient": 0.0, "window": 1.0}
    paper = simulate(Model("nonlinear", a=0.1), "plus", **short)
    assert repr(paper).startswith("<Trajectory of 3 blocks from plus, nonlinear law, a = 0.1: ")
    springs = {"coupling": (1.5, 1.0), "pulling": 0.5, "damping": 0.1, "pulling_damping": 0.2}
    blocks = {"threshold": (1.0, 1.0, 1.5), "mass": 2.0, "weakening": (1.0, 0.0, 1.0)}
    model = Model("stribeck", a=0.1, sigma=0.02, blocks=3, **springs, **blocks, v=0.3, contact="symmetric")
    printed = repr(simulate(model, initial="plus", **short))
    for name, value in {**springs, **blocks, "sigma": 0.02, "v": 0.3, "contact": "symmetric"}.items():
        assert f", {name} = {value!r}" in printed
    assert "law 1 - c*a*u, a = 0.1, c = 0.5" in repr(
        simulate(Model({"formula": "1 - c*a*u", "c": 0.5}, a=0.1), **short)
    )


def test_own_numbers_are_taken_as_they_are_under_any_name():
    plus = PAPER_STATES["plus"]
    for form in (as_numbers(plus), {"name": "plus", "position": plus.position, "velocity": plus.velocity}):
        stored = simulate(Model("linearized", a=0.08, v=0.2), form, transient=0.0, window=1.0).to_dataset()
        assert stored["initial_position"].values.tolist() == list(plus.position)
    with refused("initial.name: 'plus'"):
        simulate(Model("linearized", a=0.08), {"name": "plus", "position": plus.position, "velocity": (0.1, 0.1, 0.1)})


@pytest.mark.parametrize("kind", [InitialState, PaperState])
@pytest.mark.parametrize("last", [float("nan"), 1e7, 10**400, "1", None])
def test_refused(kind, last):
    with refused("position"):
        kind("bad", (0.0, last), (0.1, 0.1))
    for velocity in ((0.1,), (0.1, True)):
        with refused("velocity"):
            kind("bad", (0.0, 0.0), velocity)
