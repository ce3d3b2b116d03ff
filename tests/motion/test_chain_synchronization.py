"""Whether the states of a chain synchronize: symmetries, whole runs, and distances whose outcome is known."""

import math
from dataclasses import astuple, fields, replace
from itertools import product
from types import SimpleNamespace

import numpy as np
import pytest

from burridge_knopoff import (
    ChainState,
    FormulaLaw,
    InitialState,
    Model,
    simulate,
    transverse_exponent,
)
from burridge_knopoff.motion import chain_synchronization as chains
from burridge_knopoff.motion.chain_synchronization import INTERVAL, Fate, Outcome, Watch, watch_state
from burridge_knopoff.motion.mirror import symmetrized
from burridge_knopoff.running.runner import Runner
from burridge_knopoff.running.status import Status
from tests.motion.chains import SAMPLE, model, two_block_exponent
from tests.refused import refused

APART = Outcome.NOT_SYNCHRONIZED


def fate(chain, state, watch):
    return watch_state(Runner(chain), chain.begin(state), watch)


def test_two_blocks_synchronize_below_the_critical_a_only():
    critical = 0.05012
    assert two_block_exponent("linearized", critical - 1e-5) < 0.0 < two_block_exponent("linearized", critical + 1e-5)
    state = InitialState("state", (-0.9, -0.85), (0.1, 0.1))
    watch = Watch(time_limit=4000.0)
    assert fate(model(2, critical - 0.01), state, watch).outcome == Outcome.SYNCHRONIZED
    beyond = fate(model(2, critical + 0.005), state, watch)
    assert beyond.outcome == Outcome.NOT_SYNCHRONIZED
    assert 1e-3 < beyond.distance < 0.1
    # So close that neither the distance nor its rate is conclusive within the time limit.
    assert fate(model(2, critical - 1e-4), state, watch).outcome == Outcome.UNDETERMINED


@pytest.mark.parametrize(("blocks", "a"), [(2, 0.04), (3, 0.06), (4, 0.05), (7, 0.06)])
def test_the_mirrored_sample_has_the_mirrored_fate(blocks, a):
    chain = model(blocks, a)
    watch = Watch(time_limit=2000.0)
    for state in SAMPLE.initial_states(blocks)[:3]:
        mirror = InitialState("mirror", state.position[::-1], state.velocity[::-1])
        first, second = fate(chain, state, watch), fate(chain, mirror, watch)
        assert first.outcome == second.outcome
        assert first.pairs == second.pairs
        if first.outcome == Outcome.SYNCHRONIZED:
            assert abs(first.time - second.time) <= INTERVAL
        else:
            assert first.distance == pytest.approx(second.distance, rel=1e-6)


def test_three_blocks_against_whole_runs(law):
    """For three blocks the mirror distance is J: outcome, largest and mean distance are those of a run."""
    watch = Watch(time_limit=3000.0)
    outcomes = set()
    for a in (0.06, 0.2):
        for state in SAMPLE.initial_states(3)[:4]:
            mine = fate(model(3, a, law), state, watch)
            run = simulate(Model(law, a=a), state, transient=2250.0, window=750.0, sampling=INTERVAL, events="none")
            outcomes.add(mine.outcome)
            if mine.outcome == Outcome.SYNCHRONIZED:
                assert run.mean_distance < 1e-9
                assert run.distance[np.searchsorted(run.time, mine.time)] <= watch.synchronization_distance
                assert mine.transverse_exponent < 0.0
                continue
            last = run.distance[run.time > 2250.0 + 0.5 * INTERVAL]
            if run.lyapunov_exponent[0] < 1e-3:
                assert mine.distance == pytest.approx(last.max(), rel=1e-6)
                assert mine.mean_distance == pytest.approx(last.mean(), rel=1e-6)
    assert outcomes == {Outcome.SYNCHRONIZED, Outcome.NOT_SYNCHRONIZED}


def test_a_run_cut_off_while_it_synchronizes_is_undetermined():
    state = InitialState("state", (-0.9, -0.85), (0.1, 0.1))
    for limit, outcome in ((600.0, Outcome.UNDETERMINED), (6000.0, Outcome.SYNCHRONIZED)):
        assert fate(model(2, 0.04), state, Watch(time_limit=limit)).outcome == outcome


def test_an_exactly_symmetric_start_does_not_show_synchrony():
    """The distance is 0 from the beginning, but the motion is unstable, so the outcome is undetermined."""
    state = InitialState("state", (-1.0, -1.0), (0.1, 0.1))
    result = fate(model(2, 0.1), state, Watch(time_limit=2000.0))
    assert result.distance == 0.0
    assert result.transverse_exponent > 0.03
    assert result.outcome == Outcome.UNDETERMINED


