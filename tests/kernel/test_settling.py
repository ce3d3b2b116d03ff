"""When J was last at least at a level: closed forms, SciPy, dense samples, and the same in lanes, groups and parts."""

import dataclasses

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import brentq, minimize_scalar

from burridge_knopoff import Chain, ChainState, InitialState, Model, simulate, sweep
from burridge_knopoff.model.model import CONTACTS
from burridge_knopoff.running.runner import Runner, new_observer, run_together
from burridge_knopoff.running.settling import LEVELS, distance_rounding
from burridge_knopoff.running.status import Status
from tests.kernel.test_groups import LAWS, at_rest
from tests.scipy_flow import model_events

MINUS = InitialState("minus", (-0.989, -0.993, -0.991), (0.099, 0.1012, 0.1023))
SHORT = {"transient": 100.0, "window": 100.0, "batches": 2, "lyapunov_exponents": 0}


def prepared(model, start, end, level, groups=None, solver="series", sampling=None):
    times = () if sampling is None else np.append(np.arange(start.time, end, sampling), end)
    observer = new_observer(model, [start.time, end], times, level=level)
    runner = Runner(model, solver, observer=observer, groups=groups)
    runner.begin(start)
    return runner


def settling(*arguments, **options):
    """Return the settling times of a run, its samples of J, and its state at the end."""
    runner = prepared(*arguments, **options)
    assert runner.run() == Status.COMPLETED
    found = runner.observer.results()
    return found["settling_time"], found["distance"], runner.final()


class Turning:
    """Two blocks that slip freely: d'' = a d' − 3 d, so that J is known in closed form."""

    a = 0.1
    model = Model("linearized", a=a, blocks=2)

    def __init__(self):
        sliding = -(1.0 - self.a * 0.1)
        state = InitialState("near", (sliding - 0.01, sliding + 0.02), (0.1, 0.13))
        self.start = self.model.begin(state)
        self.d, self.rate = (last - first for first, last in (state.position, state.velocity))

    def distance(self, t):
        half = self.a / 2
        omega = np.sqrt(3 - half**2)

        def turning(first, second):
            return np.exp(half * t) * (first * np.cos(omega * t) + second / omega * np.sin(omega * t))

        d, rate = turning(self.d, self.rate - half * self.d), turning(self.rate, half * self.rate - 3 * self.d)
        return np.hypot(d, rate)


def test_the_closed_form_of_two_blocks():
    """At its levels, at its maximum between two samples, and just above this."""
    turning = Turning()
    grid = np.linspace(0.0, 2.3, 100_001)
    values = turning.distance(grid)
    inner = 1 + np.flatnonzero((values[1:-1] > values[:-2]) & (values[1:-1] > values[2:]))
    top = minimize_scalar(lambda t: -turning.distance(t), bracket=grid[inner[-1] + np.array([-1, 0, 1])], tol=1e-12).x
    highest = turning.distance(top)
    end = float(grid[inner[-1] + np.argmax(values[inner[-1] :] < 0.95 * highest)])
    levels = highest * np.array([0.96, 1.0 - 1e-3, 1.0 - 1e-6, 1.0 - 1e-10, 1.0 + 1e-10, 1.1, 0.5])
    times, *_ = settling(turning.model, turning.start, end, levels)
    for level, time in zip(levels[:3], times[:3], strict=True):
        expected = brentq(lambda t, level=level: turning.distance(t) - level, top, end, xtol=1e-14)
        assert time == pytest.approx(expected, abs=1e-12 * highest / (highest - level) + 1e-13)
    assert times[3] == pytest.approx(top, abs=1e-4)
    stepped, *_ = settling(turning.model, turning.start, end, levels, solver="rk4")
    assert stepped[:2] == pytest.approx(times[:2], abs=1e-8)
    earlier = [grid[values >= level][-1] if (values >= level).any() else 0.0 for level in levels[4:6]]
    assert times[4:6] == pytest.approx(earlier, abs=1e-4)
    # It is above the lowest level at the end.
    assert np.isnan(times[6])


def test_synchrony_of_the_paper_agrees_with_scipy_and_with_dense_samples():
    """Twice the time 1064.84 of an independent integrator, and J at the settling times by SciPy."""
    model = Model("linearized", a=0.08)
    for solver in ("series", "map"):
        times, distance, _ = settling(model, model.begin(MINUS), 1500.0, LEVELS, solver=solver, sampling=0.01)
        assert times[2] == pytest.approx(1064.84, abs=0.01)
        for level, time in zip(LEVELS[1:3], times[1:3], strict=True):
            last = 0.01 * np.flatnonzero(distance >= level)[-1]
            assert last <= time <= last + 0.01
    model = Model("nonlinear", a=0.02)
    times, *_ = settling(model, model.begin(MINUS), 200.0, LEVELS[1:3])
    for level, time in zip(LEVELS[1:3], times, strict=True):
        _, (first, _, last, rate, _, end) = model_events(model, model.begin(MINUS), time)
        assert np.hypot(last - first, end - rate) == pytest.approx(level, abs=1e-9)


