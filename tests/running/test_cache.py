"""Cached results, which are reused only if everything that determines them is unchanged."""

import dataclasses
import math
import os
import pickle
from functools import partial

import numpy as np
import pytest

from burridge_knopoff import (
    Chain,
    ChainState,
    InitialState,
    Model,
    MotionKind,
    SearchSettings,
    simulate,
)
from burridge_knopoff.dataset.variables import Answer
from burridge_knopoff.running import cache as module
from burridge_knopoff.running.cache import cached_call
from burridge_knopoff.running.packing import pack, unpack
from burridge_knopoff.running.processes import parallel_map


@dataclasses.dataclass
class Item:
    values: object


def first(*items, extra=0):
    return items[0]


def second(*items):
    return items[0]


MODEL = Model("nonlinear", a=0.08)
CLASSES = (Item, Model, Chain, type(MODEL.law), Answer)
CALLS = [
    (first, 1),
    (second, 1),
    (first, 1, 2),
    (first, 1, 23),
    (first, 12, 3),
    (first, [1, 2]),
    (first, (1, [2])),
    (first, 1.0),
    (first, np.array([1.0, 0.0])),
    (first, np.array([1.0, -0.0])),
    (first, np.array([[1.0, 0.0]])),
    (first, np.array([1.0, 0.0], dtype="f4")),
    (first, Item(np.zeros(2))),
    (first, Item(np.zeros(3))),
    (partial(first, extra=1), 1),
    (partial(first, extra=2), 1),
    (first, MODEL),
    (first, MODEL.at(a=0.0800000000000001)),
    (first, dataclasses.replace(MODEL, contact="symmetric")),
]


def test_each_call_is_made_once_and_has_its_own_file(tmp_path):
    for call in CALLS:
        result, path, was_read = cached_call(tmp_path, CLASSES, *call)
        again, same, was_read_again = cached_call(tmp_path, CLASSES, *call)
        assert (path, was_read, was_read_again) == (same, False, True)
        assert repr(again) == repr(result)
    assert len(list(tmp_path.iterdir())) == len(CALLS)


def test_cached_properties_and_identity_of_arguments_do_not_count(tmp_path):
    """A property computed before, or a shared object, does not make the call a different one."""
    model = MODEL.at(a=0.05)
    path = cached_call(tmp_path, CLASSES, first, [model, model])[1]
    assert model.sliding_offset.shape == (3,)
    assert cached_call(tmp_path, CLASSES, first, [model, MODEL.at(a=0.05)])[1:] == (path, True)


@pytest.mark.parametrize(
    ("place", "name", "other"), [(module, "source_fingerprint", lambda name: "another"), (np, "__version__", "0.1")]
)
def test_a_call_of_changed_code_is_another_call(tmp_path, monkeypatch, place, name, other):
    cached_call(tmp_path, CLASSES, first, 1)
    monkeypatch.setattr(place, name, other)
    assert not cached_call(tmp_path, CLASSES, first, 1)[2]


@pytest.mark.parametrize("damage", [b"", b"no line", b"0" * 64 + b"\nother"])
def test_a_corrupt_file_is_ignored(tmp_path, damage):
    path = cached_call(tmp_path, CLASSES, first, 7)[1]
    path.write_bytes(damage)
    assert cached_call(tmp_path, CLASSES, first, 7) == (7, path, False)
    assert cached_call(tmp_path, CLASSES, first, 7) == (7, path, True)


def test_a_file_of_another_call_is_ignored(tmp_path):
    one, other = (cached_call(tmp_path, CLASSES, first, number)[1] for number in (7, 8))
    os.replace(one, other)
    assert cached_call(tmp_path, CLASSES, first, 8) == (8, other, False)


def test_a_written_value_is_read_back():
    """This includes types, signs, bits and the order in memory, which identify a later call."""
    array = np.asfortranarray(np.arange(6.0).reshape(2, 3))
    scalar = np.float64(0.1)
    value = [None, True, -0.0, 0.1, np.nan, 3, "text", b"\0\xff", (1, [2, ()]), {1: "a", (2,): [array, array]}]
    value += [scalar, np.int32(3), np.zeros((0, 4)), np.array(1.5), np.array([True, False]), MODEL, Answer.YES, [MODEL]]
    again = unpack(pack(value, CLASSES), CLASSES)
    assert repr(again) == repr(value)
    assert pack(again, CLASSES) == pack(value, CLASSES)
    pair = again[9][2,]
    assert pair[0] is pair[1]
    assert pair[0].flags.f_contiguous
    assert pair[0].flags.writeable
    assert again[-1][0] is again[-3] == MODEL
    assert type(again[10]) is np.float64
    assert math.copysign(1, again[2]) == -1


def test_a_state_that_no_run_has_reached_is_read_back():
    """It has no last step."""
    span = {"transient": 10, "window": 10, "trajectory": 1, "event_window": 10}
    state = MODEL.begin(InitialState("own", (-0.9, -1.1, -1.0), (0.1, 0.1, 0.1)), start="tested")
    again = unpack(pack(state, [ChainState]), [ChainState])
    assert again.last_step is None
    runs = [simulate(MODEL, initial=at, **span).final for at in (state, again)]
    assert np.array_equal(runs[0].position, runs[1].position)


@pytest.mark.parametrize(
    "value", [np.array([None]), {1, 2}, print, SearchSettings(), MotionKind.PERIODIC, np.datetime64("2000-01-01")]
)
def test_values_that_cannot_be_stored_are_refused(value):
    """This includes objects of classes that are not listed."""
    with pytest.raises(TypeError):
        pack(value, CLASSES)


def test_nothing_is_a_pickle(tmp_path):
    content = cached_call(tmp_path, CLASSES, first, MODEL)[1].read_bytes()
    with pytest.raises(pickle.UnpicklingError):
        pickle.loads(content)


def number_and_process(number):
    return number, os.getpid()


@pytest.mark.parametrize("processes", [1, 2])
def test_unused_files_are_deleted_at_the_end(tmp_path, processes):
    """Caches of other settings in neighbouring folders are deleted too; no file is deleted if a call failed."""
    before, now = tmp_path / (16 * "0"), tmp_path / (16 * "1")
    kept_paths = [tmp_path / "mine", now / "mine", now / "numbers" / "mine", tmp_path / "kept/numbers" / (32 * "a")]
    for path in kept_paths:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("mine")
    for folder, numbers in ((before, [1]), (now, [1, 2])):
        with parallel_map(processes, folder) as pool:
            pool("numbers", number_and_process, numbers)
    assert not any(path.is_file() for path in before.rglob("*"))
    with pytest.raises(ZeroDivisionError), parallel_map(processes, now) as pool:
        pool("fails", divmod, [1], [0])
    with parallel_map(processes, now) as pool:
        assert [pid != os.getpid() for _, pid in pool("numbers", number_and_process, [2])] == [processes == 2]
    left = {path for path in tmp_path.rglob("*") if path.is_file()}
    assert set(kept_paths) <= left
    assert len(left) == len(kept_paths) + 1
