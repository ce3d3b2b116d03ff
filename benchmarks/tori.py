"""How far tori are resolved: those of a study in windows of 2.4 million time units, ten times as long as the search's.

    python benchmarks/tori.py results/paper

A torus that proves to be chaos there, or a closed orbit that attracts slowly, would have another kind in attractors.nc
if the search looked so long.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import xarray
from measure import print_table

from burridge_knopoff.model.model import Instant
from burridge_knopoff.running.settings import Settings
from burridge_knopoff.running.simulation import run
from burridge_knopoff.stability.motion import MotionKind
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


def resolved(study: Study, law: str, attractors: xarray.Dataset) -> list[object]:
    """Return how many tori a study has under a law, one of each mirror pair, and what becomes of them.

    That is how many are chaos in the longer window, and how many are closed orbits, with their rates and values of a.
    """
    count, chaotic, closed = 0, 0, []
    for a, slot in np.argwhere((attractors["kind"] == MotionKind.QUASIPERIODIC).values):
        one = attractors.isel(a=a, attractor=slot)
        if one["side"] < 0:
            continue
        model, velocity = study.model(law, float(one["a"])), one["velocity"].values
        start = Instant(one["position"].values - model.sliding_offset, velocity, velocity == 0.0)
        trajectory = run(model, start, OPTIONS)
        above, below = trajectory.lyapunov_exponent / (CERTAIN * trajectory.lyapunov_error)
        count += 1
        chaotic += int(above > 1.0)
        if below < -1.0:
            closed.append((float(one["a"]), -trajectory.lyapunov_exponent[1]))
    rates = f"{min(rate for _, rate in closed):.1e} to {max(rate for _, rate in closed):.1e}" if closed else ""
    return [count, chaotic, len(closed), rates, ", ".join(f"{a:g}" for a, _ in closed)]


def main() -> None:
    """Print the table of each study."""
    for results in map(Path, sys.argv[1:]):
        _, study = recorded_study(results)
        attractors = xarray.load_dataset(results / "summary/attractors.nc")
        rows = [[law, *resolved(study, law, attractors.sel(law=law))] for law in study.laws]
        print_table(["law", "tori", "chaos", "closed orbits", "their rates", "at a"], rows)


if __name__ == "__main__":
    main()
