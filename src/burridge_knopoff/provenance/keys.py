"""The keys of a config on which a file of results depends, as {key: value} with dotted keys.

A key stands for its whole section, or for a part: `attractors`, `attractors.samples`, `laws.linearized`. A job at a
single a has that value as `a=0.0800`, with its name in file names.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable, Mapping
from typing import Any

#: {parameter: {name in file names: value}}
Parameters = Mapping[str, Mapping[str, float]]

#: Maximum length of a value in a message.
_LONGEST = 60
#: Stands for the value of a key that a study does not have.
MISSING = object()


def select(config: Mapping[str, Any], parameters: Parameters, keys: Iterable[str]) -> dict[str, Any]:
    """Return {key: value} of a study. Raises KeyError if it has no such key."""
    values = {key: value_of(config, parameters, key) for key in keys}
    if missing := [key for key, value in values.items() if value is MISSING]:
        raise KeyError(missing[0])
    return values


def value_of(config: Mapping[str, Any], parameters: Parameters, key: str) -> Any:
    """Return the value of a key, `MISSING` if the study has none."""
    if key.startswith("a="):
        return parameters.get("a", {}).get(key[2:], MISSING)
    value: Any = config
    for part in key.split("."):
        value = value.get(part, MISSING) if isinstance(value, Mapping) else MISSING
    return value


def nested(values: Mapping[str, Any]) -> dict[str, Any]:
    """Return {key: value} as a config: `laws.linearized` is the key `linearized` of `laws`, `a=0.0800` the key `a`."""
    config: dict[str, Any] = {}
    for key, value in values.items():
        *sections, name = ["a"] if key.startswith("a=") else key.split(".")
        inside = config
        for section in sections:
            inside = inside.setdefault(section, {})
        inside[name] = value
    return config


def difference(actual: Any, expected: Any, place: str = "", form: str = "{}: got {}, expected {}") -> str:
    """Return the first difference of two values in words, `attractors.samples: got 100, expected 120`; empty if none.

    The order counts, such as that of the laws in a summary.
    """
    if _json(actual) == _json(expected):
        return ""
    if isinstance(actual, Mapping) and isinstance(expected, Mapping):
        for key in {**expected, **actual}:
            pair = actual.get(key, MISSING), expected.get(key, MISSING)
            if words := difference(*pair, f"{place}.{key}" if place else key, form):
                return words
        return difference(list(actual), list(expected), place, form)
    if (
        isinstance(actual, list)
        and isinstance(expected, list)
        and max(len(_text(actual)), len(_text(expected))) > _LONGEST
    ):
        for n, pair in enumerate(zip(actual, expected, strict=False)):
            if words := difference(*pair, f"{place}[{n}]", form):
                return words
        actual, expected = f"{len(actual)} entries", f"{len(expected)} entries"
    texts = _text(actual), _text(expected)
    return form.format(place, _cut(*texts), _cut(*texts[::-1]))


def digest_of(*values: Any) -> str:
    """Return 16 hexadecimal digits for values of a config."""
    return hashlib.sha256(_json(values).encode()).hexdigest()[:16]


def _json(value: Any) -> str:
    return json.dumps(value, default=str)


def _text(value: Any) -> str:
    return "nothing" if value is MISSING else value if isinstance(value, str) else json.dumps(value)


def _cut(text: str, other: str) -> str:
    """Return a text, if it is long cut around the first letter in which it differs from another."""
    if max(len(text), len(other)) <= _LONGEST:
        return text
    first = next((n for n, pair in enumerate(zip(text, other, strict=False)) if len({*pair}) > 1), 0)
    begin = max(first - _LONGEST // 2, 0)
    return f"{'…' * (begin > 0)}{text[begin : begin + _LONGEST]}{'…' * (len(text) > begin + _LONGEST)}"
