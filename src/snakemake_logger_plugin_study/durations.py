"""What jobs take: durations and sizes that the tree ships, corrected by what jobs have taken here.

`durations.json`, made by `benchmarks/durations.py`, holds for each kind of job seconds and bytes, each as a fixed part
and one in proportion to its work, and the seconds of the calibration on the same machine: the ratio to those that it
takes here tells how fast this machine is.
"""

from __future__ import annotations

import json
import timeit
from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from math import prod
from pathlib import Path
from typing import Any

from burridge_knopoff.study import Study, all_points

FILE = Path(__file__).with_name("durations.json")
SHIPPED: dict[str, Any] = json.loads(FILE.read_text(encoding="utf-8"))
#: Of a kind that nobody has measured: seconds to start a script with its libraries, and bytes of a small file.
UNKNOWN = (1.5, 0.0, 50_000.0, 0.0)
#: Seconds of jobs for which what was known before counts as much as what has finished: of all kinds, and of one.
WEIGHT, WEIGHT_OF_KIND = 5.0, 2.0
#: Of the calibration: runs, of which the fastest counts, and time units of each: short, to slip between other programs.
RUNS, UNITS = 12, 5000.0

#: Wildcards that decide how fast a job is.
_BY_WILDCARD = {"simulate_solver": "solver", "attractors_of_law": "law", "edges_of_law": "law"}
#: The search for attractors refines some gaps between values of a if any is wide enough: so many more, by measurement.
_VALUES_BETWEEN = 6.6
#: What a long job keeps last of all, about once for every gap between values of a; and what is spared at most.
_LAST = {"attractors_of_law": "refined", "edges_of_law": "followed"}
_SPARED = 0.9


@dataclass(frozen=True)
class Durations:
    """What jobs take on a machine.

    costs : {kind: (seconds, seconds a unit of work, bytes, bytes a unit of work)} on another one
    speed, factors : ratios of the seconds here to those there, of kinds that have never run here and of the others
    """

    costs: Mapping[str, Sequence[float]] = field(default_factory=dict)
    speed: float = 1.0
    factors: Mapping[str, float] = field(default_factory=dict)

    def cost(self, kind: str, work: float) -> tuple[float, float]:
        """Return the seconds that a job takes, of all its threads together, and the bytes of the files that it makes.

        What is not known, as of a law of one's own, costs as much as the slowest kind of its rule.
        """
        known = self.costs.get(kind)
        if known is None:
            rule = kind.partition(" ")[0]
            alike = [cost for name, cost in self.costs.items() if name.partition(" ")[0] == rule]
            known = max(alike, key=lambda cost: cost[1], default=UNKNOWN)
        seconds, rate, size, size_rate = known
        return (seconds + rate * work) * self.factors.get(kind, self.speed), size + size_rate * work

    def corrected(self, known: Iterable[tuple[str, float, float]]) -> Durations:
        """Return the same, corrected by jobs of which (kind, work, seconds) are known, and more by those of a kind."""
        taken: dict[str, float] = defaultdict(float)
        thought: dict[str, float] = defaultdict(float)
        for kind, work, seconds in known:
            taken[kind] += seconds
            thought[kind] += self.cost(kind, work)[0]
        weight, of_kind = WEIGHT * self.speed, WEIGHT_OF_KIND * self.speed
        speed = (sum(taken.values()) + weight) / (sum(thought.values()) + weight)
        factors = {
            kind: self.factors.get(kind, self.speed)
            * (taken[kind] + of_kind * speed)
            / (thought[kind] + of_kind)
            for kind in taken.keys() | self.factors.keys()
        }
        return Durations(self.costs, self.speed * speed, factors)


def calibrate() -> float:
    """Return the seconds that a fixed simulation takes on this machine now; raises ImportError without a kernel."""
    from burridge_knopoff import simulate

    def run() -> None:
        simulate("linearized", 0.08, "plus", transient=0.001, window=UNITS)

    return min(timeit.repeat(run, number=1, repeat=RUNS))


def work_of(study: Study, rule: str, wildcards: Mapping[str, str], kept: str | None = None) -> tuple[str, float]:
    """Return the kind of a job, which shares its durations, and how much it has to do, in units of that kind.

    kept : folder in which a long job keeps what it has found at values of a, and between them
    """
    kind = f"{rule} {wildcards[_BY_WILDCARD[rule]]}" if rule in _BY_WILDCARD else rule
    work = float(_units(study, rule))
    if kept and len(study.grid) > 1:
        done = sum(1 for _ in Path(kept, _LAST[rule]).glob("*")) / (len(study.grid) - 1)
        work *= 1.0 - _SPARED * min(1.0, done)
    return kind, work


def _units(study: Study, rule: str) -> float:
    """Return the work of a job as far as the config tells; of what reads or draws all points, their number."""
    config, grid, chains, phases = study.config, study.grid, study.config["chains"], study.config["phases"]
    time = config["transient"] + config["window"]
    match rule:
        case "simulate" | "simulate_solver":
            return study.blocks * time
        case "attractors_of_law":
            search = config["attractors"]
            widest = max((after - before for before, after in pairwise(grid.values())), default=0.0)
            values = len(grid) + (_VALUES_BETWEEN if config["refine"]["resolution"] < widest else 0.0)
            return study.blocks * search["samples"] * (search["transient"] + search["window"]) * values
        case "edges_of_law":
            return len(grid)
        case "basin_tile":
            return config["basins"]["pixels"] ** 2 / config["basins"]["tiles"]
        case "basin_pairs":
            return config["basins"]["pairs"]
        case "basins":
            return len(study.basin_maps)
        case "phases_of_law":
            return phases["samples"] * prod(len(phases[name]) for name in ("a", "amplitude", "phase_difference"))
        case "two_blocks":
            runs = chains["two_blocks"]["samples"] * len(chains["two_blocks"]["a"]) * len(study.laws)
            return runs * time
        case "watch_chain":
            samples = chains["samples"] + chains["symmetric_samples"]
            return samples * len(chains["a"]) * len(chains["laws"]) * chains["time_limit"]
        case "proof":
            return len(study.proved_laws)
    return len(all_points(study))
