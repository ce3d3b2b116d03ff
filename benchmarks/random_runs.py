"""Random runs of random chains, each continuing the previous one, for the sanitizers of `make sanitize`.

    python benchmarks/random_runs.py [SECONDS] [FIRST_SEED]

Chains, rings, grids under all laws, contacts and loadings are continued as a whole, in groups, in closed form, by fixed
steps, with and without exponents, catalogue and observer; ensembles are moved and labelled. A sanitizer ends the
process at the first error; the seed before it is on the last line.
"""

import sys
import time
from collections import Counter

import numpy as np

from burridge_knopoff import Chain, ChainState, Model, law_of
from burridge_knopoff.kernel._core import Catalogue, Clouds, Exponents
from burridge_knopoff.model.model import CONTACTS
from burridge_knopoff.running.ensemble import new_ensemble
from burridge_knopoff.running.runner import Runner, new_observer, run_together
from burridge_knopoff.running.section import SUM, Section
from burridge_knopoff.running.solvers import SOLVERS
from burridge_knopoff.values import MOST_NUMBERS

LAWS = ("linearized", "nonlinear", "carlson_langer", "exponential", "stribeck")


def random_model(random: np.random.Generator) -> Model:
    """Return a chain, ring or grid of up to 60 blocks with a law, a driver and a contact."""
    shape = random.integers(3)
    springs = {"coupling": 10 ** random.uniform(-1, 1.5), "pulling": 10 ** random.uniform(-0.5, 0.5)}
    springs |= {name: 10 ** random.uniform(-2, 0) for name in ("damping", "pulling_damping") if random.random() < 0.3}
    if shape == 2:
        chain = Chain(grid=tuple(random.integers(1, 8, 2).tolist()), **springs)
    else:
        blocks = int(random.choice([1, 2, 3, 5, 8, 9, 23, 24, 40, 60]))
        chain = Chain(blocks, ends="ring" if shape == 1 and blocks > 1 else "open", **springs)
    law = law_of(str(random.choice(LAWS)), a=10 ** random.uniform(-1.5, 0.5))
    return Model(law, chain=chain, v=10 ** random.uniform(-2.5, 0), contact=str(random.choice(CONTACTS)))


def random_state(model: Model, random: np.random.Generator) -> ChainState:
    """Return a state, often at rest, often its own mirror image."""
    position, velocity = random.uniform(-1.5, 0.5, model.blocks), random.uniform(0, 0.3, model.blocks)
    stuck = random.random(model.blocks) < random.choice([0.0, 0.5, 1.0])
    if random.random() < 0.4:
        position, velocity, stuck = position + position[::-1], velocity + velocity[::-1], stuck & stuck[::-1]
    return ChainState(position - model.sliding_offset, np.where(stuck, 0.0, velocity), stuck)


def resume(model: Model, state: ChainState, random: np.random.Generator, loading: str) -> tuple[str, ChainState]:
    """Run from a state in a random way; return the way and the state at the end, or the same one if the run failed."""
    solver = str(random.choice(["series", "series", *SOLVERS]))
    blocks, begin = model.blocks, state.time
    end = begin + random.choice([0.0, 0.7, 5.0, 25.0])
    edges = np.linspace(begin + (end - begin) * random.choice([0.0, 0.3]), end, 4)
    times = np.sort(random.uniform(begin, end, 7))
    section = Section("block", int(random.integers(1, blocks + 1))) if random.random() < 0.5 else SUM
    vectors = int(random.choice([0, 0, 1, 2 * blocks]))
    is_observed = SOLVERS[solver].has_fixed_step or (loading == "steady" and random.random() < 0.5)
    runner = Runner(
        model,
        solver,
        step=0.01,
        events_from=float(edges[0]),
        keep_events=bool(random.random() < 0.7),
        stops_only=bool(random.random() < 0.3),
        observer=new_observer(model, edges, times, times[2:], section=section) if is_observed else None,
        exponents=Exponents(blocks, vectors, begin, edges) if vectors and blocks < 12 else None,
        groups=[None, True, False][random.integers(3)],
        catalogue=Catalogue(blocks, begin, True, MOST_NUMBERS) if random.random() < 0.5 else None,
        loading=loading,
    )
    runner.begin(state)
    status = runner.run() if SOLVERS[solver].has_fixed_step else runner.run(end, int(random.integers(-1, blocks)))
    runner.log.events.values()
    runner.observer.results()
    runner.exponents.results()
    if runner.catalogue is not None:
        runner.catalogue.take()
    return f"{solver} {status.name.lower()}", runner.final() if status == 0 else state


def move_many(model: Model, random: np.random.Generator) -> str:
    """Move an ensemble, or label its states by clouds."""
    count, blocks = int(random.integers(1, 20)), model.blocks
    position, velocity = random.uniform(-1.5, 0.5, (count, blocks)), random.uniform(0, 0.3, (count, blocks))
    states = position, velocity, random.random((count, blocks)) < 0.3
    ensemble = new_ensemble(model)
    if random.random() < 0.5:
        ensemble.run(*states, np.sort(random.uniform(0, 10, 3)).tolist(), int(random.integers(0, 9)))
        return "ensemble"
    points = [random.uniform(-1, 1, (int(random.integers(1, 50)), 2 * blocks)) for _ in range(2)]
    clouds = Clouds(points, 2 * blocks, [0.5, 0.1])
    ensemble.label(
        *states, clouds, [2, 3], random.integers(0, blocks, 2).tolist(), random.integers(0, 2, 2).tolist(), 10.0
    )
    return "labels"


def move_together(model: Model, random: np.random.Generator) -> str:
    """Carry out several runs in lockstep, of which some have ended before others begin."""
    blocks, runners = model.blocks, []
    vectors = int(random.integers(0, 4)) if blocks < 12 else 0
    for _ in range(random.integers(1, 30)):
        edges = np.cumsum(random.uniform(0.1, 10.0, 3))
        runner = Runner(
            model,
            events_from=float(edges[0]),
            keep_events=True,
            observer=new_observer(model, edges, edges, edges[:2], bool(random.random() < 0.3)),
            exponents=Exponents(blocks, vectors, 0.0, edges),
        )
        runner.begin(random_state(model, random))
        runners.append(runner)
    for runner, end in zip(runners, run_together(runners), strict=True):
        runner.status_of(end)
        runner.observer.results()
        runner.exponents.results()
    return "in lockstep"


def main() -> None:
    """Make random runs for some seconds and print their number."""
    seconds, seed = (int(word) for word in [*sys.argv[1:], "120", "0"][:2])
    done: Counter[str] = Counter()
    stop = time.monotonic() + seconds
    while time.monotonic() < stop:
        print(f"\rseed {seed}", end="", flush=True)
        random = np.random.default_rng(seed)
        model, loading = random_model(random), "quasistatic" if random.random() < 0.25 else "steady"
        state = random_state(model, random)
        for _ in range(random.integers(1, 6)):
            try:
                way, state = resume(model, state, random, loading)
            except ValueError:
                way = "refused"
            done[way] += 1
        done[move_many(model, random)] += 1
        try:
            done[move_together(model, random)] += 1
        except ValueError:
            done["refused"] += 1
        seed += 1
    print(f"\r{seed} models, {done.total()} runs:", ", ".join(f"{count} {way}" for way, count in done.most_common()))


if __name__ == "__main__":
    main()
