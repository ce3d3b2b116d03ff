"""CPU time of an event in long chains: blocks that slip together in groups of their own, against the chain as a whole.

Chains of the earthquake literature (Carlson and Langer): stiff springs, friction that drops at the start of a slip and
weakens with speed. They start at rest, nearly in line. After the first slips, both ways go on from the same state, in
turn and without observables; a figure is the CPU time of a run divided by its number of events. So do a run that
records the catalogue of its slip events, and one under quasi-static loading.
"""

from __future__ import annotations

import argparse
import os
import time

os.environ["OPENBLAS_NUM_THREADS"] = "1"

import numpy as np
from measure import print_table

from burridge_knopoff import Chain, ChainState, Model, law_of
from burridge_knopoff.catalogue.events import MOST_EVENTS
from burridge_knopoff.kernel._core import Catalogue
from burridge_knopoff.running.runner import Runner

COUPLING, A, SIGMA = 100.0, 5.0, 0.01
# Blocks, driver, and how many events are wanted: in groups, and as a whole, which takes far longer.
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
    law = law_of("carlson_langer", A, {"sigma": SIGMA})
    return Model(Chain(blocks, coupling=COUPLING, pulling=1.0), law, v)


def settled(model: Model) -> ChainState:
    """Return a state after the driver has gone far enough for every block to slip."""
    generator = np.random.default_rng(1)
    position = -0.9 + 0.0005 * generator.uniform(-1.0, 1.0, model.blocks) - model.sliding_offset
    rest = ChainState(position, np.zeros(model.blocks), np.ones(model.blocks, dtype=bool))
    after = Runner(model).after(rest, 0.5 / model.v)
    if after is None:
        raise RuntimeError(f"{model.blocks} blocks, v = {model.v}: the run from rest did not complete")
    return after


def per_event(
    model: Model, start: ChainState, wanted: int, *, groups: bool = True, record: bool = False, loading: str = "steady"
) -> tuple[float, int]:
    """Return the CPU time of an event in µs, and how many events were measured."""
    catalogue = Catalogue(model.blocks, 0.0, False, MOST_EVENTS) if record else None
    runner = Runner(model, groups=groups, catalogue=catalogue, loading=loading)
    runner.begin(start)
    end, spent = 0.0, 0.0
    while runner.log.count < wanted:
        end += 0.05 / model.v
        begin = time.process_time()
        runner.run(end)
        spent += time.process_time() - begin
    return 1e6 * spent / runner.log.count, runner.log.count


def main() -> None:
    """Measure all cases and print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0], allow_abbrev=False)
    parser.add_argument("--rounds", type=int, default=3, help="runs of each way (default: %(default)s)")
    rounds = parser.parse_args().rounds
    rows = []
    for blocks, v, many, few in CASES:
        model = model_of(blocks, v)
        start = settled(model)
        # In turn: in groups, recorded, quasi-static, as a whole.
        turns = [
            (
                per_event(model, start, many),
                per_event(model, start, many, record=True),
                per_event(model, start, many, loading="quasistatic"),
                per_event(model, start, few, groups=False) if few else None,
            )
            for _ in range(rounds)
        ]
        one, recorded, still, other = (
            min(each[0] for each in column if each) if column[0] else None for column in zip(*turns, strict=True)
        )
        rows.append(
            [
                blocks,
                v,
                f"{one:.2f}",
                f"{recorded / one:.2f}",
                f"{still / one:.2f}",
                "" if other is None else f"{other:.1f}",
                "" if other is None else f"{other / one:.1f}",
                turns[0][0][1],
            ]
        )
    print(f"\nStiffness {COUPLING:g}, a = {A:g}, σ = {SIGMA:g}.\n")
    print_table(
        [
            "N",
            "v",
            "in groups, µs/event",
            "recorded, ratio",
            "quasi-static, ratio",
            "as a whole, µs/event",
            "ratio",
            "events",
        ],
        rows,
    )


if __name__ == "__main__":
    main()