@settings(max_examples=40)
@given(
    st.sampled_from([2, 3, 8, 23, 24, 40]),
    st.sampled_from(list(LAWS)),
    st.sampled_from(CONTACTS),
    st.floats(-4.0, 0.0),
    st.sampled_from([(0.0, 0.0), (0.5, 0.0), (2.0, 2.5)]),
    st.sampled_from([0.0, 1e4]),
    st.integers(0, 10_000),
)
def test_dense_samples_of_any_chain(blocks, law, contact, power, dashpots, clock, seed):
    """The last sample at least at a level is at most an interval earlier, or J is at the level on a crest between two.

    In groups, as a whole, in two parts, and in lanes to the bit; for levels in the range of J.
    """
    v, (damping, pulling_damping) = 10.0**power, dashpots
    chain = Chain(blocks, coupling=3.0, pulling=1.0, damping=damping, pulling_damping=pulling_damping)
    model = Model(law, a=LAWS[law], chain=chain, v=v, contact=contact)
    start = dataclasses.replace(at_rest(model, seed), time=clock)
    end = clock + 0.6 / v + 5.0
    interval = (end - clock) / 4000
    _, distance, _ = settling(model, start, end, (), sampling=interval)
    levels = np.quantile(distance, [0.0, 0.3, 0.6, 0.9, 0.99]) * (1.0 + 1e-9)
    whole, distance, _ = settling(model, start, end, levels, groups=False, sampling=interval)
    grouped, in_groups, _ = settling(model, start, end, levels, groups=True, sampling=interval)
    for times, values in ((whole, distance), (grouped, in_groups)):
        for level, time in zip(levels, times, strict=True):
            if values[-1] >= level:
                assert np.isnan(time)
                continue
            last = clock + interval * np.flatnonzero(values >= level)[-1] if (values >= level).any() else clock
            assert time >= last - 0.01 * interval
            if time > last + 1.01 * interval:
                assert settling(model, start, time, (), sampling=end)[1][-1] == pytest.approx(level, rel=1e-6)
    alone = settling(model, start, end, levels)[0]
    together = [prepared(model, start, end, levels) for _ in range(5)]
    assert run_together(together) == 5 * [Status.COMPLETED]
    for runner in together:
        assert np.array_equal(runner.observer.results()["settling_time"], alone, equal_nan=True)
    middle = clock + 0.37 * (end - clock)
    first, _, state = settling(model, start, middle, levels)
    second, *_ = settling(model, state, end, levels)
    parts = np.where((second == middle) & ~np.isnan(first), first, second)
    assert np.allclose(parts, alone, rtol=0.0, atol=0.01 * interval, equal_nan=True)


@pytest.mark.parametrize("offset", [-1e-7, -1e-8, -1e-10, 1e-10, 1e-8, 1e-7])
def test_levels_close_to_the_ends_of_pieces(offset):
    """J at an end, computed as part of a piece only if it is close to a level: in groups and in lanes it always is."""
    model = Model("linearized", a=0.08)
    start, end = model.begin(MINUS), 400.0
    run = simulate(model, initial=MINUS, transient=0.0, window=end, batches=2, events="all", lyapunov_exponents=0)
    first, last = (np.stack([x[:, block] for x in (run.event_position, run.event_velocity)]) for block in (0, -1))
    far = np.hypot(*(last - first))
    levels = far[-200::5] * (1.0 + offset)
    times, *_ = settling(model, start, end, levels)
    settled = ~np.isnan(times)
    assert settled.sum() > 10
    grouped, *_ = settling(model, start, end, levels, groups=True)
    assert np.allclose(grouped, times, rtol=0.0, atol=1e-6, equal_nan=True)
    together = [prepared(model, start, end, levels) for _ in range(3)]
    assert run_together(together) == 3 * [Status.COMPLETED]
    for runner in together:
        assert np.array_equal(runner.observer.results()["settling_time"], times, equal_nan=True)
    for level, time in zip(levels[settled][:5], times[settled][:5], strict=True):
        assert settling(model, start, time, (), sampling=end)[1][-1] == pytest.approx(level, rel=1e-9)


def test_a_sweep_has_the_settling_times_of_its_runs():
    """In lanes of different a, of which some synchronize."""
    values = np.linspace(0.01, 0.16, 16)
    options = {**SHORT, "transient": 300.0}
    runs = sweep(Model("nonlinear"), "minus", a=values, **options)
    assert runs.level.values.tolist() == list(LEVELS)
    alone = [simulate(Model("nonlinear", a=a), "minus", **options).settling_time for a in values]
    np.testing.assert_array_equal(runs.settling_time.values, alone)
    assert np.isfinite(alone).any()
    assert np.isnan(alone).any()


def test_levels_of_rounding_are_not_judged():
    """A level that a fast driver's coordinates cannot resolve, in a run of exact synchrony."""
    for v, resolved in ((0.1, 5), (10.0, 4)):
        model = Model("linearized", a=0.05, v=v)
        offset = model.sliding_offset
        state = InitialState("symmetric", tuple(offset + v * np.array([-0.1, 0.2, -0.1])), (v, 1.1 * v, v))
        run = simulate(model, initial=state, **SHORT)
        assert not run.distance.any()
        assert np.isfinite(run.settling_time).tolist() == resolved * [True] + (5 - resolved) * [False]
        assert (run.settling_time[:resolved] == 0.0).all()


def test_rounding_stays_below_the_level_that_is_judged():
    """Also near a_c, where synchrony damps it slowly."""
    for law, a in (("linearized", 0.08), ("nonlinear", 0.08), ("nonlinear", 0.0855)):
        model = Model(law, a=a)
        _, distance, state = settling(model, model.begin(MINUS), 20_000.0, (), sampling=0.37)
        assert distance[40_000:].max() < 0.2 * distance_rounding(model, state)


def test_a_run_that_does_not_complete_has_no_settling_times():
    run = simulate(Model("linearized", a=0.05), "minus", **SHORT)
    assert np.isfinite(run.settling_time[:3]).all()
    assert (run.settling_time[:3] < 200.0).all()
    state = ChainState(np.array([0.0, 3e4, 0.0]), np.zeros(3), np.zeros(3, dtype=bool))
    diverged = simulate(Model("linearized", a=3.0), initial=state, **SHORT)
    assert diverged.status != "completed"
    assert np.isnan(diverged.settling_time).all()
