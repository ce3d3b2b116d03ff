"""Quasi-static loading: the two-block map of Huang and Turcotte, ties, balances, exponents, and the limit of a slow
driver."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from burridge_knopoff import ChainState, Model, law_of
from burridge_knopoff.catalogue.events import record_events
from burridge_knopoff.catalogue.stability import event_exponents, event_multipliers
from burridge_knopoff.running.runner import Runner
from burridge_knopoff.running.status import Status
from tests.kernel.test_catalogue import at_rest, record_catalogue
from tests.refused import refused

# J. Huang and D. L. Turcotte, Nature 348 (1990) 234: Coulomb friction that drops to 1/1.25 as slip begins.
COULOMB = law_of("carlson_langer", a=0.0, sigma=0.2)


def two_blocks(coupling=3.25, v=0.01):
    return Model(COULOMB, blocks=2, coupling=coupling, pulling=1.0, threshold=(1.0, 2.25), v=v)


def resting(model, position, time=0.0):
    blocks = model.blocks
    return ChainState(
        np.asarray(position) - model.sliding_offset, np.zeros(blocks), np.ones(blocks, dtype=bool), time=time
    )


def slips(events):
    """Return the slips of two blocks in each event, shape (events, 2)."""
    table, event = np.zeros((len(events.time), 2)), np.repeat(np.arange(len(events.time)), events.blocks)
    table[event, events.slip_block - 1] = events.slip
    return table


def next_event(position, coupling, threshold=(1.0, 2.25), friction=0.8):
    """Return positions after the next event, and the slips: by SciPy, from stop to start to stop."""
    threshold = np.array(threshold)

    def force(y):
        return -y - coupling * (y - y[::-1])

    y = np.array(position, dtype=float)
    y -= (threshold - force(y)).min()
    slip = threshold - force(y) < 1e-12
    before, u = y.copy(), np.zeros(2)
    while slip.any():

        def motion(_, state, slip=slip):
            return np.concatenate([state[2:], np.where(slip, force(state[:2]) - friction * threshold, 0.0)])

        events = []
        for k in range(2):
            stop, start = (lambda _, s, k=k: s[2 + k]), (lambda _, s, k=k: threshold[k] - force(np.asarray(s[:2]))[k])
            events.append(stop if slip[k] else start)
            events[-1].terminal, events[-1].direction = True, -1
        # U' of a block that has just started leaves 0 upward.
        solution = solve_ivp(motion, (0.0, 20.0), [*y, *u], method="DOP853", rtol=1e-12, atol=1e-14, events=events)
        which = next(k for k in range(2) if len(solution.t_events[k]))
        y, u = solution.y[:2, -1], solution.y[2:, -1].copy()
        u[which] = 0.0
        slip[which] = not slip[which]
    return y, y - before


def test_two_blocks_of_huang_and_turcotte():
    """Different states lead to the same cycle of four events."""
    model = two_blocks()
    for position in ((-0.45, -1.02), (-0.55, -0.95)):
        events = record_events(
            model, resting(model, position), 5000.0, begin=4500.0, profiles=True, loading="quasistatic"
        )
        table = slips(events)[:4]
        assert np.allclose(table[table[:, 1] == 0.0], [[0.0941176, 0.0]] * 2, atol=1e-7)
        large = table[table[:, 1] > 0.0]
        assert np.allclose(large[np.argsort(large[:, 0])], [[0.4765242, 0.5799702], [0.5563011, 0.6410904]], atol=1e-7)
        begin, end = (float(events.time[k : k + 2].mean()) for k in (2, 6))
        runner = Runner(model, loading="quasistatic")
        runner.begin(resting(model, position))
        assert runner.run(begin) == Status.COMPLETED
        at = runner.state()
        multipliers = event_multipliers(model, ChainState(at.position, at.velocity, at.stuck, time=begin), end)
        assert multipliers == pytest.approx([0.58823, 0.0], abs=5e-6)


@pytest.mark.parametrize("coupling", [1.0, 2.2, 3.25, 6.0])
def test_events_of_two_blocks(coupling):
    """The events are compared one by one, since chaos makes the motions diverge."""
    model = two_blocks(coupling)
    events = record_events(model, resting(model, (-0.45, -1.02)), 900.0, profiles=True, loading="quasistatic")
    assert len(events.time) > 12
    moved = np.cumsum(slips(events), axis=0)
    for before, expected in list(zip(moved, slips(events)[1:], strict=False))[:12]:
        _, slip = next_event(np.array([-0.45, -1.02]) + before, coupling)
        assert np.allclose(slip, expected, rtol=0.0, atol=1e-9)


@pytest.mark.parametrize(("v", "multiplier"), [(1e-4, 0.5712), (3e-5, 0.5831)])
def test_a_slow_driver_tends_to_it(v, multiplier):
    model = two_blocks(v=v)
    start, end = resting(model, (-0.45, -1.02)), 60.0 / v
    events = record_events(model, start, end, begin=0.8 * end)
    begin, end = (float(events.time[k : k + 2].mean()) for k in (2, 6))
    runner = Runner(model)
    runner.begin(start)
    assert runner.run(begin) == Status.COMPLETED
    at = runner.state()
    values = event_multipliers(model, ChainState(at.position, at.velocity, at.stuck, time=begin), end, loading="steady")
    # The other one is 1, of a displacement along the motion.
    assert sorted(np.abs(values)) == pytest.approx([multiplier, 1.0], abs=5e-5)


def test_exponents_are_those_of_the_multipliers():
    model = two_blocks()
    start = resting(model, (-0.45, -1.02))
    time = record_events(model, start, 9000.0, begin=8000.0, loading="quasistatic").time
    end = 4000.0 + 40 * float(time[-1] - time[-5])
    spectrum = event_exponents(model, start, end, begin=4000.0, count=2)
    assert spectrum.events == 160
    assert spectrum.exponent[0] == pytest.approx(math.log(0.58823) / 4, abs=5e-6)
    assert spectrum.exponent[1] == -math.inf


@pytest.mark.parametrize("groups", [False, True])
def test_mirror_images_start_together(groups):
    model = Model("carlson_langer", a=1.0, sigma=0.05, blocks=8, coupling=3.0, pulling=1.0, v=0.01)
    half = np.array([-0.61, -0.83, -0.72, -0.94])
    _, runner, _ = record_catalogue(model, resting(model, [*half, *half[::-1]]), 300.0, groups, loading="quasistatic")
    assert len(runner.events()[0]) > 40
    assert np.array_equal(runner.state().position, runner.state().position[::-1])


@pytest.mark.parametrize("groups", [False, True])
def test_forces_and_displacements_balance(groups):
    model = Model("carlson_langer", a=1.0, blocks=12, coupling=5.0, pulling=1.0, v=0.02)
    start = at_rest(model)
    table, runner, (_, block, slip, _) = record_catalogue(model, start, 200.0, groups, loading="quasistatic")
    moved = runner.state().position - start.position + model.v * 200.0
    assert len(table["time"]) > 20
    assert np.allclose(np.bincount(block - 1, slip, 12), moved, rtol=0.0, atol=1e-12)


@pytest.mark.parametrize("groups", [False, True])
def test_the_released_energy_is_what_the_springs_lose(groups):
    """The driver stops, and does no work, while blocks slip."""
    model = Model("carlson_langer", a=1.0, blocks=12, coupling=5.0, pulling=1.0, v=0.02)
    start = resting(model, np.random.default_rng(1).uniform(-0.9, -0.6, 12))
    table, _, _ = record_catalogue(model, start, 60.0, groups, loading="quasistatic")
    assert len(table["time"]) > 10
    runner = Runner(model, loading="quasistatic", groups=groups)
    runner.begin(start)
    # The first one begins with the run.
    for time, released in zip(table["time"][1:], table["energy_released"][1:], strict=True):
        energies = []
        for at in (time - 1e-7, time + 1e-7):
            assert runner.run(float(at)) == Status.COMPLETED
            position = runner.state().position + model.sliding_offset
            energies.append(0.5 * position @ model.chain.stiffness @ position)
        # Meanwhile the driver advances by 2e-7 v against the force of its springs, at most 12.
        assert energies[0] - energies[1] == pytest.approx(released, rel=1e-12, abs=12 * 2e-7 * model.v)


def test_groups_and_the_chain_as_a_whole_have_the_same_events():
    model = Model("carlson_langer", a=2.0, blocks=40, coupling=20.0, pulling=1.0, v=0.01)
    grouped, ungrouped = (
        record_catalogue(model, at_rest(model), 30.0, groups, loading="quasistatic")[0] for groups in (True, False)
    )
    assert len(grouped["time"]) == len(ungrouped["time"]) > 20
    for name, values in grouped.items():
        assert np.allclose(values, ungrouped[name], rtol=1e-6, atol=1e-8, equal_nan=True), name


@pytest.mark.parametrize("blocks", [3, 40])
def test_consecutive_runs_have_the_catalogue_of_the_whole_run(blocks):
    model = Model("carlson_langer", a=2.0, blocks=blocks, coupling=20.0, pulling=1.0, v=0.01)
    whole = record_events(model, at_rest(model), 400.0, loading="quasistatic")
    parts, at = [], at_rest(model)
    for end in (37.7, 101.0, 400.0):
        parts.append(record_events(model, at, end, loading="quasistatic"))
        at = parts[-1].final
    assert len(whole.time) > 30
    for name in ("time", "slip_time", "duration", "moment", "energy_released", "interval"):
        values = np.concatenate([getattr(part, name) for part in parts])
        exact = name != "energy_released"
        assert np.allclose(values, getattr(whole, name), rtol=0.0 if exact else 1e-12, atol=0.0, equal_nan=True), name


def test_friction_that_does_not_drop_is_refused():
    model = Model("nonlinear", a=0.1)
    with refused("loading", "nonlinear"):
        record_events(model, at_rest(model), 10.0, loading="quasistatic")
