"""Studies small enough to run inside a test, in this process, one job after another."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import pytest
import xarray

from burridge_knopoff.dataset.given import Given
from burridge_knopoff.dataset.point import write_point
from burridge_knopoff.dataset.summary import open_summary
from burridge_knopoff.jobs.jobs import Jobs
from burridge_knopoff.jobs.run import do_job
from burridge_knopoff.model.model import Model
from burridge_knopoff.provenance.record import write_study_record
from burridge_knopoff.provenance.sources import source_fingerprint
from burridge_knopoff.running.simulation import run
from burridge_knopoff.study.load import load_study
from burridge_knopoff.study.study import Study
from burridge_knopoff.summaries.points import Grid

ROOT = Path(__file__).parents[1]

#: Runs that are just long enough for data in every panel.
SMALL = {
    "study": "small",
    "a": [0.05, 0.2],
    "initial": {"minus": {}, "plus": {}},
    "transient": 100,
    "window": 200,
    "batches": 2,
    "refine": {"resolution": 1.0},
    "attractors": {
        "samples": 2,
        "fraction_width": 0.25,
        "lifetime": 1000,
        "transient": 100,
        "window": 100,
        "time_limit": 1000,
        "perturbations": 4,
    },
    "basins": {"pixels": 4, "pairs": 10, "tiles": 1},
    "phases": {"amplitude": [0.05, 0.5], "phase_difference": [30, 180], "inner_share": [0, 1], "samples": 2},
    "solvers": {"a": [0.2], "step": 0.05},
    "chains": {"two_blocks": {"a": [0.05, 0.2], "samples": 2}},
}


_EQUAL = [-0.95, -1.0, -0.97]
_STATES = {"pushed": {"position": _EQUAL, "velocity": [0.1, 0.12, 0.09]}}

#: Changes to it in the studies for which every figure and the report are drawn.
STUDIES: dict[str, dict[str, Any]] = {
    "paper": {},
    "one_law": {"laws": {"linearized": {}}, "edges": {"a": [0.05], "duration": 800, "samples": 20}},
    "four_laws": {
        "laws": {
            "linearized": {},
            "nonlinear": {},
            "squared": {"formula": "1/(1 + c*a*u)**2", "c": 0.5},
            "stribeck": {"sigma": 0.3},
        },
        "catalogue": {},
        "edges": {"duration": 800, "samples": 20},
    },
    "ring": {
        "laws": {"slow": {"law": "exponential"}, "linearized": {}, "drop": {"law": "carlson_langer"}},
        "chain": {"ends": "ring"},
        "initial": _STATES,
        "catalogue": {"a": [0.2]},
    },
    "unequal": {
        "laws": {"rough": {"law": "nonlinear"}, "smooth": {"formula": "1 - a*u"}},
        "chain": {"coupling": [1.0, 1.3], "pulling": 1.5, "threshold": [1.0, 1.1, 1.2]},
        "initial": _STATES,
    },
    "two_blocks": {"initial": {"pair": {"position": [-0.9, -1.1], "velocity": [0.1, 0.1]}}},
}

#: Their names as parameters. The finished study of the workflow is like that of the paper; `make test-all` adds the
#: others.
SOME_STUDIES = [pytest.param(name, marks=() if name == "one_law" else pytest.mark.slow) for name in STUDIES]


@dataclass(frozen=True)
class SmallStudy:
    """A study with some finished jobs; folder : of its results."""

    study: Study
    folder: Path

    @property
    def jobs(self) -> Jobs:
        """Its jobs."""
        return Jobs(self.study)

    @property
    def grid(self) -> Grid:
        """Its points."""
        return Grid.from_points(self.folder / "points", self.study.points)

    @property
    def models(self) -> list[Model]:
        """One model for each law, at the first a."""
        return [self.study.model(law, next(iter(self.study.grid.values()))) for law in self.study.laws]

    @cached_property
    def found(self) -> dict[str, xarray.Dataset]:
        """The finished summaries, by name."""
        return {path.stem: open_summary(path) for path in sorted(self.folder.glob("summary/*.nc"))}

    def do(self, names: Collection[str]) -> None:
        """Do the jobs of some stages or rules, after those that they wait for."""
        jobs = self.jobs
        for rule in jobs.existing.values():
            asked = rule.name in names or (rule.stage in names and rule.requested)
            # The points of chunks are run one by one here.
            for job in rule.each if asked and rule.name != "chunk" else ():
                if rule.make:
                    inputs = {
                        name: [self.folder / file for file in files]
                        for name, files in jobs.inputs(rule, job).items()
                        if not name.endswith("points")
                    }
                    given = Given(self.folder, inputs, job, rule.sources[-1], figures=rule.figures)
                    outputs = [self.folder / form.format(**job) for form in rule.files]
                    fingerprint = source_fingerprint(*rule.sources)
                    do_job(rule.make, rule.name, fingerprint, jobs.config(rule, job), given, outputs)
                else:
                    path = self.folder / rule.files[0].format(**job)
                    write_point(run(*self.study.run_of(**job)), path)


#: The stages that make summaries, except proofs.
SUMMARIES = (
    *("points", "attractors", "basins", "bifurcations", "edges", "phases"),
    *("solvers", "catalogue", "two_blocks", "summary"),
)


def run_study(folder: Path, config: Mapping[str, Any], names: Collection[str] = ("points",)) -> SmallStudy:
    """Run some stages or rules of a study, by default the points, into a folder."""
    small = SmallStudy(load_study(config, f"{config['study']}.yaml"), folder)
    write_study_record(folder, small.study.config, small.study.parameters, "small.yaml", dict(config), "")
    small.do(names)
    return small
