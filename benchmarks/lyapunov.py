"""CPU time of a trajectory with Lyapunov exponents, relative to the trajectory alone.

The perturbations are carried along the whole run, transient and window; the default of the study carries them along
four fifths of it. One thread, process CPU time of `simulate`, median of runs in alternation.
"""

from __future__ import annotations

import argparse
import os

os.environ["OPENBLAS_NUM_THREADS"] = "1"

from chains import near_sliding
from measure import cpu_times, print_table

from burridge_knopoff import FormulaLaw, InitialState, Law, Model, law_of, simulate
from burridge_knopoff.model.initial import PAPER_STATES

A = 0.08
#: A power steepens with the speed, beyond all speeds of slips.
POWER = "1 - a*u + 0.3*u**6"
LAWS = (law_of("linearized", a=A), law_of("nonlinear", a=A), FormulaLaw(POWER, a=A))
TRANSIENT, WINDOW = 3000.0, 7000.0
LONG_CHAIN = 10


def compare(law: Law, initial: InitialState, window: float, counts: tuple[int, ...], rounds: int) -> list[list[str]]:
    """Return a row for each number of exponents."""

    def contestant(count: int):
        settings = {"transient": TRANSIENT, "window": window, "events": "all", "lyapunov_alignment": TRANSIENT}
        return lambda: simulate(Model(law), initial=initial, lyapunov_exponents=count, **settings)

    runs = {str(count): contestant(count) for count in (0, *counts)}
    for run in runs.values():
        run()
    seconds = cpu_times(runs, rounds)
    rows = []
    for count in counts:
        ratio = seconds[str(count)] / seconds["0"]
        rows.append(
            [
                f"{ratio:.2f}",
                str(count),
                str(len(initial.position)),
                law.formula if isinstance(law, FormulaLaw) else law.name,
                initial.name,
                f"{1e3 * seconds['0']:.1f}",
                f"{1e3 * seconds[str(count)]:.1f}",
            ]
        )
    return rows


def main() -> None:
    """Measure three blocks and a longer chain, and print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0], allow_abbrev=False)
    parser.add_argument("--rounds", type=int, default=15, help="runs of each contestant (default: %(default)s)")
    rounds = parser.parse_args().rounds
    rows = []
    for law in LAWS:
        for initial in PAPER_STATES.values():
            rows += compare(law, initial, WINDOW, (1, 3, 6), rounds)
        rows += compare(law, near_sliding(LONG_CHAIN, law), WINDOW, (3, 2 * LONG_CHAIN), rounds)
    print(f"\nOne run to τ = {TRANSIENT + WINDOW:g}, a = {A}, all events and observables; ms of CPU.\n")
    header = ["ratio", "exponents", "N", "law", "initial", "without ms", "with ms"]
    print_table(header, rows)


if __name__ == "__main__":
    main()
