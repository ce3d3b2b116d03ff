"""CPU time of the event-driven solvers against the number of blocks.

Chains start near uniform sliding, which is unstable, and are run with all events and observables. One thread, process
CPU time of `simulate`, median of runs in alternation. It includes what `map` solves once in a run, the normal modes of
every row of moving blocks that it meets; from N = 64 on that is a large part of these short runs.
"""

from __future__ import annotations

import argparse
import os

os.environ["OPENBLAS_NUM_THREADS"] = "1"

import numpy as np
from measure import cpu_times, print_table

from burridge_knopoff import Chain, InitialState, law_of, simulate

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


def near_sliding(blocks: int, law: str) -> InitialState:
    """Return a random state near uniform sliding, the same in every run of the benchmark."""
    random = np.random.default_rng(blocks)
    offset = Chain(blocks).sliding_offset(float(law_of(law, A)(V)))
    position = offset + PERTURBATION * random.uniform(-1.0, 1.0, blocks)
    velocity = V + PERTURBATION * random.uniform(-1.0, 1.0, blocks)
    return InitialState("near_sliding", tuple(position.tolist()), tuple(velocity.tolist()))


def main() -> None:
    """Measure all chains and print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0], allow_abbrev=False)
    parser.add_argument("--rounds", type=int, default=5, help="runs of each solver (default: %(default)s)")
    rounds = parser.parse_args().rounds
    rows = []
    for blocks in BLOCKS:
        window = min(LONGEST_WINDOW, max(BLOCK_UNITS / blocks, 50.0))
        duration = TRANSIENT + window

        def contestant(law: str, solver: str, blocks: int = blocks, window: float = window):
            initial = near_sliding(blocks, law)
            settings = {"transient": TRANSIENT, "window": window, "events": "all", "lyapunov_exponents": 0}
            return lambda: simulate(law, A, initial, v=V, solver=solver, **settings)

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


if __name__ == "__main__":
    main()
