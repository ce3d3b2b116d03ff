"""The config of a study: every key with its range, default and description.

Most keys are settings of the library, under the same names. This module adds the keys that only a study has and
combines all of them. `CONFIG.form` fills in the defaults or refuses a config; rules.py checks the keys against each
other.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any

from burridge_knopoff.attractors.settings import SearchSettings
from burridge_knopoff.basins.settings import BasinSettings, EdgeSettings, PhaseSettings
from burridge_knopoff.catalogue.settings import CatalogueSettings
from burridge_knopoff.continuation.settings import RefinementSettings
from burridge_knopoff.laws import LAWS, unknown_law
from burridge_knopoff.messages import full_key
from burridge_knopoff.model.chain import Chain
from burridge_knopoff.model.fields import FOLLOWS, Field, Keys, fields_of
from burridge_knopoff.model.initial import STATE_NAME, InitialState
from burridge_knopoff.model.model import LAW_NAME, Model
from burridge_knopoff.model.ranges import HUGE, SHARE, Either, Named, Number, OneOf, Range, Several, Text, Whole
from burridge_knopoff.model.sampling import SAMPLES
from burridge_knopoff.motion.chain_settings import Sample, Watch
from burridge_knopoff.motion.settings import ERRORS, MotionSettings
from burridge_knopoff.running.section import SECTION_KEYS
from burridge_knopoff.running.settings import TIME, Settings
from burridge_knopoff.running.solvers import RUN_SOLVERS
from burridge_knopoff.study.paper import PAPER_A, PAPER_BASINS, PAPER_COMPARED, PAPER_LAWS, PAPER_PHASES
from burridge_knopoff.study.stages import CHAIN_LENGTHS, STAGES

NUMBER = Number(-HUGE, HUGE)
A = Number(0.0, 100.0)


def _values(number: Number, longest: float) -> Several:
    """Return the range of a list of numbers and of ranges {from, to, step}; see `grid.values_of`."""
    steps = {
        "from": Field(number, "first value"),
        "to": Field(number, "last value"),
        "step": Field(Number(0.0, longest, above=True), "distance between values; must divide the length of the range"),
    }
    return Several(Either((number, Keys(steps))), 1)


VALUES = _values(A, 100.0)
SOME_VALUES = Several(A, 0, 100, distinct=True)

PARAMETER_NAME = Text(
    "letters, digits and _, a letter first; mass[1] for one block or spring",
    r"[A-Za-z][A-Za-z0-9_]*(\[[0-9]+\])?",
)
STUDY_NAME = Text("letters, digits, _ and -, at most 64, a letter or digit first", "[A-Za-z0-9][A-Za-z0-9_-]{0,63}")


class _BuiltInLaw(OneOf):
    """The name of a built-in law."""

    def form(self, value: Any, key: str) -> Any:
        """Return a name. Raises ValueError, one line with the closest name, or with the way to give a formula."""
        if self._fit(value, key) is None:
            raise unknown_law(key, value)
        return value


class LawKeys(Range):
    """The description of a law: `law` or `formula`, and parameters under any other names."""

    fields: Mapping[str, Field] = {
        "law": Field(_BuiltInLaw(tuple(LAWS)), "built-in law, to use it under another name"),
        "formula": Field(
            Text(), "friction over the static friction of the block, as a function of u, a and other names"
        ),
    }
    #: Range of a parameter.
    number = NUMBER

    def _fit(self, value: Any, key: str) -> dict[str, Any] | None:
        if not isinstance(value, Mapping):
            return None
        ranges = {name: field.range for name, field in self.fields.items()}
        return {name: ranges.get(name, self.number).form(item, full_key(key, name)) for name, item in value.items()}

    def __str__(self) -> str:
        return "law or formula, and parameters; {} for a built-in law with its defaults"


_LAW_KEY = replace(LAW_NAME, words=f"{LAW_NAME.words}; a formula as NAME: {{formula: ...}}")


def _settings_of(kind: type, *without: str, **other: Field) -> dict[str, Field]:
    """Return the settings of a class except those in `without`, with those in `other` replaced."""
    return {name: other.get(name, field) for name, field in fields_of(kind).items() if name not in without}


def _section(description: str, fields: Mapping[str, Field]) -> Field:
    return Field(Keys(fields), description, {})


def _optional_section(description: str, fields: Mapping[str, Field]) -> Field:
    """Return a section without which the study has no such stage."""
    return Field(Keys(fields), f"{description}; without this key there are none", FOLLOWS)


def _study_default(field: Field) -> Field:
    return replace(field, description=f"{field.description}; by default the study's", default=FOLLOWS)


_SETTINGS, _SAMPLE, _CATALOGUE = fields_of(Settings), fields_of(Sample), fields_of(CatalogueSettings)
_STATE = {name: replace(field, default=FOLLOWS) for name, field in fields_of(InitialState).items()}
_SOLVER = OneOf(RUN_SOLVERS)

AGREEMENT = {
    "relative_tolerance": Field(
        SHARE,
        "a law agrees with the first law if its motion is of the same kind (periodic and quasiperiodic count as one) "
        "and <J> differs by at most this fraction of the larger value, or by at most synchronization_threshold",
        0.1,
    ),
    "standard_errors": Field(
        ERRORS,
        "the comparison is undecided if the difference lies within this many standard errors of that tolerance",
        3.0,
    ),
}
COMPARED = {
    "a": Field(
        replace(SOME_VALUES, least=1),
        "values of a on the grid at which every other solver that applies to the law repeats the runs; by default "
        f"those of {', '.join(map(str, PAPER_COMPARED))} that are on the grid, or figures.a if none is",
        FOLLOWS,
    ),
    "step": replace(_SETTINGS["step"], description="step of rk4 in this comparison", default=0.0025),
}
FIGURES = {
    "a": Field(A, f"value of a on the grid in figures of single runs; by default that nearest to {PAPER_A}", FOLLOWS),
    "law": Field(Text(), "friction law in figures of single runs; by default the study's first", FOLLOWS),
}
BASINS = {
    "a": Field(
        Named(Text(), SOME_VALUES),
        "values of a on the grid for which basins are mapped, by law; by default those of "
        + " and ".join(f"{', '.join(map(str, values))} ({law})" for law, values in PAPER_BASINS.items())
        + f" that are on the grid; other laws as {next(iter(PAPER_BASINS))}",
        {},
    ),
    "pixels": fields_of(BasinSettings)["pixels"],
    "initial": Field(
        Text(),
        "initial state that gives the other positions and all velocities of the plane; by default the study's first",
        FOLLOWS,
    ),
    **_settings_of(BasinSettings, "pixels"),
}
PHASES = {
    "a": Field(
        SOME_VALUES,
        "values of a on the grid for which initial states are defined by the phases of their end blocks; by default, "
        f"for the paper's chain, those of {', '.join(map(str, PAPER_PHASES))} that are on the grid",
        FOLLOWS,
    ),
    **_settings_of(PhaseSettings),
}
EDGES = {
    "a": Field(
        replace(VALUES, element=A, distinct=True),
        "values of a on the grid at which the boundaries between basins are followed to edge states; by default all",
        FOLLOWS,
    ),
    **_settings_of(EdgeSettings),
}
CATALOGUE = {
    "a": Field(
        replace(VALUES, element=A, distinct=True),
        "values of a on the grid with a catalogue of slip events; by default all",
        FOLLOWS,
    ),
    "initial": Field(Text(), "initial state of these runs; by default the study's first", FOLLOWS),
    **_settings_of(CatalogueSettings, **{name: _study_default(_CATALOGUE[name]) for name in ("transient", "window")}),
}
TWO_BLOCKS = {
    "a": Field(VALUES, "friction parameters at which the laws are compared", [{"from": 0.01, "to": 0.4, "step": 0.01}]),
    "samples": Field(SAMPLES, "number of random initial states for this comparison", 8),
}
CHAINS = {
    "blocks": Field(
        Several(Whole(2, 64), 1, distinct=True),
        "numbers of blocks of the chains that belong to the study; by default none do, and the target `chains` "
        f"computes those of {CHAIN_LENGTHS[0]} to {CHAIN_LENGTHS[-1]} blocks",
        FOLLOWS,
    ),
    "a": Field(VALUES, "friction parameters", [0.005, {"from": 0.01, "to": 0.16, "step": 0.01}, 0.18, 0.2, 0.25, 0.3]),
    "laws": Field(
        Several(Text(), 1, distinct=True), "friction laws, a subset of the study's; by default the first", FOLLOWS
    ),
    "samples": _SAMPLE["samples"],
    "symmetric_samples": replace(_SAMPLE["symmetric_samples"], range=SAMPLES),
    **{key: _SAMPLE[key] for key in ("seed", "position", "velocity")},
    **_settings_of(Watch, "synchronization_threshold"),
    "two_blocks": _optional_section("comparison of the laws for two blocks", TWO_BLOCKS),
}


def check_law_numbers(names: Iterable[str]) -> None:
    """Raise ValueError, one line, if a parameter of a law has the name of a key of the config, such as `window`.

    In Python both are arguments of the same functions. `a` and `u` are refused by every law.
    """
    sections = (field.range.fields for field in CONFIG.fields.values() if isinstance(field.range, Keys))
    settings = CONFIG.fields.keys() | {name for section in sections for name in section}
    for name in names:
        if name in settings - {"a"}:
            raise ValueError(f"{name}: got a parameter of the law with the name of a setting, expected another name")


CONFIG = Keys(
    {
        "study": Field(STUDY_NAME, "name of the study and of its folder in results/"),
        "a": Field(
            VALUES,
            "friction parameters, in any order; ranges may overlap; from and to are included, and to − from must be a "
            "multiple of step",
            FOLLOWS,
        ),
        "grid": Field(
            Named(PARAMETER_NAME, _values(NUMBER, HUGE)),
            "values of a and of other parameters, in place of the key a; every combination is simulated",
            {},
        ),
        "a_digits": Field(Whole(1, 15), "number of decimals of a and of the other parameters in file names", 4),
        "initial": Field(
            Named(STATE_NAME, Keys(_STATE, "; {} for one of the paper's"), 1),
            "initial states by name, each with position U(0) and velocity U'(0): one number for all blocks, one per "
            "block, or random; minus: {} and plus: {} are the paper's states, which follow v",
        ),
        "without": Field(
            Several(OneOf(tuple(STAGES)), distinct=True),
            "stages to leave out; stages that use their results are left out as well",
            [],
        ),
        "laws": Field(Named(_LAW_KEY, LawKeys(), 1), "friction laws by name", {law: {} for law in PAPER_LAWS}),
        "chain": _section("blocks and springs, by default the paper's", _settings_of(Chain)),
        **_settings_of(Model),
        **_settings_of(
            Settings,
            solver=Field(
                Either((_SOLVER, Named(LAW_NAME, _SOLVER))),
                f"{_SETTINGS['solver'].description}; one for all laws, or by law, such as {{linearized: map}}",
                _SETTINGS["solver"].default,
            ),
            transient=replace(_SETTINGS["transient"], range=TIME),
            section=Field(SECTION_KEYS, "Poincaré section W = 0", {}),
            events=Field(OneOf(("window", "all")), _SETTINGS["events"].description.partition(" | none")[0], "window"),
        ),
        "synchronization_threshold": fields_of(MotionSettings)["synchronization_threshold"],
        "motion": _section(
            "criteria by which kinds of motion are distinguished",
            _settings_of(MotionSettings, "synchronization_threshold", "section"),
        ),
        "agreement": _section("comparison of each law with the first", AGREEMENT),
        "solvers": _section("comparison of the solvers", COMPARED),
        "figures": _section("runs in the figures of single runs", FIGURES),
        "attractors": _section("search for attractors", _settings_of(SearchSettings)),
        "refine": _section("changes of the attractors between the values of a", _settings_of(RefinementSettings)),
        "basins": _section("maps of basins of attraction", BASINS),
        "phases": _section("initial states defined by the phases of their blocks", PHASES),
        "edges": _optional_section("edge states on the boundaries between basins", EDGES),
        "chains": _section("synchronization of chains of other lengths", CHAINS),
        "catalogue": _optional_section("catalogues of slip events", CATALOGUE),
    }
)
