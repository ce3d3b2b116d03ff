"""Stops, starts and the final state of all solvers against SciPy, for all kinds of chains, laws and contacts."""

from collections.abc import Callable
from dataclasses import replace
from functools import cache, partial
from typing import NamedTuple

import numpy as np
import pytest

from burridge_knopoff import Chain, ChainState, FormulaLaw, InitialState, Model
from burridge_knopoff.kernel._core import LANES, run_in_lockstep
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.model.model import CONTACTS
from burridge_knopoff.running.ensemble import new_ensemble
from burridge_knopoff.running.runner import Runner
from burridge_knopoff.running.status import Status
from tests.flows import check_events, wave
from tests.kernel.test_ensemble import events_of
from tests.kernel.test_few_blocks import CHAINS as FEW_BLOCKS
from tests.kernel.test_networks import CHAINS as NETWORKS
from tests.kernel.test_networks import rest
from tests.kernel.test_steep_laws import FORMULAS
from tests.scipy_flow import friction_of, model_events, scipy_events

TOLERANCE = 1e-8
LAWS = "linearized", "nonlinear"
ALL_LAWS = {"linearized": 0.1, "nonlinear": 0.3, "carlson_langer": 2.0, "exponential": 0.5, "stribeck": 1.0}


class Case(NamedTuple):
    """States of a model that are followed to a time, and a number of events that each passes at least.

    matrices : stiffness and damping, if they are not taken from the chain; weakening : of each block then
    """

    model: Model
    starts: list[ChainState]
    end: float
    least: int
    matrices: tuple[np.ndarray, np.ndarray] | None = None
    weakening: float | np.ndarray = 1.0

    def expected(self, start: ChainState) -> tuple[list, np.ndarray]:
        """Return the events and the final state by SciPy."""
        if self.matrices is None:
            return model_events(self.model, start, self.end)
        model, (stiffness, damping) = self.model, self.matrices
        assert np.allclose(model.chain.stiffness, stiffness, rtol=1e-15)
        sliding = np.broadcast_to(model.law(self.weakening * np.full(model.blocks, model.v)), model.blocks)
        offset = np.linalg.solve(stiffness, -sliding)
        slip = np.where(start.stuck, 0, np.where(start.velocity < 0.0, -1, 1))
        matter = stiffness, np.ones(model.blocks), friction_of(model.law), model.v
        kind = {"contact": model.contact, "damping": damping, "weakening": self.weakening}
        moving = start.position + offset, start.velocity, slip
        events, position, velocity = scipy_events(*matter, *moving, self.end, **kind)
        return events, np.concatenate([position - offset, velocity])


def few_blocks(chain, law, contact):
    model = Model(law, a=0.2, chain=chain, contact=contact)
    return Case(model, [model.begin(wave(chain.blocks, 0.3), "tested")], 25.0, 5)


def network(chain, law, contact):
    model = Model(law, a=0.3, chain=chain, contact=contact)
    return Case(model, [rest(model)], 14.0, 3)


def steep_law(name, w, contact):
    """The time is short enough for the peer, which needs short steps, to remain accurate."""
    model = Model(FormulaLaw(FORMULAS[name], w=w, **{"a": 0.1} if "a*u" in FORMULAS[name] else {}), contact=contact)
    return Case(model, [model.begin(PAPER_STATES["minus"])], 6.0, 5)


def many_states(law):
    model, generator = Model(law, a=0.2), np.random.default_rng(3)
    positions = generator.uniform(-1.2, -0.4, (LANES + 2, 3))
    states = [InitialState("drawn", tuple(position), (0.1, 0.05, 0.12)) for position in positions]
    return Case(model, [model.begin(state) for state in states], 15.0, 6)


def dashpots(seed):
    """A row, a ring or a grid with dashpots, K and C of its springs and dashpots as listed here, and a state."""
    generator = np.random.default_rng(seed)
    form = generator.choice(["row", "ring", "grid"])
    blocks = 6 if form == "grid" else int(generator.integers(2 if form == "row" else 3, 7))
    pairs = [(i, i + 1) for i in range(blocks - 1)] + [(blocks - 1, 0)] * (form == "ring")
    if form == "grid":
        pairs = [(0, 1), (1, 2), (3, 4), (4, 5), (0, 3), (1, 4), (2, 5)]
    count = 1 if form == "grid" else len(pairs)
    strength = generator.uniform(0.5, 2.0, count)
    dashpot = 10.0 ** generator.uniform(-2.0, 0.5) * generator.uniform(0.0, 1.0, count)
    to_driver = generator.choice([0.0, 0.3]) * generator.uniform(0.0, 1.0, blocks)
    options = {"coupling": strength, "damping": dashpot, "ends": "ring" if form == "ring" else "open"}
    if form == "grid":
        options = {"coupling": strength[0], "damping": dashpot[0], "grid": (3, 2)}
    chain = Chain(blocks, pulling=1.0, pulling_damping=to_driver, **options)
    stiffness, damping = np.eye(blocks), np.diag(to_driver)
    for (i, j), k, c in zip(pairs, np.resize(strength, len(pairs)), np.resize(dashpot, len(pairs)), strict=True):
        for matrix, number in ((stiffness, k), (damping, c)):
            matrix[[i, j], [i, j]] += number
            matrix[[i, j], [j, i]] -= number
    law, contact = str(generator.choice(list(ALL_LAWS))), str(generator.choice(CONTACTS))
    model = Model(law, a=ALL_LAWS[law], chain=chain, v=float(generator.choice([0.1, 0.3])), contact=contact)
    velocity = generator.uniform(0.0, 0.3, blocks)
    if contact == "symmetric":
        velocity *= generator.choice([-1.0, 1.0], blocks)
    stuck = generator.random(blocks) < 0.3
    start = ChainState(generator.uniform(-1.4, 0.4, blocks), np.where(stuck, 0.0, velocity), stuck)
    return Case(model, [start], 10.0, 0, (stiffness, damping))


