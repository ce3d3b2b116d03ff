"""Runs of any model, compared with SciPy; symmetries; and that observation changes no motion."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from burridge_knopoff import Chain, ChainState, FormulaLaw, InitialState, Model, Settings, simulate
from burridge_knopoff.kernel._core import STATUS
from burridge_knopoff.laws import LAWS
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.running.runner import Runner
from burridge_knopoff.running.simulation import run
from burridge_knopoff.running.solvers import RUN_SOLVERS, SOLVERS
from burridge_knopoff.running.status import Status
from burridge_knopoff.study.load import load_study
from burridge_knopoff.study.yaml_file import read_config
from tests.conftest import quick_first
from tests.flows import carry, check_events, listed, wave
from tests.refused import refused
from tests.scipy_flow import model_events, scipy_events

UNEQUAL = {
    "open": {"coupling": [1.3, 0.6, 2.0], "pulling": [1.0, 0.5, 1.5, 0.8], "threshold": [1.0, 1.2, 0.7, 1.1]},
    "ring": {"coupling": [1.3, 0.6, 2.0, 0.9], "pulling": 0.8, "threshold": [1.0, 1.2, 0.7, 1.1], "ends": "ring"},
    "equal ring": {"ends": "ring"},
}


@pytest.mark.parametrize("law", ["linearized", "nonlinear", "carlson_langer", "stribeck"])
@pytest.mark.parametrize("chain", UNEQUAL)
def test_unequal_chains_and_rings_against_scipy(chain, law):
    model = Model(law, a=0.3, blocks=4, **UNEQUAL[chain])
    assert not model.has_closed_form
    position = -0.3 + 0.25 * np.sin(1.0 + 2.0 * np.arange(4)) * model.chain.thresholds
    start = ChainState(position, 0.1 + 0.05 * np.cos(3.0 * np.arange(4)), np.zeros(4, dtype=bool))
    expected, state = model_events(model, start, 10.0)
    solver, events = carry(model, start, 10.0)
    assert len(events) >= 4
    check_events(events, expected, 1e-8)
    assert np.abs(solver.state().vector() - state).max() < 1e-8


# The example studies with their own laws and springs: stiffness, static friction and Φ as on their pages.


def unequal_blocks(a):
    return np.array([[2.0, -1.0], [-1.0, 1.8]]), np.array([1.0, 2.25]), lambda u: np.full_like(u, 1.0 / (1.0 + a))


def carlson_langer(a):
    stiffness = np.diag([10.0, *8 * [19.0], 10.0]) - 9.0 * (np.eye(10, k=1) + np.eye(10, k=-1))
    return stiffness, np.ones(10), lambda u: 0.99 / (1.0 + a * u / 0.99)


@pytest.mark.parametrize(
    ("model", "a", "end", "least", "tolerance"),
    quick_first(
        [
            # Chaos: errors grow by a factor of e in about ten units of time.
            (carlson_langer, 2.0, 100.0, 40, 1e-6),
            (unequal_blocks, 0.1, 500.0, 60, 1e-8),
            (unequal_blocks, 0.4, 500.0, 20, 1e-8),
            (carlson_langer, 5.0, 150.0, 40, 1e-6),
        ],
        1,
    ),
)
def test_example_studies_against_scipy(repository, model, a, end, least, tolerance):
    file = repository / "config" / "examples" / f"{model.__name__}.yaml"
    study = load_study(read_config(file), str(file))
    settings = Settings(start="tested", transient=0.0, window=end, events="all", lyapunov_exponents=0)
    state = study.state(study.initial[0])
    events = listed(run(study.model(study.laws[0], a), state, settings))
    stuck, position = np.zeros(study.blocks, dtype=int), np.array(state.position)
    stiffness, threshold, friction = model(a)
    assert (-stiffness @ position < threshold).all()
    v = study.config["v"]
    expected, *_ = scipy_events(stiffness, threshold, friction, v, position, 0.0 * position, stuck, end)
    assert len(expected) >= least
    check_events(events, expected, tolerance)


def test_the_distance_of_unequal_chains_is_that_of_the_end_blocks():
    model = Model("nonlinear", a=0.3, blocks=4, **UNEQUAL["open"])
    state = InitialState("uneven", (-0.4, -0.5, -0.3, -0.6), (0.1, 0.12, 0.1, 0.08))
    run = simulate(
        model, initial=state, settings=Settings(transient=10.0, window=20.0, batches=2, sampling=0.5, trajectory=30.0)
    )
    at = np.searchsorted(run.trajectory_time, run.time - 1e-9)
    apart = run.position[at, 3] - run.position[at, 0], run.velocity[at, 3] - run.velocity[at, 0]
    assert np.abs(run.distance - np.hypot(*apart)).max() < 1e-9


@pytest.mark.parametrize("law", [kind(a=0.26) for kind in LAWS.values()] + [FormulaLaw("exp(-a*u)/(1 + a*u)", a=0.26)])
@pytest.mark.parametrize("blocks", [3, 9])
def test_observation_does_not_change_the_motion(law, blocks):
    """Every event time is the same to the bit, whatever is measured or stored, and however long the run."""
    state = PAPER_STATES["minus"] if blocks == 3 else wave(blocks, 0.05)
    model = Model(law, blocks=blocks)
    everything = simulate(model, initial=state, settings=Settings(transient=100.0, window=700.0, events="all"))
    for options in (
        {"transient": 333.3, "window": 91.7},
        {"transient": 100.0, "window": 200.0, "lyapunov_exponents": 0, "sampling": 0.37},
        {"transient": 50.0, "window": 650.0, "lyapunov_exponents": 6, "trajectory": 600.0, "lyapunov_alignment": 20.0},
    ):
        other = simulate(model, initial=state, settings=Settings(events="all", **options))
        count = len(other.event_time)
        assert count > 5
        for name in ("event_time", "event_block", "event_velocity"):
            assert getattr(other, name).tobytes() == getattr(everything, name)[:count].tobytes()


def test_longer_windows_continue_shorter_ones():
    """In chaos a difference in the last bit would soon lead to another trajectory."""
    runs = [simulate(Model("nonlinear", a=0.26), "minus", window=window, events="all") for window in (900.0, 7000.0)]
    count = len(runs[0].event_time)
    assert runs[0].event_time.tobytes() == runs[1].event_time[:count].tobytes()


@given(st.integers(2, 11), st.sampled_from(sorted(LAWS)), st.sampled_from(["open", "ring"]), st.integers(0, 2**32 - 1))
@settings(max_examples=40)
def test_mirror_images_move_as_mirror_images(blocks, law, ends, seed):
    """This holds to the bit in symmetric chains; motion shifted in time is the same as well."""
    generator = np.random.default_rng(seed)
    strength = generator.uniform(0.5, 2.0, blocks)
    chain = Chain(blocks, pulling=strength + strength[::-1], threshold=float(generator.uniform(0.7, 1.3)), ends=ends)
    assert chain.is_mirror_symmetric
    model = Model(law, a=generator.uniform(0.0, 0.5), chain=chain)
    position, velocity = generator.uniform(-0.4, 0.4, blocks), generator.uniform(0.02, 0.3, blocks)
    start = ChainState(position, velocity, np.zeros(blocks, dtype=bool))
    solver, events = carry(model, start, 12.0)
    # The order of two simultaneous events is arbitrary.
    assume(all(gap > 1e-12 for gap in np.diff([time for time, _, _ in events])))
    mirror, mirrored = carry(model, start.mirrored(), 12.0)
    assert events == [(time, blocks + 1 - block, kind) for time, block, kind in mirrored]
    assert (solver.state().vector() == mirror.state().mirrored().vector()).all()
    half, first = carry(model, start, 5.0)
    second = [(5.0 + time, block, kind) for time, block, kind in carry(model, half.state(), 7.0)[1]]
    assume(len(first) + len(second) == len(events) > 0)
    times = [time for time, _, _ in (*first, *second)]
    assert np.abs(np.subtract(times, [time for time, _, _ in events])).max() < 1e-11 * np.exp(0.5 * 12.0)


def test_statuses_are_those_of_the_kernel():
    assert {item.name: item.value for item in Status} == STATUS


@pytest.mark.parametrize("arguments", [{"until": 5.0}, {"halting_block": 0}])
def test_the_solver_of_fixed_steps_ends_only_at_the_end_of_a_window(arguments):
    """Without an observer there is no window, and the run would never end."""
    runner = Runner(Model("linearized", a=0.08), "rk4")
    runner.begin(runner.model.begin(PAPER_STATES["minus"]))
    with refused("solver: 'rk4'"):
        runner.run(**arguments)


def test_events_that_were_read_survive_another_run():
    model = Model("linearized", a=0.08)
    runner = Runner(model, keep_events=True)
    runner.state_after(model.begin(PAPER_STATES["plus"]), 40.0)
    time, block, _ = runner.events()
    copy = time.copy()
    runner.state_after(model.begin(PAPER_STATES["minus"]), 10.0)
    assert len(block) == len(copy) > 10
    assert (time == copy).all()
    # The log contains only the events of the second run.
    assert runner.events()[0].max() <= 10.0
    assert len(runner.events()[0]) == runner.log.count


@pytest.mark.parametrize("solver", [name for name in RUN_SOLVERS if not SOLVERS[name].closed_form])
def test_a_log_of_stops_has_the_stops_of_the_whole_log_with_states(solver):
    model = Model("linearized", a=0.08)
    options = Settings(transient=30.0, window=60.0, event_window=60.0, solver=solver)
    whole, stops = (run(model, PAPER_STATES["plus"], options, stops_only=only) for only in (False, True))
    chosen = whole.event_kind == 0
    assert 0 < chosen.sum() < len(chosen)
    for name in ("event_time", "event_block", "event_kind", "event_position", "event_velocity"):
        assert np.array_equal(getattr(stops, name), getattr(whole, name)[chosen]), name
    assert len(stops.earlier_event_time) == 0 < len(whole.earlier_event_time)
    # Nothing else depends on what is stored.
    assert (stops.event_count, stops.mean_distance) == (whole.event_count, whole.mean_distance)
