"""The configuration of a study: validated against the schema, with defaults filled in, and turned into grid points."""

from __future__ import annotations

import copy
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from functools import cache
from typing import Any

from burridge_knopoff.model.initial import InitialState
from burridge_knopoff.model.model import Model
from burridge_knopoff.provenance.command import simulate_command
from burridge_knopoff.running.settings import SOLVERS, Settings
from burridge_knopoff.study.checks import (
    check_beginnings,
    check_boxes,
    check_chains,
    check_runs,
    check_states,
    fill_basins,
    fill_compared,
    run_settings,
)
from burridge_knopoff.study.grid import grid_of
from burridge_knopoff.study.message import ConfigError, explain, shown
from burridge_knopoff.study.model import MODEL_KEYS, model_of
from burridge_knopoff.study.models import check_chain_laws, check_models, fill_laws, fill_solver
from burridge_knopoff.study.size import check_size

LARGEST = 1e300

#: The friction parameter of the paper's figures of single runs (Figs. 5, 6 and 7).
PAPER_A = 0.08


@dataclass(frozen=True)
class Study:
    """A validated study: its config with all defaults, and the grid of a as {name in file names: exact value}."""

    config: Mapping[str, Any]
    grid: Mapping[str, float]

    @property
    def name(self) -> str:
        """Name of the study and of its results folder."""
        return self.config["study"]

    @property
    def laws(self) -> tuple[str, ...]:
        """Names of the friction laws, in the order of the config."""
        return tuple(self.config["laws"])

    @property
    def initial(self) -> tuple[str, ...]:
        """Names of the initial states."""
        return tuple(self.config["initial"])

    @property
    def blocks(self) -> int:
        """Number of blocks of the chain."""
        return len(next(iter(self.config["initial"].values()))["position"])

    @property
    def shown_point(self) -> str:
        """Name of the value of a that the figures of single runs show."""
        shown = self.config["figures"].get("a", PAPER_A)
        return min(self.grid, key=lambda name: abs(self.grid[name] - shown))

    @property
    def shown_a(self) -> float:
        """The value of a that the figures of single runs show."""
        return self.grid[self.shown_point]

    @property
    def shown_law(self) -> str:
        """The law that the figures of single runs show."""
        return self.config["figures"]["law"]

    def shown_runs(self, wildcards: Mapping[str, str]) -> dict[str, Any]:
        """Return `points` of the runs that figures of single runs show, of one initial state if a wildcard names it."""
        points, law = self.points, self.shown_law
        initial = {name: state for name, state in points["initial"].items() if wildcards.get("initial", name) == name}
        only = {key: {law: points[key][law]} for key in ("laws", "settings")}
        folder = f"results/{self.name}/points"
        return {**points, **only, "folder": folder, "initial": initial, "a": {self.shown_point: self.shown_a}}

    @property
    def law_descriptions(self) -> dict[str, dict[str, Any]]:
        """The laws as the config describes them, by name."""
        return self.config["laws"]

    @property
    def has_several_laws(self) -> bool:
        """Whether there is a law to compare with the first one."""
        return len(self.laws) > 1

    @property
    def is_mirror_symmetric(self) -> bool:
        """Whether the chain is its own mirror image."""
        return self.model(self.laws[0], self.shown_a).chain.is_mirror_symmetric

    @property
    def has_synchronized_orbit(self) -> bool:
        """Whether the orbit of three blocks is looked for, the last of which is the mirror image of the first."""
        return self.blocks == 3 and self.is_mirror_symmetric

    @property
    def basin_maps(self) -> list[tuple[str, float]]:
        """Law and a of every map of basins."""
        return [(law, a) for law, values in self.config["basins"]["a"].items() for a in values]

    @property
    def has_other_lengths(self) -> bool:
        """Whether there are chains of other lengths, of two blocks among them."""
        return not self.single_length_key

    @property
    def single_length_key(self) -> str:
        """Key of the chain that has a number for each spring or block: there is no other length then. Else empty."""
        return next((key for key, value in self.config["chain"].items() if isinstance(value, list)), "")

    @property
    def marked_states(self) -> dict[str, tuple[float, float]]:
        """U_1(0) and U_N(0) of the initial states that lie in the plane of the maps of basins, by name."""
        states = self.config["initial"]
        plane = states[self.config["basins"]["initial"]]
        return {
            name: (state["position"][0], state["position"][-1])
            for name, state in states.items()
            if state["position"][1:-1] == plane["position"][1:-1] and state["velocity"] == plane["velocity"]
        }

    def model(self, law: str, a: float) -> Model:
        """Return the model of the study under one of its laws, at one a."""
        return model_of(self.config, law, a, self.blocks)

    def other_solvers(self, law: str) -> list[str]:
        """Return the solvers that know a law where they are compared, without the one that makes the points."""
        others = [solver for solver in SOLVERS if solver != self.config["solver"][law]]
        if "map" in others and not all(self.model(law, a).has_closed_form for a in self.config["solvers"]["a"]):
            others.remove("map")
        return others

    def value(self, a: str) -> float:
        """Return the value of a by its name in file names; raises ConfigError if it is not in the grid."""
        if a not in self.grid:
            raise ConfigError(f"a{a}: not a point of study {self.name}: a is not in its grid")
        return self.grid[a]

    def settings(self, law: str, solver: str | None = None) -> Settings:
        """Return the settings of the runs under a law.

        solver : another one than that of the study's points
        Raises ConfigError if it is not another one that knows the law.
        """
        config = dict(self.config)
        if solver is not None:
            if solver not in self.other_solvers(law):
                allowed = " | ".join(self.other_solvers(law))
                raise ConfigError(f"{law}/{solver}: not a comparison of study {self.name}: {allowed} for this law")
            config["step"] = config["solvers"]["step"]
            if solver == "rk4":
                config["lyapunov_exponents"] = 0
        return run_settings(config, solver or config["solver"][law])

    def state(self, initial: str) -> InitialState:
        """Return an initial state of the study by its name."""
        return InitialState(initial, **self.config["initial"][initial])

    def command(self, law: str, initial: str, a: str, solver: str | None = None) -> str:
        """Return the `bk simulate` command of one grid point, named by its wildcards, without its --out.

        solver : another one than that of the study's points
        Raises ConfigError if a is not a value of the grid, or the solver not another one that knows the law.
        """
        return simulate_command(self.model(law, self.value(a)), self.state(initial), self.settings(law, solver))

    @property
    def points(self) -> dict[str, Any]:
        """What decides the point files, in the types of a config: `initial`, `a`, `settings` of each law, models."""
        return {
            **{key: self.config[key] for key in MODEL_KEYS},
            "initial": {name: dict(state) for name, state in self.config["initial"].items()},
            "a": dict(self.grid),
            "settings": {law: asdict(self.settings(law)) for law in self.laws},
        }