class Scripted:
    """A runner whose four blocks are at the given distances, (outer pair, inner pair), at each check."""

    model = model(4, 0.1)

    def __init__(self, distances):
        self.distances = distances

    def begin(self, at, clock):
        self.clock = clock

    def run(self, end):
        assert end == self.clock + INTERVAL
        self.clock = end
        return Status.COMPLETED if end / INTERVAL <= len(self.distances) else Status.DIVERGED

    def state(self):
        outer, inner = self.distances[round(self.clock / INTERVAL) - 1]
        # The outer pair differs in positions, the inner one in velocities.
        return ChainState(np.array([outer, 0.0, 0.0, 0.0]), np.array([0.0, inner, 0.0, 0.0]), np.zeros(4, bool))


FAR, NEAR_SYMMETRY = [(0.5, 0.3)] * 10, [(0.008, 0.006)] * 10


@pytest.mark.parametrize(
    ("distances", "exponent", "expected"),
    [
        (FAR, None, Fate(APART, distance=0.5, mean_distance=0.5)),
        # The last quarter of ten checks is the last two, the quarter before them the previous two.
        ([*FAR[:8], (0.4, 0.0), (0.2, 0.1)], None, Fate(APART, distance=0.4, mean_distance=0.3)),
        ([*FAR[:8], (0.3, 0.0), (0.2, 9e-7)], None, Fate(APART, distance=0.3, mean_distance=0.25, pairs=1)),
        ([*FAR[:8], (0.26, 0.3), (0.2, 0.1)], None, Fate(APART, distance=0.3, mean_distance=0.25)),
        # The distance still falls: its largest value is below half of that of the quarter before.
        ([*FAR[:8], (0.2, 0.24), (0.2, 0.1)], None, Fate(Outcome.UNDETERMINED, distance=0.24, mean_distance=0.22)),
        ([*FAR[:6], (0.3, 0), (0.3, 0), *[(0.2, 0.2)] * 2], None, Fate(APART, distance=0.2, mean_distance=0.2)),
        # Near symmetric motion the outcome is undetermined unless the exponent exceeds three errors.
        (NEAR_SYMMETRY, (0.31, 0.1), Fate(APART, math.nan, 0.008, 0.008, 0, 0.31)),
        (NEAR_SYMMETRY, (0.29, 0.1), Fate(Outcome.UNDETERMINED, math.nan, 0.008, 0.008, 0, 0.29)),
        (NEAR_SYMMETRY, (math.nan, 0.1), Fate(Outcome.UNDETERMINED, math.nan, 0.008, 0.008, 0)),
        ([(0.0, 0.011)] * 10, None, Fate(APART, distance=0.011, mean_distance=0.011, pairs=1)),
        # Synchronized if the exponent is negative.
        ([*FAR[:2], (1e-12, 1e-13)], (-0.01, 1.0), Fate(Outcome.SYNCHRONIZED, 60.0, 1e-12, 1e-12, 2, -0.01)),
        ([*FAR[:2], (1e-12, 1e-13)], (0.0, 1.0), Fate(Outcome.UNDETERMINED, 60.0, 1e-12, 1e-12, 2, 0.0)),
        (FAR[:9], None, Fate(Outcome.UNDETERMINED)),
    ],
)
def test_distances_and_the_exponent_decide_the_fate(script_answers, distances, exponent, expected):
    calls = script_answers(chains, "transverse_exponent", [exponent])
    fate_of_state = watch_state(
        Scripted(distances), ChainState(np.zeros(4), np.zeros(4), np.zeros(4, bool)), Watch(200.0)
    )
    assert astuple(fate_of_state) == pytest.approx(astuple(expected), nan_ok=True)
    assert [call[2:] for call in calls] == ([(200.0, 50.0)] if exponent else [])


@pytest.mark.parametrize(("v", "pair", "near"), [(0.05, 0.5e-6, 0.005), (0.2, 1e-6, 0.02)])
def test_distances_scale_with_the_driver_velocity(script_answers, v, pair, near):
    """Distances of pairs scale only below the paper's velocity, those from symmetric motion at any velocity."""
    runner = Scripted([])
    runner.model = Model("linearized", a=0.1, blocks=4, v=v)
    for share, inside in ((0.99, True), (1.01, False)):
        calls = script_answers(chains, "transverse_exponent", [(1.0, 0.1)] * 2)
        runner.distances = [(0.5, share * pair)] * 10
        assert watch_state(runner, None, Watch(200.0)).pairs == inside
        assert not calls
        runner.distances = [(share * near, 0.0)] * 10
        watch_state(runner, None, Watch(200.0))
        assert len(calls) == inside


