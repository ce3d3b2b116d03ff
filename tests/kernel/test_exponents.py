"""Lyapunov exponents, compared with closed forms, determinants and the divergence of two trajectories."""

from itertools import pairwise, product

import numpy as np
import pytest

from burridge_knopoff import Chain, ChainState, FormulaLaw, InitialState, Model, law_of, simulate, synchronized_orbit
from burridge_knopoff.kernel._core import Exponents
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.running.runner import Runner
from burridge_knopoff.running.status import Status
from tests.flows import SYMMETRIC, carry, differences, growth_from, later, wave
from tests.periodic_orbits.exact import exact_transverse_multiplier

LAWS = ("linearized", "nonlinear")
PLUS = PAPER_STATES["plus"]


def side_by_side(model, start, end, *, interval=3.0, distance=1e-7, batches=14):
    """Return the largest exponent and its standard error from the distance between two trajectories.

    The distance is measured and reset to `distance` after every interval (Benettin's first method).
    """
    runner = Runner(model)
    offset = np.array([1.0, -0.5, 0.3, 0.2, 0.4, -0.1])
    offset *= distance / np.linalg.norm(offset)
    growth, stuck = [], start.stuck
    for _ in range(round(end / interval)):
        position, velocity = np.split(start.vector() + offset, 2)
        # One of the two may stick a little longer than the other.
        other = runner.state_after(
            ChainState(position, np.where(stuck, 0.0, np.maximum(velocity, 0.0)), stuck), interval
        )
        start, stuck = runner.state_after(start, interval), other.stuck
        offset = other.vector() - start.vector()
        length = np.linalg.norm(offset)
        growth.append(np.log(length / distance) / interval)
        offset *= distance / length
    size = len(growth) // batches
    batch = np.array(growth[: size * batches]).reshape(batches, size).mean(axis=1)
    return batch.mean(), batch.std(ddof=1) / np.sqrt(batches)


CHAOTIC = {
    "linearized": [("plus", 0.2), ("minus", 0.18), ("plus", 0.28)],
    "nonlinear": [("plus", 0.21), ("minus", 0.25)],
}


@pytest.mark.parametrize(("law", "initial", "a"), [(law, *case) for law in LAWS for case in CHAOTIC[law]])
def test_two_trajectories_side_by_side(law, initial, a):
    model = Model(law, a=a)
    run = simulate(Model(law, a=a), initial, window=14000.0, batches=14, lyapunov_exponents=1, events="none")
    start = later(model, model.begin(PAPER_STATES[initial]), 3000.0)
    expected, error = side_by_side(model, start, 14000.0)
    assert run.lyapunov_exponent[0] > 5.0 * run.lyapunov_error[0]
    # Four standard errors: five cases fail by chance once in three thousand runs.
    assert abs(run.lyapunov_exponent[0] - expected) < 4.0 * np.hypot(run.lyapunov_error[0], error)
    assert error < 0.15 * expected


@pytest.mark.parametrize("blocks", [2, 3, 5])
@pytest.mark.parametrize("transient", [0.0, 500.0])
def test_uniform_sliding(law, blocks, transient):
    """All 2N exponents are aΦ²/2 (Φ² = 1 for the linearized law), half the slope of friction over velocity."""
    a, v = 0.3, 0.1
    offset = Chain(blocks).sliding_offset(float(law_of(law, a=a)(v)))
    state = InitialState("uniform", tuple(offset), (v,) * blocks)
    run = simulate(
        Model(law, a=a, v=v, blocks=blocks), state, transient=transient, window=4000.0, lyapunov_exponents=2 * blocks
    )
    assert run.event_count == 0
    slope = a if law == "linearized" else a / (1.0 + a * v) ** 2
    # The modes rotate: after a time T a vector's length differs from exp(λT) by less than the ratio e² of axes.
    assert np.abs(run.lyapunov_exponent - slope / 2).max() < 2.0 / 4000.0
    assert run.lyapunov_exponent.sum() == pytest.approx(blocks * slope, abs=1e-9)
    assert run.lyapunov_infinite_count == 0


