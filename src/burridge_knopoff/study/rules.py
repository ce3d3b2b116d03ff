"""Rules between the keys of a config: keys that must fit each other, and defaults derived from other keys.

Every function raises ValueError, `key: got X, expected Y`, if a rule is broken.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import reduce
from math import prod
from operator import getitem
from typing import Any

from burridge_knopoff.basins.initial_phases import has_free_ends
from burridge_knopoff.laws import LAWS, law_of, unknown_law
from burridge_knopoff.laws.law import law_at_recorded_a
from burridge_knopoff.messages import cut, refusal, suggestion
from burridge_knopoff.model.chain import BLOCKS, Chain
from burridge_knopoff.model.distances import is_by_distance
from burridge_knopoff.model.fields import Field, Keys
from burridge_knopoff.model.initial import PAPER_STATES, PAPER_V, initial_state
from burridge_knopoff.model.model import Model
from burridge_knopoff.model.parameters import plain_name
from burridge_knopoff.model.ranges import OneOf, Range, Several
from burridge_knopoff.provenance.files import LONGEST_NAME
from burridge_knopoff.running.settings import LONGEST_STEP, Settings, shortest_step
from burridge_knopoff.running.solvers import RUN_SOLVERS, SOLVERS
from burridge_knopoff.study.config import SOME_VALUES, LawKeys, check_law_numbers
from burridge_knopoff.study.grid import MAXIMUM_POINTS, values_of
from burridge_knopoff.study.paper import PAPER_BASINS, PAPER_COMPARED, PAPER_PHASES
from burridge_knopoff.study.paths import point_file
from burridge_knopoff.study.stages import CHAIN_LENGTHS
from burridge_knopoff.values import MOST_NUMBERS

#: States labelled at once for each pair of nearby states: basins/pair_separation.py.
_STATES_OF_A_PAIR = 2
#: Most numbers in a list of a config, since the command of a run contains them.
MOST_LISTED = 1024


@contextmanager
def error_prefix(place: str) -> Iterator[None]:
    """Prefix the message of a ValueError raised inside with a place."""
    try:
        yield
    except ValueError as error:
        raise ValueError(f"{place}{error}") from error


def fill_states(config: Mapping[str, Any], velocities: Collection[float]) -> None:
    """Fill in the numbers of the paper's initial states if the driver always has the paper's velocity.

    velocities : all v of the study; at others these states have no numbers of their own, but follow v
    """
    states = config["initial"]
    for name, state in states.items():
        if not state and name not in PAPER_STATES:
            names = f"{' | '.join(PAPER_STATES)} may leave out{suggestion(name, PAPER_STATES)}"
            raise ValueError(f"initial.{name}: got no position and velocity, which only {names}")
        for key in ("position", "velocity"):
            if state and key not in state:
                raise ValueError(f"initial.{name}.{key}: got none, expected position and velocity together")
        if not state and {*velocities} == {PAPER_V}:
            position, velocity = PAPER_STATES[name].coordinates(BLOCKS)
            state.update(position=position.tolist(), velocity=velocity.tolist())


def fill_blocks(config: Mapping[str, Any]) -> None:
    """Fill in the number of blocks, from the springs or the initial states, and require it of every state."""
    chain, blocks = config["chain"], {}
    sections = {"chain": chain, **{f"initial.{name}": state for name, state in config["initial"].items()}}
    for section, values in sections.items():
        for key, value in values.items():
            if isinstance(value, list) and len(value) > MOST_LISTED:
                raise refusal(f"{section}.{key}", value, f"at most {MOST_LISTED} numbers in a list, or random numbers")
    for name, state in config["initial"].items():
        with error_prefix(f"initial.{name}."):
            blocks[name] = initial_state(name, **state).blocks
    lists = {
        name: blocks[name]
        for name, state in config["initial"].items()
        if not state or list in map(type, state.values())
    }
    if len({*lists.values()}) > 1:
        counts = ", ".join(f"{name}: {count}" for name, count in lists.items())
        raise ValueError(f"initial: got different numbers of positions ({counts}), expected one for all states")
    has_file = "springs" in chain and not is_by_distance(chain["springs"])
    if not {"blocks", "grid"} & chain.keys() and not has_file:
        chain["blocks"] = next(iter(lists.values()), max(count or 0 for count in blocks.values()))
        if not chain["blocks"]:
            raise ValueError("chain.blocks: missing, expected the number of blocks, which random states do not fix")
    chain["blocks"] = Chain(**chain).blocks
    for name, count in lists.items():
        if count != chain["blocks"]:
            raise ValueError(f"initial.{name}: got numbers for {count} blocks, expected {chain['blocks']}")


def fill_names(config: dict[str, Any]) -> None:
    """Check the names of laws and states in other keys, and fill in the default names."""
    laws, state, solver = config["laws"], next(iter(config["initial"])), config["solver"]
    for name, description in laws.items():
        if name not in LAWS and not {"law", "formula"} & description.keys():
            raise unknown_law(f"laws.{name}", name)
        if "a" in description:
            raise ValueError(f"laws.{name}.a: got a number of the law, expected it in `a` or in `grid`")
        with error_prefix(f"laws.{name}."):
            check_law_numbers(description.keys() - LawKeys.fields.keys())
    law_names, first = OneOf(tuple(laws)), next(iter(laws))
    law_names.form(config["figures"].setdefault("law", first), "figures.law")
    Several(law_names).form(config["chains"].setdefault("laws", [first]), "chains.laws")
    OneOf(tuple(config["initial"])).form(config["basins"].setdefault("initial", state), "basins.initial")
    usual, by_law = (solver, {}) if isinstance(solver, str) else (RUN_SOLVERS[0], solver)
    config["solver"] = _law_keys(OneOf(RUN_SOLVERS), dict.fromkeys(laws, usual)).form(by_law, "solver")


def _law_keys(allowed: Range, usual: Mapping[str, Any]) -> Keys:
    """Return a range with one entry for each law, and the usual value of each as its default."""
    return Keys({law: Field(allowed, "", value) for law, value in usual.items()})


def check_models(
    config: Mapping[str, Any], grid: Iterable[float], others: Sequence[Mapping[str, float]] = ({},)
) -> None:
    """Check the chain, every law at every point where it is used, its solver, and that a run can begin at every state.

    grid, others : values of a, and the combinations of the other parameters, all of which are simulated at each a
    """
    chain, laws = Chain(**config["chain"]), config["laws"]
    with error_prefix("laws."):
        numbers = {number for name in laws for number in law_of({name: laws[name]}).names}
    # With one value they are of the laws that have them.
    single = {name for name in numbers & others[0].keys() if len({values[name] for values in others}) == 1}
    for name, solver in config["solver"].items():
        tapes = []
        for a in grid:
            with error_prefix("laws."):
                law = law_at_recorded_a(law_of({name: laws[name]}), a)
                for number in law.missing:
                    raise ValueError(f"{name}.{number}: missing, expected a number: the formula contains it")
                tapes.append(law.tape)
            base = Model(law, chain=chain, v=config["v"], contact=config["contact"])
            for values in others:
                with error_prefix(f"grid ({name} law, a = {a:g}): " if values else ""):
                    own = {key: values[key] for key in values if key not in single or base.has_parameter(key)}
                    model = base.at(**own)
                if SOLVERS[solver].closed_form and not model.has_closed_form:
                    solver_names = " | ".join(name for name in RUN_SOLVERS if not SOLVERS[name].closed_form)
                    raise refusal(
                        f"solver.{name}", solver, f"{solver_names}: no closed form at a = {a:g}, {_reason(model)}"
                    )
        if len(tapes) > 1 and all(tape == tapes[0] for tape in tapes):
            raise refusal(
                f"laws.{name}.formula",
                laws[name].get("formula"),
                "a formula that depends on a, or a single value of a",
            )
    chains = config["chains"]
    pair = chains.get("two_blocks", {"a": []})
    for key, values, names in (("chains", chains["a"], chains["laws"]), ("chains.two_blocks", pair["a"], laws)):
        for name in names:
            for a in values:
                with error_prefix(f"{key}.a: got {a:g}, at which laws."):
                    law_at_recorded_a(law_of({name: laws[name]}), a)
    for name, state in config["initial"].items():
        with error_prefix(f"initial.{name}."):
            model.initial_coordinates(initial_state(name, **state))


def _reason(model: Model) -> str:
    """Return the reason why the motion of a model has no closed form."""
    if not model.law.is_linear:
        return "as its friction is not linear in the speed"
    if not model.chain.is_uniform:
        return (
            "which requires a row with open ends, masses and weakening of 1, no dashpots, and one number each for "
            "coupling, pulling and threshold"
        )
    return f"as a slope steeper than {model.chain.damping_limit:g} overdamps the blocks"


def fill_values(config: Mapping[str, Any], grid: Collection[float], shown_a: float) -> None:
    """Check the values of a in all sections against the grid and fill in defaults; shown_a : that of single runs."""
    chain = Chain(**config["chain"])
    of_paper = chain == Chain(3)
    maps = {law: PAPER_BASINS.get(law, next(iter(PAPER_BASINS.values()))) for law in config["laws"]}
    usual = {law: [a for a in values if a in grid] for law, values in maps.items()}
    basins, phases, solvers = (config[section] for section in ("basins", "phases", "solvers"))
    chosen = _law_keys(SOME_VALUES, usual).form(basins["a"], "basins.a")
    basins["a"] = {law: list(values) for law, values in chosen.items()}
    phases["a"] = sorted(phases.get("a", [a for a in PAPER_PHASES if a in grid and of_paper]))
    solvers["a"] = sorted(solvers.get("a", [a for a in PAPER_COMPARED if a in grid] or [shown_a]))
    config["figures"].setdefault("a", shown_a)
    if phases["a"] and not has_free_ends(chain):
        raise refusal("phases.a", phases["a"], "[] unless the chain is a row of three blocks or more with open ends")
    for key, values in (
        *((f"basins.a.{law}", values) for law, values in basins["a"].items()),
        ("phases.a", phases["a"]),
        ("solvers.a", solvers["a"]),
        ("figures.a", [config["figures"]["a"]]),
    ):
        for a in values:
            if a not in grid:
                raise refusal(key, a, "a value of the grid")


def check_comparison(settings: Settings, chain: Chain, sets_step: bool) -> None:
    """Check the settings with which another solver repeats runs; sets_step : whether the config has `solvers.step`."""
    try:
        settings.check_chain(chain)
    except ValueError as error:
        least = shortest_step(settings.duration, chain)
        if sets_step or settings.step >= least or not settings.has_fixed_step:
            raise ValueError(f"solvers.{error}, or without: [solvers]") from error
        key = "transient" if settings.transient > settings.window else "window"
        step = f", solvers.step of at least {least:g}" if least < LONGEST_STEP / chain.highest_rate else ""
        raise refusal(key, getattr(settings, key), f"a shorter run{step}, or without: [solvers]") from error


def fill_catalogue(config: dict[str, Any], grid: Collection[float]) -> None:
    """If the study has catalogues, check their values of a and initial state, and fill in the defaults."""
    if "catalogue" not in config:
        return
    section = config["catalogue"]
    of_study = {"initial": next(iter(config["initial"])), "transient": config["transient"], "window": config["window"]}
    for key, value in of_study.items():
        section.setdefault(key, value)
    OneOf(tuple(config["initial"])).form(section["initial"], "catalogue.initial")
    _fill_grid(section, "catalogue", grid)


def fill_edges(config: dict[str, Any], grid: Collection[float]) -> None:
    """If the study has edge states, check their values of a; by default all values of the grid."""
    if "edges" in config:
        _fill_grid(config["edges"], "edges", grid)


def _fill_grid(section: dict[str, Any], name: str, grid: Collection[float]) -> None:
    """Check that the values of a in a section are on the grid; by default all values of the grid."""
    for a in section.setdefault("a", list(grid)):
        if a not in grid:
            raise refusal(f"{name}.a", a, "a value of the grid")
    section["a"] = [a for a in grid if a in section["a"]]


def fill_chains(config: Mapping[str, Any]) -> None:
    """Convert the lists of a for chains of other lengths to numbers."""
    chains = config["chains"]
    chains["a"] = values_of(chains["a"], "chains.a")
    if "two_blocks" in chains:
        chains["two_blocks"]["a"] = values_of(chains["two_blocks"]["a"], "chains.two_blocks.a")


def leave_out(config: Mapping[str, Any], stages: Collection[str]) -> None:
    """Remove the values of a of stages that are left out."""
    for name in {"solvers", "phases"} & set(stages):
        config[name]["a"] = []
    if "basins" in stages:
        config["basins"]["a"] = {law: [] for law in config["laws"]}


def check_size(config: Mapping[str, Any], parameters: Mapping[str, Collection[str]]) -> None:
    """Check that Snakemake can plan the points of a study; parameters : the values of each parameter."""
    states, laws = config["initial"], config["laws"]
    points = len(laws) * len(states) * prod(map(len, parameters.values()))
    if points > MAXIMUM_POINTS:
        values = ", ".join(f"{len(values)} values of {name}" for name, values in parameters.items())
        raise ValueError(
            f"{'grid' if config['grid'] else 'a'}: got {points} points ({len(laws)} laws, {len(states)} initial "
            f"states, {values}), expected at most {MAXIMUM_POINTS}"
        )


def check_names(config: Mapping[str, Any], parameters: Mapping[str, Collection[str]]) -> None:
    """Check that the names of points, which contain the values of all parameters, fit into a file system."""
    longest = {plain_name(name): max(values, key=len) for name, values in parameters.items()}
    name = point_file(parameters).format(law="", initial="", **longest).rpartition("/")[2]
    if len(name) > LONGEST_NAME:
        raise ValueError(
            f"{'grid' if config['grid'] else 'a'}: got points with file names of {len(name)} characters ({cut(name)}), "
            f"expected at most {LONGEST_NAME}: fewer parameters, shorter numbers, or fewer a_digits"
        )


def check_jobs(config: Mapping[str, Any], blocks: int, without: Collection[str]) -> None:
    """Check that no job of a study holds too many numbers; config : with defaults; without : stages left out."""
    attractors, basins, phases, chains = (config[name] for name in ("attractors", "basins", "phases", "chains"))
    oscillating = len(phases["amplitude"]) * len(phases["phase_difference"]) * phases["samples"]
    kept = len(phases["a"]) * max(len(phases["inner_share"]), blocks - 2)
    maps = sum(map(len, basins["a"].values()))
    rows = -(-basins["pixels"] // basins["tiles"])
    two_blocks = chains.get("two_blocks", {"a": [], "samples": 0})
    for key, numbers in (
        ("attractors.samples", 2 * blocks * attractors["samples"]),
        ("basins.pixels", maps * basins["pixels"] ** 2),
        ("basins.tiles", 2 * blocks * rows * basins["pixels"]),
        ("basins.pairs", 2 * blocks * _STATES_OF_A_PAIR * basins["pairs"]),
        ("phases.samples", max(2 * blocks, kept) * oscillating),
        ("chains.samples", max(len(chains["a"]), 2 * max(chains.get("blocks", CHAIN_LENGTHS))) * chains["samples"]),
        ("chains.two_blocks.samples", len(two_blocks["a"]) * two_blocks["samples"]),
    ):
        if numbers > MOST_NUMBERS and key.partition(".")[0] not in without:
            value = reduce(getitem, key.split("."), config)
            raise refusal(key, value, f"at most {MOST_NUMBERS:.0e} numbers held by a job, not {numbers:.1e}")
    if maps * basins["tiles"] > MAXIMUM_POINTS:
        raise refusal("basins.tiles", basins["tiles"], f"at most {MAXIMUM_POINTS} tiles in {maps} maps")
