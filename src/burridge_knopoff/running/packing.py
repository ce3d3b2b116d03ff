"""Serialization of Python values: a line of JSON, followed by the bytes of all arrays.

Unlike a pickle, the file runs no code when it is read: it can name only classes that the reader lists, and objects get
their attributes without a call of these classes. Supported are None, booleans, numbers, texts, bytes, enumerations,
lists, tuples, mappings, NumPy arrays and numbers, and objects by their attributes. An array or object that occurs
several times is read as a single object.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Collection
from dataclasses import fields, is_dataclass
from enum import Enum
from functools import cache
from typing import Any, Literal

import numpy as np

from burridge_knopoff.values import own_attributes

_PLAIN = (type(None), bool, int, float, str)
# Truth values, numbers and texts. NumPy would read other words, such as those for tuples of types, by a parser.
_DTYPE = re.compile(r"[<>|][biufcSU]\d{1,9}")


def pack(value: Any, classes: Collection[type] = ()) -> bytes:
    """Return a value as bytes.

    classes : of the objects and enumerations that may occur in it
    Raises TypeError for an object of another class and for an array of anything but numbers or texts.
    """
    names = {kind: name for name, kind in _by_name(classes).items()}
    objects: list[Any] = []
    arrays: list[bytes] = []
    # Keep the objects: an address identifies an object only while the object exists.
    places: dict[int, tuple[Any, int]] = {}

    def pack_value(value: Any) -> Any:
        if type(value) in _PLAIN:
            return value
        match value:
            case Enum():
                return ["enum", name_of(value), value.name]
            case bytes():
                return ["bytes", value.hex()]
            case np.generic():
                return ["number", dtype_of(value), value.tobytes().hex()]
        if type(value) in (list, tuple):
            return [type(value).__name__, *map(pack_value, value)]
        if type(value) is dict:
            return ["dict", *([pack_value(key), pack_value(item)] for key, item in value.items())]
        if id(value) not in places:
            item = pack_array(value) if isinstance(value, np.ndarray) else pack_attributes(value)
            places[id(value)] = value, len(objects)
            objects.append(item)
        return ["object", places[id(value)][1]]

    def pack_array(value: np.ndarray) -> Any:
        order: Literal["F", "C"] = "F" if value.flags.f_contiguous and not value.flags.c_contiguous else "C"
        arrays.append(value.tobytes(order))
        return ["array", dtype_of(value), list(value.shape), order]

    def pack_attributes(value: Any) -> Any:
        kind = name_of(value)
        return ["attributes", kind, {name: pack_value(item) for name, item in own_attributes(value).items()}]

    def name_of(value: Any) -> str:
        if type(value) not in names:
            raise TypeError(f"an object of the class {type(value).__qualname__} cannot be packed")
        return names[type(value)]

    def dtype_of(value: np.ndarray | np.generic) -> str:
        if not _DTYPE.fullmatch(value.dtype.str):
            raise TypeError(f"an array of {value.dtype} cannot be packed")
        return value.dtype.str

    top = pack_value(value)
    return json.dumps([top, objects], separators=(",", ":")).encode() + b"\n" + b"".join(arrays)


def unpack(content: bytes, classes: Collection[type] = ()) -> Any:
    """Return the value written by `pack`.

    classes : of the objects and enumerations that may occur in it
    Raises ValueError for any other content, and for an object of another class.
    """
    try:
        return _unpack(content, _by_name(classes))
    # Whatever JSON, NumPy and the rules of packing make of bytes that `pack` has not written.
    except Exception as error:
        raise ValueError(f"not a packed value: {error!r}") from None


def _unpack(content: bytes, classes: dict[str, type]) -> Any:
    line, _, data = content.partition(b"\n")
    top, packed_objects = json.loads(line)
    objects: list[Any] = []
    place = 0

    def unpack_value(item: Any) -> Any:
        if not isinstance(item, list):
            return item
        kind, *parts = item
        match kind:
            case "enum":
                return _members(classes[parts[0]])[parts[1]]
            case "bytes":
                return bytes.fromhex(parts[0])
            case "number":
                return np.frombuffer(bytes.fromhex(parts[1]), _dtype(parts[0]))[0]
            case "list" | "tuple":
                return (list if kind == "list" else tuple)(map(unpack_value, parts))
            case "dict":
                return {unpack_value(key): unpack_value(value) for key, value in parts}
            case "object":
                return objects[parts[0]]
        raise ValueError(f"unknown kind {kind!r}")

    for kind, *parts in packed_objects:
        if kind == "array":
            dtype, shape, order = parts
            count = math.prod(shape)
            values = np.frombuffer(data, _dtype(dtype), count, place) if count else np.empty(0, _dtype(dtype))
            place += values.nbytes
            objects.append(values.reshape(shape, order=order).copy(order="K"))
        else:
            value = _empty_object(classes[parts[0]], parts[1])
            vars(value).update({name: unpack_value(item) for name, item in parts[1].items()})
            objects.append(value)
    return unpack_value(top)


def _by_name(classes: Collection[type]) -> dict[str, type]:
    return {f"{kind.__module__}:{kind.__qualname__}": kind for kind in classes}


def _dtype(name: str) -> np.dtype:
    if not _DTYPE.fullmatch(name):
        raise ValueError(f"unknown type {name!r}")
    return np.dtype(name)


def _members(kind: type) -> Any:
    if not issubclass(kind, Enum):
        raise ValueError(f"{kind.__qualname__} is not an enumeration")
    return kind.__members__


@cache
def _field_names(kind: Any) -> tuple[set[str], set[str]]:
    """Return the fields of a dataclass that every object has, and all of them."""
    return {field.name for field in fields(kind) if field.init}, {field.name for field in fields(kind)}


def _empty_object(kind: type, names: Collection[str]) -> Any:
    """Return an object without attributes; raises ValueError if a dataclass has others than those named."""
    if is_dataclass(kind) and not _field_names(kind)[0] <= {*names} <= _field_names(kind)[1]:
        raise ValueError(f"{kind.__qualname__} has other attributes")
    return object.__new__(kind)
