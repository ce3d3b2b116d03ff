"""A study: its complete config, its grid, and the runs that follow from both."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product
from typing import Any

import numpy as np

from burridge_knopoff.model.chain import Chain
from burridge_knopoff.model.distances import is_by_distance
from burridge_knopoff.model.fields import settings_from_config
from burridge_knopoff.model.initial import InitialState, initial_state
from burridge_knopoff.model.model import Model
from burridge_knopoff.model.parameters import CHAIN_PARAMETERS, parameter_key, plain_name, set_chain_parameters
from burridge_knopoff.proof.scope import is_covered
from burridge_knopoff.running.command import simulate_command
from burridge_knopoff.running.settings import Settings
from burridge_knopoff.running.solvers import RUN_SOLVERS, SOLVERS
from burridge_knopoff.study.grid import parameters_of
from burridge_knopoff.study.model import model_of
from burridge_knopoff.study.paper import PAPER_A
from burridge_knopoff.study.paths import point_file
from burridge_knopoff.study.stages import CHAIN_LENGTHS, STAGES
from burridge_knopoff.study.yaml_file import ConfigError


@dataclass(frozen=True)
class Study:
    """A validated study: its config with all defaults, and {parameter: {name in file names: exact value}}."""

    config: Mapping[str, Any]
    parameters: Mapping[str, Mapping[str, float]]

    @classmethod
    def of_keys(cls, config: Mapping[str, Any]) -> Study:
        """Return the part of a study that some keys of its config describe."""
        return cls(config, parameters_of({"grid": {}, "a": [], "a_digits": 0, **config}))

    @property
    def name(self) -> str:
        """Name of the study and of its results folder."""
        return self.config["study"]

    @property
    def laws(self) -> tuple[str, ...]:
        """Names of the friction laws, in the order of the config."""
        return tuple(self.config["laws"])

    @property
    def has_a(self) -> bool:
        """Whether any of the laws contains a."""
        return any("a" in model_of(self.config, law, 0.0).law.names for law in self.laws)

    @property
    def initial(self) -> tuple[str, ...]:
        """Names of the initial states."""
        return tuple(self.config["initial"])

    @property
    def blocks(self) -> int:
        """Number of blocks of the chain."""
        return self.config["chain"]["blocks"]

    @property
    def grid(self) -> Mapping[str, float]:
        """The values of a, by their names in file names."""
        return self.parameters["a"]

    @property
    def wildcards(self) -> dict[str, str]:
        """The parameters by their names in file names and Datasets."""
        return {plain_name(name): name for name in self.parameters}

    @property
    def is_plane(self) -> bool:
        """Whether the study varies parameters in addition to a."""
        return len(self.parameters) > 1

    @property
    def other_values(self) -> list[dict[str, float]]:
        """The combinations of the values of all parameters except a."""
        names = [name for name in self.parameters if name != "a"]
        return [
            dict(zip(names, values, strict=True))
            for values in product(*(self.parameters[name].values() for name in names))
        ]

    @property
    def point_file(self) -> str:
        """Path of a point in the folder `points`, with wildcards for `all_points`."""
        return point_file(self.parameters)

    @property
    def shown_point(self) -> str:
        """Name of the value of a in the figures of single runs."""
        shown = self.shown_a
        return min(self.grid, key=lambda name: abs(self.grid[name] - shown))

    @property
    def shown_a(self) -> float:
        """The value of a in the figures of single runs."""
        default = min(self.grid.values(), key=lambda value: abs(value - PAPER_A), default=PAPER_A)
        return self.config["figures"].get("a", default)

    @property
    def shown_law(self) -> str:
        """The law in the figures of single runs."""
        return self.config["figures"]["law"]

    @property
    def law_descriptions(self) -> dict[str, dict[str, Any]]:
        """The laws by name, as the config describes them."""
        return self.config["laws"]

    @property
    def has_one_chain(self) -> bool:
        """Whether all points have the same chain."""
        varied = {parameter_key(name) for name, values in self.parameters.items() if len(values) > 1}
        return varied.isdisjoint(CHAIN_PARAMETERS)

    @property
    def chain(self) -> Chain:
        """The chain of the first point."""
        first = self.other_values[0].items()
        values = {name: value for name, value in first if parameter_key(name) in CHAIN_PARAMETERS}
        return set_chain_parameters(Chain(**self.config["chain"]), values)

    @property
    def has_several_laws(self) -> bool:
        """Whether there is a second law to compare with the first."""
        return len(self.laws) > 1

    @property
    def is_mirror_symmetric(self) -> bool:
        """Whether the chain is its own mirror image."""
        return self.chain.is_mirror_symmetric

    @property
    def has_end_blocks(self) -> bool:
        """Whether there are two end blocks, whose distance is J."""
        return self.blocks > 1

    @property
    def has_paper_chain(self) -> bool:
        """Whether the chain is that of the paper, the only one that its claims are about."""
        return self.chain.is_equivalent_to(Chain(3))

    @property
    def has_synchronized_orbit(self) -> bool:
        """Whether there is a summary of the synchronized orbit, which is computed for three blocks."""
        return self.blocks == 3 and self.is_mirror_symmetric

    @property
    def proved_laws(self) -> list[str]:
        """The laws for which the synchronized orbit and its loss of stability are proved."""
        return [law for law in self.laws if is_covered(self.model(law, self.shown_a))]

    @property
    def omitted_stages(self) -> tuple[str, ...]:
        """Stages that the config leaves out and those that use their results; all stages if several parameters vary."""
        without = STAGES if self.is_plane else self.config["without"]
        return tuple(stage for stage, needed in STAGES.items() if stage in without or needed in without)

    def omission(self, stage: str, over: str = "a") -> str:
        """Return why the study has no such stage; empty if it has.

        over : the studies that can have it: over `a` alone, over `several` parameters, or over `any`
        """
        if over == "several" and not self.is_plane:
            return "only a study of several parameters has it: `grid: {a: …, v: …}` in place of `a: …`"
        if over == "a" and self.is_plane:
            return "a study of several parameters has none: `a: …` in place of `grid: …`"
        if stage not in self.omitted_stages:
            return ""
        without, needed = self.config["without"], STAGES[stage]
        names = " and ".join(name for name in (stage, needed) if name in without)
        needs = f", which needs {needed}" if needed in without else ""
        return f"part of stage {stage}{needs}: remove {names} from `without: [{', '.join(without)}]`"

    @property
    def chain_lengths(self) -> list[int]:
        """Numbers of blocks of the chains of other lengths."""
        return self.config["chains"].get("blocks", CHAIN_LENGTHS)

    @property
    def basin_maps(self) -> list[tuple[str, str]]:
        """Law and name of a for every basin map."""
        names = {value: name for name, value in self.grid.items()}
        return [(law, names[a]) for law, values in self.config["basins"]["a"].items() for a in values]

    @property
    def catalogue_a(self) -> list[str]:
        """Names of the values of a with a catalogue of slip events."""
        chosen = [] if "catalogue" in self.omitted_stages else self.config.get("catalogue", {}).get("a", [])
        return [name for name, value in self.grid.items() if value in chosen]

    @property
    def single_length_key(self) -> str:
        """Key of the chain that fixes its length, a list or a file of springs; empty if there is none."""
        chain = self.config["chain"]
        is_file = "springs" in chain and not is_by_distance(chain["springs"])
        return next(
            (key for key, value in chain.items() if isinstance(value, list) or (key == "springs" and is_file)), ""
        )

    @property
    def marked_states(self) -> dict[str, list[tuple[float, float]]]:
        """Coordinates on each basin map of the initial states in its plane, by name: U_1(0) and U_N(0), or U_1'(0)."""
        models = [self.model(law, a) for law, values in self.config["basins"]["a"].items() for a in values]
        base = self.config["basins"]["initial"]
        marked = {}
        for name in self.initial:
            states = [[model.initial_coordinates(self.state(state)) for state in (name, base)] for model in models]
            if self.blocks == 1:
                marked[name] = [(float(u[0]), float(w[0])) for (u, w), _ in states]
            elif all(np.array_equal(u[1:-1], v[1:-1]) and np.array_equal(w, z) for (u, w), (v, z) in states):
                marked[name] = [(float(u[0]), float(u[-1])) for (u, _), _ in states]
        return marked

    def of_laws(self, laws: Sequence[str]) -> Study:
        """Return the study of some of its laws."""
        return replace(self, config={**self.config, "laws": {law: self.config["laws"][law] for law in laws}})

    def model(self, law: str, a: float, **others: float) -> Model:
        """Return the model of the study for one of its laws at one a, and at values of its other parameters."""
        return model_of(self.config, law, a, others=others)

    def other_solvers(self, law: str) -> list[str]:
        """Return the solvers, except that of the points, that apply to a law at the compared values of a."""
        others = [solver for solver in RUN_SOLVERS if solver != self.config["solver"][law]]
        has_closed_form = all(self.model(law, a).has_closed_form for a in self.config["solvers"]["a"])
        return [solver for solver in others if has_closed_form or not SOLVERS[solver].closed_form]

    @property
    def compared_values(self) -> dict[str, float]:
        """The values of a at which solvers are compared, by their names in file names."""
        return {name: value for name, value in self.grid.items() if value in self.config["solvers"]["a"]}

    def value(self, name: str, parameter: str = "a") -> float:
        """Return a parameter's value from its name in file names; raises ConfigError if it is not in the grid."""
        grid = self.parameters[parameter]
        if name not in grid:
            meant = next((key for key, value in grid.items() if value == float(name)), "")
            remedy = f"write {parameter}{meant}" if meant else f"this {parameter} is not on its grid"
            raise ConfigError(f"{parameter}{name}: not a point of study {self.name}; {remedy}")
        return grid[name]

    def settings(self, law: str, solver: str | None = None) -> Settings:
        """Return the settings of the runs with a law.

        solver : one of `other_solvers`; by default that of the points
        Raises ConfigError for any other solver.
        """
        config = {**self.config, "solver": solver or self.config["solver"][law]}
        if solver is not None:
            if solver not in self.other_solvers(law):
                allowed = " | ".join(self.other_solvers(law))
                raise ConfigError(f"{law}/{solver}: not a comparison of study {self.name}; expected {allowed}")
            config["step"] = config["solvers"]["step"]
            if SOLVERS[solver].has_fixed_step:
                config["lyapunov_exponents"] = 0
        if not SOLVERS[config["solver"]].has_fixed_step:
            # The other solvers have no step, so that a change of the step must not repeat their points.
            config.pop("step", None)
        return settings_from_config(Settings, config)

    def state(self, initial: str) -> InitialState:
        """Return an initial state of the study from its name."""
        return initial_state(initial, **self.config["initial"][initial])

    def run_of(
        self, law: str, initial: str, a: str, solver: str | None = None, **others: str
    ) -> tuple[Model, InitialState, Settings]:
        """Return model, initial state and settings of a grid point given by its wildcards.

        solver : one of `other_solvers`; by default that of the points
        Raises ConfigError if a value is not on the grid, and for any other solver.
        """
        names = {self.wildcards[word]: name for word, name in {"a": a, **others}.items()}
        values = {parameter: self.value(name, parameter) for parameter, name in names.items()}
        return self.model(law, **values), self.state(initial), self.settings(law, solver)

    def command(self, law: str, initial: str, a: str, solver: str | None = None, **others: str) -> str:
        """Return the `bk simulate` command of a grid point given by its wildcards, without --out; see `run_of`."""
        return simulate_command(*self.run_of(law, initial, a, solver, **others))

    def run_file(self, solver: str | None = None, **point: str) -> str:
        """Return the path in the results of a grid point given by its wildcards; solver : see `run_of`."""
        folder = f"solvers/{solver}" if solver else "points"
        return f"{folder}/{self.point_file.format(**point)}"


def all_points(study: Study) -> list[dict[str, str]]:
    """Return the wildcards of every point, the arguments of `Study.command`, in the order of the summaries."""
    names = ("law", "initial", *study.wildcards)
    return [
        dict(zip(names, point, strict=True)) for point in product(study.laws, study.initial, *study.parameters.values())
    ]


def run_files(study: Study) -> dict[str, dict[str, str]]:
    """Return {point file in the results: its wildcards, the arguments of `Study.command`}, also by other solvers."""
    repeated = [] if "solvers" in study.omitted_stages else solver_points(study)
    return {study.run_file(**point): point for point in (*all_points(study), *repeated)}


def solver_points(study: Study) -> list[dict[str, str]]:
    """Return the wildcards of every run that repeats a point with another solver."""
    compared = study.compared_values
    points = [point for point in all_points(study) if point["a"] in compared]
    return [{**point, "solver": solver} for point in points for solver in study.other_solvers(point["law"])]
