"""Checks of what decides the models of a study: its laws, its chain, and the solvers that know them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from burridge_knopoff.laws import law_of
from burridge_knopoff.model.chain import Chain
from burridge_knopoff.model.model import Model
from burridge_knopoff.running.settings import SOLVERS
from burridge_knopoff.study.message import ConfigError, shown


def fill_laws(config: Mapping[str, Any], file: str) -> None:
    """Check the names of laws that other keys hold, and fill in the first law where they hold none."""
    laws = config["laws"]
    shown_law = config["figures"].setdefault("law", next(iter(laws)))
    others = config["chains"].setdefault("laws", [next(iter(laws))])
    for place, law in [("figures.law", shown_law), *((f"chains.laws[{i}]", law) for i, law in enumerate(others))]:
        if law not in laws:
            raise ConfigError(f"{file}: {place}: {law!r} is not allowed: {' | '.join(laws)}")


def check_models(config: Mapping[str, Any], grid: Iterable[float], blocks: int, file: str) -> None:
    """Check the chain, and each law at every a of the grid."""
    try:
        chain = Chain(blocks, **config["chain"])
    except ValueError as error:
        raise ConfigError(f"{file}: {error}") from error
    for name, description in config["laws"].items():
        for a in grid:
            try:
                law = law_of(name, a, description)
            except ValueError as error:
                raise ConfigError(f"{file}: {_place(name, description, str(error))}") from error
            try:
                Model(chain, law, config["v"], config["contact"])
            except ValueError as error:
                raise ConfigError(f"{file}: {error}") from error


def check_chain_laws(config: Mapping[str, Any], file: str) -> None:
    """Check each law at the values of a of longer chains and of two blocks, which have lists of their own."""
    chains, laws = config["chains"], config["laws"]
    for key, values, names in (
        ("chains.a", chains["a"], chains["laws"]),
        ("chains.two_blocks.a", chains["two_blocks"]["a"], laws),
    ):
        for name in names:
            for a in values:
                try:
                    law_of(name, a, laws[name])
                except ValueError as error:
                    raise ConfigError(f"{file}: {key}: {a:g} is not allowed: laws.{error}") from error


def _place(name: str, description: Mapping[str, Any], message: str) -> str:
    """Return the message of a law with the key in front that it is about."""
    if message.startswith("law: "):
        return f"laws.{name}{'.law' if 'law' in description else ''}: {message.removeprefix('law: ')}"
    return f"laws.{message}"


def fill_solver(config: dict[str, Any], grid: Iterable[float], blocks: int, file: str) -> None:
    """Turn the solver into one for each law, and check that these know the models at every a of the grid."""
    given, laws = config["solver"], config["laws"]
    if isinstance(given, str) and given not in SOLVERS:
        raise ConfigError(
            f"{file}: solver: {given!r} is not allowed: {' | '.join(SOLVERS)}, or one of them for each law"
        )
    solvers = dict.fromkeys(laws, given) if isinstance(given, str) else {**dict.fromkeys(laws, SOLVERS[0]), **given}
    for law, solver in solvers.items():
        if law not in laws:
            raise ConfigError(f"{file}: solver.{shown(law)}: unknown key; allowed here: {', '.join(laws)}")
        if solver == "map":
            _check_map(config, law, grid, blocks, file)
    config["solver"] = solvers


def _check_map(config: Mapping[str, Any], name: str, grid: Iterable[float], blocks: int, file: str) -> None:
    chain = Chain(blocks, **config["chain"])
    for a in grid:
        model = Model(chain, law_of(name, a, config["laws"][name]), config["v"], config["contact"])
        if not model.has_closed_form:
            if not model.law.is_linear:
                reason = "its friction is no straight line"
            elif not chain.is_uniform:
                reason = (
                    "the chain has open ends and one number each for coupling, pulling and threshold if there is one"
                )
            else:
                reason = f"a slope steeper than {chain.damping_limit:g} does not let the blocks oscillate"
            others = " | ".join(solver for solver in SOLVERS if solver != "map")
            raise ConfigError(
                f"{file}: solver.{name}: 'map' is not allowed: no closed form at a = {a:g}: {reason}; {others}"
            )