@pytest.mark.parametrize(
    ("law", "a"), [*product(["linearized"], (0.05, 0.08, 0.1, 0.15)), *product(["nonlinear"], (0.08, 0.12))]
)
def test_transverse_exponent_of_synchrony(law, a):
    """That of a difference of blocks 1 and 3, whose multiplier over a period is known from 40-digit arithmetic."""
    orbit = synchronized_orbit(Model(law, a=a))
    transverse = np.log(abs(exact_transverse_multiplier(orbit))) / orbit.period
    run = simulate(Model(law, a=a), SYMMETRIC, window=20000.0, transient=2000.0, events="none")
    assert run.distance.max() == 0.0
    # Two exponents are known, in the order of their size: that of the flow itself, 0, and the transverse one.
    for exponent in (0.0, transverse):
        assert np.abs(run.lyapunov_exponent - exponent).min() < 2e-4
    assert (transverse > 0.0) == (run.lyapunov_exponent[0] > 1e-3)


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
    """Between two instants with m blocks stuck the flow maps 2N − m dimensions to as many."""
    model = Model(law, a=a, blocks=blocks, contact=contact)
    states = [later(model, model.begin(wave(blocks)), 200.0)]
    for _ in range(800):
        states.append(later(model, states[-1], 0.05))
    most = max(int(state.stuck.sum()) for state in states)
    assert most >= 1
    chosen = next(k for k, state in enumerate(states) if state.stuck.sum() == most)
    first = states[chosen]
    duration = 0.05 * max(k - chosen for k, state in enumerate(states) if (state.stuck == first.stuck).all())
    assert duration > 10.0
    growth = growth_from(model, first, duration, 2 * blocks)
    mask = np.concatenate([np.ones(blocks, dtype=bool), ~first.stuck])
    runner, _ = carry(model, first, duration, np.diag(mask.astype(float)))
    sign, logarithm = np.linalg.slogdet(runner.perturbations[np.ix_(mask, mask)])
    assert sign != 0
    assert growth["lost"] == most
    assert np.isneginf(growth["growth"][0]).sum() == most
    assert growth["growth"][0, : 2 * blocks - most].sum() == pytest.approx(logarithm, abs=1e-4)


@pytest.mark.parametrize(("law", "initial", "a"), [("linearized", "minus", 0.08), ("nonlinear", "plus", 0.08)])
def test_the_first_exponents_do_not_depend_on_how_many_are_computed(law, initial, a):
    runs = [simulate(Model(law, a=a), initial, events="none", lyapunov_exponents=count) for count in (0, 1, 2, 3, 6)]
    for run in runs:
        first = run.lyapunov_exponent[:3]
        assert np.allclose(first, runs[-1].lyapunov_exponent[: len(first)], rtol=0, atol=1e-9)
    assert len({run.mean_distance for run in runs}) == 1


def test_mirror_image(law):
    mirror = InitialState("mirror", PLUS.position[::-1], PLUS.velocity[::-1])
    run, other = (simulate(Model(law, a=0.08), initial, events="none") for initial in (PLUS, mirror))
    assert run.lyapunov_infinite_count == other.lyapunov_infinite_count
    assert np.abs(run.lyapunov_exponent - other.lyapunov_exponent).max() < 3e-4


@pytest.mark.parametrize("blocks", [2, 5])
def test_shorter_and_longer_chains(law, blocks):
    """Regular motion has at least one zero exponent, none above it, and 2N in all."""
    run = simulate(Model(law, a=0.05, blocks=blocks), wave(blocks), lyapunov_exponents=2 * blocks)
    exponent, error = run.lyapunov_exponent, run.lyapunov_error
    finite = np.isfinite(exponent)
    assert np.abs(exponent[finite]).min() < 3.0 * error[finite][np.abs(exponent[finite]).argmin()]
    assert (np.diff(exponent[finite]) < 3e-3).all()
    assert (~finite).sum() == run.lyapunov_infinite_count >= 1


def growth(model, start, edges, **options):
    """Return the growth of three perturbations, which start with the run, and the perturbations at the end."""
    exponents = Exponents(model.blocks, 3, 0.0, np.array(edges))
    runner = Runner(model, exponents=exponents, **options)
    runner.begin(start)
    assert runner.run(edges[-1]) == Status.COMPLETED
    assert exponents.results()["duration"] == pytest.approx(np.diff(edges), rel=1e-12)
    return exponents.results()["growth"], exponents.matrix()


BATCHED = {law: (law_of(law, a=0.2), 0.1) for law in LAWS} | {"quintic": (FormulaLaw("1 - a*u + 0.3*u**5", a=0.3), 0.5)}


