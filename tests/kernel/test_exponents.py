"""Lyapunov exponents against closed forms, determinants, two trajectories side by side, and what they must be."""

import numpy as np
import pytest
from scipy.optimize import approx_fprime

from burridge_knopoff.laws import law_of
from burridge_knopoff.model.chain import Chain
from burridge_knopoff.model.initial import PAPER_STATES, InitialState
from burridge_knopoff.model.model import Instant, Model
from burridge_knopoff.running.runner import Runner
from burridge_knopoff.running.simulation import simulate
from burridge_knopoff.running.status import Status
from tests.kernel.flows import growth_from, later

LAWS = ("linearized", "nonlinear")
SYMMETRIC = InitialState("symmetric", (-0.99, -0.993, -0.99), (0.1, 0.101, 0.1))


def side_by_side(model, start, end, *, interval=3.0, distance=1e-7, batches=14):
    """Return the largest exponent and its standard error from the distance between two trajectories.

    It is measured and set back to `distance` after every interval (Benettin's first method).
    """
    solvers = Runner(model), Runner(model)
    offset = distance * np.array([1.0, -0.5, 0.3, 0.2, 0.4, -0.1]) / np.linalg.norm([1.0, -0.5, 0.3, 0.2, 0.4, -0.1])
    blocks = model.chain.blocks
    growth = []
    other_stuck = start.stuck
    for _ in range(round(end / interval)):
        vector = start.vector() + offset
        # One of the two may stick a little longer than the other.
        velocity = np.where(other_stuck, 0.0, np.maximum(vector[blocks:], 0.0))
        reached = []
        for solver, state in zip(solvers, (start, Instant(vector[:blocks], velocity, other_stuck)), strict=True):
            solver.begin(state)
            solver.run(interval)
            reached.append(solver.instant())
        start, other_stuck = reached[0], reached[1].stuck
        offset = reached[1].vector() - start.vector()
        length = np.linalg.norm(offset)
        growth.append(np.log(length / distance) / interval)
        offset *= distance / length
    size = len(growth) // batches
    batch = np.array(growth[: size * batches]).reshape(batches, size).mean(axis=1)
    return batch.mean(), batch.std(ddof=1) / np.sqrt(batches)


@pytest.mark.parametrize(
    ("law", "initial", "a"),
    [
        ("linearized", "plus", 0.2),
        ("linearized", "minus", 0.18),
        ("linearized", "plus", 0.28),
        ("nonlinear", "plus", 0.21),
        ("nonlinear", "minus", 0.25),
    ],
)
def test_two_trajectories_side_by_side(law, initial, a):
    model = Model(Chain(3), law_of(law, a))
    run = simulate(law, a, initial, window=14000.0, batches=14, lyapunov_exponents=1, events="none")
    start = later(model, model.begin(PAPER_STATES[initial]), 3000.0)
    expected, error = side_by_side(model, start, 14000.0)
    assert run.lyapunov_exponent[0] > 5.0 * run.lyapunov_error[0]
    # Four standard errors: five cases fail by chance once in three thousand runs.
    assert abs(run.lyapunov_exponent[0] - expected) < 4.0 * np.hypot(run.lyapunov_error[0], error)
    assert error < 0.15 * expected


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("blocks", [2, 3, 5])
@pytest.mark.parametrize("transient", [0.0, 500.0])
def test_uniform_sliding(law, blocks, transient):
    """All 2N exponents are aΦ²/2 (Φ² = 1 for the linearized law), half the slope of friction over velocity."""
    a, v = 0.3, 0.1
    offset = Chain(blocks).sliding_offset(float(law_of(law, a)(v)))
    run = simulate(
        law,
        a,
        InitialState("uniform", tuple(offset), (v,) * blocks),
        v=v,
        transient=transient,
        window=4000.0,
        lyapunov_exponents=2 * blocks,
    )
    assert run.event_count == 0
    slope = a if law == "linearized" else a / (1.0 + a * v) ** 2
    # The modes turn: within a window of T a vector's length differs from exp(λT) by less than the ratio e² of axes.
    assert np.abs(run.lyapunov_exponent - slope / 2).max() < 2.0 / 4000.0
    assert run.lyapunov_exponent.sum() == pytest.approx(blocks * slope, abs=1e-9)
    assert run.lyapunov_infinite_count == 0


