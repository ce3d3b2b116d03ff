"""Fields: settings with a range, a default and a description.

A setting is a field of a dataclass whose type is annotated with a range and a description:

    step: Annotated[float, Number(1e-9, 10.0), "step of rk4"] = 1e-3

This single line defines the setting in Python, in the options of `bk simulate`, in the config of a study and in the
tables of config/keys.md. The decorator `settings` makes `help` show the plain type.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any, TypeVar, get_args, get_origin, get_type_hints

from burridge_knopoff.messages import full_key, unknown_key_error
from burridge_knopoff.model.ranges import Range

#: Default of a required field, and of an optional field whose value follows from other fields.
REQUIRED, FOLLOWS = object(), object()


@dataclass(eq=False, repr=False)
class Field:
    """A setting: its range, description and default."""

    range: Range
    description: str
    default: Any = REQUIRED


@dataclass(eq=False, repr=False)
class Keys(Range):
    """A mapping with known keys, each of which is a field. Its form has all defaults, in the order of the fields."""

    fields: Mapping[str, Field]
    #: Appended to the description of the keys.
    words: str = ""

    def _fit(self, value: Any, key: str) -> dict[str, Any] | None:
        if not isinstance(value, Mapping):
            return None
        for name in value:
            if name not in self.fields:
                raise unknown_key_error(key, name, sorted(self.fields))
        values = {}
        for name, field in self.fields.items():
            entry = value.get(name, field.default)
            if entry is REQUIRED:
                raise ValueError(f"{full_key(key, name)}: missing, expected {field.description}")
            if entry is not FOLLOWS:
                values[name] = field.range.form(entry, full_key(key, name))
        return values

    def __str__(self) -> str:
        return f"{{{', '.join(self.fields)}}}{self.words}"


_T = TypeVar("_T")
_FIELDS: dict[type, Mapping[str, Field]] = {}


def settings(kind: type[_T]) -> type[_T]:
    """Decorate a dataclass whose fields have ranges: register the ranges and show plain types in its signature."""
    fields_of(kind)
    plain = get_type_hints(kind)
    for item in dataclasses.fields(kind):  # type: ignore[arg-type]
        item.type = kind.__annotations__[item.name] = kind.__init__.__annotations__[item.name] = plain[item.name]
    return kind


def fields_of(kind: type) -> Mapping[str, Field]:
    """Return the settings of a dataclass by name: the fields that have a range."""
    # A subclass that is no dataclass itself has the fields of its base.
    kind = next((base for base in kind.__mro__ if "__dataclass_fields__" in vars(base)), kind)
    if kind not in _FIELDS:
        hints, fields = get_type_hints(kind, include_extras=True), {}
        for item in dataclasses.fields(kind):
            if get_origin(hints[item.name]) is Annotated:
                _, allowed, description = get_args(hints[item.name])
                default = REQUIRED if item.default is dataclasses.MISSING else item.default
                default = FOLLOWS if default is None else default
                fields[item.name] = Field(allowed, description, default)
        _FIELDS[kind] = fields
    return _FIELDS[kind]


def settings_from_config(kind: type[_T], config: Mapping[str, Any]) -> _T:
    """Return settings of a class from the keys of the same names in a config."""
    return kind(**{name: config[name] for name in fields_of(kind) if name in config})


def check_fields(settings: Any, place: str = "") -> None:
    """Convert the settings of a new dataclass to their form: 3 becomes 3.0, a list becomes a tuple.

    None is kept if the value follows from other fields.

    place : prefix of the names in messages
    Raises ValueError, one line, for anything out of range.
    """
    for name, field in fields_of(type(settings)).items():
        value = getattr(settings, name)
        if not (value is None and field.default is FOLLOWS):
            object.__setattr__(settings, name, field.range.form(value, place + name))
