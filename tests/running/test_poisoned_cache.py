"""Files in the cache that are damaged, or that somebody else wrote: they run nothing, and are computed again."""

import ctypes
import dataclasses
import json
import logging
import random
import typing
from enum import Enum

import numpy as np
import pytest

from burridge_knopoff import Model
from burridge_knopoff.attractors.lifetime import Lifetime
from burridge_knopoff.attractors.search import Search
from burridge_knopoff.continuation.cached import CLASSES
from burridge_knopoff.laws import LAWS, FormulaLaw, Law
from burridge_knopoff.motion.kind import MotionKind
from burridge_knopoff.periodic_orbits.branch_segment import HalfBranch
from burridge_knopoff.periodic_orbits.periodic import PeriodicOrbit
from burridge_knopoff.running.cache import _HEAD, _head, cached_call
from burridge_knopoff.running.packing import pack, unpack

MODEL = Model("linearized", a=0.08)


def result_of(number):
    return [MODEL.at(a=number), MotionKind.PERIODIC, np.arange(4.0), (1, {"a": b"bytes"}), np.float64(0.5)]


def parts_of(content):
    """Return the JSON of a packed value, and the bytes of its arrays."""
    line, _, data = content.partition(b"\n")
    return json.loads(line), data


def put_together(packed, data):
    return json.dumps(packed).encode() + b"\n" + data


def write_with_checksum(path, content):
    """Write a file of the cache whose checksum agrees, as anybody can."""
    path.write_bytes(_head(path.name, content) + content)


@pytest.fixture
def loaded(monkeypatch):
    """The names of libraries that are loaded."""
    names = []
    monkeypatch.setattr(ctypes.cdll, "_dlltype", names.append)
    return names


# The first loads a library; others name functions, modules and classes, listed or not.
FOREIGN = [
    ["enum", "ctypes:cdll", "./evil.so"],
    ["enum", "ctypes:pydll", "./evil.so"],
    ["enum", "os:environ", "PATH"],
    ["enum", "burridge_knopoff.model.model:Model", "at"],
    ["enum", "burridge_knopoff.motion.kind:MotionKind", "words"],
    ["enum", "burridge_knopoff.motion.kind:MotionKind", "__class__"],
    ["enum", "burridge_knopoff.basins.settings:BasinSettings", "pixels"],
    ["number", "O", "0000000000000000"],
    ["number", "f8,O", "00" * 16],
    ["system", "touch evil"],
    ["object", 10**6],
    [],
]
FOREIGN_OBJECTS = [
    ["attributes", "os:system", {"command": "touch evil"}],
    ["attributes", "os:environ", {"_data": {}}],
    ["attributes", "subprocess:Popen", {"args": "touch evil"}],
    ["attributes", "builtins:eval", {}],
    ["attributes", "antigravity:x", {}],
    ["attributes", "burridge_knopoff.provenance.files:write_text", {"path": "evil"}],
    ["attributes", "burridge_knopoff.running.processes:ParallelMap", {}],
    ["attributes", "burridge_knopoff.model.model:Model", {}],
    ["attributes", "burridge_knopoff.model.model:Model", {"chain": 1, "law": 2, "v": 3, "contact": 4, "evil": 5}],
    ["attributes", "burridge_knopoff.motion.kind:MotionKind", {"name": "evil"}],
    ["array", "|O", [1], "C"],
    ["array", "(10)f8", [1], "C"],
    ["array", "<f8", [10**9], "C"],
    ["array", "<f8", ["x"], "C"],
    ["array"],
]


