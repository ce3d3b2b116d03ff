"""Catalogues of slip events: one block in closed form, balances of slip and energy, connection in space and time."""

from itertools import pairwise

import numpy as np
import pytest
from mpmath import mp

from burridge_knopoff import ChainState, Model
from burridge_knopoff.kernel._core import Catalogue
from burridge_knopoff.running.runner import Runner
from burridge_knopoff.running.status import Status
from burridge_knopoff.values import MOST_NUMBERS


def record_catalogue(model, start, end, groups=None, stops=(), loading="steady"):
    """Return the catalogue of a run, in the order of the events, the solver at its end, and the profiles.

    The profiles are in the order in which the events end.
    """
    catalogue = Catalogue(model.blocks, 0.0, True, MOST_NUMBERS)
    runner = Runner(model, groups=groups, keep_events=True, catalogue=catalogue, loading=loading)
    runner.begin(start)
    for time in (*stops, end):
        assert runner.run(time) == Status.COMPLETED
    table = catalogue.take()
    order = np.argsort(table["time"], kind="stable")
    profiles = [table.pop(name) for name in ("slip_end", "slip_block", "slip", "slip_onset")]
    return {name: column[order] for name, column in table.items()}, runner, profiles


def at_rest(model, seed=1, spread=0.05):
    generator = np.random.default_rng(seed)
    position = generator.uniform(-0.95 - spread, -0.95, model.blocks) - model.sliding_offset
    return ChainState(position, np.zeros(model.blocks), np.ones(model.blocks, dtype=bool))


def last_rest(model, start, end):
    """Return a time, before the end, at which no block slips."""
    runner = Runner(model, keep_events=True)
    runner.begin(start)
    assert runner.run(end) == Status.COMPLETED
    time, _, kind = runner.events()
    return float(time[np.flatnonzero(np.cumsum(np.where(kind == 1, 1, -1)) == 0)[-1]]) + 1e-6


@pytest.mark.parametrize("v", [1e-4, 1e-2, 0.1, 1.0])
@pytest.mark.parametrize("a", [0.1, 1.5])
def test_one_block_in_closed_form(v, a):
    """From its threshold y'' = vt − y + ay' with y = y' = 0; it stops when y' is 0 again and starts after slip/v."""
    with mp.workdps(30):
        half, omega = mp.mpf(a) / 2, mp.sqrt(1 - mp.mpf(a) ** 2 / 4)

        def y(t):
            turning = mp.exp(half * t) * (a * mp.cos(omega * t) + (1 - half * a) / omega * mp.sin(omega * t))
            return v * (t + a - turning)

        def first(falling):
            low = next(t for t in mp.linspace(0.1, 20, 400) if falling(t + mp.mpf("0.05")) < 0 < falling(t))
            return mp.findroot(falling, (low, low + mp.mpf("0.05")), solver="anderson")

        duration = first(lambda t: mp.diff(y, t))
        slip = y(duration)
        peak = mp.diff(y, first(lambda t: mp.diff(y, t, 2)))
        slip, duration, peak = float(slip), float(duration), float(peak)
    model = Model("linearized", a=a, blocks=1, pulling=1.0, v=v)
    table, _, _ = record_catalogue(model, at_rest(model, spread=0.0), 0.2 / v + 5.5 * max(slip / v, duration))
    assert len(table["time"]) >= 5
    assert np.allclose(table["moment"], slip, rtol=1e-12, atol=1e-15)
    assert np.allclose(table["duration"], duration, rtol=1e-10)
    assert np.allclose(table["peak_velocity"], peak, rtol=1e-12)
    assert np.allclose(table["interval"][1:], slip / v, rtol=1e-11)
    assert np.allclose(table["stress_drop"], slip, rtol=1e-12)
    assert (table["blocks"] == 1).all()
    # The work of friction: ∫ (1 − aU') U' dτ.
    with mp.workdps(20):
        lost = float(mp.quad(lambda t: (1 - a * mp.diff(y, t)) * mp.diff(y, t), [0, duration / 2, duration]))
    assert np.allclose(table["energy_released"], lost, rtol=1e-9)


@pytest.mark.parametrize("groups", [False, True])
@pytest.mark.parametrize("law", ["nonlinear", "carlson_langer"])
def test_forces_and_displacements_balance(law, groups):
    """The slips of each block add up to its displacement."""
    model = Model(law, a=1.0, blocks=12, coupling=5.0, pulling=1.0, v=0.02)
    start = at_rest(model)
    end = last_rest(model, start, 120.0)
    table, runner, (ends, block, slip, _) = record_catalogue(model, start, end, groups)
    assert len(ends) == len(table["time"]) > 15
    moved = runner.state().position - start.position + model.v * end
    total = np.bincount(block - 1, slip, model.blocks)
    assert np.allclose(total, moved, rtol=0.0, atol=1e-12)
    assert np.sum(table["moment"]) == pytest.approx(total.sum(), rel=1e-13)
    assert (table["first_block"] <= table["epicentre"]).all()
    assert (table["epicentre"] <= table["last_block"]).all()