def weakening(seed):
    """A chain with or without dashpots whose blocks differ in friction: it falls, grows and is constant with speed."""
    case, generator = dashpots(seed), np.random.default_rng([seed, 1])
    model, (stiffness, damping) = case.model, case.matrices
    # Hyperbolic laws have a pole at some speed where friction grows, which must be above 10.
    least = {"nonlinear": -0.3, "carlson_langer": -0.04}.get(model.law.name, -1.0)
    factors = generator.permutation(np.resize([1.0, least, 0.0, 1.5, 0.5 * least, 0.3], model.blocks))
    options = {"damping": 0.0, "pulling_damping": 0.0} if seed % 2 else {}
    if seed % 2:
        damping = np.zeros_like(damping)
    chain = replace(model.chain, weakening=factors, **options)
    return Case(replace(model, chain=chain), case.starts, case.end, 0, (stiffness, damping), factors)


CASES: dict[str, Callable[[], Case]] = {
    **{
        f"{kind.__name__}-{number}-{law}-{contact}": partial(kind, chain, law, contact)
        for kind, chains in ((few_blocks, FEW_BLOCKS), (network, NETWORKS))
        for number, chain in enumerate(chains)
        for law in LAWS
        for contact in CONTACTS
    },
    **{
        f"{name}-{w}-{contact}": partial(steep_law, name, w, contact)
        for name in FORMULAS
        for w in (1e-2, 1e-3)
        for contact in CONTACTS
    },
    **{f"many_states-{law}": partial(many_states, law) for law in LAWS},
    **{f"dashpots-{seed}": partial(dashpots, seed) for seed in range(60)},
    **{f"weakening-{seed}": partial(weakening, seed) for seed in range(60)},
}


@cache
def solved_by_scipy(name):
    case = CASES[name]()
    return case, [case.expected(start) for start in case.starts]


def alone(case, **options):
    """Follow each state alone."""
    for start in case.starts:
        runner = Runner(case.model, keep_events=True, **options)
        runner.begin(start)
        assert runner.run(case.end) == Status.COMPLETED
        yield runner


def in_lockstep(case):
    """Follow more states at once than there are lanes."""
    starts = case.starts * (1 if len(case.starts) > LANES else LANES + 2)
    runners = [Runner(case.model, keep_events=True) for _ in starts]
    for runner, start in zip(runners, starts, strict=True):
        runner.begin(start)
        runner.kernel.end = case.end
    assert run_in_lockstep([runner.kernel for runner in runners]) == [Status.COMPLETED] * len(runners)
    return runners


def by_runners(runners):
    for runner in runners:
        time, block, kind = runner.events()
        yield list(zip(time, block + 1, kind, strict=True)), runner.state().vector()


def in_ensemble(case):
    """Follow all states in lanes, without runners."""
    columns = zip(*((start.position, start.velocity, start.stuck) for start in case.starts), strict=True)
    results = new_ensemble(case.model).run(*map(np.array, columns), [case.end], events=3000)
    for k in range(len(case.starts)):
        yield events_of(results, k), np.concatenate([results["position"][k, 0], results["velocity"][k, 0]])


SOLVERS = {
    "series": lambda case: by_runners(alone(case)),
    "one group": lambda case: by_runners(alone(case, groups=False)),
    "groups": lambda case: by_runners(alone(case, groups=True)),
    "lockstep": lambda case: by_runners(in_lockstep(case)),
    "ensemble": in_ensemble,
    "map": lambda case: by_runners(alone(case, solver="map")),
}


#: Most random chains, which are of every form, law and contact.
LONG = {f"{kind}-{seed}" for kind in ("dashpots", "weakening") for seed in range(8, 60)}


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("name", [pytest.param(name, marks=pytest.mark.slow if name in LONG else ()) for name in CASES])
def test_events_against_scipy(name, solver):
    case, expected = solved_by_scipy(name)
    if solver == "map" and not case.model.has_closed_form:
        pytest.skip("the model has no closed form")
    for (events, end), (other_events, other_end) in zip(SOLVERS[solver](case), expected, strict=False):
        assert len(other_events) >= case.least
        check_events(events, other_events, TOLERANCE)
        assert np.allclose(end, other_end, rtol=0.0, atol=TOLERANCE)
