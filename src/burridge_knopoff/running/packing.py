"""Serialization of Python values: a line of JSON, followed by the bytes of all arrays.

Unlike a pickle, the file runs no code when it is read. Supported are None, booleans, numbers, texts, bytes,
enumerations, lists, tuples, mappings, NumPy arrays and numbers, and objects by their attributes. An array or object
that occurs several times is read as a single object.
"""

from __future__ import annotations

import json
import sys
from enum import Enum
from typing import Any, Literal

import numpy as np

from burridge_knopoff.values import own_attributes

_PLAIN = (type(None), bool, int, float, str)


def pack(value: Any) -> bytes:
    """Return a value as bytes; raises TypeError for an array of objects or an object without attributes."""
    objects: list[Any] = []
    arrays: list[bytes] = []
    # Keep the objects: an address identifies an object only while the object exists.
    places: dict[int, tuple[Any, int]] = {}

    def pack_value(value: Any) -> Any:
        if type(value) in _PLAIN:
            return value
        match value:
            case Enum():
                return ["enum", _name(type(value)), value.name]
            case bytes():
                return ["bytes", value.hex()]
            case np.generic():
                return ["number", value.dtype.str, value.tobytes().hex()]
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
        if value.dtype.hasobject:
            raise TypeError(f"an array of objects cannot be packed: {value.dtype}")
        order: Literal["F", "C"] = "F" if value.flags.f_contiguous and not value.flags.c_contiguous else "C"
        arrays.append(value.tobytes(order))
        return ["array", value.dtype.str, list(value.shape), order]

    def pack_attributes(value: Any) -> Any:
        return [
            "attributes",
            _name(type(value)),
            {name: pack_value(item) for name, item in own_attributes(value).items()},
        ]

    top = pack_value(value)
    return json.dumps([top, objects], separators=(",", ":")).encode() + b"\n" + b"".join(arrays)


def unpack(content: bytes) -> Any:
    """Return the value written by `pack`. Raises ValueError, LookupError or AttributeError for other content.

    The modules that define the classes of objects must have been imported.
    """
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
                return _class(parts[0])[parts[1]]
            case "bytes":
                return bytes.fromhex(parts[0])
            case "number":
                return np.frombuffer(bytes.fromhex(parts[1]), parts[0])[0]
            case "list" | "tuple":
                return (list if kind == "list" else tuple)(map(unpack_value, parts))
            case "dict":
                return {unpack_value(key): unpack_value(value) for key, value in parts}
        return objects[parts[0]]

    for kind, *parts in packed_objects:
        if kind == "array":
            dtype, shape, order = parts
            count = int(np.prod(shape, dtype=int))
            values = np.frombuffer(data, dtype, count, place) if count else np.empty(0, dtype)
            place += values.nbytes
            objects.append(values.reshape(shape, order=order).copy(order="K"))
        else:
            value = object.__new__(_class(parts[0]))
            vars(value).update({name: unpack_value(item) for name, item in parts[1].items()})
            objects.append(value)
    return unpack_value(top)


def _name(kind: type) -> str:
    return f"{kind.__module__}:{kind.__qualname__}"


def _class(name: str) -> Any:
    module, _, qualname = name.partition(":")
    return getattr(sys.modules[module], qualname)
