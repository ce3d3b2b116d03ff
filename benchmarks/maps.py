"""Cost of maps of basins, per pixel and relative to a full-length run, and of exponents over two parameters.

The map of basins is the plane of U_1(0) and U_3(0) at a = 0.08 under the linearized law. A pixel is followed until its
attractor is certain; the full-length runs take 10 000 time units, one with all observables and one (bare) without any.

The exponents are those of two blocks, over 100 values of a and 100 of the driver velocity or of the coupling.
"""

from __future__ import annotations

import argparse
import os
import sys
import time

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np
from measure import cpu_times, print_table

from burridge_knopoff import Model, find_attractors, simulate, sweep
from burridge_knopoff.attractors.labels import label_states
from burridge_knopoff.basins.plane import pixel_centres, plane
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.running.runner import Runner

A = 0.08
SAMPLE_PIXELS = 64
SIDE = 100
INITIAL = {"position": [-0.9, -1.1], "velocity": [0.1, 0.1]}
SETTINGS = {"transient": 500.0, "window": 1000.0, "lyapunov_alignment": 500.0, "lyapunov_exponents": 1}
PLANE_A = np.linspace(0.05, 3.0, SIDE)
OTHER = {"v": np.linspace(0.02, 0.5, SIDE), "coupling": np.linspace(0.2, 5.0, SIDE)}


def full_run(model) -> None:
    """Run 10 000 time units from `plus` without observables."""
    solver = Runner(model)
    solver.begin(model.begin(PAPER_STATES["plus"]))
    solver.run(1e4)


def basins(pixels: int, cores: int) -> None:
    """Measure the map of basins and print its table."""
    model = Model("linearized", a=A)
    attractors, _ = find_attractors(model, starts=list(PAPER_STATES.values()))
    state = PAPER_STATES["minus"]

    def label(side: int, cores: int) -> tuple[np.ndarray, np.ndarray]:
        axis = pixel_centres((-1.5, 1.5), side)
        position, velocity = plane(state.position, axis, axis, state.velocity)
        return label_states(model, attractors, position, velocity, cores=cores)

    begin_time = time.perf_counter()
    labels, times = label(pixels, cores)
    wall = time.perf_counter() - begin_time
    print(
        f"{pixels} × {pixels} pixels, a = {A}, linearized law, {cores} cores",
        file=sys.stderr,
    )
    cost = cpu_times(
        {
            "map": lambda: label(SAMPLE_PIXELS, 1),
            "bare run": lambda: full_run(model),
            "run": lambda: simulate(Model("linearized", a=A), "plus"),
        },
        5,
    )
    pixel = cost["map"] / SAMPLE_PIXELS**2
    header = [
        "pixels",
        "cores",
        "minutes",
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
                cores,
                f"{wall / 60:.2f}",
                int(np.count_nonzero(labels < 0)),
                f"{times.mean():.0f}",
                f"{cost['run'] / pixel:.0f}",
                f"{cost['bare run'] / pixel:.0f}",
            ]
        ],
    )


def exponents() -> None:
    """Measure the maps of exponents and print their table."""
    rows = []
    for name, values in OTHER.items():
        begin = time.process_time()
        runs = sweep(Model("nonlinear"), INITIAL, a=PLANE_A, **{name: values}, **SETTINGS)
        seconds = time.process_time() - begin
        largest = runs["lyapunov_exponent"].values[..., 0]
        chaotic = int((largest > 2.0 * runs["lyapunov_error"].values[..., 0]).sum())
        rows.append([f"a, {name}", largest.size, f"{seconds:.0f}", f"{1e3 * seconds / largest.size:.1f}", chaotic])
    print_table(["parameters", "points", "CPU s", "ms a point", "largest exponent above twice its error"], rows)


def main() -> None:
    """Measure and print the tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0], allow_abbrev=False)
    parser.add_argument("--pixels", type=int, default=1024, help="pixels along each axis (default: %(default)s)")
    parser.add_argument("--cores", type=int, default=2, help="cores (default: %(default)s)")
    options = parser.parse_args()
    basins(options.pixels, options.cores)
    exponents()


if __name__ == "__main__":
    main()
