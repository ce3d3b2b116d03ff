"""Runs in lockstep, each in a lane of vectors, compared with the same runs one by one.

CPU times of a run to τ = 10⁴ with its observables: the smallest of alternated calls, and their ratio. To compare other
vector widths compile with `BURRIDGE_KNOPOFF_LANES=2`, 4 or 8; single runs use at most four lanes.
"""

from __future__ import annotations

import numpy as np
from measure import least, print_table

from burridge_knopoff import InitialState, Model, Settings
from burridge_knopoff.kernel._core import LANES
from burridge_knopoff.running.runner import run_together
from burridge_knopoff.running.simulation import prepare

MEMBERS, ROUNDS = 32, 3
#: Blocks, law, a and exponents.
CASES = (
    (3, "linearized", 0.08, 0),
    (3, "linearized", 0.08, 3),
    (3, "nonlinear", 0.08, 0),
    (3, "nonlinear", 0.08, 3),
    (2, "linearized", 0.3, 1),
    (2, "nonlinear", 0.3, 1),
)


def main() -> None:
    """Measure and print the table."""
    rows = []
    generator = np.random.default_rng(1)
    for blocks, law, a, exponents in CASES:
        model = Model(law, a=a, blocks=blocks)
        settings = Settings(transient=2000.0, window=8000.0, lyapunov_exponents=exponents)
        states = [
            InitialState(
                f"state {k}", tuple(generator.uniform(-0.5, 0.4, blocks)), tuple(generator.uniform(0, 0.2, blocks))
            )
            for k in range(MEMBERS)
        ]

        def runners(model=model, settings=settings, states=states):
            return [prepare(model, state, settings).runner for state in states]

        alone = together = np.inf
        for _ in range(ROUNDS):
            alone = min(alone, least(lambda: [runner.run() for runner in runners()], 1) / MEMBERS)
            together = min(together, least(lambda: run_together(runners()), 1) / MEMBERS)
        rows.append([f"{together / alone:.2f}", law, blocks, exponents, f"{alone:.2f}", f"{together:.2f}"])
    print(f"Vectors of {LANES} doubles.\n")
    print_table(["ratio", "law", "blocks", "exponents", "one by one ms", "in lockstep ms"], rows)


if __name__ == "__main__":
    main()
