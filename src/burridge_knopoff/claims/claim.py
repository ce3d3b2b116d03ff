"""The claims as stated in `claims.yaml`, each with its judge."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, get_type_hints

import numpy as np

from burridge_knopoff.claims import (
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
from burridge_knopoff.claims.margins import PARTS
from burridge_knopoff.claims.verdict import Range, Verdict
from burridge_knopoff.model import ranges
from burridge_knopoff.model.fields import FOLLOWS, Field, Keys, unknown_key
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.model.ranges import Named, Number, OneOf, Several, Text, Whole
from burridge_knopoff.provenance.files import display_path
from burridge_knopoff.study.paper import PAPER_LAWS
from burridge_knopoff.study.yaml_file import ConfigError, read_yaml
from burridge_knopoff.values import refusal

#: The statements of the paper.
FILE = Path(__file__).with_name("claims.yaml")

TOPICS = {
    "synchronization": synchronization,
    "history": history,
    "kinds": kinds,
    "section": section,
    "locking": locking,
    "motion": motion,
    "model": model,
    "laws": laws,
    "solvers": solvers,
    "blocks": blocks,
}

_RANGE = {"from": "first", "to": "last", "above": "above", "below": "below"}


class _Arguments(ranges.Range):
    """The arguments of a judge, which `_parameter` checks."""

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
            "judge": Field(
                Text(f"topic.function, the topic one of {', '.join(TOPICS)}", rf"({'|'.join(TOPICS)})\.[a-z_]+"),
                "the function that judges the claim",
            ),
            "parameters": Field(_Arguments(), "its arguments"),
            "figure": Field(
                Text("small letters, digits and _", "[a-z][a-z0-9_]*"), "the figure of the study that shows the claim"
            ),
            "depends_on": Field(
                Several(Text("one name"), distinct=True),
                "the claims of which this is a case, a repetition or a consequence",
                (),
            ),
        }
    ),
    1,
)

_NUMBER, _NAME, _SHARE = Number(-ranges.HUGE, ranges.HUGE), Text("one name"), Number(0.0, 1.0, above=True)
#: Ranges of judges' parameters by name; other parameters are checked by their type.
_BY_NAME: Mapping[str, ranges.Range] = {
    **dict.fromkeys(("a", "synchrony"), Keys({name: Field(_NUMBER, "one end", FOLLOWS) for name in _RANGE})),
    "laws": Several(OneOf(PAPER_LAWS), 1, distinct=True),
    "part": OneOf(PARTS),
    "law": OneOf(PAPER_LAWS),
    "tolerance": Number(0.0, ranges.HUGE),
    **dict.fromkeys(("loose", "much"), Number(0.0, ranges.HUGE, above=True)),
    **dict.fromkeys(("share", "loose_share"), _SHARE),
    "kinds": Several(OneOf(("synchronized", "periodic", "quasiperiodic", "chaotic")), 1),
    "claims": Several(_NAME, 1, distinct=True),
    "coefficients": Several(_NUMBER, 3, 3),
}
_BY_TYPE: Mapping[Any, ranges.Range] = {
    str: _NAME,
    int: Whole(1, 10**9),
    float: _NUMBER,
    Sequence[str]: Several(_NAME),
    tuple[str, str]: Several(_NAME, 2, 2),
    Sequence[float]: Several(_NUMBER),
}


@dataclass(frozen=True)
class Claim:
    """A statement of the paper, in our words, and how it is judged.

    topic, judge, parameters : the function `judge` of the module `topic`, and its arguments
    figure : the figure of the study that shows the claim
    depends_on : names of the claims of which this is a case, a repetition or a consequence; empty if independent
    """

    name: str
    statement: str
    place: str
    topic: str
    judge: Callable[..., Verdict]
    parameters: Mapping[str, Any]
    figure: str
    depends_on: Sequence[str] = ()


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
    claims = [_claim(name, item) for name, item in CLAIMS.form(content, "").items()]
    for claim in claims:
        for other in claim.depends_on:
            OneOf(tuple(one.name for one in claims if one is not claim)).form(other, f"{claim.name}.depends_on")
    return claims


def _claim(name: str, item: Mapping[str, Any]) -> Claim:
    topic, function = item["judge"].split(".")
    judges = _judges(topic)
    if function not in judges:
        raise refusal(f"{name}.judge", item["judge"], f"one of {', '.join(judges)} of {topic}")
    parameters = dict(item["parameters"])
    expected = get_type_hints(judges[function])
    del expected["evidence"], expected["return"]
    place = f"{name}.parameters"
    for key in parameters:
        if key not in expected:
            raise unknown_key(place, key, list(expected))
    for key, kind in expected.items():
        if key not in parameters:
            raise ValueError(f"{place}.{key}: missing, expected a value for {item['judge']}")
        parameters[key] = _parameter(key, parameters[key], kind, f"{place}.{key}")
    for state in np.atleast_1d(parameters.get("initial", [])):
        if state not in PAPER_STATES:
            raise ValueError(f"{place}.initial: got {state!s}, expected {' | '.join(PAPER_STATES)}")
    if parameters.get("loose", np.inf) < parameters.get("tolerance", 0.0):
        raise refusal(f"{place}.loose", parameters["loose"], "at least tolerance")
    statement, where = (" ".join(item[key].split()) for key in ("statement", "place"))
    depends = tuple(item["depends_on"])
    return Claim(name, statement, where, topic, judges[function], parameters, item["figure"], depends)


def _parameter(key: str, value: Any, kind: Any, place: str) -> Any:
    """Return a parameter as its judge takes it; `kind` is the annotation."""
    if kind is bool:
        if not isinstance(value, bool):
            raise refusal(place, value, "true | false")
        return value
    value = _BY_NAME.get(key, _BY_TYPE.get(kind, _NUMBER)).form(value, place)
    if kind is not Range:
        return value
    if not value or ("from" in value and "above" in value) or ("to" in value and "below" in value):
        raise refusal(place, value, "at least one end, and one of each side")
    ends = Range(**{_RANGE[name]: number for name, number in value.items()})
    if ends.empty:
        raise refusal(place, value, "the first end below the last")
    return ends


def _judges(topic: str) -> dict[str, Callable[..., Verdict]]:
    """Return the judges of a topic by name: the public functions defined in its module."""
    module = TOPICS[topic]
    return {
        name: function
        for name, function in vars(module).items()
        if inspect.isfunction(function) and function.__module__ == module.__name__ and not name.startswith("_")
    }
