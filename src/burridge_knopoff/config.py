"""The configuration of a study: validated against the schema, with defaults filled in, and turned into grid points."""

from __future__ import annotations

import copy
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal, InvalidOperation
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import Any

from burridge_knopoff.files import display_path
from burridge_knopoff.friction import LAWS

MAXIMUM_POINTS = 1_000_000
LARGEST = 1e300

#: The friction parameter of the paper's figures of single runs (Figs. 5, 6 and 7).
PAPER_A = 0.08

#: Where the basins are mapped if a study does not say: synchrony with and without rivals, and beyond its loss.
BASIN_A = {"linearized": (0.05, 0.08, 0.15), "nonlinear": (0.08,)}

#: Config keys that are options of `bk simulate` under the same name.
RUN_KEYS = (
    "v",
    "contact",
    "start",
    "transient",
    "window",
    "batches",
    "sampling",
    "trajectory",
    "trajectory_sampling",
    "events",
    "event_window",
    "lyapunov_exponents",
    "lyapunov_alignment",
)


class ConfigError(ValueError):
    """A config that is not allowed; the message is one line: file, key, value, what is allowed."""


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

    def options(self, law: str, initial: str, a: str) -> str:
        """Return the options of `bk simulate` for one grid point, named by its wildcards.

        Raises ConfigError if a is not a value of the grid.
        """
        if a not in self.grid:
            raise ConfigError(f"a{a}.nc: not a point of study {self.name}: a is not in its grid")
        config = self.config
        state = config["initial"][initial]
        options = [("law", law), ("a", repr(self.grid[a])), ("initial", initial)]
        options += [(key, ",".join(repr(float(value)) for value in state[key])) for key in ("position", "velocity")]
        options.append(("solver", config["solver"][law]))
        if config["solver"][law] == "rk4":
            options.append(("step", repr(config["step"])))
        options += [(key.replace("_", "-"), str(config[key])) for key in RUN_KEYS]
        return " ".join(f"--{key}={value}" if value.startswith("-") else f"--{key} {value}" for key, value in options)


def load_study(config: Mapping[str, Any], schema: Mapping[str, Any], file: str) -> Study:
    """Validate a config against its schema and the rules that a schema cannot state.

    file : name of the config file, for messages
    Raises ConfigError.
    """
    _check_names(config, file)
    filled = _with_defaults(copy.deepcopy(dict(config)), schema)
    _check_schema(filled, schema, file)
    grid = _grid(filled, file)
    _check_states(filled, file)
    _check_runs(filled, file)
    _check_boxes(filled, file)
    _fill_basins(filled, set(grid.values()), file)
    _check_chains(filled, file)
    shown = filled["figures"].get("a")
    if shown is not None and shown not in grid.values():
        raise ConfigError(f"{file}: figures.a: {shown!r} is not allowed: a value of the grid")
    return Study(filled, grid)


def check_file(path: str | Path) -> None:
    """Raise ConfigError if a key stands twice in one place of a YAML file: the first would be dropped in silence."""
    import yaml

    def walk(node: Any) -> None:
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

    # Without aliases resolved: an anchor's content is walked where it is written.
    walk(yaml.compose(Path(path).read_text(encoding="utf-8"), Loader=yaml.SafeLoader))


def read_schema(path: str | Path) -> dict[str, Any]:
    """Return the schema in a YAML file."""
    import yaml

    return yaml.safe_load(Path(path).read_text(encoding="utf-8"))


def _with_defaults(config: Any, schema: Mapping[str, Any]) -> Any:
    if isinstance(config, dict):
        for key, item in schema.get("properties", {}).items():
            if key not in config and "default" in item:
                config[key] = copy.deepcopy(item["default"])
            if key in config:
                config[key] = _with_defaults(config[key], item)
    return config


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


def _check_schema(config: Mapping[str, Any], schema: Mapping[str, Any], file: str) -> None:
    errors = sorted(_validator_class()(schema).iter_errors(config), key=lambda error: [str(key) for key in error.path])
    if not errors:
        return
    from burridge_knopoff.config_message import explain

    raise ConfigError(f"{file}: {explain(errors[0])}")


def _check_names(config: Any, file: str, place: str = "") -> None:
    """Refuse keys that are not text, and names that end in a line break, which a pattern does not see."""
    if isinstance(config, Mapping):
        for key, value in config.items():
            if not isinstance(key, str) or key != key.strip():
                raise ConfigError(f"{file}: {place}{key!r} is not allowed as a key: text without spaces around it")
            _check_names(value, file, f"{place}{key}.")
    if place == "study." and isinstance(config, str) and config != config.strip():
        raise ConfigError(f"{file}: study: {config!r} is not allowed: text without spaces or line breaks around it")


def _check_runs(config: Mapping[str, Any], file: str) -> None:
    """Let the settings of the runs be checked by the code that will run them."""
    from burridge_knopoff.simulation import Settings

    blocks = len(next(iter(config["initial"].values()))["position"])
    for solver in config["solver"].values():
        try:
            Settings(solver=solver, step=config["step"], **{key: config[key] for key in RUN_KEYS}).check_blocks(blocks)
        except ValueError as error:
            raise ConfigError(f"{file}: {error}") from error


