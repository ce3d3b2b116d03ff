"""Rules of a config that no single key states: keys that must fit each other, and defaults that follow from others.

Every function raises ValueError, one line, for what is not allowed: key, value, what is.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from contextlib import contextmanager
from typing import Any

from burridge_knopoff.laws import law_of
from burridge_knopoff.model.chain import Chain
from burridge_knopoff.model.initial import PAPER_STATES, InitialState
from burridge_knopoff.model.model import Model
from burridge_knopoff.model.ranges import OneOf, Several, joined, refusal
from burridge_knopoff.running.settings import SOLVERS
from burridge_knopoff.study.grid import MAXIMUM_POINTS, values_of
from burridge_knopoff.study.paper import PAPER_BASINS, PAPER_COMPARED, PAPER_PHASES

#: Numbers that a job holds of one kind, at most: 800 MB.
MOST_NUMBERS = 100_000_000

#: States that are labelled at once for each pair of near states: stability/splitting.py.
_STATES_OF_A_PAIR = 2


@contextmanager
def under(place: str) -> Iterator[None]:
    """Put a place before the message of a ValueError that is raised inside."""
    try:
        yield
    except ValueError as error:
        raise ValueError(f"{place}{error}") from error


def fill_states(config: Mapping[str, Any]) -> None:
    """Fill in the numbers of the initial states that are known by name; all states have the same number of blocks."""
    states = config["initial"]
    for name, state in states.items():
        if not state and name not in PAPER_STATES:
            known = " | ".join(PAPER_STATES)
            raise ValueError(f"initial.{name}: unknown initial state; without position and velocity: {known}")
        for key in ("position", "velocity"):
            if state and key not in state:
                raise ValueError(f"initial.{name}.{key}: missing; position and velocity are needed together")
        if not state:
            state.update(position=list(PAPER_STATES[name].position), velocity=list(PAPER_STATES[name].velocity))
    if len({len(state["position"]) for state in states.values()}) > 1:
        counts = ", ".join(f"{name}: {len(state['position'])}" for name, state in states.items())
        raise ValueError(f"initial: states of one study have the same number of positions ({counts})")


def fill_laws(config: Mapping[str, Any]) -> None:
    """Check the names of laws that other keys hold, and fill in the first law where they hold none."""
    laws = config["laws"]
    known = OneOf(tuple(laws))
    known.form(config["figures"].setdefault("law", next(iter(laws))), "figures.law")
    Several(known).form(config["chains"].setdefault("laws", [next(iter(laws))]), "chains.laws")


def check_models(config: Mapping[str, Any], grid: Iterable[float], blocks: int) -> None:
    """Check the chain, each law at every a that it is wanted at, and that every initial state can begin."""
    chain = Chain(blocks, **config["chain"])
    for name, description in config["laws"].items():
        for a in grid:
            try:
                law = law_of(name, a, description)
            except ValueError as error:
                raise ValueError(_with_law(name, description, str(error))) from error
            model = Model(chain, law, config["v"], config["contact"])
    for key, values, names in (
        ("chains.a", config["chains"]["a"], config["chains"]["laws"]),
        ("chains.two_blocks.a", config["chains"]["two_blocks"]["a"], config["laws"]),
    ):
        for name in names:
            for a in values:
                with under(f"{key}: {a:g} is not allowed: laws."):
                    law_of(name, a, config["laws"][name])
    for name, state in config["initial"].items():
        with under(f"initial.{name}."):
            model.begin(InitialState(name, **state), config["start"])


def _with_law(name: str, description: Mapping[str, Any], message: str) -> str:
    """Return the message of a law with the key in front that it is about."""
    if message.startswith("law: "):
        return f"laws.{name}{'.law' if 'law' in description else ''}: {message.removeprefix('law: ')}"
    return f"laws.{message}"


def fill_solver(config: dict[str, Any], grid: Iterable[float], blocks: int) -> None:
    """Turn the solver into one for each law, and check that these know the models at every a of the grid."""
    given, laws = config["solver"], config["laws"]
    solvers = dict.fromkeys(laws, given) if isinstance(given, str) else {**dict.fromkeys(laws, SOLVERS[0]), **given}
    _check_laws("solver", solvers, laws)
    chain = Chain(blocks, **config["chain"])
    for name in (name for name, solver in solvers.items() if solver == "map"):
        for a in grid:
            model = Model(chain, law_of(name, a, laws[name]), config["v"], config["contact"])
            if not model.has_closed_form:
                others = " | ".join(solver for solver in SOLVERS if solver != "map")
                raise refusal(f"solver.{name}", "map", f"no closed form at a = {a:g}: {_reason(model)}; {others}")
    config["solver"] = solvers


def _reason(model: Model) -> str:
    """Return why the motion of a model has no closed form."""
    if not model.law.is_linear:
        return "its friction is no straight line"
    if not model.chain.is_uniform:
        return "the chain has open ends and one number each for coupling, pulling and threshold if there is one"
    return f"a slope steeper than {model.chain.damping_limit:g} does not let the blocks oscillate"


def _check_laws(key: str, named: Iterable[str], laws: Iterable[str]) -> None:
    for law in named:
        if law not in laws:
            raise ValueError(f"{joined(key, law)}: unknown key; allowed here: {', '.join(laws)}")


def fill_basins(config: Mapping[str, Any], grid: Iterable[float]) -> None:
    """Check the maps of basins against grid, laws and states, and fill in what depends on these."""
    basins, laws, states = config["basins"], config["laws"], config["initial"]
    _check_laws("basins.a", basins["a"], laws)
    for law, values in basins["a"].items():
        _check_grid(f"basins.a.{law}", values, grid)
    usual = {law: PAPER_BASINS.get(law, next(iter(PAPER_BASINS.values()))) for law in laws}
    basins["a"] = {law: basins["a"].get(law, [a for a in usual[law] if a in grid]) for law in laws}
    OneOf(tuple(states)).form(basins.setdefault("initial", next(iter(states))), "basins.initial")


def fill_phases(config: Mapping[str, Any], grid: Iterable[float], blocks: int) -> None:
    """Check where states are drawn by their phases against the grid, and fill it in."""
    of_paper = Chain(blocks, **config["chain"]) == Chain(3)
    _fill_values(config, "phases", [a for a in PAPER_PHASES if a in grid and of_paper], grid)


def fill_compared(config: Mapping[str, Any], grid: Iterable[float], else_a: float) -> None:
    """Check where the solvers are compared against the grid, and fill it in; `else_a` if no usual value is there."""
    _fill_values(config, "solvers", [a for a in PAPER_COMPARED if a in grid] or [else_a], grid)
    _check_grid("figures.a", [config["figures"].get("a", else_a)], grid)


def _fill_values(config: Mapping[str, Any], section: str, usual: list[float], grid: Iterable[float]) -> None:
    """Check the values of a of a section against the grid, the usual ones where it has none, and sort them."""
    values = config[section].setdefault("a", usual)
    _check_grid(f"{section}.a", values, grid)
    values.sort()


def _check_grid(key: str, values: Iterable[float], grid: Iterable[float]) -> None:
    for a in values:
        if a not in grid:
            raise refusal(key, a, "a value of the grid")


def fill_chains(config: Mapping[str, Any]) -> None:
    """Turn the lists of a of longer chains into numbers."""
    chains = config["chains"]
    chains["a"] = values_of(chains["a"], "chains.a")
    chains["two_blocks"]["a"] = values_of(chains["two_blocks"]["a"], "chains.two_blocks.a")


def leave_out(config: Mapping[str, Any], stages: Collection[str]) -> None:
    """Take away the values of a of stages that are left out."""
    for name in {"solvers", "phases"} & set(stages):
        config[name]["a"] = []
    if "basins" in stages:
        config["basins"]["a"] = {law: [] for law in config["laws"]}


def check_size(config: Mapping[str, Any], values: int, blocks: int) -> None:
    """Check that a study has no more jobs than Snakemake can plan, and that none of them has too much to hold.

    config : with all defaults; values : number of those of a
    """
    states, laws = config["initial"], config["laws"]
    points = len(laws) * len(states) * values
    if points > MAXIMUM_POINTS:
        raise ValueError(
            f"a: {points} points are not allowed ({len(laws)} laws, {len(states)} initial states, "
            f"{values} values of a): at most {MAXIMUM_POINTS}"
        )
    attractors, basins, phases, chains = (config[name] for name in ("attractors", "basins", "phases", "chains"))
    oscillating = len(phases["amplitude"]) * len(phases["phase_difference"]) * phases["samples"]
    maps = sum(map(len, basins["a"].values()))
    rows = -(-basins["pixels"] // basins["tiles"])
    two_blocks = chains["two_blocks"]
    for key, value, numbers in (
        ("attractors.samples", attractors["samples"], 2 * blocks * attractors["samples"]),
        (
            "attractors.fraction_samples",
            attractors["fraction_samples"],
            2 * blocks * attractors["fraction_samples"],
        ),
        ("basins.pixels", basins["pixels"], maps * basins["pixels"] ** 2),
        ("basins.tiles", basins["tiles"], 2 * blocks * rows * basins["pixels"]),
        ("basins.pairs", basins["pairs"], 2 * blocks * _STATES_OF_A_PAIR * basins["pairs"]),
        ("phases.samples", phases["samples"], max(2 * blocks, len(phases["a"])) * oscillating),
        ("chains.samples", chains["samples"], len(chains["a"]) * chains["samples"]),
        ("chains.samples", chains["samples"], 2 * max(chains["blocks"]) * chains["samples"]),
        ("chains.two_blocks.samples", two_blocks["samples"], len(two_blocks["a"]) * two_blocks["samples"]),
    ):
        if numbers > MOST_NUMBERS:
            raise refusal(key, value, f"a job would hold {numbers:.1e} numbers for it, at most {MOST_NUMBERS:.0e}")
    if maps * basins["tiles"] > MAXIMUM_POINTS:
        raise refusal("basins.tiles", basins["tiles"], f"{maps} maps in at most {MAXIMUM_POINTS} tiles")