@pytest.mark.slow
def test_energy_is_the_work_of_friction():
    """The work is computed by quadrature of friction times speed along the whole motion, between two times of rest."""
    model = Model("nonlinear", a=0.5, blocks=6, coupling=2.0, pulling=1.0, v=0.01)
    start = at_rest(model)
    end = last_rest(model, start, 400.0)
    runner = Runner(model, keep_events=True)
    runner.begin(start)
    assert runner.run(end) == Status.COMPLETED
    time = runner.events()[0]
    table, _, _ = record_catalogue(model, start, end)
    lost, edges = 0.0, np.unique(np.concatenate([[0.0], time, [end]]))
    node, weight = np.polynomial.legendre.leggauss(24)
    solver = Runner(model)
    for low, high in pairwise(edges):
        for x, w in zip(node, weight, strict=True):
            solver.begin(start)
            assert solver.run(low + 0.5 * (high - low) * (1.0 + x)) == Status.COMPLETED
            speed = solver.state().velocity
            lost += 0.5 * (high - low) * w * float(np.sum(speed * model.law(speed)))
    assert table["energy_released"].sum() == pytest.approx(lost, rel=1e-9)


def test_a_catalogue_does_not_depend_on_where_runs_are_divided():
    model = Model("carlson_langer", a=3.0, blocks=30, coupling=20.0, pulling=1.0, v=0.01)
    start = at_rest(model)
    whole, _, _ = record_catalogue(model, start, 150.0)
    parts, _, _ = record_catalogue(model, start, 150.0, stops=(10.0, 33.3, 90.1))
    assert len(whole["time"]) > 50
    for name, values in whole.items():
        exact = name not in ("energy_released", "peak_velocity")
        assert np.allclose(values, parts[name], rtol=0.0 if exact else 1e-12, atol=0.0, equal_nan=True), name


def test_groups_and_the_chain_as_a_whole_have_the_same_events():
    """They have the same events until chaos makes them diverge."""
    model = Model("carlson_langer", a=1.0, blocks=12, coupling=5.0, pulling=1.0, v=0.02)
    grouped, ungrouped = (record_catalogue(model, at_rest(model), 60.0, groups)[0] for groups in (True, False))
    assert len(grouped["time"]) >= 8
    for name, values in grouped.items():
        assert np.allclose(values[:8], ungrouped[name][:8], rtol=1e-7, atol=1e-9, equal_nan=True), name


def events_of_starts_and_stops(model, log):
    """Return {block: time of its first start} of each event that ends, from all starts and stops of a run."""
    springs = model.chain.stiffness != 0.0
    event_of, events = {}, []
    for time, block, kind in zip(*log, strict=True):
        if kind == 1:
            beside = {id(event_of[k]): event_of[k] for k in np.flatnonzero(springs[block]) if k in event_of}
            event = {"starts": {block: time}, "slipping": 1}
            for other in beside.values():
                event["slipping"] += other["slipping"]
                for k, first in other["starts"].items():
                    event["starts"][k] = min(first, event["starts"].get(k, first))
            event_of |= {k: event for k, old in event_of.items() if id(old) in beside} | {block: event}
        elif block in event_of:
            event = event_of.pop(block)
            event["slipping"] -= 1
            if not event["slipping"]:
                events.append(event["starts"])
    return events


@pytest.mark.parametrize("loading", ["steady", "quasistatic"])
@pytest.mark.parametrize("blocks", [23, 24])
@pytest.mark.parametrize("groups", [False, True])
def test_onsets_are_those_of_the_starts(blocks, groups, loading):
    model = Model("carlson_langer", a=3.0, blocks=blocks, coupling=9.0, pulling=1.0, v=0.02)
    _, runner, (ends, block, _, onset) = record_catalogue(model, at_rest(model), 250.0, groups, loading=loading)
    events = events_of_starts_and_stops(model, runner.events())
    assert len(events) == len(ends) > 100
    for part, delays, starts in zip(np.split(block - 1, ends[:-1]), np.split(onset, ends[:-1]), events, strict=True):
        assert part.tolist() == sorted(starts)
        expected = [starts[k] - min(starts.values()) for k in part]
        np.testing.assert_allclose(delays, expected, rtol=0.0, atol=1e-12)
    # Some blocks slip twice in an event.
    assert (runner.events()[2] == 1).sum() > len(block) + 10


def test_connection_decides():
    """Two blocks far apart that slip at the same time are two events."""
    model = Model("nonlinear", a=0.3, blocks=9, coupling=0.2, pulling=1.0, v=0.05)
    position = np.full(9, -0.5)
    position[[1, 7]] = -0.999
    start = ChainState(position - model.sliding_offset, np.zeros(9), np.ones(9, dtype=bool))
    table, _, _ = record_catalogue(model, start, 8.0)
    first = table["time"] < 3.0
    assert set(table["epicentre"][first]) == {2, 8}
    assert (table["blocks"][first] <= 3).all()
