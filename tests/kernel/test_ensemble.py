"""Trajectories in lanes: the events of the scalar kernel, and the same bits whatever goes on in other lanes."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from burridge_knopoff.laws import FormulaLaw, law_of
from burridge_knopoff.model.chain import Chain
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.model.model import Instant, Model
from burridge_knopoff.provenance.compilation import vector_flags
from burridge_knopoff.running.runner import Runner
from burridge_knopoff.running.together import new_ensemble
from tests.kernel.test_events import GRAZES

A = 0.3

# 1/(1 + a u) in other operations.
SAME_LAW = {
    "powers": "(1 + a*u)**-1.5*sqrt(1 + a*u)",
    "exp log": "exp(-log(1 + a*u))",
    "square of a root": "((1 + a*u)**-0.5)**2",
    "difference": "2/(1 + a*u) - 1/(1 + a*u)",
}


def states(model, count, seed=1):
    """Positions, velocities and which blocks stick, drawn at random."""
    generator = np.random.default_rng(seed)
    blocks = model.chain.blocks
    least = -0.1 if model.contact == "symmetric" else 0.0
    position = generator.uniform(-1.5, 1.0, (count, blocks)) - model.sliding_offset
    velocity = generator.uniform(least, 0.2, (count, blocks))
    return position, velocity, generator.random((count, blocks)) < 0.2


def scalar_run(model, position, velocity, stuck, end):
    """Return the solver at the end, the times, blocks and kinds of its events, and why it ended."""
    solver = Runner(model, keep_events=True)
    solver.begin(Instant(position, np.where(stuck, 0.0, velocity), stuck))
    code = solver.run(end)
    return solver, *solver.events(), code


def check_against_scalar(model, ensemble, count, end, seed=1):
    position, velocity, stuck = states(model, count, seed)
    found = ensemble.run(position, velocity, stuck, [end], events=3000)
    total = 0
    # With a slow driver forces come to their thresholds slowly: their rounding makes more of a difference.
    tolerance = 1e-12 * max(1.0, 0.1 / model.v)
    for k in range(count):
        solver, times, block, kind, code = scalar_run(model, position[k], velocity[k], stuck[k], end)
        n = len(times)
        assert (found["event_count"][k], found["status"][k]) == (n, code)
        assert found["event_block"][k, :n].tolist() == (block + 1).tolist()
        assert found["event_kind"][k, :n].tolist() == kind.tolist()
        assert np.abs(found["event_time"][k, :n] - times).max(initial=0.0) < tolerance
        x, w, slip = solver.kernel.state.values()
        assert max(np.abs(found["position"][k, 0] - x).max(), np.abs(found["velocity"][k, 0] - w).max()) < 1e-12
        assert (found["slip"][k, 0] == slip).all()
        total += n
    return total


@pytest.mark.parametrize("contact", ["one_sided", "symmetric"])
@pytest.mark.parametrize("blocks", [2, 3, 5, 8])
@pytest.mark.parametrize("law", ["linearized", "nonlinear"])
@pytest.mark.parametrize("a", [0.02, 0.08, A])
def test_events_of_random_states(law, blocks, contact, a):
    model = Model(Chain(blocks), law_of(law, a), 0.1, contact)
    assert check_against_scalar(model, new_ensemble(model), 40, 12.0) > 100


@pytest.mark.parametrize("v", [0.003, 0.5])
def test_slow_and_fast_drivers(v):
    model = Model(Chain(3), law_of("nonlinear", 0.1), v)
    assert check_against_scalar(model, new_ensemble(model), 20, 1.0 / v) > 50


@pytest.mark.parametrize("name", SAME_LAW)
def test_a_law_in_other_operations(name):
    model, other = (Model(Chain(3), law) for law in (law_of("nonlinear", A), FormulaLaw(A, SAME_LAW[name])))
    assert check_against_scalar(model, new_ensemble(other), 30, 10.0) > 100


def independent_events(springs, threshold, law, v, position, velocity, end):
    """The events of a chain by SciPy, (time, block from 1, kind), from positions x_i with all blocks slipping."""
    matrix, sliding = springs
    blocks = len(threshold)
    events, clock, state = [], 0.0, np.concatenate([position, velocity])
    slips = np.ones(blocks, dtype=bool)

    def rate(_, y):
        force = sliding - matrix @ y[:blocks]
        return np.concatenate([y[blocks:] - v, np.where(slips, force - threshold * law(y[blocks:]), 0.0)])

    def gap(i):
        def value(_, y):
            return y[blocks + i] if slips[i] else threshold[i] - sliding[i] + matrix[i] @ y[:blocks]

        value.terminal, value.direction = True, -1
        return value

    while True:
        gaps = [gap(i) for i in range(blocks)]
        piece = solve_ivp(rate, (clock, end), state, "DOP853", events=gaps, rtol=1e-12, atol=1e-13, max_step=0.02)
        clock, state = piece.t[-1], piece.y[:, -1]
        if piece.status == 0:
            return events
        i = next(k for k, times in enumerate(piece.t_events) if len(times))
        slips[i] = not slips[i]
        state[blocks + i] = 0.0
        events.append((clock, i + 1, int(slips[i])))


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("ring", [False, True])
@pytest.mark.parametrize("drop", [0.0, 0.1])
def test_unequal_springs_and_thresholds_and_a_drop_at_the_start(drop, ring, seed):
    """Φ = (1 − drop) exp(−u / 2), on a ring and on an open chain whose blocks and springs are all different."""
    generator = np.random.default_rng(seed)
    blocks, v = 4, 0.1
    chain = Chain(
        blocks,
        coupling=generator.uniform(0.5, 1.5, blocks if ring else blocks - 1),
        pulling=generator.uniform(0.5, 1.5, blocks),
        threshold=generator.uniform(0.8, 1.2, blocks),
        ends="ring" if ring else "open",
    )
    law = FormulaLaw(0.5, "(1 - drop)*exp(-a*u)", drop=drop)
    ensemble = new_ensemble(Model(chain, law, v))
    matrix, threshold = chain.stiffness, chain.thresholds
    position, velocity = generator.uniform(-0.4, 0.4, (2, blocks)), generator.uniform(0.05, 0.2, (2, blocks))
    found = ensemble.run(position, velocity, np.zeros((2, blocks)), [12.0], events=100)
    for k in range(2):
        expected = independent_events((matrix, threshold * law(v)), threshold, law, v, position[k], velocity[k], 12.0)
        n = len(expected)
        assert n == found["event_count"][k] > 8
        times, numbers, kinds = zip(*expected, strict=True)
        assert found["event_block"][k, :n].tolist() == list(numbers)
        assert found["event_kind"][k, :n].tolist() == list(kinds)
        assert np.abs(found["event_time"][k, :n] - times).max() < 1e-8


def members(result, order=slice(None)):
    """The bits of all that was found, of the members in some order."""
    return {key: value[order].tobytes() for key, value in result.items()}


CASES = [("linearized", 3, "one_sided"), ("nonlinear", 5, "one_sided"), ("nonlinear", 3, "symmetric")]


@pytest.mark.parametrize(("law", "blocks", "contact"), CASES)
def test_no_lane_depends_on_another(law, blocks, contact):
    """Whatever the order, in whatever company: alone, in threes, or all of them."""
    model = Model(Chain(blocks), law_of(law, 0.2), 0.1, contact)
    start = states(model, 37)
    times = [0.5, 7.0, 30.0]
    whole = new_ensemble(model).run(*start, times, events=20)
    order = np.random.default_rng(3).permutation(37)
    assert members(new_ensemble(model).run(*(part[order] for part in start), times, events=20)) == members(whole, order)
    for size in (1, 3):
        ensemble = new_ensemble(model)
        for k in range(0, 37 - size, size):
            some = slice(k, k + size)
            assert members(ensemble.run(*(part[some] for part in start), times, events=20)) == members(whole, some)


@pytest.mark.parametrize(("law", "blocks", "contact"), CASES)
def test_the_end_only_cuts_off(law, blocks, contact):
    model = Model(Chain(blocks), law_of(law, 0.2), 0.1, contact)
    start = states(model, 20)
    ensemble = new_ensemble(model)
    times = np.linspace(0.3, 25.0, 40)
    long = ensemble.run(*start, [*times, 40.0], events=300)
    assert members({"x": ensemble.run(*start, times)["position"]}) == members({"x": long["position"][:, :-1].copy()})
    for end in (1.0, 11.1):
        short = ensemble.run(*start, [end], events=300)
        for k in range(20):
            n = short["event_count"][k]
            assert n == np.count_nonzero(long["event_time"][k] <= end)
            assert (short["event_time"][k, :n] == long["event_time"][k, :n]).all()


@pytest.mark.parametrize(("law", "blocks", "contact"), CASES)
def test_mirror_images_move_as_mirror_images(law, blocks, contact):
    """To the bit; and a state that is its own image stays so."""
    model = Model(Chain(blocks), law_of(law, 0.2), 0.1, contact)
    start = states(model, 30)
    ensemble = new_ensemble(model)
    straight = ensemble.run(*start, [3.0, 25.0])
    mirrored = ensemble.run(*(part[:, ::-1] for part in start), [3.0, 25.0])
    for key in ("position", "velocity", "slip"):
        assert (straight[key] == mirrored[key][:, :, ::-1]).all()
    own = [np.where(np.arange(blocks) < blocks // 2, part[:, ::-1], part) for part in start]
    found = ensemble.run(*own, [25.0, 200.0])
    for key in ("position", "velocity", "slip"):
        assert (found[key] == found[key][:, :, ::-1]).all()


@pytest.mark.parametrize(("law", "initial", "before", "after"), GRAZES)
def test_grazing_touches(law, initial, before, after):
    """Where a touch has just become a stick as short as 0.0013, and where it has not yet."""
    state = PAPER_STATES[initial]
    counts = []
    for a in (before, after):
        model = Model(Chain(3), law_of(law, a))
        start = model.begin(state)
        found = new_ensemble(model).run(start.position[None], start.velocity[None], start.stuck[None], [200.0])
        counts.append(int(found["event_count"][0]))
        assert counts[-1] == len(scalar_run(model, start.position, start.velocity, start.stuck, 200.0)[1])
    assert counts[1] >= counts[0] + 2


def test_threads_share_the_work():
    model = Model(Chain(3), law_of("nonlinear", 0.2))
    start = states(model, 64)
    whole = new_ensemble(model).run(*start, [50.0])

    def part(k):
        return new_ensemble(model).run(*(values[k::4] for values in start), [50.0])

    with ThreadPoolExecutor(4) as pool:
        for k, found in enumerate(pool.map(part, range(4))):
            assert members(found) == members(whole, slice(k, None, 4))


def test_a_trajectory_without_bound_ends_alone():
    """A fast block under a law that drives it ever faster ends as diverged, beside one that goes on."""
    model = Model(Chain(3), law_of("linearized", 1.9), 0.1, "symmetric")
    position, velocity = np.array([[5.0, -5.0, 5.0], [0.0, 0.0, 0.0]]), np.array([[3.0, -3.0, 3.0], [0.1, 0.1, 0.1]])
    found = new_ensemble(model).run(position, velocity, np.zeros((2, 3)), [1.0, 300.0])
    alone = new_ensemble(model).run(position[1:], velocity[1:], np.zeros((1, 3)), [1.0, 300.0])
    assert found["status"][0] == 3
    assert found["end"][0] < 300.0
    assert np.isnan(found["position"][0, 1]).all()
    assert members(found, slice(1, 2)) == members(alone)


@pytest.mark.parametrize("lanes", ["2", "4", "8", None, "3", ""])
def test_flags_for_vectors(monkeypatch, lanes):
    monkeypatch.setattr("platform.machine", lambda: "x86_64")
    monkeypatch.delenv("BURRIDGE_KNOPOFF_LANES", raising=False)
    if lanes is not None:
        monkeypatch.setenv("BURRIDGE_KNOPOFF_LANES", lanes)
    if lanes in ("3", ""):
        with pytest.raises(ValueError, match=f"BURRIDGE_KNOPOFF_LANES: '{lanes}' is not allowed: 2 | 4 | 8"):
            vector_flags()
    else:
        assert vector_flags()[0].startswith("-march=")
    monkeypatch.setattr("platform.machine", lambda: "arm64")
    assert vector_flags() == ()