@pytest.mark.parametrize("law", BATCHED)
@pytest.mark.parametrize("damping", [0.0, 0.05])
def test_batches_begin_and_end_at_their_edges(law, damping):
    """Against QR of finite differences over each batch: perturbed runs, which know of no perturbation."""
    law, v = BATCHED[law]
    model = Model(law, damping=damping, v=v)
    at = later(model, model.begin(PLUS), 37.0)
    start = ChainState(at.position, at.velocity, at.stuck)
    edges = [0.0, 5.3, 11.0, 16.2]
    found, _ = growth(model, start, edges)
    _, vectors = growth(model, start, [0.0, 1e-12])
    for (begin, end), batch in zip(pairwise(edges), found, strict=True):
        quotients = differences(model, start, end - begin, 1e-4)
        assert quotients is not None
        vectors, triangle = np.linalg.qr(quotients[0] @ vectors)
        assert np.abs(np.log(np.abs(np.diag(triangle))) - batch).max() < 1e-8
        at = later(model, start, end - begin)
        start = ChainState(at.position, at.velocity, at.stuck)


@pytest.mark.parametrize("law", BATCHED)
@pytest.mark.parametrize("groups", [True, False])
@pytest.mark.parametrize("blocks", [3, 24])
def test_growth_up_to_an_edge_is_that_of_a_run_that_ends_there(law, groups, blocks):
    law, v = BATCHED[law]
    model = Model(law, blocks=blocks, v=v)
    start = model.begin(wave(blocks))
    edges = np.linspace(0.0, 30.0, 11)
    found = np.cumsum(growth(model, start, edges, groups=groups)[0], axis=0)
    for edge, total in zip(edges[1:], found, strict=True):
        assert growth(model, start, [0.0, edge], groups=groups)[0][0] == pytest.approx(total, abs=1e-9)


@pytest.mark.parametrize("window", [1e-3, 0.5, 3.0])
@pytest.mark.parametrize("transient", [0.0, 100.0])
def test_windows_too_short_for_batches(law, transient, window):
    """The exponent is the growth of a real vector, and its error says how little a short window resolves."""
    run = simulate(Model(law, a=0.2), "plus", transient=transient, window=window, lyapunov_exponents=6)
    assert run.status == "completed"
    exponent, error = run.lyapunov_exponent, run.lyapunov_error
    assert (np.isnan(error) == np.isinf(exponent)).all()
    assert np.nanmin(error) >= np.log1p(window / (1.0 + transient)) / window
    # No perturbation grows faster than the largest rate of the equations, ω + a with ω² ≤ 6.
    assert not (exponent > 2.7).any()
    assert run.lyapunov_infinite_count == np.isinf(exponent).sum()


@pytest.mark.parametrize(
    ("limit", "settings", "count"),
    [
        (10, {"transient": 100.0}, 3),
        (2000, {"transient": 100.0}, 3),
        (None, {"transient": 10.0, "window": 20.0, "solver": "rk4", "step": 0.01}, 3),
        (None, {"transient": 10.0, "window": 20.0, "lyapunov_exponents": 0}, 0),
    ],
)
def test_runs_without_exponents(monkeypatch, limit, settings, count):
    """Some do not complete; in others no exponents are requested or possible."""
    if limit:
        monkeypatch.setattr("burridge_knopoff.running.runner.STEP_LIMIT", limit)
    run = simulate(Model("linearized", a=0.08), "plus", **settings)
    assert run.status == ("step_limit" if limit else "completed")
    assert run.lyapunov_exponent.shape == run.lyapunov_error.shape == (count,)
    assert run.batch_lyapunov_exponent.shape == (7, count)
    for values in (run.lyapunov_exponent, run.lyapunov_error, run.batch_lyapunov_exponent):
        assert np.isnan(values).all()
    assert run.lyapunov_infinite_count == -1


REGULAR = {
    "linearized": [("minus", 0.06, 1), ("plus", 0.1, 1), ("minus", 0.3, 1), ("plus", 0.06, 2)],
    "nonlinear": [("plus", 0.24, 1), ("plus", 0.06, 2), ("plus", 0.08, 2)],
}


@pytest.mark.parametrize(("law", "initial", "a", "zeros"), [(law, *case) for law in LAWS for case in REGULAR[law]])
def test_zero_exponents_of_regular_motion(law, initial, a, zeros):
    """One exponent belongs to the flow, a second one to a torus; both are 0 within their errors, the next is not."""
    run = simulate(Model(law, a=a), initial, events="none")
    exponent, error = run.lyapunov_exponent, run.lyapunov_error
    assert (np.abs(exponent[:zeros]) < 2.0 * error[:zeros]).all()
    assert exponent[zeros] < -10.0 * error[zeros]
    assert (error < 2e-3).all()