@pytest.mark.parametrize("start", ["moving", "tested"])
def test_a_watched_chain_obeys_the_start_convention(script_answers, start):
    """With a tested start, blocks with a spring force −(K U) of at most the threshold stick."""
    watched = script_answers(chains, "watch_state", [Fate(APART)] * SAMPLE.samples)
    perturbed = script_answers(chains, "transverse_exponent", [(0.0, 0.0)] * SAMPLE.symmetric_samples)
    runs = script_answers(chains, "run", [SimpleNamespace(lyapunov_exponent=[0.1], lyapunov_error=[0.2])])
    chains.watch_chain([model(3, 0.0)], [0.05], replace(SAMPLE, start=start))
    position = np.array([state.position for state in SAMPLE.initial_states(3, 0.05)])
    stuck = position @ np.array([[-2.0, 1.0, 0.0], [1.0, -4.0, 1.0], [0.0, 1.0, -2.0]]) <= 1.0
    assert stuck.any(axis=1).all()
    expected = (stuck & (start == "tested")).tolist()
    assert [at.stuck.tolist() for _, at, *_ in watched] == expected
    assert [at.stuck.tolist() for _, at, *_ in perturbed] == expected[: SAMPLE.symmetric_samples]
    assert [(settings.start, section_only) for _, _, settings, section_only in runs] == [(start, True)]


def test_a_state_is_watched_up_to_the_time_limit_at_most(monkeypatch):
    """There are checks every 20 until then."""
    times, run = [], Runner.run
    monkeypatch.setattr(Runner, "run", lambda runner, time: times.append(time) or run(runner, time))
    chain = model(3, 0.2)
    assert fate(chain, SAMPLE.initial_states(3)[0], Watch(time_limit=219.0)).outcome != Outcome.SYNCHRONIZED
    assert times == [20.0 * check for check in range(1, 11)]


def test_a_watched_chain_equals_its_states_one_by_one():
    watch = Watch(time_limit=600.0)
    results = chains.watch_chain([model(3, 0.0), model(3, 0.0, "nonlinear")], [0.05, 0.2], SAMPLE, watch)
    for (i, law), (j, a) in product(enumerate(("linearized", "nonlinear")), enumerate((0.05, 0.2))):
        chain = model(3, a, law)
        fates = [astuple(fate(chain, state, watch)) for state in SAMPLE.initial_states(3, a)]
        for name, values in zip((item.name for item in fields(Fate)), zip(*fates, strict=True), strict=True):
            np.testing.assert_array_equal(results[name][i, j], values, name)
        starts = [chain.begin(state) for state in SAMPLE.initial_states(3, a)[:2]]
        exponents = [transverse_exponent(chain, start, 150.0, 150.0) for start in starts]
        symmetric = np.stack([results[f"symmetric_{name}"][i, j] for name in ("exponent", "error")], axis=1)
        assert symmetric.tolist() == [list(item) for item in exponents]
        run = simulate(
            Model(law, a=a),
            SAMPLE.initial_states(3, a)[0],
            transient=300.0,
            window=300.0,
            batches=5,
            lyapunov_exponents=1,
        )
        assert results["lyapunov_exponent"][i, j] == pytest.approx(run.lyapunov_exponent[0], rel=1e-9)
        assert results["lyapunov_error"][i, j] == pytest.approx(run.lyapunov_error[0], rel=1e-9)
    assert (results["symmetric_exponent"][0, 0] < 0.0).all()
    assert (results["symmetric_exponent"][0, 1] > 0.0).all()


def test_each_a_has_its_own_states():
    """A larger sample begins with the smaller one, other numbers of blocks and other seeds have others."""
    samples = [
        SAMPLE.initial_states(3, 0.05),
        SAMPLE.initial_states(3, 0.06),
        SAMPLE.initial_states(3),
        SAMPLE.initial_states(2, 0.05),
    ]
    samples.append(replace(SAMPLE, seed=2).initial_states(3, 0.05))
    first = [number for states in samples for state in states for number in state.position]
    assert len(set(first)) == len(first)
    assert replace(SAMPLE, samples=9).initial_states(3, 0.05)[:6] == samples[0]


def test_a_chain_without_mirror_blocks_is_refused():
    chain = Model("linearized", a=0.05, threshold=(1.0, 1.0, 0.9))
    state = chain.begin(InitialState("state", (-1.0, -0.9, -1.0), (0.1, 0.1, 0.1)))
    for call in (
        lambda: transverse_exponent(chain, state, 10.0, 10.0),
        lambda: watch_state(Runner(chain), state),
        lambda: chains.watch_chain([chain], [0.05]),
    ):
        with refused("chain", "mirror"):
            call()


def test_a_ring_synchronizes_if_its_transverse_exponent_is_negative():
    """Four blocks in a ring, with a formula for friction, synchronize where the symmetric motion attracts."""
    ring = Model(FormulaLaw("1/(1 + a*u)**2", a=0.02), blocks=4, ends="ring")
    start = symmetrized(ring.begin(InitialState("state", (-1.0, -0.9, -0.9, -1.0), (0.1, 0.1, 0.1, 0.1))))
    exponent, error = transverse_exponent(ring, start, 500.0, 1000.0)
    assert exponent < -10.0 * error
    fates = [fate(ring, state, Watch(time_limit=4000.0)) for state in SAMPLE.initial_states(4)[:4]]
    exponents = [item.transverse_exponent for item in fates if item.outcome == Outcome.SYNCHRONIZED]
    assert exponents == pytest.approx([exponent] * 2, abs=3.0 * error)
