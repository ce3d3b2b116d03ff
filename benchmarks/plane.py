"""CPU time of Lyapunov exponents over a plane of two parameters: two blocks, 100 values of a and 100 of v or coupling.

python benchmarks/plane.py
"""

import time

import numpy as np
from measure import print_table

from burridge_knopoff import sweep

SIDE = 100
INITIAL = {"position": [-0.9, -1.1], "velocity": [0.1, 0.1]}
SETTINGS = {"transient": 500.0, "window": 1000.0, "lyapunov_alignment": 500.0, "lyapunov_exponents": 1}
A = np.linspace(0.05, 3.0, SIDE)
OTHER = {"v": np.linspace(0.02, 0.5, SIDE), "coupling": np.linspace(0.2, 5.0, SIDE)}


def main():
    """Print the table."""
    rows = []
    for name, values in OTHER.items():
        begin = time.process_time()
        runs = sweep("nonlinear", A, INITIAL, **{name: values}, **SETTINGS)
        seconds = time.process_time() - begin
        largest = runs["lyapunov_exponent"].values[..., 0]
        chaotic = int((largest > 2.0 * runs["lyapunov_error"].values[..., 0]).sum())
        rows.append([f"a, {name}", largest.size, f"{seconds:.0f}", f"{1e3 * seconds / largest.size:.1f}", chaotic])
    print_table(["parameters", "points", "CPU s", "ms a point", "largest exponent above twice its error"], rows)


if __name__ == "__main__":
    main()