@pytest.mark.parametrize("alignment", [10.0, 1000.0])
def test_growth_like_a_power_of_time_is_within_the_error(alignment):
    """Linear growth gains ln(1 + T/A) in a window T after an alignment A, which batches alone take for an exponent."""
    run = simulate(Model("linearized", a=0.06), "plus", events="none", lyapunov_alignment=alignment)
    window = 7000.0
    statistical = run.batch_lyapunov_exponent.std(axis=0, ddof=1) / np.sqrt(7)
    expected = np.hypot(statistical, np.log(1.0 + window / (1.0 + alignment)) / window)
    assert run.lyapunov_error == pytest.approx(expected, rel=2e-3)
    batch = np.diff(np.log(1000.0 + np.linspace(0.0, window, 8))) / 1000.0
    assert batch.mean() > 3.0 * batch.std(ddof=1) / np.sqrt(7)


def most_stuck(run, begin_time):
    """Return the most blocks stuck at once after a time; every block slips at τ = 0."""
    stuck, most = np.zeros(run.model.blocks, dtype=bool), 0
    following = np.append(run.event_time[1:], np.inf)
    for time, next_time, block, kind in zip(run.event_time, following, run.event_block, run.event_kind, strict=True):
        stuck[block - 1] = kind == 0
        if next_time > max(time, begin_time):
            most = max(most, int(stuck.sum()))
    return most


@pytest.mark.parametrize(
    ("law", "initial", "a", "contact"),
    [
        *(("linearized", "minus", a, "one_sided") for a in (0.02, 0.08)),
        *(("linearized", "plus", a, "one_sided") for a in (0.08, 0.25)),
        *(("nonlinear", "plus", a, "one_sided") for a in (0.15, 0.25)),
        ("linearized", "plus", 0.2, "symmetric"),
        ("nonlinear", "plus", 0.15, "symmetric"),
    ],
)
def test_as_many_exponents_are_infinite_as_blocks_stick_at_once(law, initial, a, contact):
    run = simulate(Model(law, a=a, contact=contact), initial, events="all", lyapunov_exponents=6, transient=1000.0)
    expected = most_stuck(run, 1000.0)
    assert run.lyapunov_infinite_count == expected
    assert np.isneginf(run.lyapunov_exponent).tolist() == [False] * (6 - expected) + [True] * expected
    assert np.isneginf(run.batch_lyapunov_exponent).sum() == 7 * expected
    assert np.isnan(run.lyapunov_error[6 - expected :]).all()
    assert np.isfinite(run.lyapunov_error[: 6 - expected]).all()


def test_blocks_that_stick_only_in_the_transient_do_not_count():
    """Three blocks stuck at once before the window, one within it."""
    options = {"events": "all", "lyapunov_exponents": 6, "start": "tested", "transient": 2000.0}
    state = InitialState("held", (0.3, 0.3, 0.25), (0.1, 0.1, 0.1))
    assert (-Chain(3).stiffness @ state.position < 1.0).all()
    run, other = (
        simulate(Model("linearized", a=0.25), state, lyapunov_alignment=time, **options) for time in (2000.0, 500.0)
    )
    assert most_stuck(run, 1990.0) == run.lyapunov_infinite_count == 1
    assert np.isfinite(run.lyapunov_exponent[:5]).all()
    assert (np.abs(run.lyapunov_exponent[:5] - other.lyapunov_exponent[:5]) < 4.0 * other.lyapunov_error[:5]).all()


def test_parts_of_a_chain_lose_perturbations_one_after_the_other():
    """Block 2 sticks and separates its neighbours: block 1 stops and starts, then block 3 stops.

    At most two blocks stick at once, but block 3 cannot restore the directions that block 1 has lost, so that the map
    has rank 3. The remainders of the lost vectors are rounding errors and must not be taken for finite exponents.
    """
    model = Model("linearized", a=0.1, v=0.1)
    start = ChainState(np.array([0.17, 0.3, 0.345]), np.array([0.003, 0.0, 0.3]), np.array([False, True, False]))
    runner, events = carry(model, start, 1.0, np.diag([1.0, 1.0, 1.0, 1.0, 0.0, 1.0]))
    assert [event[1:] for event in events] == [(1, 0), (1, 1), (3, 0)]
    assert (np.linalg.svd(runner.perturbations, compute_uv=False) > 1e-12).sum() == 3
    growth = growth_from(model, start, 1.0, 6)
    assert growth["lost"] == 3
    assert np.isneginf(growth["growth"][0]).tolist() == [False] * 3 + [True] * 3