def symmetric_period(law, a):
    """Return the model, the state just after blocks 1 and 3 have stopped together, the period and their slip time."""
    model = Model(Chain(3), law_of(law, a))
    solver = Runner(model, keep_events=True)
    solver.begin(model.begin(SYMMETRIC))
    solver.run(2000.0)
    assert solver.run(2100.0, halting_block=0) == Status.HALTED
    after = solver.instant()
    first = solver.clock
    assert solver.run(2100.0, halting_block=0) == Status.HALTED
    period = solver.clock - first
    time, block, kind = solver.events()
    starts = time[(block == 0) & (kind == 1)]
    return model, after, period, solver.clock - starts[-1]


@pytest.mark.parametrize("a", [0.05, 0.08, 0.1, 0.15])
def test_transverse_exponent_of_synchrony_in_closed_form(a):
    """Blocks 1 and 3 against each other: 2 is the stiffness of that mode, and every stop takes its velocity away.

    Over a slip of length T a difference in position is multiplied by exp(aT/2)(cos ωT − a/(2ω) sin ωT), ω² = 2 − a²/4.
    """
    model, _, period, slip = symmetric_period("linearized", a)
    omega = np.sqrt(2.0 - a * a / 4.0)
    multiplier = np.exp(a * slip / 2) * (np.cos(omega * slip) - a / (2 * omega) * np.sin(omega * slip))
    check_transverse(model, np.log(abs(multiplier)) / period)


@pytest.mark.parametrize("a", [0.08, 0.12])
def test_transverse_exponent_of_synchrony_from_the_flow(a):
    """The nonlinear law: the multiplier is the slope of the difference after a period over that before."""
    model, start, period, _ = symmetric_period("nonlinear", a)

    def difference(shift):
        position = start.position + np.array([0.5, 0.0, -0.5]) * shift[0]
        state = later(model, Instant(position, start.velocity, start.stuck), period + 0.5)
        return state.position[0] - state.position[2]

    # From 0.5 after one stop to 0.5 after the next all of the difference is in the positions: both blocks are stuck.
    multiplier = approx_fprime([0.0], difference, 1e-7)[0]
    check_transverse(model, np.log(abs(multiplier)) / period)


def check_transverse(model, expected):
    run = simulate(model.law, model.a, SYMMETRIC, window=20000.0, transient=2000.0, events="none")
    assert run.distance.max() == 0.0
    # Two exponents are known, in the order of their size: that of the flow itself, 0, and the transverse one.
    for known in (0.0, expected):
        assert np.abs(run.lyapunov_exponent - known).min() < 2e-4
    assert (expected > 0.0) == (run.lyapunov_exponent[0] > 1e-3)


@pytest.mark.parametrize(
    ("law", "blocks", "a", "contact"),
    [
        ("linearized", 2, 0.05, "one_sided"),
        ("linearized", 3, 0.1, "one_sided"),
        ("linearized", 3, 0.2, "symmetric"),
        ("nonlinear", 3, 0.2, "one_sided"),
        ("nonlinear", 2, 0.1, "symmetric"),
        ("nonlinear", 5, 0.05, "one_sided"),
    ],
)
def test_sum_of_all_finite_exponents_is_the_determinant(law, blocks, a, contact):
    """From one instant with m blocks stuck to another the flow maps 2N − m dimensions to as many."""
    model = Model(Chain(blocks), law_of(law, a), contact=contact)
    wave = tuple(-0.9 + 0.1 * np.sin(1.0 + 2.0 * np.arange(blocks)))
    start = later(model, model.begin(InitialState("wave", wave, (0.1,) * blocks)), 200.0)
    states = [start]
    for _ in range(800):
        states.append(later(model, states[-1], 0.05))
    most = max(int(state.stuck.sum()) for state in states)
    assert most >= 1
    chosen = [k for k, state in enumerate(states) if state.stuck.sum() == most]
    first = states[chosen[0]]
    same = [k for k in chosen[1:] if (states[k].stuck == first.stuck).all()]
    duration = 0.05 * (same[-1] - chosen[0])
    assert duration > 10.0
    found = growth_from(model, first, duration, 2 * blocks)
    solver = Runner(model, perturbations=np.eye(2 * blocks))
    kept = np.concatenate([np.ones(blocks, dtype=bool), ~first.stuck])
    solver.carry(np.diag(kept.astype(float)))
    solver.begin(first)
    solver.run(duration)
    sign, logarithm = np.linalg.slogdet(solver.perturbations[np.ix_(kept, kept)])
    assert sign != 0
    assert found["lost"] == most
    assert np.isneginf(found["growth"][0]).sum() == most
    assert found["growth"][0, : 2 * blocks - most].sum() == pytest.approx(logarithm, abs=1e-4)


