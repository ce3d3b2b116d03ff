"""Creep under quasi-static loading: closed forms, the forces on blocks that creep, and the limit of a slow driver."""

from dataclasses import replace

import numpy as np
import pytest

from burridge_knopoff import Chain, FormulaLaw, InitialState, Model, event_exponents, law_of, record_events
from burridge_knopoff.model.model import CONTACTS
from burridge_knopoff.running.runner import Runner
from burridge_knopoff.running.status import Status
from tests.kernel.test_catalogue import record_catalogue
from tests.kernel.test_quasistatic import resting

GROUPS = pytest.mark.parametrize("groups", [False, True])


def state_at(model, position, displacement, groups=False):
    """Return the state of a chain of resting blocks after a displacement of the driver."""
    runner = Runner(model, loading="quasistatic", groups=groups)
    runner.begin(resting(model, position))
    assert runner.run(displacement / model.v) == Status.COMPLETED
    return runner.state()


@pytest.mark.parametrize("v", [1e-4, 1e-2, 1.0])
@pytest.mark.parametrize("drag", [2.0, 2.5, 60.0])
@GROUPS
def test_one_overdamped_block_slips_once_and_then_creeps(v, drag, groups):
    """u'' + (c − a) u' + u = 0 with c − a ≥ 2: its force stays at θ Φ(0), and its slip event never ends."""
    law = law_of("carlson_langer", a=0.5, sigma=0.2)
    assert float(law.slope(0.0)) == -0.5
    model = Model(law, blocks=1, pulling=1.0, pulling_damping=drag + 0.5, v=v)
    table, runner, _ = record_catalogue(model, resting(model, [-0.9]), 3.0 / v, groups, loading="quasistatic")
    assert len(table["time"]) == 0
    assert runner.state().stuck.tolist() == [False]
    assert runner.state().position + model.sliding_offset == pytest.approx(-0.8, abs=1e-14)


def test_friction_that_grows_with_speed_damps_as_a_dashpot():
    """Φ = 0.9 + u resists like a dashpot of 1: 2.5 times that overdamps, and 0.5 times does not."""
    for formula, weakening in (("0.9 + a*u", 1.0), ("0.9 - a*u", -1.0)):
        for a, events in ((2.5, 0), (0.5, 21)):
            model = Model(FormulaLaw(formula, a=a), blocks=1, pulling=1.0, weakening=weakening, v=0.1)
            assert len(record_events(model, resting(model, [-0.9]), 30.0, loading="quasistatic").time) == events


def dashed(form, generator, drag):
    """Return a chain with dashpots of about this damping ratio between its blocks and to the driver."""
    blocks = {"row": 5, "ring": 6, "grid": 6}[form]
    coupling, share = generator.uniform(1.0, 5.0), generator.uniform(0.3, 1.0)
    options = {"ends": "ring"} if form == "ring" else {"grid": (3, 2)} if form == "grid" else {}
    return Chain(
        blocks,
        coupling=coupling,
        pulling=1.0,
        damping=drag * share * 2.0 * np.sqrt(coupling),
        pulling_damping=tuple(drag * generator.uniform(0.0, 2.0, blocks)),
        mass=tuple(generator.uniform(0.5, 2.0, blocks)),
        **options,
    )


def first_changes(seed, form, drag, contact, groups):
    """Return the starts and stops of a chain quasi-statically, and behind two slow drivers as long as they agree.

    A block whose speed would fall below 0 by less than the velocity of the driver does not stop, however small it is.
    With these thresholds, velocities are relative to a slip speed of about 10.
    """
    generator = np.random.default_rng(seed)
    chain = dashed(form, generator, drag)
    chain = replace(chain, threshold=1e3)
    law = law_of("carlson_langer", a=1e-3 * generator.uniform(0.1, 1.0), sigma=0.05)
    position = 1e3 * generator.uniform(-0.5, -0.4, chain.blocks)
    changes = []
    for v, loading in ((1.0, "quasistatic"), (1e-3, "steady"), (1e-4, "steady")):
        model = Model(law, chain=chain, v=v, contact=contact)
        _, runner, _ = record_catalogue(model, resting(model, position), 600.0 / v, groups, loading=loading)
        changes.append(list(zip(*runner.events()[1:], strict=True)))
    quasistatic, slow, slower = changes
    same = next((k for k, (one, other) in enumerate(zip(slow, slower, strict=False)) if one != other), len(slower))
    return quasistatic[:same], slower[:same]


