"""Tests how well tori and chaos are distinguished, by windows of 2.4 million time units, fifty times as long.

    python benchmarks/tori.py results/paper

A torus that proves to be chaos or a slowly attracting periodic orbit, and chaos that proves to be regular, would have
another kind in the study's files if the search used such windows. All tori and chaotic attractors of the grid
are tested, and every eighth at the values of a between: the thresholds of the search were chosen without these.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import xarray
from measure import print_table

from burridge_knopoff.model.model import ChainState
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


def resolved(study: Study, law: str, places: list[xarray.Dataset]) -> list[object]:
    """Return the number of attractors, and their kinds in the longer window.

    These are the numbers of chaotic attractors, of others, and of periodic orbits, with their values of a.
    """
    chaotic, closed = 0, []
    for one in places:
        model, velocity = study.model(law, float(one["a"])), one["velocity"].values
        start = ChainState(one["position"].values - model.sliding_offset, velocity, velocity == 0.0)
        trajectory = run(model, start, OPTIONS)
        above, below = trajectory.lyapunov_exponent / (CERTAIN * trajectory.lyapunov_error)
        chaotic += int(above > 1.0)
        if below < -1.0 and above <= 1.0:
            closed.append(float(one["a"]))
    return [len(places), chaotic, len(places) - chaotic, len(closed), ", ".join(f"{a:g}" for a in closed)]


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
            "at a",
        ]
        print_table(head, rows)


if __name__ == "__main__":
    main()