@pytest.mark.parametrize(("law", "initial", "a"), [("linearized", "minus", 0.08), ("nonlinear", "plus", 0.08)])
def test_the_first_ones_do_not_depend_on_how_many_are_computed(law, initial, a):
    runs = [simulate(law, a, initial, events="none", lyapunov_exponents=count) for count in (1, 2, 3, 6)]
    for run in runs:
        count = len(run.lyapunov_exponent)
        assert np.allclose(run.lyapunov_exponent[:3], runs[3].lyapunov_exponent[: min(count, 3)], rtol=0, atol=1e-9)
    assert len({run.mean_distance for run in runs}) == 1
    assert simulate(law, a, initial, events="none", lyapunov_exponents=0).mean_distance == runs[0].mean_distance


@pytest.mark.parametrize(("law", "a"), [("linearized", 0.08), ("nonlinear", 0.08)])
def test_mirror_image(law, a):
    state = PAPER_STATES["plus"]
    mirror = InitialState("mirror", state.position[::-1], state.velocity[::-1])
    run, other = (simulate(law, a, initial, events="none") for initial in (state, mirror))
    assert run.lyapunov_infinite_count == other.lyapunov_infinite_count
    assert np.abs(run.lyapunov_exponent - other.lyapunov_exponent).max() < 3e-4


@pytest.mark.parametrize(("initial", "a"), [("minus", 0.08), ("plus", 0.08), ("plus", 0.3)])
def test_map_and_series(initial, a):
    runs = [
        simulate("linearized", a, initial, solver=solver, events="none", lyapunov_exponents=4)
        for solver in ("map", "series")
    ]
    exponents = [run.lyapunov_exponent for run in runs]
    assert np.allclose(*exponents, rtol=0.0, atol=1e-8)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("blocks", [2, 5])
def test_shorter_and_longer_chains(law, blocks):
    """One zero exponent at least, none above it in regular motion, and 2N in all."""
    wave = tuple(-0.9 + 0.1 * np.sin(1.0 + 2.0 * np.arange(blocks)))
    run = simulate(law, 0.05, InitialState("wave", wave, (0.1,) * blocks), lyapunov_exponents=2 * blocks)
    exponent, error = run.lyapunov_exponent, run.lyapunov_error
    finite = np.isfinite(exponent)
    assert np.abs(exponent[finite]).min() < 3.0 * error[finite][np.abs(exponent[finite]).argmin()]
    assert (np.diff(exponent[finite]) < 3e-3).all()
    assert (~finite).sum() == run.lyapunov_infinite_count >= 1


@pytest.mark.parametrize("window", [1e-3, 0.5, 3.0])
@pytest.mark.parametrize("transient", [0.0, 100.0])
@pytest.mark.parametrize("law", LAWS)
def test_windows_too_short_for_batches(law, transient, window):
    """No errors where a batch has seen no orthonormalisation; what there is is the growth of a real vector."""
    run = simulate(law, 0.2, "plus", transient=transient, window=window, lyapunov_exponents=6)
    assert run.status == "completed"
    assert np.isnan(run.lyapunov_error).all()
    exponent = run.lyapunov_exponent
    assert np.isnan(exponent).all() or not np.isnan(exponent).any()
    # No perturbation grows faster than the largest rate of the equations, ω + a with ω² ≤ 6.
    assert not (exponent > 2.7).any()
    assert (run.lyapunov_infinite_count == -1) == np.isnan(exponent).all()


@pytest.mark.parametrize("limit", [10, 2000])
def test_runs_that_do_not_complete_have_none(monkeypatch, limit):
    monkeypatch.setattr("burridge_knopoff.running.runner.STEP_LIMIT", limit)
    run = simulate("linearized", 0.08, "plus", transient=100.0)
    assert run.status == "step_limit"
    assert np.isnan(run.lyapunov_exponent).all()
    assert np.isnan(run.lyapunov_error).all()
    assert np.isnan(run.batch_lyapunov_exponent).all()
    assert run.lyapunov_infinite_count == -1


@pytest.mark.parametrize(("settings", "count"), [({"solver": "rk4", "step": 0.01}, 3), ({"lyapunov_exponents": 0}, 0)])
def test_no_exponents_asked_for_or_possible(settings, count):
    run = simulate("linearized", 0.08, "plus", transient=10.0, window=20.0, **settings)
    assert run.lyapunov_exponent.shape == (count,)
    assert np.isnan(run.lyapunov_exponent).all()
    assert run.batch_lyapunov_exponent.shape == (7, count)
    assert run.lyapunov_infinite_count == -1
