"""Tests how well tori and chaos are distinguished, by windows of 2.4 million time units, fifty times as long.

    python benchmarks/tori.py results/paper

A torus that proves to be chaos, and chaos that proves to be regular, would have another kind in the study's files if
the search used such windows. A torus whose second exponent is negative is locked to a periodic orbit; its period, after
which it repeats to 1e-6, should exceed `motion.longest_period`. All tori and chaotic attractors of the grid are tested,
and every eighth at the values of a between: the thresholds of the search were chosen without these.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import xarray
from measure import print_table

from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.motion.kind import CHAOS, MotionKind
from burridge_knopoff.running.settings import Settings
from burridge_knopoff.running.simulation import run
from burridge_knopoff.study.recorded import recorded_study
from burridge_knopoff.study.study import Study

TRANSIENT, WINDOW = 3000.0, 2.4e6
CERTAIN = 3.0
OPTIONS = Settings(
    transient=TRANSIENT,
    window=WINDOW,
    batches=6,
    sampling=WINDOW,
    trajectory=0.0,
    events="none",
    lyapunov_exponents=2,
    lyapunov_alignment=TRANSIENT,
)
#: The time within which periodic orbits repeat if their period is found, and to what distance.
PERIODS, REPEATED = 2.4e5, 1e-6


def period(model: Model, state: ChainState) -> float:
    """Return the time after which a stop of the first block is repeated, infinity if it takes longer than `PERIODS`."""
    options = Settings(transient=0.0, window=PERIODS, batches=2, sampling=PERIODS, trajectory=0.0, events="all")
    trajectory = run(model, state, options)
    stops = (trajectory.event_block == 1) & (trajectory.event_kind == 0)
    states = np.hstack([trajectory.event_position, trajectory.event_velocity])[stops]
    near = np.flatnonzero(np.abs(states[:-1] - states[-1]).max(axis=1) < REPEATED)
    times = trajectory.event_time[stops]
    return float(times[-1] - times[near[-1]]) if len(near) else np.inf


def resolved(study: Study, law: str, places: list[xarray.Dataset]) -> list[object]:
    """Return the number of attractors, and their kinds in the longer window.

    These are the numbers of chaotic attractors, of others, and of periodic orbits, with their values of a and periods.
    """
    chaotic, closed = 0, []
    for attractor in places:
        model, velocity = study.model(law, float(attractor["a"])), attractor["velocity"].values
        start = ChainState(attractor["position"].values - model.sliding_offset, velocity, velocity == 0.0)
        trajectory = run(model, start, OPTIONS)
        above, below = trajectory.lyapunov_exponent / (CERTAIN * trajectory.lyapunov_error)
        chaotic += int(above > 1.0)
        if below < -1.0 and above <= 1.0:
            closed.append(f"{model.parameter('a'):g} ({period(model, trajectory.final):.0f})")
    return [len(places), chaotic, len(places) - chaotic, len(closed), ", ".join(closed)]


def places(dataset: xarray.Dataset, kinds: tuple[MotionKind, ...], every: int) -> list[xarray.Dataset]:
    """Return every n-th attractor of these kinds, n being `every`, one of each mirror pair."""
    wanted = np.isin(dataset["kind"].values, kinds) & (dataset["side"].values >= 0)
    return [dataset.isel({dataset["kind"].dims[0]: a, "attractor": slot}) for a, slot in np.argwhere(wanted)[::every]]


def main() -> None:
    """Print the table of each study."""
    for results in map(Path, sys.argv[1:]):
        _, study = recorded_study(results)
        grid, refined = (xarray.load_dataset(results / f"summary/{name}.nc") for name in ("attractors", "refined"))
        rows = []
        for law in study.laws:
            values = refined.sel(law=law)
            between = values.isel(value=np.flatnonzero(values["in_grid"].values == 0))
            for words, kinds in (("torus", (MotionKind.QUASIPERIODIC,)), ("chaos", CHAOS)):
                for where, dataset, every in (("grid", grid.sel(law=law), 1), ("between", between, 8)):
                    rows.append([law, where, words, *resolved(study, law, places(dataset, kinds, every))])
        head = [
            "law",
            "values of a",
            "found to be",
            "attractors",
            "chaos",
            "no chaos",
            "of these periodic orbits",
            "at a (period)",
        ]
        print_table(head, rows)


if __name__ == "__main__":
    main()
