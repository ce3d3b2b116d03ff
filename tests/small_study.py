"""Studies small enough to run inside a test, by the real workflow."""

from __future__ import annotations

import json
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import xarray

from burridge_knopoff.dataset.summary import open_summary
from burridge_knopoff.model.model import Model
from burridge_knopoff.provenance.record import write_study_record
from burridge_knopoff.study.load import load_study
from burridge_knopoff.study.recorded import recorded_study
from burridge_knopoff.study.study import Study
from tests.workflow.snakemake import run_workflow

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
    "one_block": {
        "a": [0.0],
        "laws": {"belt": {"formula": "mud + (1 - mud)*exp(-u/v0)", "mud": 0.5, "v0": 0.5}},
        "v": 1.5,
        "contact": "symmetric",
        "chain": {"blocks": 1, "pulling_damping": 0.1},
        "initial": {"slow": {"position": [0.5], "velocity": [0.0]}, "fast": {"position": [0.9], "velocity": [0.5]}},
        "solvers": {"a": [0.0], "step": 0.05},
        "attractors": {**SMALL["attractors"], "position": [-2, 2], "velocity": ["v - 2", "v"]},
        "basins": {**SMALL["basins"], "a": {"belt": [0.0]}, "first_velocity": ["v - 2", "v"]},
    },
}

#: Their names, and that of the finished study.
ALL_STUDIES = ("paper", *STUDIES)


@dataclass(frozen=True)
class SmallStudy:
    """A study with some finished jobs; folder : of its results."""

    study: Study
    folder: Path

    @property
    def models(self) -> list[Model]:
        """One model for each law, at the first a."""
        return [self.study.model(law, next(iter(self.study.grid.values()))) for law in self.study.laws]

    @cached_property
    def summaries(self) -> dict[str, xarray.Dataset]:
        """The finished summaries, by name."""
        return {path.stem: open_summary(path) for path in sorted(self.folder.glob("summary/*.nc"))}

    def record(self, config_file: str | Path, config: Mapping[str, Any], arguments: str = "") -> None:
        """Record another config file, its content and other arguments of Snakemake for the same study."""
        study = self.study
        write_study_record(self.folder, study.config, study.parameters, config_file, dict(config), arguments)


def open_small_study(results: Path) -> SmallStudy:
    """Return a study that has run."""
    return SmallStudy(recorded_study(results)[1], results)


#: The rules of the summaries of points and of models, without those that need attractors or other runs.
OF_POINTS = ("mean_distance", "bifurcation_diagram", "lyapunov", "agreement", "stick_slip", "orbits", "equilibrium")


def run_study(results: Path, config: Mapping[str, Any], targets: Collection[str] = ("points",)) -> SmallStudy:
    """Run a study for some targets of the workflow, by default the points, into its results folder, results/<study>."""
    root = results.parents[1]
    root.mkdir(parents=True, exist_ok=True)
    assert results == root / "results" / config["study"]
    (root / "small.yaml").write_text(json.dumps(config))
    run = run_workflow(root, *targets, "--configfile", "small.yaml")
    assert run.returncode == 0, run.stderr
    return SmallStudy(load_study(config, "small.yaml"), results)