def _check_boxes(config: Mapping[str, Any], file: str) -> None:
    boxes = [(section, key) for section in ("attractors", "chains") for key in ("position", "velocity")]
    boxes += [("basins", key) for key in ("first_position", "last_position")]
    for section, key in boxes:
        low, high = config[section][key]
        if not low < high:
            raise ConfigError(f"{file}: {section}.{key}: [{low}, {high}] is not allowed: [low, high] with low < high")


def _fill_basins(config: Mapping[str, Any], grid: set[float], file: str) -> None:
    """Check the maps of basins against grid and states, and fill in what depends on these."""
    basins = config["basins"]
    for law, usual in BASIN_A.items():
        if law not in basins:
            basins[law] = [a for a in usual if a in grid]
        for a in basins[law]:
            if a not in grid:
                raise ConfigError(f"{file}: basins.{law}: {a!r} is not allowed: a value of the grid")
        basins[law] = [float(a) for a in basins[law]]
    name = basins.setdefault("initial", next(iter(config["initial"])))
    if name not in config["initial"]:
        raise ConfigError(f"{file}: basins.initial: {name!r} is not allowed: {' | '.join(config['initial'])}")
    if basins["tiles"] > basins["pixels"]:
        raise ConfigError(
            f"{file}: basins.tiles: {basins['tiles']} is not allowed: at most the {basins['pixels']} rows of a map"
        )


def _check_states(config: Mapping[str, Any], file: str) -> None:
    from burridge_knopoff.initial import PAPER_STATES, InitialState

    for name, state in config["initial"].items():
        if not state and name not in PAPER_STATES:
            raise ConfigError(
                f"{file}: initial.{name}: unknown initial state; without position and velocity only these are known: "
                f"{' | '.join(PAPER_STATES)}"
            )
        if not state:
            state.update(position=list(PAPER_STATES[name].position), velocity=list(PAPER_STATES[name].velocity))
    blocks = {len(state["position"]) for state in config["initial"].values()}
    if len(blocks) > 1:
        counts = ", ".join(f"{name}: {len(state['position'])}" for name, state in config["initial"].items())
        raise ConfigError(f"{file}: initial: states of one study have the same number of positions ({counts})")
    for name, state in config["initial"].items():
        try:
            InitialState(name, state["position"], state["velocity"]).check_contact(config["contact"])
        except ValueError as error:
            raise ConfigError(f"{file}: initial.{name}.{error}") from error


def _check_chains(config: dict[str, Any], file: str) -> None:
    """Turn the lists of a into numbers, and check the counts of states."""
    chains = config["chains"]
    chains["a"] = _values(chains["a"], f"{file}: chains.a")
    chains["two_blocks"]["a"] = _values(chains["two_blocks"]["a"], f"{file}: chains.two_blocks.a")
    if chains["symmetric_samples"] > chains["samples"]:
        raise ConfigError(
            f"{file}: chains.symmetric_samples: {chains['symmetric_samples']!r} is not allowed: "
            f"at most chains.samples ({chains['samples']!r})"
        )


def _grid_name(a: float, digits: int) -> str:
    return f"{a:.{digits}f}"


def _grid(config: Mapping[str, Any], file: str) -> dict[str, float]:
    """Return {name: value}, ascending; every value the double nearest to its decimal."""
    grid: dict[str, float] = {}
    for value in _values(config["a"], f"{file}: a"):
        name = _grid_name(value, config["a_digits"])
        if name in grid:
            raise ConfigError(
                f"{file}: a: {grid[name]!r} and {value!r} share the file name a{name}.nc: "
                "values that differ within a_digits decimals are needed"
            )
        grid[name] = value
    return grid


def _values(items: Sequence[Any], place: str) -> list[float]:
    """Return the numbers and the values of the ranges in a list, ascending; none may be there twice."""
    values: list[float] = []
    for position, item in enumerate(items):
        # Adding 0 turns -0.0 into 0.0.
        values += [float(item) + 0.0] if not isinstance(item, dict) else _range(item, f"{place}[{position}]")
        if len(values) > MAXIMUM_POINTS:
            raise ConfigError(f"{place}: more than {MAXIMUM_POINTS} values; at most that many are allowed")
    values.sort()
    for value, following in pairwise(values):
        if value == following:
            raise ConfigError(f"{place}: {value!r} is listed twice, as a number or by two ranges; once is allowed")
    return values


def _range(item: Mapping[str, float], place: str) -> list[float]:
    try:
        first, last, step = (Decimal(repr(item[key])) for key in ("from", "to", "step"))
    except InvalidOperation as error:
        raise ConfigError(f"{place}: {dict(item)!r} is not allowed: finite numbers") from error
    if last < first:
        raise ConfigError(f"{place}.to: {item['to']!r} is not allowed: at least from ({item['from']!r})")
    count = (last - first) / step
    if count > MAXIMUM_POINTS:
        raise ConfigError(f"{place}.step: {item['step']!r} is not allowed: at most {MAXIMUM_POINTS} values in a range")
    if count != int(count):
        raise ConfigError(
            f"{place}.step: {item['step']!r} is not allowed: it does not divide the range "
            f"{item['from']!r} to {item['to']!r}"
        )
    return [float(first + step * k) for k in range(int(count) + 1)]


def all_points(study: Study) -> list[tuple[str, str, str]]:
    """Return (law, initial, a) of every point job, in the order of the summaries."""
    return [(law, initial, a) for law in LAWS for initial in study.initial for a in study.grid]