@pytest.mark.parametrize(
    "foreign",
    [
        *(pytest.param(lambda top, objects, item=item: top.append(item), id=f"{item}") for item in FOREIGN),
        *(pytest.param(lambda top, objects, item=item: objects.append(item), id=f"{item}") for item in FOREIGN_OBJECTS),
    ],
)
def test_a_file_that_names_anything_else_is_computed_again(tmp_path, monkeypatch, caplog, loaded, foreign):
    """The checksum of the file agrees, and the rest of it is intact."""
    monkeypatch.chdir(tmp_path)
    folder = tmp_path / "cache"
    result, path, _ = cached_call(folder, CLASSES, result_of, 0.1)
    intact = path.read_bytes()
    packed, data = parts_of(intact[_HEAD:])
    foreign(*packed)
    write_with_checksum(path, put_together(packed, data))
    with caplog.at_level(logging.INFO):
        again = cached_call(folder, CLASSES, result_of, 0.1)
    assert repr(again) == repr((result, path, False))
    assert path.read_bytes() == intact
    (line,) = caplog.messages
    assert line.startswith(f"note: {path}: not a result of this call, which is computed again: ")
    assert "\n" not in line
    assert not loaded
    assert [*tmp_path.iterdir()] == [folder]
    assert cached_call(folder, CLASSES, result_of, 0.1)[2]


def fail(*_, **__):
    raise AssertionError("called")


@dataclasses.dataclass
class Trap:
    """A listed class with side effects everywhere."""

    value: int
    __new__ = __init__ = __post_init__ = __setattr__ = __setstate__ = fail


def test_listed_classes_are_not_called():
    trap = object.__new__(Trap)
    vars(trap)["value"] = 3
    again = unpack(pack([trap], [Trap]), [Trap])[0]
    assert (type(again), vars(again)) == (Trap, {"value": 3})


def values_in(item):
    """Yield the containers in a JSON value, each with a key or index."""
    keys = range(len(item)) if isinstance(item, list) else list(item) if isinstance(item, dict) else ()
    for key in keys:
        yield item, key
        yield from values_in(item[key])


def test_damage_gives_an_error_or_a_value_and_nothing_else(tmp_path, monkeypatch, loaded):
    """Single bytes, lengths, and parts of the JSON are changed at random."""
    monkeypatch.chdir(tmp_path)
    content, draw = pack(result_of(0.1), CLASSES), random.Random(1)
    hostile = [*FOREIGN, *FOREIGN_OBJECTS, None, True, -1, 1e400, 2**70, "", "\0", {}, [[]], "ctypes:cdll", "./evil.so"]
    refused = 0
    for number in range(3000):
        damaged = bytearray(content)
        if number % 3 == 0:
            for _ in range(draw.randint(1, 5)):
                damaged[draw.randrange(len(damaged))] = draw.randrange(256)
        elif number % 3 == 1:
            del damaged[draw.randrange(len(damaged)) :][: draw.randint(1, 50)]
        else:
            packed, data = parts_of(content)
            place, key = draw.choice([*values_in(packed)])
            place[key] = draw.choice(hostile)
            damaged = put_together(packed, data)
        try:
            unpack(bytes(damaged), CLASSES)
        except ValueError:
            refused += 1
    assert 1000 < refused < 3000
    assert not loaded
    assert not [*tmp_path.iterdir()]


@pytest.mark.parametrize("content", [b"[" * 100_000, b"", b"\n", b"null", b"[1,2]", b"\xff\xfe[]"])
def test_content_that_is_no_packed_value_is_refused(content):
    with pytest.raises(ValueError, match="not a packed value"):
        unpack(content, CLASSES)


def classes_in(kind, found):
    """Collect the dataclasses and enumerations that may occur in a value of a type, by the types of its fields."""
    for part in typing.get_args(kind):
        classes_in(part, found)
    if kind is Law:
        found.update((FormulaLaw, *LAWS.values()))
    elif isinstance(kind, type) and kind not in found and (dataclasses.is_dataclass(kind) or issubclass(kind, Enum)):
        found.add(kind)
        hints = typing.get_type_hints(kind) if dataclasses.is_dataclass(kind) else {}
        for field in dataclasses.fields(kind) if hints else ():
            classes_in(hints[field.name], found)


def test_all_classes_that_occur_in_results_are_listed():
    """A result of another class could not be stored, and its job would fail at its end."""
    found = set()
    for kind in (Search, Lifetime, PeriodicOrbit, HalfBranch):
        classes_in(kind, found)
    assert found == set(CLASSES)
    assert all(kind.__module__.startswith("burridge_knopoff.") for kind in CLASSES)
