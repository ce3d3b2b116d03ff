"""CPU time of chains of many blocks: of the solvers, and of groups of blocks against the chain as a whole.

First, chains that start near uniform sliding, which is unstable, with all events and observables: process CPU time of
`simulate`, median of runs in alternation. It includes the normal modes of every row of moving blocks, which `map`
computes once in a run; from N = 64 on these take a large part of such short runs.

Then chains of the earthquake literature (Carlson and Langer): stiff springs, friction that drops at the start of a slip
and weakens with speed. They start at rest with nearly equal positions. After the first slips, runs in groups, with
Lyapunov exponents, with a catalogue of slip events, under quasi-static loading and as a whole continue alternately from
the same state without observables; the table has the CPU time of each run divided by its number of events.
"""

from __future__ import annotations

import argparse
import os
import time

os.environ["OPENBLAS_NUM_THREADS"] = "1"

import numpy as np
from measure import cpu_times, print_table

from burridge_knopoff import Chain, ChainState, InitialState, Law, Model, law_of, simulate
from burridge_knopoff.catalogue.events import MOST_EVENTS
from burridge_knopoff.kernel._core import Catalogue, Exponents
from burridge_knopoff.running.runner import Runner

A = 0.08
V = 0.1
BLOCKS = (2, 3, 4, 8, 16, 32, 64, 128, 256)
TRANSIENT = 50.0
# Long chains have more events in a time unit; they need a shorter window for the same number.
LONGEST_WINDOW, BLOCK_UNITS = 400.0, 6400.0
# Runs of these take seconds: one is enough.
LONG_CHAIN = 128
PERTURBATION = 0.05
VARIANTS = {
    "map": ("linearized", "map"),
    "series, linearized": ("linearized", "series"),
    "series, nonlinear": ("nonlinear", "series"),
}


def near_sliding(blocks: int, law: Law) -> InitialState:
    """Return a random state near uniform sliding, the same in every run of the benchmark."""
    random = np.random.default_rng(blocks)
    offset = Chain(blocks).sliding_offset(float(law(V)))
    position = offset + PERTURBATION * random.uniform(-1.0, 1.0, blocks)
    velocity = V + PERTURBATION * random.uniform(-1.0, 1.0, blocks)
    return InitialState("near_sliding", tuple(position.tolist()), tuple(velocity.tolist()))


def by_solver(rounds: int) -> None:
    """Print the CPU time of the solvers against the number of blocks."""
    rows = []
    for blocks in BLOCKS:
        window = min(LONGEST_WINDOW, max(BLOCK_UNITS / blocks, 50.0))
        duration = TRANSIENT + window

        def contestant(law: str, solver: str, blocks: int = blocks, window: float = window):
            initial = near_sliding(blocks, law_of(law, a=A))
            settings = {"transient": TRANSIENT, "window": window, "events": "all", "lyapunov_exponents": 0}
            return lambda: simulate(Model(law, a=A, blocks=blocks, v=V), initial, solver=solver, **settings)

        runs = {name: contestant(*variant) for name, variant in VARIANTS.items()}
        results = {name: run() for name, run in runs.items()}
        for name, result in results.items():
            if result.status != "completed":
                raise RuntimeError(f"{blocks} blocks, {name}: {result.status}")
        seconds = cpu_times(runs, rounds if blocks < LONG_CHAIN else 1)
        rows.append(
            [
                *(f"{seconds[name] / seconds['map']:.2f}" for name in list(VARIANTS)[1:]),
                blocks,
                *(f"{1e6 * seconds[name] / duration:.1f}" for name in VARIANTS),
                *(f"{1e6 * seconds[name] / results[name].event_count:.2f}" for name in VARIANTS),
                *(f"{results[name].event_count / duration:.2f}" for name in list(VARIANTS)[1:]),
            ]
        )
    print(f"\nChains of N blocks, a = {A}, v = {V}, from near uniform sliding, all events and observables.\n")
    header = ["series linearized / map", "series nonlinear / map", "N"]
    header += [f"{name}: {unit}" for unit in ("µs/unit", "µs/event") for name in VARIANTS]
    header += ["events/unit linearized", "events/unit nonlinear"]
    print_table(header, rows)


