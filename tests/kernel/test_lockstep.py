"""Runs in lockstep: each result equals that of the run alone, to the bit."""

import os
import signal
import threading

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from burridge_knopoff import Chain, FormulaLaw, InitialState, Model, Settings, law_of
from burridge_knopoff.kernel._core import LANES, run_in_lockstep
from burridge_knopoff.running.runner import Runner, run_together
from burridge_knopoff.running.section import SUM, Section
from burridge_knopoff.running.simulation import prepare, run
from burridge_knopoff.running.solvers import RUN_SOLVERS, SOLVERS
from burridge_knopoff.running.status import Status

LAWS = "linearized", "nonlinear", "carlson_langer", "exponential", "stribeck"
# Steeper than at rest.
QUINTIC = "1 - a*u + 0.05*u**5"


@st.composite
def batches(draw):
    """Models that differ only in parameters, each with its own state and settings."""
    generator = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    blocks = draw(st.integers(1, 7))
    ends = draw(st.sampled_from(["open", "ring"])) if blocks > 2 else "open"
    law, contact = draw(st.sampled_from(LAWS)), draw(st.sampled_from(["one_sided", "symmetric"]))
    exponents = draw(st.integers(0, min(2 * blocks, 4)))
    dashpots = draw(st.sampled_from([("damping",), ("pulling_damping",), ("damping", "pulling_damping"), ()]))
    members = []
    for _ in range(draw(st.sampled_from([2, LANES - 1, LANES, LANES + 1, 3 * LANES]))):
        a = float(generator.choice([0.02, 0.08, 0.3]) * generator.uniform(0.8, 1.2))
        damped = {name: float(generator.uniform(0.01, 1.0)) for name in dashpots}
        weakening = generator.choice([-0.02, 0.0, 0.5, 1.0], blocks) if generator.random() < 0.5 else 1.0
        options = {"ends": ends, "weakening": weakening, **damped}
        chain = Chain(blocks, generator.uniform(0.3, 3.0), generator.uniform(0.5, 2.0), **options)
        of = FormulaLaw(law, a=a) if law == QUINTIC else law_of(law, a=a)
        model = Model(of, chain=chain, v=float(generator.choice([0.01, 0.1, 0.5])), contact=contact)
        position, velocity = generator.uniform(-0.5, 0.4, blocks), generator.uniform(0.0, 0.2, blocks)
        # Blocks that move identically except for rounding.
        if generator.random() < 0.4:
            position, velocity = position + position[::-1], velocity + velocity[::-1]
        run_settings = Settings(
            transient=float(generator.choice([0.0, 30.0, 100.0])),
            window=float(generator.choice([50.0, 150.0])),
            batches=int(generator.integers(2, 6)),
            sampling=float(generator.choice([0.1, 1.0, 40.0])),
            trajectory=float(generator.choice([0.0, 20.0])),
            events=str(generator.choice(["all", "window", "none"])),
            section=SUM if generator.random() < 0.5 else Section("block", int(generator.integers(1, blocks + 1))),
            lyapunov_exponents=exponents,
        )
        members.append((model, InitialState("drawn", tuple(position), tuple(velocity)), run_settings))
    return members


def contents(trajectory):
    """Return all numbers of a trajectory, as bytes, and its status."""
    numbers = {name: value for name, value in vars(trajectory).items() if isinstance(value, np.ndarray | float | int)}
    at = trajectory.final
    final = np.array([at.position, at.velocity, at.stuck])
    return {name: np.asarray(value).tobytes() for name, value in {**numbers, "final": final}.items()}, trajectory.status


@settings(max_examples=60)
@given(batches())
def test_each_run_equals_the_run_alone(members):
    alone = [run(*member) for member in members]
    prepared = [prepare(*member) for member in members]
    ends = run_together([item.runner for item in prepared])
    for first, item, end in zip(alone, prepared, ends, strict=True):
        together = item.result(item.runner.status_of(end))
        assert contents(first) == contents(together)
        # The marks from which both continue are equal as well.
        longer = Settings(transient=0.0, window=20.0, lyapunov_exponents=0)
        assert contents(run(item.model, first.final, longer)) == contents(run(item.model, together.final, longer))


def test_runs_of_all_kinds_at_once():
    """Runs that cannot use a lane (long chains in groups, closed forms, fixed steps) are computed alone."""
    members = []
    for law in LAWS:
        for blocks in (2, 3, 24):
            model = Model(law, a=0.1, blocks=blocks)
            state = InitialState("drawn", tuple(0.2 * np.cos(np.arange(blocks))), (0.1,) * blocks)
            for solver in RUN_SOLVERS:
                if SOLVERS[solver].closed_form and not model.has_closed_form:
                    continue
                for exponents in (0, 2) if not SOLVERS[solver].has_fixed_step else (0,):
                    options = Settings(
                        solver=solver, step=0.01, transient=0.0, window=20.0, lyapunov_exponents=exponents
                    )
                    members += 2 * [(model, state, options)]
    prepared = [prepare(*member) for member in members]
    for member, item, end in zip(members, prepared, run_together([item.runner for item in prepared]), strict=True):
        assert contents(run(*member)) == contents(item.result(item.runner.status_of(end)))


def test_runs_halt_at_stops_and_continue():
    model = Model("nonlinear", a=0.08)

    def runners():
        for k in range(2 * LANES + 1):
            runner = Runner(model)
            runner.begin(model.begin(InitialState("drawn", (-1.0, -0.9 + 0.01 * k, -1.0), (0.1, 0.12, 0.1))))
            yield runner

    alone, together = list(runners()), list(runners())
    for _ in range(5):
        for runner in alone:
            assert runner.run(1e3, halting_block=1) == Status.HALTED
        for runner in together:
            runner.kernel.end, runner.kernel.halting_block = 1e3, 1
        assert run_in_lockstep([runner.kernel for runner in together]) == [Status.HALTED] * len(together)
        for runner, partner in zip(alone, together, strict=True):
            assert runner.clock == partner.clock
            assert (runner.state().vector() == partner.state().vector()).all()
            assert partner.state().stuck[1]


def test_runs_end_as_they_do_alone():
    """A diverging run, one with too many events and one with a full table end as they do alone; the others continue."""
    law, symmetric = law_of("linearized", a=3.0), "symmetric"
    state = InitialState("drawn", (0.3, -0.4), (0.1, 0.0))
    diverging = (
        Model(law, chain=Chain(2, 0.1, 0.1), v=1.0, contact=symmetric),
        InitialState("drawn", (90.0, -50.0), (0.0, 0.0)),
    )
    ordinary = Model("linearized", a=0.1, blocks=2, v=1.0, contact=symmetric), state
    options = Settings(transient=0.0, window=200.0, lyapunov_exponents=1)
    members = [(*(diverging if k % 3 == 0 else ordinary), options) for k in range(2 * LANES)]
    alone = [run(*member) for member in members]
    assert {single.status for single in alone} == {"completed", "diverged"}
    prepared = [prepare(*member) for member in members]
    for single, other, end in zip(alone, prepared, run_together([single.runner for single in prepared]), strict=True):
        assert contents(single) == contents(other.result(other.runner.status_of(end)))


def test_ctrl_c_ends_them():
    model = Model("nonlinear", a=0.08)
    runners = [Runner(model) for _ in range(2 * LANES)]
    for runner in runners:
        runner.begin(model.begin(InitialState("drawn", (-1.0, -0.9, -1.0), (0.1, 0.12, 0.1))))
        runner.kernel.end = 1e9
    timer = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        run_in_lockstep([runner.kernel for runner in runners])
