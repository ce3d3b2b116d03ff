"""Durations of jobs: the mean of the finished jobs of a rule in this run or the last one, otherwise the shipped value.

`durations.json`, written by `benchmarks/durations.py`, contains for each rule the seconds of a job, times its cores,
and its bytes in a small and in a large study.
"""

from __future__ import annotations

import json
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from math import prod
from pathlib import Path
from statistics import fmean, median

from burridge_knopoff.report.stages import job_costs
from burridge_knopoff.study.chunks import chunks
from burridge_knopoff.study.study import Study, all_points

FILE = Path(__file__).with_name("durations.json")
#: {rule: one or two rows of the work of a job, its seconds times its cores, and its bytes, sorted by work}
SHIPPED: dict[str, list[list[float]]] = json.loads(FILE.read_text(encoding="utf-8"))
#: The rows of a rule that was never measured.
_OTHERS = [[median(column) for column in zip(*(rows[0] for rows in SHIPPED.values()), strict=True)]]


def measured_seconds(benchmark: str | Path, cores: float) -> float | None:
    """Return the duration of a job in seconds, times its cores, from its benchmark file; None if it has none."""
    return next((wall * cores for wall, *_ in job_costs(Path(benchmark))), None)


@dataclass(frozen=True)
class Durations:
    """Durations of the jobs of a study.

    work : {rule: amount of work of one of its jobs}, see `work_of`
    last : {rule: seconds of each of its jobs in the last run, times their cores}
    """

    work: Mapping[str, float] = field(default_factory=dict)
    last: Mapping[str, Sequence[float]] = field(default_factory=dict)

    def shipped_cost(self, rule: str) -> tuple[float, float]:
        """Return the shipped seconds of a job, times its cores, and its bytes, interpolated between its two rows."""
        first, *others = SHIPPED.get(rule, _OTHERS)
        last, work = [*others, first][0], self.work.get(rule, self.work.get("all points", 0.0))
        share = max(0.0, (work - first[0]) / (last[0] - first[0])) if others else 0.0
        seconds, size = (low + share * (high - low) for low, high in zip(first[1:], last[1:], strict=True))
        return seconds, size

    def expected(self, rules: Collection[str], finished: Mapping[str, Sequence[float]]) -> dict[str, float]:
        """Return {rule: expected seconds of a job, times its cores}.

        finished : {rule: seconds of each job that has finished in this run, times its cores}
        """
        known = {**self.last, **finished}
        shipped = sum(len(jobs) * self.shipped_cost(rule)[0] for rule, jobs in known.items())
        # The ratio of durations on this machine to the shipped ones.
        ratio = sum(map(sum, known.values())) / shipped if shipped else 1.0
        return {rule: fmean(known[rule]) if rule in known else ratio * self.shipped_cost(rule)[0] for rule in rules}


def work_of(study: Study) -> dict[str, float]:
    """Return {rule: amount of work of one of its jobs}, each in its own unit; other rules read or draw "all points"."""
    config, laws, values = study.config, len(study.laws), len(study.grid)
    search, basins, phases, chains = (config[name] for name in ("attractors", "basins", "phases", "chains"))
    pair, time = chains.get("two_blocks", {"a": [], "samples": 0}), config["transient"] + config["window"]
    swept = [len(phases[name]) for name in ("a", "inner_share", "amplitude", "phase_difference")]
    return {
        "all points": len(all_points(study)),
        "simulate": study.blocks * time,
        "simulate_solver": study.blocks * time,
        "chunk": study.blocks * time * max(map(len, chunks(study).values()), default=0),
        "attractors_of_law": study.blocks * search["samples"] * (search["transient"] + search["window"]) * values,
        "basin_tile": basins["pixels"] ** 2 / basins["tiles"],
        "basin_pairs": basins["pairs"],
        "basins": len(study.basin_maps),
        "bifurcations_of_law": values,
        "edges_of_law": len(config.get("edges", {"a": []})["a"]),
        "phases_of_law": phases["samples"] * prod(swept),
        "two_blocks": pair["samples"] * len(pair["a"]) * laws * time,
        "watch_chain": chains["samples"] * len(chains["a"]) * len(chains["laws"]) * chains["time_limit"],
    }
