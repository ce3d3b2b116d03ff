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

from pathlib import Path

import numpy as np
from measure import cpu_times, print_table, verdict

from burridge_knopoff.config import load_study, read_schema
from burridge_knopoff.initial import PAPER_STATES
from burridge_knopoff.simulation import simulate
from burridge_knopoff.stability.basins import known_attractors, label_states, pixel_centres, plane
from burridge_knopoff.stability.flow import begin, new_solver
from burridge_knopoff.summaries import attractors

REPOSITORY = Path(__file__).resolve().parent.parent
A = 0.08
LIMIT_MINUTES = 10.0
SAMPLE_PIXELS = 64


def full_run(known) -> None:
    """Run 10 000 time units from `plus` without observables."""
    solver = new_solver(known.model)
    solver.end = 1e4
    state = begin(known.model, PAPER_STATES["plus"])
    solver.begin(state.position, state.velocity, state.stuck)
    while solver.run() == -1:
        pass


def main() -> None:
    """Measure and print the tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0], allow_abbrev=False)
    parser.add_argument("--pixels", type=int, default=1024, help="pixels along each axis (default: %(default)s)")
    parser.add_argument("--threads", type=int, default=2, help="threads (default: %(default)s)")
    options = parser.parse_args()
    schema = read_schema(REPOSITORY / "workflow" / "schemas" / "config.schema.yaml")
    config = load_study({"study": "basins", "a": [A], "initial": {"minus": {}, "plus": {}}}, schema, "basins").config
    part = attractors.one_law("linearized", [A], config["initial"], config)
    known = known_attractors(attractors.merge([part]), "linearized", A, config)
    state = config["initial"]["minus"]
    limit = config["attractors"]["time_limit"]

    def label(pixels: int, threads: int) -> tuple[np.ndarray, np.ndarray]:
        axis = pixel_centres((-1.5, 1.5), pixels)
        position, velocity = plane(state["position"], axis, axis, state["velocity"])
        return label_states(known, position, velocity, "moving", limit, threads)

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
            "bare run": lambda: full_run(known),
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