# In these a speed falls below 0 by less than the slower driver moves, and by much more than rounding.
HIDDEN = {("row", 7), ("grid", 3)}
CHAINS = [(form, seed) for form in ("row", "ring", "grid") for seed in range(8) if (form, seed) not in HIDDEN]


@pytest.mark.slow
@pytest.mark.parametrize(("form", "seed"), CHAINS)
def test_it_is_the_limit_of_a_slow_driver(form, seed):
    """On both sides of critical damping."""
    drag, contact, groups = (0.2, 0.6, 1.2, 2.0)[seed % 4], CONTACTS[seed // 4 % 2], seed // 2 % 2 == 1
    quasistatic, slow = first_changes(seed, form, drag, contact, groups)
    assert quasistatic == slow


@pytest.mark.parametrize(("form", "drag"), [("row", 0.3), ("grid", 0.3), ("row", 1.0), ("ring", 1.0)])
@GROUPS
def test_slow_drivers_start_and_stop_the_same_blocks(form, drag, groups):
    quasistatic, slow = first_changes(2, form, drag, "one_sided", groups)
    assert len(slow) > 10
    assert quasistatic == slow


@pytest.mark.slow
@GROUPS
def test_events_of_a_slow_driver(groups):
    """Sizes, energies and times converge in proportion to the velocity of the driver."""
    tables = []
    for v, loading in ((0.01, "quasistatic"), (1e-4, "steady"), (1e-5, "steady"), (1e-6, "steady")):
        model, start = overdamped(6)
        model = model.at(v=v)
        again = resting(model, start.position + overdamped(6)[0].sliding_offset)
        table, _, _ = record_catalogue(model, again, 1.5 / v, groups, loading=loading)
        order = np.argsort(table["time"], kind="stable")
        names = ("moment", "peak_velocity", "stress_drop", "energy_released", "energy_damped")
        tables.append(np.array([v * table["time"], *(table[name] for name in names)])[:, order])
    errors = [np.abs(table - tables[0]).max() for table in tables[1:]]
    assert tables[0].shape[1] > 2
    assert errors[0] > 4.0 * errors[1] > 16.0 * errors[2]
    assert errors[2] < 1e-3


def creeping(displacement):
    """Return a chain, its positions at rest, and its state after a displacement at which blocks creep."""
    generator = np.random.default_rng(4)
    damping, pulling = generator.uniform(5.0, 8.0, 5), generator.uniform(0.5, 1.0, 6)
    chain = Chain(6, coupling=tuple(generator.uniform(3.0, 4.0, 5)), pulling=tuple(pulling), damping=tuple(damping))
    model = Model("carlson_langer", a=0.5, sigma=0.1, chain=chain, v=1.0)
    start = -0.9 / np.array(pulling) + np.array([0.0, 0.0, 0.05, 0.0, 0.05, 0.05])
    return model, start, state_at(model, start, displacement)


@GROUPS
def test_blocks_that_creep_stay_at_their_threshold(groups):
    """Between two events K_CC dU_C = D_C dX, and the next block starts where the force on it reaches its threshold."""
    model, position, _ = creeping(0.0)
    chain, stiffness = model.chain, model.chain.stiffness
    runner = Runner(model, loading="quasistatic", groups=groups, keep_events=True)
    runner.begin(resting(model, position))
    compared, before = 0, None
    for displacement in np.arange(0.01, 0.6, 0.01):
        assert runner.run(displacement / model.v) == Status.COMPLETED
        now, count = runner.state(), runner.log.count
        absolute, creeps = now.position + displacement, ~now.stuck
        force = chain.driving * displacement - stiffness @ (absolute + model.sliding_offset)
        assert force[creeps] == pytest.approx(np.full(creeps.sum(), float(model.law(0.0))), abs=1e-13)
        assert (force[now.stuck] < 1.0).all()
        assert (now.velocity == 0.0).all()
        if before is not None and before[1] == count and creeps.any():
            moved = np.zeros(6)
            moved[creeps] = np.linalg.solve(stiffness[np.ix_(creeps, creeps)], 0.01 * chain.driving[creeps])
            assert absolute - before[0] == pytest.approx(moved, abs=1e-13)
            compared += 1
        before = absolute, count
    assert compared > 15
    assert runner.log.count > 4


def test_perturbations_of_blocks_that_creep():
    """They are those of finite differences, but for the driver, whose displacement since the last event is its own."""
    model, position, state = creeping(0.12)
    creeps = ~state.stuck
    assert creeps.any()
    assert not creeps.all()
    runner = Runner(model, loading="quasistatic", groups=False, perturbations=np.vstack([np.eye(6), np.zeros((6, 6))]))
    runner.begin(resting(model, position))
    assert runner.run(0.12) == Status.COMPLETED
    pairs = [
        [state_at(model, position + side * row, 0.12).position for side in (1.0, -1.0)] for row in 1e-6 * np.eye(6)
    ]
    difference = np.array([(one - other) / 2e-6 for one, other in pairs]).T
    rate = np.ones(6)
    stiffness = model.chain.stiffness
    rate[creeps] -= np.linalg.solve(stiffness[np.ix_(creeps, creeps)], model.chain.driving[creeps])
    driver = rate @ (difference - runner.perturbations[:6]) / (rate @ rate)
    assert np.allclose(difference - runner.perturbations[:6], np.outer(rate, driver), rtol=0.0, atol=1e-6)
    assert np.abs(runner.perturbations[6:]).max() == 0.0


def test_creep_removes_perturbations():
    """More exponents are −∞ than the one of a threshold."""
    generator = np.random.default_rng(0)
    coupling, damping = 9.0 * generator.uniform(0.5, 1.5, 3), 6.0 * generator.uniform(0.5, 1.5, 3)
    mass = generator.uniform(0.7, 1.4, (2, 4))[1]
    chain = Chain(4, coupling=tuple(coupling), pulling=1.0, damping=tuple(damping), mass=tuple(mass))
    model = Model("carlson_langer", a=1.0, sigma=0.05, chain=chain, v=1.0)
    start = resting(model, generator.uniform(-0.6, -0.5, 4))
    spectrum = event_exponents(model, start, 40.0, begin=5.0, count=4)
    assert 1 < np.isinf(spectrum.exponent).sum() < 4


@GROUPS
def test_v_only_scales_the_loading_clock(groups):
    chain = Chain(6, coupling=2.0, pulling=1.0, pulling_damping=(0.5, 0.2, 3.0, 0.0, 2.0, 0.4))
    rough = InitialState("rough", {"random": "uniform", "low": -0.62, "high": -0.6, "seed": 3}, 0.0)
    tables = []
    for v in (1.0, 1e-3):
        model = Model("carlson_langer", a=0.5, sigma=0.05, chain=chain, v=v)
        start = model.begin(rough, "tested", "quasistatic")
        assert start.stuck.all()
        table, _, _ = record_catalogue(model, start, 0.5 / v, groups, loading="quasistatic")
        tables.append(np.array([table["time"] * v, table["moment"], table["duration"], table["interval"] * v]))
    assert tables[0].shape[1] > 10
    assert np.allclose(*tables, rtol=1e-9, atol=1e-12, equal_nan=True)


@pytest.mark.parametrize("v", [1.0, 1e-3])
def test_a_driver_at_rest_pulls_by_no_dashpot(v):
    model = Model("carlson_langer", a=3.0, blocks=1, pulling=1.0, pulling_damping=0.5, v=v)
    state = InitialState("own", (-0.9,), (v,))
    assert model.begin(state, "tested").stuck.tolist() == [v < 0.1]
    start = model.begin(state, "tested", "quasistatic")
    events = record_events(model, start, 3.0 / v, loading="quasistatic")
    assert events.time[0] * v == pytest.approx(0.1, rel=1e-12)


def overdamped(blocks):
    """Return a row in which single blocks and pairs creep, and a rough state of rest."""
    chain = Chain(blocks, coupling=9.0, pulling=1.0, damping=8.0, pulling_damping=0.5)
    model = Model("carlson_langer", a=2.0, sigma=0.05, chain=chain, v=0.01)
    return model, resting(model, np.random.default_rng(blocks).uniform(-0.7, -0.6, blocks))


def test_groups_and_the_chain_as_a_whole_have_the_same_events():
    model, start = overdamped(40)
    tables = []
    for groups in (True, False):
        table, _, _ = record_catalogue(model, start, 45.0, groups, loading="quasistatic")
        order = np.lexsort((table["epicentre"], table["time"]))[:12]
        tables.append({name: values[order] for name, values in table.items()})
    assert len(tables[0]["time"]) == 12
    for name, values in tables[0].items():
        assert np.allclose(values, tables[1][name], rtol=1e-6, atol=1e-6, equal_nan=True), name


@pytest.mark.parametrize("blocks", [6, 40])
def test_consecutive_runs_have_the_catalogue_of_the_whole_run(blocks):
    model, start = overdamped(blocks)
    whole = record_events(model, start, 90.0, loading="quasistatic")
    parts, at, creep = [], start, 0
    for end in (17.7, 24.0, 31.0, 60.1, 90.0):
        parts.append(record_events(model, at, end, loading="quasistatic"))
        at = parts[-1].final
        creep += np.sum(~at.stuck)
    assert creep > 0
    assert len(whole.time) > 2
    for name in ("time", "slip_time", "duration", "moment", "interval"):
        values = np.concatenate([getattr(part, name) for part in parts])
        assert np.array_equal(np.sort(values), np.sort(getattr(whole, name)), equal_nan=True), name
    assert np.array_equal(at.position, whole.final.position)


@GROUPS
def test_mirror_images_creep_together(groups):
    model, _ = overdamped(8)
    half = np.array([-0.7, -0.66, -0.62, -0.68])
    _, runner, _ = record_catalogue(model, resting(model, [*half, *half[::-1]]), 60.0, groups, loading="quasistatic")
    assert len(runner.events()[0]) > 10
    assert np.array_equal(runner.state().position, runner.state().position[::-1])


@GROUPS
def test_work_of_the_springs_balances(groups):
    """The driver works only while blocks stick or creep: what the springs lose and it adds is released."""
    model, start = overdamped(6)
    table, _, _ = record_catalogue(model, start, 60.0, groups, loading="quasistatic")
    runner = Runner(model, loading="quasistatic", groups=groups)
    runner.begin(start)
    chain = model.chain
    energy, pull, rests = [], [], []
    for time in np.arange(0.0, 60.0, 2e-3):
        state = start
        if time > 0.0:
            assert runner.run(float(time)) == Status.COMPLETED
            state = runner.state()
        position = state.position + model.sliding_offset
        energy.append(0.5 * position @ chain.stiffness @ position)
        pull.append(-chain.driving @ position)
        rests.append(state.stuck.all())
    last = np.flatnonzero(rests)[-1]
    assert not all(rests[:last])
    work = np.trapezoid(pull[: last + 1], dx=2e-3 * model.v)
    released = table["energy_released"][table["time"] < 2e-3 * last].sum()
    assert released > 1.0
    assert released == pytest.approx(energy[0] - energy[last] + work, rel=1e-4)


@pytest.mark.parametrize("v", [1e-3, 1e-4, 1e-5])
def test_a_block_without_a_spring_to_the_driver_does_not_stop_by_rounding(v):
    """Behind a driver that moves too, its speed tends to 0 while its neighbours stick."""
    law = law_of("carlson_langer", a=0.5, sigma=0.1)
    for pulling, drag, position in (((1.0, 0.0), (0.0, 4.0), (0.0, -0.5)), ((1.0, 0.0, 0.0), (0.0, 3.0, 3.0), None)):
        chain = Chain(len(pulling), coupling=1.0, pulling=pulling, pulling_damping=drag)
        tables = []
        for speed, loading in ((1.0, "quasistatic"), (v, "steady")):
            model = Model(law, chain=chain, v=speed)
            start = resting(model, position or (-0.5, -1.2, -1.8))
            tables.append(record_events(model, start, 8.0 / speed, loading=loading))
        assert len(tables[0].time) == len(tables[1].time) > 2
        assert np.allclose(tables[0].moment, tables[1].moment, rtol=0.05 if v > 1e-4 else 5e-3)
