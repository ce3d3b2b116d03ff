"""What jobs take: durations and sizes that the tree ships, corrected by what jobs have taken here.

`durations.json`, made by `benchmarks/durations.py`, holds the costs of each kind of job and the seconds of the
calibration on the same machine: the ratio to those that it takes here tells how fast this machine is.
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

from burridge_knopoff.study.study import Study, all_points

FILE = Path(__file__).with_name("durations.json")
SHIPPED: dict[str, Any] = json.loads(FILE.read_text(encoding="utf-8"))
#: Of a kind that nobody has measured: seconds to start a script with its libraries, and bytes of a small file.
UNKNOWN = (1.5, 0.0, 50_000.0, 0.0)
#: Seconds of jobs for which what was known before counts as much as what has finished: of all kinds, and of one.
WEIGHT, WEIGHT_OF_KIND = 5.0, 2.0
#: Wildcards that decide how fast a job is.
_BY_WILDCARD = {"simulate_solver": "solver", "attractors_of_law": "law", "bifurcations_of_law": "law"}
#: The search for attractors refines some gaps between values of a if any is wide enough: so many more, by measurement.
_VALUES_BETWEEN = 6.6
#: Where there are not three blocks, as in what the tree ships, motion is less simple: the search takes as long as with
#: so many samples more for each block, by measurement.
_SAMPLES_A_BLOCK = 20
#: What a long job keeps late, how often for every gap between values of a, and the share of its time that it spares.
_LATE = {"attractors_of_law": ("compared with the next", 1.0, 0.7), "bifurcations_of_law": ("followed", 2.7, 0.9)}


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
        """Return the seconds that a job takes, of all threads together, and the bytes of the files that it makes."""
        known = self.costs.get(kind)
        if known is None:
            # As of a law of one's own: the slowest kind of the rule.
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
            kind: self.factors.get(kind, self.speed) * (taken[kind] + of_kind * speed) / (thought[kind] + of_kind)
            for kind in taken.keys() | self.factors.keys()
        }
        return Durations(self.costs, self.speed * speed, factors)


def calibrate() -> float:
    """Return the seconds that a fixed simulation takes on this machine now; raises ImportError without a kernel."""
    # The fastest of several that are short enough to slip between other programs.
    from burridge_knopoff import simulate

    def run() -> None:
        simulate("linearized", 0.08, "plus", transient=0.001, window=5000.0)

    return min(timeit.repeat(run, number=1, repeat=12))


def work_of(
    units: Mapping[str, float], rule: str, wildcards: Mapping[str, str], kept: str | None = None
) -> tuple[str, float]:
    """Return the kind of a job, which shares its durations, and how much it has to do, in units of its rule.

    kept : folder in which a long job keeps what it has found at values of a, and between them
    """
    kind = f"{rule} {wildcards[_BY_WILDCARD[rule]]}" if rule in _BY_WILDCARD else rule
    work = float(units.get(rule, units["all points"]))
    if kept and units["gaps"]:
        folder, each, spared = _LATE[rule]
        done = sum(1 for _ in Path(kept, folder).glob("*")) / (each * units["gaps"])
        work *= 1.0 - spared * min(1.0, done)
    return kind, work


def units_of(study: Study) -> dict[str, float]:
    """Return {rule: what a job of it has to do}; those of other rules read, or draw, "all points"."""
    config, values, chains = study.config, study.grid.values(), study.config["chains"]
    search, basins, phases, pairs = config["attractors"], config["basins"], config["phases"], chains["two_blocks"]
    time = config["transient"] + config["window"]
    widest = max((after - before for before, after in pairwise(values)), default=0.0)
    searched = len(values) + (_VALUES_BETWEEN if config["refine"]["resolution"] < widest else 0.0)
    more = 0 if study.blocks == 3 else _SAMPLES_A_BLOCK * study.blocks
    states = (search["samples"] + more) * study.blocks / 3
    samples = chains["samples"] + chains["symmetric_samples"]
    return {
        "simulate": study.blocks * time,
        "simulate_solver": study.blocks * time,
        "attractors_of_law": study.blocks * states * (search["transient"] + search["window"]) * searched,
        "two_blocks": 2 * pairs["samples"] * len(pairs["a"]) * len(study.laws) * time,
        "watch_chain": samples * len(chains["a"]) * len(chains["laws"]) * chains["time_limit"],
        "phases_of_law": phases["samples"]
        * prod(len(phases[name]) for name in ("a", "inner_share", "amplitude", "phase_difference")),
        "bifurcations_of_law": len(values),
        "basin_tile": basins["pixels"] ** 2 / basins["tiles"],
        "basin_pairs": basins["pairs"],
        "basins": len(study.basin_maps),
        "proof": len(study.proved_laws),
        "all points": len(all_points(study)),
        "gaps": len(values) - 1,
    }
