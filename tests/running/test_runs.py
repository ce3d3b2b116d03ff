"""Runs of any model: solvers against each other and SciPy, symmetries, and that to be observed changes no motion."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from burridge_knopoff.kernel import events as kernel_events
from burridge_knopoff.laws import LAWS, FormulaLaw, law_of
from burridge_knopoff.model.chain import Chain
from burridge_knopoff.model.initial import PAPER_STATES, InitialState
from burridge_knopoff.model.model import Instant, Model
from burridge_knopoff.running.runner import Runner
from burridge_knopoff.running.settings import Settings
from burridge_knopoff.running.simulation import simulate
from burridge_knopoff.running.status import Status
from tests.scipy_flow import scipy_events


def events_of(model, start, end, solver_name="series"):
    solver = Runner(model, solver_name, keep_events=True)
    solver.begin(start)
    assert solver.run(end) == Status.COMPLETED
    return solver, *solver.events()


def wave(model):
    position = -0.3 + 0.25 * np.sin(1.0 + 2.0 * np.arange(model.blocks)) * model.chain.thresholds
    velocity = 0.1 + 0.05 * np.cos(3.0 * np.arange(model.blocks))
    return Instant(position, velocity, np.zeros(model.blocks, dtype=bool))


SCALED = [{"coupling": 2.5}, {"pulling": 0.7}, {"threshold": 1.6}, {"coupling": 0.4, "pulling": 1.3}]


@pytest.mark.parametrize("options", SCALED)
@pytest.mark.parametrize("blocks", [2, 3, 5])
def test_map_and_series_in_uniform_chains(options, blocks):
    model = Model(Chain(blocks, **options), law_of("linearized", 0.2))
    assert model.has_closed_form
    start = wave(model)
    (_, time, block, kind), (_, other, *rest) = (events_of(model, start, 25.0, name) for name in ("series", "map"))
    assert len(time) > 8
    assert [block.tolist(), kind.tolist()] == [values.tolist() for values in rest]
    assert np.abs(time - other).max() < 1e-10


UNEQUAL = {
    "open": {"coupling": [1.3, 0.6, 2.0], "pulling": [1.0, 0.5, 1.5, 0.8], "threshold": [1.0, 1.2, 0.7, 1.1]},
    "ring": {"coupling": [1.3, 0.6, 2.0, 0.9], "pulling": 0.8, "threshold": [1.0, 1.2, 0.7, 1.1], "ends": "ring"},
    "equal ring": {"ends": "ring"},
}


@pytest.mark.parametrize("law", ["linearized", "nonlinear", "carlson_langer", "stribeck"])
@pytest.mark.parametrize("chain", UNEQUAL)
def test_unequal_chains_and_rings_against_scipy(chain, law):
    model = Model(Chain(4, **UNEQUAL[chain]), law_of(law, 0.3))
    assert not model.has_closed_form or chain == "paper"
    start = wave(model)
    expected, state = scipy_events(model, start, 10.0)
    solver, time, block, kind = events_of(model, start, 10.0)
    assert [(int(i) + 1, int(k)) for i, k in zip(block, kind, strict=True)] == [event[1:] for event in expected]
    assert len(time) >= 4
    assert np.abs(time - [event[0] for event in expected]).max() < 1e-8
    assert np.abs(solver.instant().vector() - state).max() < 1e-8


def test_the_distance_of_unequal_chains_is_that_of_the_end_blocks():
    model = Model(Chain(4, **UNEQUAL["open"]), law_of("nonlinear", 0.3))
    state = InitialState("wave", (-0.4, -0.5, -0.3, -0.6), (0.1, 0.12, 0.1, 0.08))
    run = simulate(model, state, Settings(transient=10.0, window=20.0, batches=2, sampling=0.5, trajectory=30.0))
    at = np.searchsorted(run.trajectory_time, run.time - 1e-9)
    apart = run.position[at, 3] - run.position[at, 0], run.velocity[at, 3] - run.velocity[at, 0]
    assert np.abs(run.distance - np.hypot(*apart)).max() < 1e-9


@pytest.mark.parametrize("law", [kind(0.26) for kind in LAWS.values()] + [FormulaLaw(0.26, "exp(-a*u)/(1 + a*u)")])
@pytest.mark.parametrize("blocks", [3, 9])
def test_what_is_observed_does_not_change_the_motion(law, blocks):
    """Every event time to the bit, whatever is measured or kept, and however long the run is."""
    position = -0.9 + 0.05 * np.sin(1.0 + 2.0 * np.arange(blocks))
    state = PAPER_STATES["minus"] if blocks == 3 else InitialState("wave", tuple(position), (0.1,) * blocks)
    model = Model(Chain(blocks), law)
    everything = simulate(model, state, Settings(transient=100.0, window=700.0, events="all"))
    for options in (
        {"transient": 333.3, "window": 91.7},
        {"transient": 100.0, "window": 200.0, "lyapunov_exponents": 0, "sampling": 0.37},
        {"transient": 50.0, "window": 650.0, "lyapunov_exponents": 6, "trajectory": 600.0, "lyapunov_alignment": 20.0},
    ):
        other = simulate(model, state, Settings(events="all", **options))
        count = len(other.event_time)
        assert count > 5
        assert other.event_time.tobytes() == everything.event_time[:count].tobytes()
        assert other.event_block.tolist() == everything.event_block[:count].tolist()
        assert other.event_velocity.tobytes() == everything.event_velocity[:count].tobytes()


def test_longer_windows_go_on_where_shorter_ones_end():
    """In chaos a last bit would soon be another trajectory."""
    runs = [simulate("nonlinear", 0.26, "minus", window=window, events="all") for window in (900.0, 7000.0)]
    count = len(runs[0].event_time)
    assert runs[0].event_time.tobytes() == runs[1].event_time[:count].tobytes()


@given(st.integers(2, 11), st.sampled_from(sorted(LAWS)), st.sampled_from(["open", "ring"]), st.integers(0, 2**32 - 1))
@settings(max_examples=40)
def test_mirror_images_move_as_mirror_images(blocks, law, ends, seed):
    """To the bit, in chains that are their own image; and shifted in time the motion is the same."""
    generator = np.random.default_rng(seed)
    strength = generator.uniform(0.5, 2.0, blocks)
    model = Model(
        Chain(blocks, pulling=strength + strength[::-1], threshold=float(generator.uniform(0.7, 1.3)), ends=ends),
        law_of(law, generator.uniform(0.0, 0.5)),
    )
    assert model.chain.is_mirror_symmetric
    start = Instant(
        generator.uniform(-0.4, 0.4, blocks), generator.uniform(0.02, 0.3, blocks), np.zeros(blocks, dtype=bool)
    )
    solver, time, block, _ = events_of(model, start, 12.0)
    # Which of two events of one instant comes first is nobody's matter.
    assume(len(time) < 2 or np.diff(time).min() > 1e-12)
    mirror, other, mirrored, _ = events_of(model, start.mirrored(), 12.0)
    assert time.tobytes() == other.tobytes()
    assert (block == blocks - 1 - mirrored).all()
    assert (solver.instant().vector() == mirror.instant().mirrored().vector()).all()
    half, first, *_ = events_of(model, start, 5.0)
    _, second, *_ = events_of(model, half.instant(), 7.0)
    assume(len(first) + len(second) == len(time) and len(time) > 0)
    growth = np.exp(0.5 * 12.0)
    assert np.abs(np.concatenate([first, 5.0 + second]) - time).max() < 1e-11 * growth


def test_the_status_is_the_kernels():
    assert {item.name: item.value for item in Status} == {item.name: item.value for item in kernel_events.Status}


def test_map_where_there_is_no_closed_form():
    unequal = Chain(2, threshold=[1.0, 2.0])
    for law, chain in (("nonlinear", Chain(3)), ("linearized", Chain(3, ends="ring")), ("linearized", unequal)):
        with pytest.raises(ValueError, match="solver: 'map' is not allowed"):
            Runner(Model(chain, law_of(law, 0.1)), "map")
    with pytest.raises(ValueError, match="solver: 'map' is not allowed"):
        Runner(Model(Chain(3), law_of("linearized", 2.0)), "map")
    assert simulate("linearized", 2.5, "minus", transient=5.0, window=20.0).status in ("completed", "diverged")
