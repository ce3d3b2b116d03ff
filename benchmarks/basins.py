"""Maps of basins: a large one on all cores, and the cost of a pixel against that of a full-length run.

The map is the plane of U_1(0) and U_3(0) at a = 0.08 under the linearized law. A pixel is followed until its attractor
is certain; the full-length runs take 10 000 time units, one with all observables and one (bare) without any.
"""

from __future__ import annotations

import argparse
import os
import sys
import time

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np
from measure import cpu_times, print_table, verdict

from burridge_knopoff import Chain, Model, find_attractors, law_of, simulate
from burridge_knopoff.attractors.labels import label_states
from burridge_knopoff.basins.plane import pixel_centres, plane
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.running.runner import Runner

A = 0.08
LIMIT_MINUTES = 10.0
SAMPLE_PIXELS = 64


def full_run(model) -> None:
    """Run 10 000 time units from `plus` without observables."""
    solver = Runner(model)
    solver.begin(model.begin(PAPER_STATES["plus"]))
    solver.run(1e4)


def main() -> None:
    """Measure and print the tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0], allow_abbrev=False)
    parser.add_argument("--pixels", type=int, default=1024, help="pixels along each axis (default: %(default)s)")
    parser.add_argument("--threads", type=int, default=2, help="threads (default: %(default)s)")
    options = parser.parse_args()
    model = Model(Chain(3), law_of("linearized", A))
    attractors, _ = find_attractors(model, starts=list(PAPER_STATES.values()))
    state = PAPER_STATES["minus"]

    def label(pixels: int, threads: int) -> tuple[np.ndarray, np.ndarray]:
        axis = pixel_centres((-1.5, 1.5), pixels)
        position, velocity = plane(state.position, axis, axis, state.velocity)
        return label_states(model, attractors, position, velocity, threads=threads)

    begin_time = time.perf_counter()
    labels, times = label(options.pixels, options.threads)
    wall = time.perf_counter() - begin_time
    print(
        f"{options.pixels} × {options.pixels} pixels, a = {A}, linearized law, {options.threads} threads",
        file=sys.stderr,
    )
    cost = cpu_times(
        {
            "map": lambda: label(SAMPLE_PIXELS, 1),
            "bare run": lambda: full_run(model),
            "run": lambda: simulate("linearized", A, "plus"),
        },
        5,
    )
    pixel = cost["map"] / SAMPLE_PIXELS**2
    header = [
        "pixels",
        "threads",
        "minutes",
        "limit, kept",
        "undetermined",
        "mean τ",
        "run / pixel",
        "bare run / pixel",
    ]
    print_table(
        header,
        [
            [
                len(labels),
                options.threads,
                f"{wall / 60:.2f}",
                f"{LIMIT_MINUTES:g}, {verdict(wall / 60, LIMIT_MINUTES)}",
                int(np.count_nonzero(labels < 0)),
                f"{times.mean():.0f}",
                f"{cost['run'] / pixel:.0f}",
                f"{cost['bare run'] / pixel:.0f}",
            ]
        ],
    )


if __name__ == "__main__":
    main()
