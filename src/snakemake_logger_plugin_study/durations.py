"""Durations of jobs: the mean of the finished jobs of a rule in this run or the last one, otherwise the shipped value.

`durations.json`, written by `benchmarks/durations.py`, contains for each rule the seconds of a job, times its cores,
and its bytes in a small and in a large study; without the simulation itself, whose cost `running/cost.py` estimates.
"""

from __future__ import annotations

import json
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from math import log2, prod
from pathlib import Path
from statistics import fmean, median

from burridge_knopoff.model.model import Model
from burridge_knopoff.report.stages import job_costs
from burridge_knopoff.running.cost import run_seconds, stiffness
from burridge_knopoff.running.settings import Settings
from burridge_knopoff.study.chunks import chunks
from burridge_knopoff.study.study import Study, all_points

FILE = Path(__file__).with_name("durations.json")
#: {rule: one or two rows of the work of a job, its seconds times its cores, and its bytes, sorted by work}
SHIPPED: dict[str, list[list[float]]] = json.loads(FILE.read_text(encoding="utf-8"))
#: The rows of a rule that was never measured.
_OTHERS = [[median(column) for column in zip(*(rows[0] for rows in SHIPPED.values()), strict=True)]]

#: Measured: what a search does at each a besides labelling random states costs as much as labelling so many.
GIVEN_STATES = 400
#: Most models by which the cost of points is estimated.
MODELS = 20


def measured_seconds(benchmark: str | Path, cores: float) -> float | None:
    """Return the duration of a job in seconds, times its cores, from its benchmark file; None if it has none."""
    return next((wall * cores for wall, *_ in job_costs(Path(benchmark))), None)


@dataclass(frozen=True)
class Durations:
    """Durations of the jobs of a study.

    work : {rule: amount of work of one of its jobs}, see `work_of`
    last : {rule: seconds of each of its jobs in the last run, times their cores}
    runs : {rule: seconds of the simulation in one of its jobs}, see `run_seconds_of`
    """

    work: Mapping[str, float] = field(default_factory=dict)
    last: Mapping[str, Sequence[float]] = field(default_factory=dict)
    runs: Mapping[str, float] = field(default_factory=dict)

    def shipped_cost(self, rule: str) -> tuple[float, float]:
        """Return the shipped seconds of a job, times its cores, and its bytes, interpolated between its two rows."""
        first, *others = SHIPPED.get(rule, _OTHERS)
        last, work = [*others, first][0], self.work.get(rule, self.work.get("all points", 0.0))
        share = max(0.0, (work - first[0]) / (last[0] - first[0])) if others else 0.0
        seconds, size = (low + share * (high - low) for low, high in zip(first[1:], last[1:], strict=True))
        return seconds + self.runs.get(rule, 0.0), size

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
    """Return {rule: amount of work of one of its jobs}, each in its own unit; other rules read or draw "all points".

    Stiff dashpots or springs prolong all motion.
    """
    config, laws, values = study.config, len(study.laws), len(study.grid)
    search, basins, phases, chains = (config[name] for name in ("attractors", "basins", "phases", "chains"))
    pair, time = chains.get("two_blocks", {"a": [], "samples": 0}), config["transient"] + config["window"]
    swept = [len(phases[name]) for name in ("a", "inner_share", "amplitude", "phase_difference")]
    stiff = fmean(stiffness(model.chain) for model in _models(study, study.laws[0]))
    states = stiff * study.blocks * (search["samples"] + GIVEN_STATES) * (search["transient"] + search["window"])
    return {
        "all points": len(all_points(study)),
        "simulate": study.blocks * time,
        "simulate_solver": study.blocks * time,
        "chunk": study.blocks * time * _chunk_size(study),
        "attractors_of_law": states * values * (1.0 + 0.5 * _halvings(study)),
        "basin_tile": stiff * basins["pixels"] ** 2 / basins["tiles"],
        "basin_pairs": stiff * basins["pairs"],
        "basins": len(study.basin_maps),
        "bifurcations_of_law": stiff * values,
        "edges_of_law": stiff * len(config.get("edges", {"a": []})["a"]),
        "phases_of_law": stiff * phases["samples"] * prod(swept),
        "two_blocks": stiff * pair["samples"] * len(pair["a"]) * laws * time,
        "watch_chain": stiff * chains["samples"] * len(chains["a"]) * len(chains["laws"]) * chains["time_limit"],
    }


def run_seconds_of(study: Study) -> dict[str, float]:
    """Return {rule: seconds of the simulation in one of its jobs}, of rules whose job is a simulation, or several."""
    config, models = study.config, {law: _models(study, law) for law in study.laws}
    run = fmean(_run_seconds(study, model, study.settings(law)) for law in study.laws for model in models[law])
    others = [(law, solver) for law in study.laws if config["solvers"]["a"] for solver in study.other_solvers(law)]
    repeated = [_run_seconds(study, models[law][0], study.settings(law, solver)) for law, solver in others]
    seconds = {"simulate": run, "simulate_solver": fmean(repeated or [0.0]), "chunk": run * _chunk_size(study)}
    if "catalogue" not in config:
        return seconds
    # It has no exponents.
    settings = replace(study.settings(study.laws[0]), lyapunov_exponents=0)
    duration = config["catalogue"]["transient"] + config["catalogue"]["window"]
    recorded = _run_seconds(study, models[study.laws[0]][0], settings) * duration / settings.duration
    return {**seconds, "catalogue_of_run": recorded}


def _chunk_size(study: Study) -> int:
    return max(map(len, chunks(study).values()), default=0)


def _models(study: Study, law: str) -> list[Model]:
    """Return the models under a law at a few points that are evenly spaced in the list of all."""
    others = study.other_values
    return [study.model(law, study.shown_a, **values) for values in others[:: -(-len(others) // MODELS)]]


def _run_seconds(study: Study, model: Model, settings: Settings) -> float:
    return run_seconds(model, model.begin(study.state(study.initial[0]), settings.start), settings)


def _halvings(study: Study) -> float:
    """Return how often an interval between values of a is halved where the attractors change in it."""
    values = [*study.grid.values()]
    step = (values[-1] - values[0]) / max(1, len(values) - 1)
    return max(0.0, log2(step / study.config["refine"]["resolution"])) if step > 0.0 else 0.0
