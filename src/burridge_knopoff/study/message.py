"""One line for a schema violation: key, value, what is allowed."""

from __future__ import annotations

import re
from typing import Any

_TYPES = {
    "number": "a finite number",
    "integer": "a whole number",
    "string": "text",
    "array": "a list",
    "object": "named entries",
}


class ConfigError(ValueError):
    """A config that is not allowed; the message is one line: file, key, value, what is allowed."""


def shown(value: Any) -> str:
    """Return a key as a message shows it: plain words as they are, all else in quotes and ASCII; short, on one line.

    Letters of other alphabets look like those of ours, and some characters are not seen at all.
    """
    text = value if isinstance(value, str) and re.fullmatch(r"[A-Za-z0-9_.+-]+", value) else ascii(value)
    return text if len(text) <= 60 else f"{text[:57]}..."


def explain(error: Any) -> str:
    """Return «key: value is not allowed: what is» for a jsonschema ValidationError."""
    key = _key(error.absolute_path)
    if error.validator == "additionalProperties":
        known = sorted(error.schema.get("properties", {}))
        unknown = min(set(map(str, error.instance)) - set(known))
        return f"{_join(key, unknown)}: unknown key; allowed here: {', '.join(known)}"
    if error.validator == "dependentRequired":
        present, missing = re.findall(r"'([^']*)'", error.message)[1::-1]
        return f"{_join(key, missing)}: missing; needed with {present}"
    if error.validator == "required":
        missing = re.findall(r"'([^']*)' is a required property", error.message)[0]
        description = error.schema.get("properties", {}).get(missing, {}).get("description", "")
        return f"{_join(key, missing)}: missing; needed: {' '.join(description.split())}"
    if error.validator == "oneOf":
        closest = _closest(error)
        if closest is not None:
            return explain(closest)
    value = _short(error.instance)
    return f"{key or 'config'}: {value} is not allowed: {_allowed(error)}{_hint(error.instance)}"


def _closest(error: Any) -> Any:
    """Return the violation inside the alternative whose type fits, or None."""
    for item in error.context:
        fits = "object" if isinstance(error.instance, dict) else "number"
        if item.validator != "type" and item.schema_path[0] == (1 if fits == "object" else 0):
            return item
        if item.absolute_path != error.absolute_path:
            return item
    return None


def _key(path: Any) -> str:
    text = ""
    for part in path:
        text = f"{text}[{part}]" if isinstance(part, int) else _join(text, str(part))
    return text


def _join(key: str, part: str) -> str:
    return f"{key}.{shown(part)}" if key else shown(part)


def _short(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."


def _allowed(error: Any) -> str:
    schema = error.schema if isinstance(error.schema, dict) else {}
    if "enum" in schema:
        return " | ".join(map(str, schema["enum"]))
    if "pattern" in schema:
        return f"text like {schema['pattern']}"
    if "oneOf" in schema:
        return "a number 0 ≤ a ≤ 100, or a range {from, to, step}"
    if error.validator in ("minItems", "minProperties"):
        return f"at least {error.validator_value}"
    if error.validator == "maxItems":
        return f"at most {error.validator_value}"
    if error.validator == "uniqueItems":
        return "each value once"
    if schema.get("type") == "object":
        return "keys " + ", ".join(sorted(schema.get("properties", {}))) if "properties" in schema else "named entries"
    types = schema.get("type", [])
    words = " or ".join(_TYPES.get(item, item) for item in ([types] if isinstance(types, str) else types))
    bounds = [
        f"{sign} {schema[name]:g}"
        for name, sign in (("minimum", "≥"), ("exclusiveMinimum", ">"), ("maximum", "≤"), ("exclusiveMaximum", "<"))
        if name in schema
    ]
    return f"{words} {' and '.join(bounds)}".strip()


def _hint(value: Any) -> str:
    if isinstance(value, str) and re.fullmatch(r"[-+]?\d+(\.\d*)?[eE]\d+|[-+]?\d+[eE][-+]?\d+", value):
        return " (YAML takes this for text: write it with a point and a sign, like 1.0e-6)"
    return ""
