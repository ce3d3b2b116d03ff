"""The claims as stated in `claims.yaml`, each with its judge."""

from __future__ import annotations

import inspect
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

# The topics, which register their judges.
from burridge_knopoff.claims import (  # noqa: F401
    blocks,
    history,
    kinds,
    laws,
    locking,
    model,
    motion,
    section,
    solvers,
    synchronization,
)
from burridge_knopoff.claims.judge import JUDGES, Judge
from burridge_knopoff.claims.verdict import Range
from burridge_knopoff.model import ranges
from burridge_knopoff.model.fields import FOLLOWS, Field, Keys
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.model.ranges import Named, Number, OneOf, Several, Text
from burridge_knopoff.provenance.files import display_path
from burridge_knopoff.study.yaml_file import ConfigError, read_yaml

#: Summaries that the ledger itself reads: for rounded initial states, other tolerances, and the depth of the search.
OWN = ("attractors", "agreement", "lyapunov", "mean_distance", "runs", "two_blocks", "refined")
#: Summaries on which the ledger depends: a change of any other leaves it up to date.
READS = tuple(sorted({*OWN, *(name for judge in JUDGES.values() for name in judge.reads)}))

#: The statements of the paper.
FILE = Path(__file__).with_name("claims.yaml")


class _Arguments(ranges.Range):
    """The arguments of a judge, which `_parameters` checks."""

    def _fit(self, value: Any, key: str) -> dict[str, Any] | None:
        return dict(value) if isinstance(value, Mapping) else None

    def __str__(self) -> str:
        return "named entries"


_WORDS = Text("words", r"(?s:.*\S.*)")
#: The file of claims: claims by name.
CLAIMS = Named(
    Text("small letters, digits and _, a letter first", "[a-z][a-z0-9_]{0,63}"),
    Keys(
        {
            "statement": Field(_WORDS, "the paper's statement, in our words"),
            "place": Field(_WORDS, "its place in the paper"),
            "judge": Field(OneOf(tuple(JUDGES)), "the function that judges the claim"),
            "parameters": Field(_Arguments(), "its arguments"),
            "figure": Field(_WORDS, "the figure of the study that shows the claim"),
            "depends_on": Field(
                Several(Text("one name"), distinct=True),
                "the claims of which this is a case, a repetition or a consequence",
                (),
            ),
        }
    ),
    1,
)

_ENDS = {"from": "first", "to": "last", "above": "above", "below": "below"}
_RANGE = Keys({name: Field(Number(-ranges.HUGE, ranges.HUGE), "one end", FOLLOWS) for name in _ENDS})
_STATE = OneOf(tuple(PAPER_STATES))


@dataclass(frozen=True)
class Claim:
    """A statement of the paper, in our words, and how it is judged.

    parameters : of the judge
    figure : the figure of the study that shows the claim
    depends_on : names of the claims of which this one is a special case, a repetition or a consequence; empty if
        independent
    """

    name: str
    statement: str
    place: str
    judge: Judge
    parameters: Mapping[str, Any]
    figure: str
    depends_on: Sequence[str] = ()

    @property
    def topic(self) -> str:
        """The module of the judge."""
        return self.judge.name.partition(".")[0]


def read_claims(figures: Collection[str], path: str | Path = FILE) -> list[Claim]:
    """Return the claims in a YAML file, in its order.

    figures : names of all figures that a study can have
    Raises ConfigError, one line: file, key, value, expected values.
    """
    content = read_yaml(path)
    try:
        claims = claims_of(content)
        for claim in claims:
            OneOf(tuple(sorted(figures))).form(claim.figure, f"{claim.name}.figure")
        return claims
    except ValueError as error:
        raise ConfigError(f"{display_path(path)}: {error}") from error


def claims_of(content: Mapping[str, Any]) -> list[Claim]:
    """Return the claims in the content of such a file; raises ValueError, one line: key, value, expected values."""
    claims = []
    for name, item in CLAIMS.form(content, "").items():
        judge = JUDGES[item.pop("judge")]
        parameters = _parameters(judge, item.pop("parameters"), f"{name}.parameters")
        statement, place = (" ".join(item.pop(key).split()) for key in ("statement", "place"))
        claims.append(Claim(name, statement, place, judge, parameters, **item))
    for claim in claims:
        for other in claim.depends_on:
            OneOf(tuple(one.name for one in claims if one is not claim)).form(other, f"{claim.name}.depends_on")
    return claims


def _parameters(judge: Judge, parameters: Mapping[str, Any], place: str) -> dict[str, Any]:
    """Return the parameters of a judge, with ranges of a; raises ValueError if they do not fit its signature."""
    signature = inspect.signature(judge.function)
    try:
        signature.bind(None, **parameters)
    except TypeError as error:
        raise ValueError(f"{place}: {error}, expected {', '.join([*signature.parameters][1:])}") from error
    for state in np.atleast_1d(parameters.get("initial", [])).tolist():
        _STATE.form(state, f"{place}.initial")
    found = dict(parameters)
    for key in {"a", "synchrony"} & {*parameters}:
        ends = _RANGE.form(parameters[key], f"{place}.{key}")
        found[key] = Range(**{_ENDS[name]: number for name, number in ends.items()})
    return found
