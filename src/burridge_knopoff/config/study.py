"""The configuration of a study: validated against the schema, with defaults filled in, and turned into grid points."""

from __future__ import annotations

import copy
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from functools import cache
from pathlib import Path
from typing import Any

from burridge_knopoff.command import simulate_command
from burridge_knopoff.config.checks import (
    LAW_SOLVERS,
    check_boxes,
    check_chains,
    check_runs,
    check_states,
    fill_basins,
    fill_solvers,
    run_settings,
)
from burridge_knopoff.config.grid import grid_of
from burridge_knopoff.config.message import ConfigError
from burridge_knopoff.files import display_path
from burridge_knopoff.friction import LAWS
from burridge_knopoff.initial import InitialState
from burridge_knopoff.settings import Settings

LARGEST = 1e300

# A file of ours has a few levels; more are a mistake.
MOST_LEVELS = 20

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
    def initial(self) -> tuple[str, ...]:
        """Names of the initial states."""
        return tuple(self.config["initial"])

    @property
    def blocks(self) -> int:
        """Number of blocks of the chain."""
        return len(next(iter(self.config["initial"].values()))["position"])

    @property
    def figure_point(self) -> str:
        """Name of the value of a that the figures of single runs show."""
        shown = self.config["figures"].get("a", PAPER_A)
        return min(self.grid, key=lambda name: abs(self.grid[name] - shown))

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

    def other_solvers(self, law: str) -> list[str]:
        """Return the solvers that know a law, without the one that makes the points of the study."""
        return [solver for solver in LAW_SOLVERS[law] if solver != self.config["solver"][law]]

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
            config.update(solver={law: solver}, step=config["solvers"]["step"])
            if solver == "rk4":
                config["lyapunov_exponents"] = 0
        return run_settings(config, config["solver"][law])

    def state(self, initial: str) -> InitialState:
        """Return an initial state of the study by its name."""
        return InitialState(initial, **self.config["initial"][initial])

    def command(self, law: str, initial: str, a: str, solver: str | None = None) -> str:
        """Return the `bk simulate` command of one grid point, named by its wildcards, without its --out.

        solver : another one than that of the study's points
        Raises ConfigError if a is not a value of the grid, or the solver not another one that knows the law.
        """
        if a not in self.grid:
            raise ConfigError(f"a{a}.nc: not a point of study {self.name}: a is not in its grid")
        return simulate_command(law, self.grid[a], self.state(initial), self.settings(law, solver))

    @property
    def points(self) -> dict[str, Any]:
        """What decides the point files, in the types of a config: `initial`, `a`, and `settings` of each law."""
        return {
            "initial": {name: dict(state) for name, state in self.config["initial"].items()},
            "a": dict(self.grid),
            "settings": {law: asdict(self.settings(law)) for law in LAWS},
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
    check_states(filled, file)
    check_runs(filled, file)
    check_boxes(filled, file)
    fill_basins(filled, set(grid.values()), file)
    check_chains(filled, file)
    shown = filled["figures"].get("a")
    if shown is not None and shown not in grid.values():
        raise ConfigError(f"{file}: figures.a: {shown!r} is not allowed: a value of the grid")
    study = Study(filled, grid)
    fill_solvers(filled, set(grid.values()), grid[study.figure_point], file)
    return study


def check_file(path: str | Path) -> None:
    """Raise ConfigError if a key stands twice in one place of a YAML file: the first would be dropped in silence."""
    import yaml

    walked = set()

    def walk(node: Any) -> None:
        # An alias is its anchor's node once more.
        if id(node) in walked:
            return
        walked.add(id(node))
        if isinstance(node, yaml.MappingNode):
            seen = set()
            for key, value in node.value:
                if key.value in seen:
                    line = key.start_mark.line + 1
                    raise ConfigError(f"{display_path(path)}: {key.value}: stands twice (line {line}); once is allowed")
                seen.add(key.value)
                walk(value)
        elif isinstance(node, yaml.SequenceNode):
            for item in node.value:
                walk(item)

    root = _parse(path, lambda text: yaml.compose(text, Loader=yaml.SafeLoader))
    try:
        walk(root)
    except RecursionError:
        raise ConfigError(_too_deep(display_path(path))) from None


def read_yaml(path: str | Path) -> Any:
    """Return the content of a YAML file; raises ConfigError, one line, if it cannot be read or a key stands twice."""
    import yaml

    content = _parse(path, yaml.safe_load)
    check_file(path)
    _check_depth(content, display_path(path))
    return content


def _check_depth(content: Any, file: str, levels: int = MOST_LEVELS) -> None:
    """Raise ConfigError for content that is too deep: an alias inside its own anchor makes it endless."""
    if not levels:
        raise ConfigError(_too_deep(file))
    for item in content.values() if isinstance(content, dict) else content if isinstance(content, list) else ():
        _check_depth(item, file, levels - 1)


def _too_deep(file: str) -> str:
    return f"{file}: nested too deep; at most {MOST_LEVELS} levels are allowed"


def _parse(path: str | Path, parse: Callable[[str], Any]) -> Any:
    import yaml

    file = display_path(path)
    try:
        return parse(Path(path).read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError) as error:
        raise ConfigError(f"{file}: cannot be read: {getattr(error, 'strerror', None) or 'not UTF-8 text'}") from None
    except (yaml.YAMLError, ValueError, TypeError, RecursionError) as error:
        mark = getattr(error, "problem_mark", None)
        problem = " ".join(str(getattr(error, "problem", None) or error).split())[:120]
        raise ConfigError(f"{file}: not YAML{f' (line {mark.line + 1})' if mark else ''}: {problem}") from None


def read_schema(path: str | Path) -> dict[str, Any]:
    """Return the schema in a YAML file."""
    import yaml

    return yaml.safe_load(Path(path).read_text(encoding="utf-8"))


def _with_defaults(config: Any, schema: Mapping[str, Any]) -> Any:
    """Return a config with defaults, its keys in the order of the schema: in what order a file has them is nothing."""
    if not isinstance(config, dict):
        return config
    filled = {}
    for key, item in schema.get("properties", {}).items():
        if key in config or "default" in item:
            filled[key] = _with_defaults(copy.deepcopy(config.get(key, item.get("default"))), item)
    return {**filled, **{key: value for key, value in config.items() if key not in filled}}


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
    from burridge_knopoff.config.message import explain

    raise ConfigError(f"{file}: {explain(errors[0])}")


def check_names(config: Any, file: str, place: str = "") -> None:
    """Raise ConfigError for keys that are not text, and for line breaks at an end, which a pattern does not see."""
    if isinstance(config, Mapping):
        for key, value in config.items():
            if not isinstance(key, str) or key != key.strip():
                raise ConfigError(f"{file}: {place}{key!r} is not allowed as a key: text without spaces around it")
            check_names(value, file, f"{place}{key}.")
    if place == "study." and isinstance(config, str) and config != config.strip():
        raise ConfigError(f"{file}: study: {config!r} is not allowed: text without spaces or line breaks around it")


def all_points(study: Study) -> list[tuple[str, str, str]]:
    """Return (law, initial, a) of every point job, in the order of the summaries."""
    return [(law, initial, a) for law in LAWS for initial in study.initial for a in study.grid]
