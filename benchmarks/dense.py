"""CPU time of slip events in a square lattice with springs 9/r³ between all blocks, by the number of slipping blocks.

All blocks rest at half of their threshold, but for some that start at one instant: each slips once, and starts no other
block. The driver is at rest while they slip. A run begins with the sum over all springs, which is not counted.

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

from burridge_knopoff import Chain, ChainState, Model, law_of
from burridge_knopoff.running.runner import Runner

SIDES = (6, 10, 16, 24)
SLIPPING = (1, 2, 8)
LAW = law_of("carlson_langer", 0.5, {"sigma": 0.2})
V = 0.01


def lattice(side: int, folder: str) -> Model:
    """Return a square lattice with springs between all blocks, from a file, which every installation reads."""
    path = Path(folder) / f"{side}.txt"
    if not path.exists():
        first, second = np.triu_indices(side**2, 1)
        distance = np.hypot(first % side - second % side, first // side - second // side)
        np.savetxt(path, np.stack([first + 1, second + 1, 9.0 / distance**3], axis=1), fmt=["%d", "%d", "%.17g"])
    return Model(Chain(springs=str(path), pulling=1.0), LAW, V)


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


def times(folder: str) -> list[float]:
    """Return the CPU times of all lattices and numbers of slipping blocks."""
    models = {side: lattice(side, folder) for side in SIDES}
    return [event_time(models[side], slipping) for side in SIDES for slipping in SLIPPING]


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
    rows, k = [], 0
    for side in SIDES:
        for slipping in SLIPPING:
            ratio = [f"{least[0, k] / least[1, k]:.3f}", f"{least[1, k]:.0f}"] if options.before else ["", ""]
            rows.append([f"{side} × {side}", slipping, f"{least[0, k]:.0f}", *ratio])
            k += 1
    print_table(["lattice", "slipping blocks", "µs/event", "ratio to before", "before, µs/event"], rows)


if __name__ == "__main__":
    main()