def load_study(config: Mapping[str, Any], schema: Mapping[str, Any], file: str) -> Study:
    """Validate a config against its schema and the rules that a schema cannot state.

    file : name of the config file, for messages
    Raises ConfigError.
    """
    check_names(config, file)
    filled = _with_defaults(copy.deepcopy(dict(config)), schema)
    check_schema(filled, schema, file)
    grid = grid_of(filled, file)
    values = list(grid.values())
    check_states(filled, file)
    check_chains(filled, file)
    fill_laws(filled, file)
    study = Study(filled, grid)
    check_models(filled, values, study.blocks, file)
    check_chain_laws(filled, file)
    check_beginnings(filled, study.model(study.laws[0], next(iter(grid.values()))), file)
    fill_solver(filled, values, study.blocks, file)
    check_runs(filled, file)
    check_boxes(filled, file)
    fill_basins(filled, set(values), file)
    shown = filled["figures"].get("a")
    if shown is not None and shown not in values:
        raise ConfigError(f"{file}: figures.a: {shown!r} is not allowed: a value of the grid")
    fill_compared(filled, set(values), study.shown_a, file)
    check_size(filled, grid, file)
    return Study(_with_numbers(filled, schema), grid)


def _with_defaults(config: Any, schema: Mapping[str, Any]) -> Any:
    """Return a config with defaults, its keys in the order of the schema: in what order a file has them is nothing."""
    if not isinstance(config, dict):
        return config
    filled = {}
    for key, item in schema.get("properties", {}).items():
        if key in config or "default" in item:
            filled[key] = _with_defaults(copy.deepcopy(config.get(key, item.get("default"))), item)
    return {**filled, **{key: value for key, value in config.items() if key not in filled}}


def _with_numbers(config: Any, schema: Mapping[str, Any]) -> Any:
    """Return a valid config with every number that need not be whole as a double: 100 and 100.0 are one."""
    if isinstance(config, dict):
        other = schema.get("additionalProperties")
        items = schema.get("properties", {})
        return {key: _with_numbers(value, items.get(key, other or {})) for key, value in config.items()}
    if isinstance(config, list):
        return [_with_numbers(value, schema.get("items", {})) for value in config]
    is_number = isinstance(config, int) and not isinstance(config, bool)
    return float(config) if is_number and "number" in _types(schema) else config


def _types(schema: Mapping[str, Any]) -> list[str]:
    types = schema.get("type", [])
    return [types] if isinstance(types, str) else types


@cache
def _validator_class() -> Any:
    import jsonschema

    def number(checker: Any, value: Any) -> bool:
        is_number = isinstance(value, int | float) and not isinstance(value, bool)
        return is_number and -LARGEST <= value <= LARGEST

    def integer(checker: Any, value: Any) -> bool:
        return isinstance(value, int) and number(checker, value)

    base = jsonschema.Draft202012Validator
    checker = base.TYPE_CHECKER.redefine("number", number).redefine("integer", integer)
    return jsonschema.validators.extend(base, type_checker=checker)


def check_schema(config: Any, schema: Mapping[str, Any], file: str) -> None:
    """Raise ConfigError, one line, for the first place at which the content of a file breaks its schema."""
    errors = sorted(_validator_class()(schema).iter_errors(config), key=lambda error: [str(key) for key in error.path])
    if not errors:
        return
    raise ConfigError(f"{file}: {explain(errors[0])}")


def check_names(config: Any, file: str, place: str = "") -> None:
    """Raise ConfigError for keys that are not text, and for line breaks at an end, which a pattern does not see."""
    if isinstance(config, Mapping):
        for key, value in config.items():
            if not isinstance(key, str) or key != key.strip():
                raise ConfigError(
                    f"{file}: {place}{ascii(key)[:60]} is not allowed as a key: text without spaces around it"
                )
            check_names(value, file, f"{place}{shown(key)}.")
    if place == "study." and isinstance(config, str) and config != config.strip():
        raise ConfigError(f"{file}: study: {config!r} is not allowed: text without spaces or line breaks around it")


def all_points(study: Study) -> list[tuple[str, str, str]]:
    """Return (law, initial, a) of every point job, in the order of the summaries."""
    return [(law, initial, a) for law in study.laws for initial in study.initial for a in study.grid]
