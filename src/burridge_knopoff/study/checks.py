"""Rules of a config that a schema cannot state: keys that must fit each other, and defaults that follow from others."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from typing import Any

from burridge_knopoff.model.initial import PAPER_STATES, InitialState
from burridge_knopoff.model.model import Model
from burridge_knopoff.running.settings import Settings
from burridge_knopoff.study.grid import values_of
from burridge_knopoff.study.message import ConfigError, shown
from burridge_knopoff.study.paper import PAPER_BASINS, PAPER_COMPARED

#: Config keys that are settings of a run under the same name.
RUN_KEYS = (
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


def run_settings(config: Mapping[str, Any], solver: str) -> Settings:
    """Return the settings of runs by a solver; raises ValueError, one line, for what it does not allow."""
    values: dict[str, Any] = {key: config[key] for key in RUN_KEYS}
    if solver == "rk4":
        values["step"] = config["step"]
    numbers = {item.name for item in fields(Settings) if item.type == "float"}
    # 3000 and 3000.0 are one run, with one command.
    values = {key: float(item) if key in numbers else item for key, item in values.items()}
    return Settings(solver=solver, **values)


def check_runs(config: Mapping[str, Any], file: str) -> None:
    """Let the settings of the runs be checked by the code that will run them."""
    blocks = len(next(iter(config["initial"].values()))["position"])
    for solver in config["solver"].values():
        try:
            run_settings(config, solver).check_blocks(blocks)
        except ValueError as error:
            raise ConfigError(f"{file}: {error}") from error


def check_boxes(config: Mapping[str, Any], file: str) -> None:
    """Check that every interval [low, high] has low < high."""
    boxes = [(section, key) for section in ("attractors", "chains") for key in ("position", "velocity")]
    boxes += [("basins", key) for key in ("first_position", "last_position")]
    for section, key in boxes:
        low, high = config[section][key]
        if not low < high:
            raise ConfigError(f"{file}: {section}.{key}: [{low}, {high}] is not allowed: [low, high] with low < high")


def fill_basins(config: Mapping[str, Any], grid: set[float], file: str) -> None:
    """Check the maps of basins against grid and states, and fill in what depends on these."""
    basins, laws = config["basins"], config["laws"]
    for law in basins["a"]:
        if law not in laws:
            raise ConfigError(f"{file}: basins.a.{shown(law)}: unknown key; allowed here: {', '.join(laws)}")
        for a in basins["a"][law]:
            if a not in grid:
                raise ConfigError(f"{file}: basins.a.{law}: {a!r} is not allowed: a value of the grid")
    usual = {law: PAPER_BASINS.get(law, next(iter(PAPER_BASINS.values()))) for law in laws}
    basins["a"] = {law: [float(a) for a in basins["a"].get(law, [a for a in usual[law] if a in grid])] for law in laws}
    name = basins.setdefault("initial", next(iter(config["initial"])))
    if name not in config["initial"]:
        raise ConfigError(f"{file}: basins.initial: {name!r} is not allowed: {' | '.join(config['initial'])}")
    if basins["tiles"] > basins["pixels"]:
        raise ConfigError(
            f"{file}: basins.tiles: {basins['tiles']} is not allowed: at most the {basins['pixels']} rows of a map"
        )


def fill_compared(config: Mapping[str, Any], grid: set[float], else_a: float, file: str) -> None:
    """Check where the solvers are compared against the grid, and fill it in; `else_a` if no usual value is there."""
    solvers = config["solvers"]
    if "a" not in solvers:
        solvers["a"] = [a for a in PAPER_COMPARED if a in grid] or [else_a]
    for a in solvers["a"]:
        if a not in grid:
            raise ConfigError(f"{file}: solvers.a: {a!r} is not allowed: a value of the grid")
    solvers["a"] = sorted(float(a) for a in solvers["a"])


def check_states(config: Mapping[str, Any], file: str) -> None:
    """Check the initial states, and fill in the numbers of those that are known by name."""
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
            InitialState(name, state["position"], state["velocity"])
        except ValueError as error:
            raise ConfigError(f"{file}: initial.{name}.{error}") from error


def check_beginnings(config: Mapping[str, Any], model: Model, file: str) -> None:
    """Check that a model of the study can begin in each of its initial states."""
    for name, state in config["initial"].items():
        try:
            model.begin(InitialState(name, state["position"], state["velocity"]), config["start"])
        except ValueError as error:
            raise ConfigError(f"{file}: initial.{name}.{error}") from error


def check_chains(config: dict[str, Any], file: str) -> None:
    """Turn the lists of a into numbers, and check the counts of states."""
    chains = config["chains"]
    chains["a"] = values_of(chains["a"], f"{file}: chains.a")
    chains["two_blocks"]["a"] = values_of(chains["two_blocks"]["a"], f"{file}: chains.two_blocks.a")
    if chains["symmetric_samples"] > chains["samples"]:
        raise ConfigError(
            f"{file}: chains.symmetric_samples: {chains['symmetric_samples']!r} is not allowed: "
            f"at most chains.samples ({chains['samples']!r})"
        )
