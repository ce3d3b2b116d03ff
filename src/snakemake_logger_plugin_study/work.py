"""How much a job has to do, as far as the config of its study tells: what durations are in proportion to."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from itertools import pairwise
from math import prod
from pathlib import Path

from burridge_knopoff.study import Study, all_points

#: The search for attractors refines some of the gaps between values of a, if any is wide enough: so many values more,
#: by measurement.
_VALUES_BETWEEN = 6.6
#: What a long job keeps last of all, about once for every gap between values of a; and what is spared at most.
_LAST = {"attractors_of_law": "refined", "edges_of_law": "followed"}
_SPARED = 0.9


def work_of(study: Study, rule: str, wildcards: Mapping[str, str], kept: str | None = None) -> tuple[str, float]:
    """Return the kind of a job, which shares its durations, and how much it has to do, in units of that kind.

    kept : folder in which a long job keeps what it has found at values of a, and between them

    A rule is a kind, or several by wildcards that decide how fast it is. Jobs of rules that are not named here read, or
    draw, every point of the study.
    """
    kind = " ".join([rule, *(wildcards[name] for name in _BY_WILDCARD.get(rule, ()))])
    units = _UNITS.get(rule)
    work = float(len(all_points(study)) if units is None else units(study))
    if kept and len(study.grid) > 1:
        done = sum(1 for _ in Path(kept, _LAST[rule]).glob("*")) / (len(study.grid) - 1)
        work *= 1.0 - _SPARED * min(1.0, done)
    return kind, work


_BY_WILDCARD = {"simulate_solver": ("solver",), "attractors_of_law": ("law",), "edges_of_law": ("law",)}


def _run(study: Study) -> float:
    """Time units of all blocks of a run."""
    return study.blocks * (study.config["transient"] + study.config["window"])


def _search(study: Study) -> float:
    """Time units of all blocks of a search for attractors under one law."""
    section = study.config["attractors"]
    time = section["transient"] + section["window"]
    widest = max((after - before for before, after in pairwise(study.grid.values())), default=0.0)
    between = _VALUES_BETWEEN if study.config["refine"]["resolution"] < widest else 0.0
    return study.blocks * section["samples"] * time * (len(study.grid) + between)


def _phases(study: Study) -> float:
    section = study.config["phases"]
    values = (section[name] for name in ("a", "amplitude", "phase_difference"))
    return section["samples"] * prod(map(len, values))


def _two_blocks(study: Study) -> float:
    section = study.config["chains"]["two_blocks"]
    time = study.config["transient"] + study.config["window"]
    return section["samples"] * len(section["a"]) * len(study.laws) * time


def _chain(study: Study) -> float:
    section = study.config["chains"]
    samples = section["samples"] + section["symmetric_samples"]
    return samples * len(section["a"]) * len(section["laws"]) * section["time_limit"]


_UNITS: dict[str, Callable[[Study], float]] = {
    "simulate": _run,
    "simulate_solver": _run,
    "attractors_of_law": _search,
    "edges_of_law": lambda study: len(study.grid),
    "basin_tile": lambda study: study.config["basins"]["pixels"] ** 2 / study.config["basins"]["tiles"],
    "basin_pairs": lambda study: study.config["basins"]["pairs"],
    "basins": lambda study: len(study.basin_maps),
    "phases_of_law": _phases,
    "two_blocks": _two_blocks,
    "watch_chain": _chain,
    "proof": lambda study: len(study.proved_laws),
}
