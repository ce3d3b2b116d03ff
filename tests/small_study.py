"""Studies small enough to be run inside a test: their points, and the summaries that figures and reports show."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

import xarray

from burridge_knopoff.attractors.settings import SearchSettings
from burridge_knopoff.attractors.stored_returns import KnownAttractors, known_attractors, returns_of_law
from burridge_knopoff.basins.settings import BasinSettings, PhaseSettings
from burridge_knopoff.catalogue.settings import CatalogueSettings
from burridge_knopoff.catalogue.slip_events import catalogue_of_run
from burridge_knopoff.continuation.along_a import continue_attractors
from burridge_knopoff.continuation.settings import Refine
from burridge_knopoff.model.chain import Chain
from burridge_knopoff.model.model import Model
from burridge_knopoff.model.sampling import sampled_states
from burridge_knopoff.motion.settings import MotionSettings
from burridge_knopoff.study.load import load_study
from burridge_knopoff.study.params import catalogue_run
from burridge_knopoff.study.study import Study
from burridge_knopoff.summaries import (
    agreement,
    all_laws,
    attractors,
    basins,
    bifurcation_diagram,
    bifurcations,
    catalogue,
    equilibrium,
    lyapunov,
    mean_distance,
    orbits,
    phases,
    refined,
    rotation,
    solvers,
    stick_slip,
    two_blocks,
)
from burridge_knopoff.summaries.points import Grid
from tests.summaries.points import write_points

ROOT = Path(__file__).parents[1]

#: Runs that are long enough to have something in every panel.
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
}


_EQUAL = [-0.95, -1.0, -0.97]
_STATES = {"pushed": {"position": _EQUAL, "velocity": [0.1, 0.12, 0.09]}}

#: What differs from it in the studies for which every figure and the report are drawn.
STUDIES: dict[str, dict[str, Any]] = {
    "paper": {},
    "one_law": {"laws": {"linearized": {}}},
    "four_laws": {
        "laws": {
            "linearized": {},
            "nonlinear": {},
            "squared": {"formula": "1/(1 + c*a*u)**2", "c": 0.5},
            "stribeck": {"sigma": 0.3},
        },
        "catalogue": {},
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


@dataclass(frozen=True)
class SmallStudy:
    """A study whose points have been run.

    folder : of its results; models : one for each law, at the first a
    returns : the section returns of the attractors by law, once they have been found
    """

    study: Study
    folder: Path
    returns: dict[str, xarray.Dataset] = field(default_factory=dict)

    @property
    def grid(self) -> Grid:
        """Its points."""
        return Grid.of(self.folder / "points", self.study.points)

    @property
    def models(self) -> list[Model]:
        """One model for each law, at the first a."""
        return [self.study.model(law, next(iter(self.study.grid.values()))) for law in self.study.laws]

    @property
    def motion(self) -> MotionSettings:
        """How kinds of motion are told."""
        config = self.study.config
        return MotionSettings(**config["motion"], synchronization_threshold=config["synchronization_threshold"])

    @property
    def search(self) -> SearchSettings:
        """How attractors are looked for."""
        return SearchSettings(**self.study.config["attractors"])

    @cached_property
    def found(self) -> dict[str, xarray.Dataset]:
        """All summaries by name."""
        needed = self.summaries()
        return {**needed, **self.further_summaries(needed)}

    def summaries(self) -> dict[str, xarray.Dataset]:
        """Return the summaries without which there is no report."""
        config, grid, values = self.study.config, self.grid, list(self.study.grid.values())
        threshold = config["synchronization_threshold"]
        kinds = lyapunov.summarize(grid, config["lyapunov_exponents"], threshold, config["motion"])
        states = list(grid.initial.values())
        refine, options = Refine(**config["refine"]), (self.search, self.motion)
        found = [
            continue_attractors([model.at(a) for a in values], *options, refine, starts=states, start=config["start"])
            for model in self.models
        ]
        parts = [attractors.one_law(item, states, *options, config["start"]) for item in found]
        numbers = all_laws.branch_numbers(parts, self.models, self.search)
        attracting = all_laws.merge(parts, numbers)
        for item, part in zip(found, parts, strict=True):
            rows = [item.rows(place) for place in item.grid]
            self.returns[part.attrs["law"]] = returns_of_law([item.models[k] for k in item.grid], rows, part.attrs)
        further = [refined.one_law(item, *options, refine, config["start"]) for item in found]
        everywhere = all_laws.merge(further, all_laws.with_branches_between(numbers, further), refined.VARIABLES)
        everywhere = all_laws.named_alike(everywhere, attracting)
        return {
            "mean_distance": mean_distance.summarize(grid, threshold),
            "bifurcation_diagram": bifurcation_diagram.summarize(grid),
            "lyapunov": kinds,
            "agreement": agreement.summarize(
                grid, kinds, attracting, synchronization_threshold=threshold, agreement=config["agreement"]
            ),
            "orbits": orbits.summarize(self.models, values),
            "attractors": attracting,
            "refined": everywhere,
            "rotation": rotation.summarize(everywhere, self.models),
        }

    def further_summaries(self, found: Mapping[str, xarray.Dataset]) -> dict[str, xarray.Dataset]:
        """Return all others, made of the first ones where they take them."""
        config, values = self.study.config, list(self.study.grid.values())
        window = {key: config[key] for key in ("transient", "window", "batches")}
        sample = sampled_states(2, 2, (-1.5, 1.5), (0.0, 0.2), 1)
        pair = [Model(Chain(2), model.law) for model in self.models]
        settings = two_blocks.run_settings(transient=100.0, window=100.0)
        told = settings, self.search, self.motion, config["agreement"]
        return {
            "stick_slip": stick_slip.summarize(self.grid, **window),
            "equilibrium": equilibrium.summarize(self.models, values),
            "solvers": self._solvers(),
            "two_blocks": two_blocks.summarize(pair, sample, values, *told),
            "basins": self._basins(found["attractors"]),
            "bifurcations": self._bifurcations(found["attractors"], found["refined"]),
            **self._phases(found["attractors"]),
            **self._catalogue(),
        }

    def _bifurcations(self, found: xarray.Dataset, further: xarray.Dataset) -> xarray.Dataset:
        laws = zip(self.models, found["law"].values, strict=True)
        return bifurcations.merge(
            [bifurcations.one_law(model, found.sel(law=law), further.sel(law=law)) for model, law in laws]
        )

    def _phases(self, found: xarray.Dataset) -> dict[str, xarray.Dataset]:
        section = dict(self.study.config["phases"])
        grid = section.pop("a")
        told = PhaseSettings(**section), self.search.label_limit
        parts = [
            phases.one_law([self._known(found, model.at(a)) for a in grid], *told) for model in self.models if grid
        ]
        return {"phases": phases.merge(parts)} if grid else {}

    def _catalogue(self) -> dict[str, xarray.Dataset]:
        study, section = self.study, dict(self.study.config.get("catalogue", {}))
        if not section:
            return {}
        initial, grid = study.state(section.pop("initial")), section.pop("a")
        settings = CatalogueSettings(**section)
        runs = [
            catalogue_of_run(study.model(law, a), initial, settings, **catalogue_run(study, law))
            for law in study.laws
            for a in grid
        ]
        return {"catalogue": catalogue.summarize(runs, study.laws, grid)}

    def _known(self, found: xarray.Dataset, model: Model) -> KnownAttractors:
        return known_attractors(found, self.returns[model.law.name], model)

    def _solvers(self) -> xarray.Dataset:
        study = self.study
        compared = {"a": {name: value for name, value in study.grid.items() if value in study.config["solvers"]["a"]}}
        grid = Grid.of(self.folder / "points", {**study.points, "parameters": compared})
        others = {}
        for solver in ("series", "map", "rk4"):
            known = [law for law in study.laws if solver in study.other_solvers(law)]
            settings = {law: asdict(study.settings(law, solver)) for law in known}
            others[solver] = write_points(grid.elsewhere(self.folder / "solvers" / solver, settings))
        return solvers.summarize(grid, others, study.config["solvers"]["step"])

    def _basins(self, found: xarray.Dataset) -> xarray.Dataset:
        config = self.study.config
        section = {key: value for key, value in config["basins"].items() if key not in ("a", "initial", "threads")}
        plane = BasinSettings(initial=self.study.state(config["basins"]["initial"]), **section)
        maps = []
        for law, where in config["basins"]["a"].items():
            for a in where:
                model = self.study.model(law, a)
                known, limit = self._known(found, model), self.search.label_limit
                tile = basins.tile(known, 0, plane, limit, config["start"])
                maps.append((model, [tile], basins.pairs(known, plane, limit, self.search.seed, config["start"])))
        return basins.merge(maps, found, self.study.laws, plane, self.search.label_limit, config["start"])


def run_study(folder: Path, config: Mapping[str, Any]) -> SmallStudy:
    """Run the points of a study into a folder."""
    study = load_study(config, f"{config['study']}.yaml")
    small = SmallStudy(study, folder)
    write_points(small.grid)
    return small
