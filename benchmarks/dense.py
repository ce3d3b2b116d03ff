"""CPU time of slip events in dense networks: by the number of slipping blocks, and by that of neighbours.

In a square lattice with springs 9/r³ between all blocks, all blocks rest at half of their threshold, but for some that
start at one instant: each slips once, and starts no other block. The driver is at rest while they slip. A run begins
with the sum over all springs, which is not counted.

In a ring with springs 3/r to the nearest neighbours, blocks start from random positions, and many slip together.

With `--before`, the interpreter of another installation, the same events are timed there in alternation; the ratio is
that of this installation to the other.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

os.environ["OPENBLAS_NUM_THREADS"] = "1"

import numpy as np

from burridge_knopoff import ChainState, Model, law_of
from burridge_knopoff.running.runner import Runner

SIDES = (6, 10, 16, 24)
SLIPPING = (1, 2, 8)
LAW = law_of("carlson_langer", a=0.5, sigma=0.2)
V = 0.01
#: Neighbours on each side in a ring, on both sides of the number from which on forces follow by increments.
NEIGHBOURS = (1, 4, 5, 10, 30)
RING, RING_LAW, RING_END = 1000, law_of("carlson_langer", a=2.0, sigma=0.2), 1.0


def lattice(side: int, folder: str) -> Model:
    """Return a square lattice with springs between all blocks, from a file, which every installation reads."""
    path = Path(folder) / f"{side}.txt"
    if not path.exists():
        first, second = np.triu_indices(side**2, 1)
        distance = np.hypot(first % side - second % side, first // side - second // side)
        np.savetxt(path, np.stack([first + 1, second + 1, 9.0 / distance**3], axis=1), fmt=["%d", "%d", "%.17g"])
    return Model(LAW, springs=str(path), pulling=1.0, v=V)


def event_time(model: Model, slipping: int) -> float:
    """Return the CPU time of one event in which this many blocks slip, in µs."""
    blocks = model.blocks
    starting = np.arange(slipping) * (blocks // slipping)
    force = np.full(blocks, 0.5)
    force[starting] = 1.0 - 1e-9
    position = -np.linalg.solve(model.chain.stiffness, force) - model.sliding_offset
    runner = Runner(model, loading="quasistatic", keep_events=True)
    runner.begin(ChainState(position, np.zeros(blocks), np.ones(blocks, dtype=bool)))
    runner.run(1e-9)
    before = runner.log.count
    begin = time.process_time()
    runner.run(1e-3)
    spent = time.process_time() - begin
    changes = runner.log.count - before
    if before or changes < 2 * slipping or len({*runner.events()[1].tolist()}) != slipping:
        raise RuntimeError(f"{blocks} blocks: got {changes} starts and stops, expected {slipping} slips")
    return 1e6 * spent


def ring_time(neighbours: int) -> float:
    """Return the CPU time per start or stop in a ring with springs to so many blocks on each side, in µs."""
    springs = {"distance": "3/r", "cut_off": neighbours}
    model = Model(RING_LAW, blocks=RING, ends="ring", springs=springs, pulling=1.0, v=V)
    position = np.random.default_rng(1).uniform(-0.9, -0.7, RING) - model.sliding_offset
    runner = Runner(model)
    runner.begin(ChainState(position, np.zeros(RING), np.ones(RING, dtype=bool)))
    begin = time.process_time()
    runner.run(RING_END)
    return 1e6 * (time.process_time() - begin) / runner.log.count


def times(folder: str) -> list[float]:
    """Return the CPU times of all lattices and numbers of slipping blocks, and of all rings."""
    models = {side: lattice(side, folder) for side in SIDES}
    events = [event_time(models[side], slipping) for side in SIDES for slipping in SLIPPING]
    return events + [ring_time(neighbours) for neighbours in NEIGHBOURS]


def main() -> None:
    """Measure and print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0], allow_abbrev=False)
    parser.add_argument("--rounds", type=int, default=3, help="runs of each event (default: %(default)s)")
    parser.add_argument("--before", help="Python of another installation")
    parser.add_argument("--folder", help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.folder:
        print(*times(options.folder))
        return
    from measure import print_table

    interpreters = [sys.executable, *([options.before] if options.before else [])]
    with tempfile.TemporaryDirectory() as folder:
        rounds = [
            [
                [float(word) for word in subprocess.check_output([one, __file__, "--folder", folder]).split()]
                for one in interpreters
            ]
            for _ in range(options.rounds)
        ]
    least = np.min(rounds, axis=0)
    cells = [[f"{spent:.0f}", "", ""] for spent in least[0]]
    if options.before:
        cells = [[f"{spent:.0f}", f"{spent / before:.3f}", f"{before:.0f}"] for spent, before in least.T]
    cases = [[f"{side} × {side}", slipping] for side in SIDES for slipping in SLIPPING]
    measured = ["µs/event", "ratio to before", "before, µs/event"]
    rows = [case + cell for case, cell in zip(cases, cells[: len(cases)], strict=True)]
    print_table(["lattice", "slipping blocks", *measured], rows)
    rows = [[neighbours, *cell] for neighbours, cell in zip(NEIGHBOURS, cells[len(cases) :], strict=True)]
    print_table([f"ring of {RING}: neighbours on each side", *measured], rows)


if __name__ == "__main__":
    main()