COUPLING, LARGE_A, SIGMA = 100.0, 5.0, 0.01
# Blocks, driver velocity, and numbers of events to be measured: in groups, and as a whole, which takes far longer.
CASES = (
    (10, 0.001, 2000, 2000),
    (20, 0.001, 4000, 2000),
    (30, 0.001, 5000, 2000),
    (100, 0.001, 10_000, 1000),
    (300, 0.001, 20_000, 1000),
    (1000, 0.001, 20_000, 500),
    (1000, 0.01, 20_000, 500),
    (1000, 0.1, 20_000, 500),
    (100_000, 0.001, 50_000, 0),
)


def model_of(blocks: int, v: float) -> Model:
    """Return a chain of Carlson and Langer."""
    law = law_of("carlson_langer", a=LARGE_A, sigma=SIGMA)
    return Model(law, blocks=blocks, coupling=COUPLING, pulling=1.0, v=v)


def settled(model: Model) -> ChainState:
    """Return a state after the driver has gone far enough for every block to slip."""
    generator = np.random.default_rng(1)
    position = -0.9 + 0.0005 * generator.uniform(-1.0, 1.0, model.blocks) - model.sliding_offset
    rest = ChainState(position, np.zeros(model.blocks), np.ones(model.blocks, dtype=bool))
    after = Runner(model).state_after(rest, 0.5 / model.v)
    if after is None:
        raise RuntimeError(f"{model.blocks} blocks, v = {model.v}: the run from rest did not complete")
    return after


def per_event(
    model: Model,
    start: ChainState,
    wanted: int,
    *,
    groups: bool = True,
    record: bool = False,
    loading: str = "steady",
    exponents: int = 0,
) -> tuple[float, int]:
    """Return the CPU time of an event in µs, and how many events were measured."""
    catalogue = Catalogue(model.blocks, 0.0, False, MOST_EVENTS) if record else None
    followed = Exponents(model.blocks, exponents, 0.0, np.array([0.0, np.inf]))
    runner = Runner(model, groups=groups, catalogue=catalogue, loading=loading, exponents=followed)
    runner.begin(start, 0.0)
    end, spent = 0.0, 0.0
    while runner.log.count < wanted:
        end += 0.05 / model.v
        begin = time.process_time()
        runner.run(end)
        spent += time.process_time() - begin
    return 1e6 * spent / runner.log.count, runner.log.count


#: Runs of the second table. The first is the unit of the others.
RUNS = {
    "in groups": {},
    "1 exponent": {"exponents": 1},
    "4 exponents": {"exponents": 4},
    "recorded": {"record": True},
    "quasi-static": {"loading": "quasistatic"},
    "quasi-static, 4 exponents": {"loading": "quasistatic", "exponents": 4},
    "as a whole": {"groups": False},
    "as a whole, 4 exponents": {"groups": False, "exponents": 4},
}


def by_groups(rounds: int) -> None:
    """Print the CPU time of an event in groups, and that of other runs relative to it."""
    rows = []
    for blocks, v, many, few in CASES:
        model = model_of(blocks, v)
        start = settled(model)
        wanted = {name: many if settings.get("groups", True) else few for name, settings in RUNS.items()}
        turns = [
            {name: per_event(model, start, wanted[name], **RUNS[name])[0] for name in RUNS if wanted[name]}
            for _ in range(rounds)
        ]
        least = {name: min(turn[name] for turn in turns) for name in turns[0]}
        bare = least.pop("in groups")
        ratios = [f"{least[name] / bare:.2f}" if name in least else "" for name in list(RUNS)[1:]]
        rows.append([blocks, v, f"{bare:.2f}", *ratios])
    print(f"\nStiffness {COUPLING:g}, a = {LARGE_A:g}, σ = {SIGMA:g}. Ratios are those to a run in groups.\n")
    print_table(["N", "v", "in groups, µs/event", *list(RUNS)[1:]], rows)


def main() -> None:
    """Measure and print both tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0], allow_abbrev=False)
    parser.add_argument("--rounds", type=int, default=3, help="runs of each contestant (default: %(default)s)")
    rounds = parser.parse_args().rounds
    by_solver(rounds)
    by_groups(rounds)


if __name__ == "__main__":
    main()
