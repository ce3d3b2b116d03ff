"""Lifetimes of the chaos of a study, followed for ten times as long as in the search and from other states.

    python benchmarks/lifetimes.py results/paper

Printed for each chaotic set of attractors.nc that trajectories leave in that time, one of each mirror pair: its mean
lifetime with the 95 % interval, in the file and now, and whether it lasts. For all others their number, and a lower
bound of their lifetimes.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import xarray
from measure import print_table

from burridge_knopoff.attractors.attractor import Lifetime
from burridge_knopoff.attractors.lifetime import EXPOSURE, lifetimes
from burridge_knopoff.attractors.settings import SearchSettings
from burridge_knopoff.attractors.stored_returns import known_attractors
from burridge_knopoff.motion.kind import MotionKind
from burridge_knopoff.study.recorded import recorded_study
from burridge_knopoff.study.study import Study

LONGER = 10.0 * EXPOSURE
CHAOTIC = (MotionKind.CHAOTIC, MotionKind.TRANSIENT_CHAOS)


def followed(
    results: Path, study: Study, attractors: xarray.Dataset, law: str
) -> Iterator[tuple[xarray.Dataset, Lifetime]]:
    """Yield each chaotic set of a law as in the file, and its lifetime now."""
    search = SearchSettings(**study.config["attractors"])
    returns = xarray.load_dataset(results / f"returns/{law}.nc")
    part = attractors.sel(law=law)
    for a in part["a"].values[np.isin(part["kind"].values, CHAOTIC).any(axis=1)].tolist():
        point = part.sel(a=a)
        slots = point.isel(attractor=np.flatnonzero(point["branch"].values >= 0))
        candidates = known_attractors(attractors, returns, study.model(law, a)).attractors
        # Sets not shown to last are chaos too.
        sets = [
            replace(item, motion=replace(item.motion, kind=MotionKind.CHAOTIC)) if item.motion.kind in CHAOTIC else item
            for item in candidates
        ]
        spans = lifetimes(study.model(law, a), sets, replace(search, seed=search.seed + 1), LONGER)
        for slot, lifetime in enumerate(spans):
            if lifetime is not None and slots["side"].values[slot] >= 0:
                yield slots.isel(attractor=slot), lifetime


def words(mean: float, low: float, high: float) -> str:
    """Return a lifetime with its interval."""
    return f"{mean:.3g} ({low:.3g} to {high:.3g})"


def main() -> None:
    """Print the table of each study."""
    for results in map(Path, sys.argv[1:]):
        _, study = recorded_study(results)
        attractors = xarray.load_dataset(results / "summary/attractors.nc")
        least = study.config["attractors"]["lifetime"]
        rows, bounds = [], []
        for law in study.laws:
            for attractor, lifetime in followed(results, study, attractors, law):
                if not lifetime.ends:
                    bounds.append(lifetime.interval[0])
                    continue
                before = words(*(attractor[f"lifetime{end}"].item() for end in ("", "_low", "_high")))
                now = words(lifetime.mean, *lifetime.interval)
                kinds = MotionKind(attractor["kind"].item()).words, CHAOTIC[not lifetime.is_longer_than(least)].words
                rows.append(
                    [law, f"{attractor['a'].item():g}", f"{attractor['mean_distance'].item():.4f}", before, now, *kinds]
                )
        print_table(["law", "a", "<J>", "lifetime in the file", "in ten times the time", "kind", "then"], rows)
        print(f"{len(bounds)} other chaotic sets, which none left: longer than {min(bounds, default=0.0):.3g}")


if __name__ == "__main__":
    main()
