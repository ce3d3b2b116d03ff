"""CPU time of one trajectory, and of many at once: this package compared with heyoka.py, SciPy and the paper's method.

The run is that of a grid point of the study, with all its observables: the event sequence with states, <J> over the
window, J every 5 time units, section crossings with their velocity and direction, and the last 30 time units. One
thread, process CPU time, start-up and compilation excluded, median of runs in alternation. SciPy and rk4 are too slow
for that: they run to an earlier end, and their time is scaled. SciPy searches for sign changes from step to step, and
so misses sticks and slips shorter than a step.

The ensemble consists of random states whose events are counted, without observables, and is compared with heyoka's
batch mode.
"""

from __future__ import annotations

import argparse
import os

os.environ["OPENBLAS_NUM_THREADS"] = "1"

import numpy as np
from measure import cpu_times, print_table
from peer_heyoka import HeyokaPeer
from peer_heyoka_batch import HeyokaBatch
from peer_run import HORIZON, event_time_difference
from peer_scipy import ScipyPeer

from burridge_knopoff import Model, simulate
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.running.ensemble import new_ensemble

A = 0.08
V = 0.1
TRANSIENT, WINDOW = 3000.0, 7000.0
SCIPY_TRANSIENT, SCIPY_WINDOW = 100.0, 200.0
# The paper's step; two time units of it are two million steps.
RK4_STEP, RK4_WINDOW = 1e-6, 2.0
LAWS = ("linearized", "nonlinear")
MEMBERS, ENSEMBLE_END = 256, 150.0


def compare(law: str, state: str, rounds: int) -> list[list[str]]:
    """Return the rows of one law and initial state."""

    def ours(transient: float = TRANSIENT, window: float = WINDOW, **settings):
        # The peers compute no Lyapunov exponents.
        settings = {"events": "all", "lyapunov_exponents": 0, **settings}
        return simulate(Model(law, a=A, v=V), state, transient=transient, window=window, **settings)

    def paper():
        return ours(0.0, RK4_WINDOW, solver="rk4", step=RK4_STEP)

    initial = PAPER_STATES[state]
    heyoka = HeyokaPeer(law, A, V)
    scipy = ScipyPeer(law, A, V)
    ends = ((TRANSIENT, WINDOW), (SCIPY_TRANSIENT, SCIPY_WINDOW), (0.0, RK4_WINDOW))
    runs = (heyoka.run(initial, *ends[0]), scipy.run(initial, *ends[1]), paper())
    own_runs = [ours(*end) for end in ends]
    full = cpu_times({"ours": ours, "heyoka": lambda: heyoka.run(initial, *ends[0])}, rounds)
    slow = cpu_times({"scipy": lambda: scipy.run(initial, *ends[1]), "rk4": paper}, max(rounds // 5, 1))
    duration = TRANSIENT + WINDOW
    cpu = {
        "heyoka.py": full["heyoka"],
        "SciPy DOP853": slow["scipy"] * duration / (SCIPY_TRANSIENT + SCIPY_WINDOW),
        f"rk4, step {RK4_STEP:g}": slow["rk4"] * duration / RK4_WINDOW,
    }
    measured = ("whole run", f"τ = {SCIPY_TRANSIENT + SCIPY_WINDOW:g}, scaled", f"τ = {RK4_WINDOW:g}, scaled")
    rows = []
    for (name, seconds), extent, run, reference in zip(cpu.items(), measured, runs, own_runs, strict=True):
        ratio = seconds / full["ours"]
        rows.append(
            [
                f"{ratio:.1f}" if ratio < 100 else f"{ratio:.0f}",
                law,
                state,
                name,
                f"{1e3 * full['ours']:.1f}",
                f"{1e3 * seconds:.1f}" if seconds < 10 else f"{1e3 * seconds:.3g}",
                extent,
                f"{len(run.event_time)} / {len(reference.event_time)}",
                f"{abs(run.mean_distance - reference.mean_distance):.0e}",
                event_time_difference(run, reference),
            ]
        )
    return rows


def together(law: str, rounds: int) -> list[str]:
    """Return the row of one law: an ensemble in the lanes of vectors, here and there."""
    generator = np.random.default_rng(1)
    position, velocity = generator.uniform(-0.5, 0.4, (MEMBERS, 3)), generator.uniform(0.0, 0.2, (MEMBERS, 3))
    ensemble, heyoka = new_ensemble(Model(law, a=A, v=V)), HeyokaBatch(law, A, V)

    def ours():
        return ensemble.run(position, velocity, np.zeros((MEMBERS, 3)), [ENSEMBLE_END])

    reference, (final, events) = ours(), heyoka.run(position, velocity, ENSEMBLE_END)
    times = {"ours": ours, "heyoka": lambda: heyoka.run(position, velocity, ENSEMBLE_END)}
    cpu = {name: 1e6 * seconds / MEMBERS for name, seconds in cpu_times(times, rounds).items()}
    difference = np.abs(final - reference["position"][:, 0]).max()
    counts = f"{events} / {reference['event_count'].sum()}"
    ratio = f"{cpu['heyoka'] / cpu['ours']:.1f}"
    return [ratio, law, f"{cpu['ours']:.1f}", f"{cpu['heyoka']:.1f}", counts, f"{difference:.0e}"]


def main() -> None:
    """Run the comparisons and print their tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0], allow_abbrev=False)
    parser.add_argument("--rounds", type=int, default=15, help="runs of each contestant (default: %(default)s)")
    rounds = parser.parse_args().rounds
    rows = [row for law in LAWS for state in ("plus", "minus") for row in compare(law, state, rounds)]
    print(f"\nOne trajectory to τ = {TRANSIENT + WINDOW:g}, a = {A}, v = {V}, with all observables; ms of CPU.")
    print("Ratio: CPU of the peer over that of the solver.\n")
    header = ["ratio", "law", "initial", "peer", "ours ms", "peer ms", "measured on"]
    header += ["events peer / ours", "Δ<J>", f"Δ event times to {HORIZON:g}"]
    print_table(header, rows)
    print(f"\n{MEMBERS} trajectories to τ = {ENSEMBLE_END:g} at once, bare; heyoka.py in batch mode; µs of CPU each.\n")
    header = ["ratio", "law", "ours µs", "peer µs", "events peer / ours", "Δ x"]
    print_table(header, [together(law, rounds) for law in LAWS])


if __name__ == "__main__":
    main()
