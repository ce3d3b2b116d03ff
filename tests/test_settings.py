"""Settings: every field of every class takes the ends of its range and refuses, in one line, what lies outside.

The classes are found in the package. config/keys.md has the ranges and defaults of those that a config sets;
tests/study/test_keys.py compares it with the fields.
"""

import dataclasses
import importlib
import inspect
import math
import pkgutil

import numpy as np
import pytest

import burridge_knopoff
from burridge_knopoff import (
    Chain,
    ContinuationSettings,
    InitialState,
    Model,
    MotionSettings,
    SearchSettings,
    Settings,
    law_of,
)
from burridge_knopoff.attractors.settings import SEARCH
from burridge_knopoff.basins.settings import BasinSettings
from burridge_knopoff.catalogue.settings import CatalogueSettings
from burridge_knopoff.model.fields import fields_of
from burridge_knopoff.model.initial import PaperState, StartedState
from burridge_knopoff.model.physical_units import PhysicalUnits
from burridge_knopoff.model.ranges import Interval, Number, OneOf, Several, TrueOrFalse, Whole
from burridge_knopoff.motion.chain_settings import Sample
from burridge_knopoff.motion.settings import MOTION
from burridge_knopoff.running.section import Section, SectionRange
from tests.refused import refused

#: Values of the required fields.
REQUIRED = {
    Model: {"law": law_of("linearized", a=0.08)},
    InitialState: {"name": "own", "position": -0.9, "velocity": 0.1},
    PaperState: {"name": "own", "position": -0.9, "velocity": 0.1},
    PhysicalUnits: {"mass": 0.5, "stiffness": 200.0, "friction": 2.0},
}
STEPS = ("smallest_step", "first_step", "largest_step")


def classes():
    """Return all dataclasses of the package that have fields with ranges, and all that are named settings."""
    members = set()
    for module in pkgutil.walk_packages(burridge_knopoff.__path__, "burridge_knopoff."):
        if module.name.rpartition(".")[2] not in ("_core", "__main__"):
            members |= {kind for _, kind in inspect.getmembers(importlib.import_module(module.name), inspect.isclass)}
    settings_classes = [
        kind for kind in members if dataclasses.is_dataclass(kind) and kind.__module__.startswith("burridge_knopoff")
    ]
    # The numbers of a state of a run have no range.
    return sorted(
        (
            kind
            for kind in {*settings_classes} - {StartedState}
            if kind.__name__.endswith("Settings") or has_ranges(kind)
        ),
        key=lambda kind: kind.__name__,
    )


def has_ranges(kind):
    try:
        return bool(fields_of(kind))
    except NameError:
        # Types that are imported for type checkers only: no settings.
        return False


CLASSES = classes()
FIELDS = [(kind, item.name) for kind in CLASSES for item in dataclasses.fields(kind)]


def instance_of(kind, **values):
    return kind(**{**REQUIRED.get(kind, {}), **values})


def test_all_classes_of_settings_are_found():
    public = {getattr(burridge_knopoff, name) for name in burridge_knopoff.__all__ if name.endswith("Settings")}
    assert public | {BasinSettings, CatalogueSettings, Sample, Chain, Model, InitialState} <= {*CLASSES}


@pytest.mark.parametrize(
    "value", [math.nan, math.inf, -math.inf, 0, -1, "x", None, True, 1j, [math.nan], np.array(3), object()]
)
def test_a_field_takes_no_value_that_it_does_not_keep(value):
    """What is accepted is finite, has the type of the default, and is kept as it was given."""
    wrong = [(kind.__name__, name, words) for kind, name in FIELDS if (words := answer(kind, name, value)) is not None]
    assert wrong == []


def answer(kind, name, value):
    """Return what is wrong with the answer of a field to a value; None if it is right."""
    field = fields_of(kind).get(name)
    default = getattr(instance_of(kind), name)
    try:
        kept = getattr(instance_of(kind, **{name: value}), name)
    except ValueError as error:
        message = str(error)
        return None if "\n" not in message and name in message.partition(":")[0] else message
    if value is None:
        # The value follows from other fields.
        return None if inspect.signature(kind).parameters[name].default is None else "accepted"
    is_right = kept == value and (isinstance(kept, str) or math.isfinite(kept))
    is_right &= isinstance(value, bool) == (field is not None and isinstance(field.range, TrueOrFalse))
    if default is not None and not isinstance(value, float | int | np.ndarray):
        is_right &= isinstance(kept, type(default))
    return None if is_right else f"kept as {kept!r}"


def limits(kind, name):
    """Return values that a field accepts, and values that it refuses."""
    allowed = fields_of(kind)[name].range
    if isinstance(allowed, Interval):
        low, high = allowed.ends.least, allowed.ends.most
        bad = [(low - 1.0, high), (low, high + 1.0), (high, high), (high, low), (low,), (low, 1.0, high), ("0", "w")]
        return [(low, high), (high - 1.0, high)], [*bad, 1.0]
    if isinstance(allowed, Whole):
        # A tile has at least one row of pixels, and the symmetric samples are among all samples.
        most = {"tiles": BasinSettings().pixels, "symmetric_samples": Sample().samples}.get(name, allowed.most)
        return [allowed.least, most], [allowed.least - 1, allowed.most + 1, allowed.least + 0.5, True, "3"]
    if isinstance(allowed, SectionRange):
        return [Section(), Section("block", 2)], [1, None, ["sum"]]
    if isinstance(allowed, OneOf):
        return list(allowed.words), ["x", 1, None, [allowed.words[0]]]
    if isinstance(allowed, TrueOrFalse):
        return [True, False], [0, 1, "true", None]
    if isinstance(allowed, Several):
        inner = allowed.element
        least = np.nextafter(inner.least, np.inf) if inner.above else inner.least
        return [(least, inner.most)], [(), (least, least), least, (inner.most, math.nan), (inner.most + 1.0,), "x"]
    assert isinstance(allowed, Number)
    least, most = allowed.least, allowed.most
    good = [np.nextafter(least, np.inf), most] + ([] if allowed.above else [least])
    bad = [np.nextafter(least, -np.inf), np.nextafter(most, np.inf), np.nan, np.inf, True, "3"]
    return good, bad + ([least] if allowed.above else [])


def companions(kind, name, value):
    """Return values of other fields that are compatible with a value of one field."""
    if kind is ContinuationSettings:
        return {key: value for key in STEPS if key != name} if name in STEPS else {}
    others = {BasinSettings: {"tiles": 1}, Sample: {"symmetric_samples": 1}}.get(kind, {})
    if kind is Settings:
        # A run has a limited number of samples.
        others = {"sampling": 1e3, "trajectory_sampling": 1e3}
        others |= {"transient": 0.0, "window": 1.0, "trajectory": 1.0} if name in others else {}
    return {key: item for key, item in others.items() if key != name}


RANGES = [(kind, name) for kind in CLASSES if kind not in (Chain, InitialState, PaperState) for name in fields_of(kind)]


def test_a_setting_accepts_its_range():
    for kind, name in RANGES:
        for value in limits(kind, name)[0]:
            taken = getattr(instance_of(kind, **companions(kind, name, value), **{name: value}), name)
            assert np.array_equal(taken, value), (kind, name, value)


def test_a_setting_refuses_what_is_outside_its_range():
    for kind, name in RANGES:
        for value in limits(kind, name)[1]:
            with refused(name):
                instance_of(kind, **{name: value})


@pytest.mark.parametrize(
    ("kind", "values", "key"),
    [
        (ContinuationSettings, {"smallest_step": 2e-3}, "smallest_step"),
        (ContinuationSettings, {"smallest_step": 1.0}, "smallest_step"),
        (ContinuationSettings, {"first_step": 1e-10}, "smallest_step"),
        (ContinuationSettings, {"largest_step": 1e-10}, "smallest_step"),
        (BasinSettings, {"pixels": 2, "tiles": 3}, "tiles"),
        (BasinSettings, {"initial": "minus"}, "initial"),
        (Sample, {"samples": 3}, "symmetric_samples"),
        (CatalogueSettings, {"low": 2.0, "high": 2.0}, "high"),
    ],
)
def test_settings_fit_each_other(kind, values, key):
    with refused(key):
        kind(**values)


def test_steps_may_be_equal_and_the_first_one_the_largest():
    assert ContinuationSettings(**dict.fromkeys(STEPS, 1e-5)).largest_step == 1e-5
    assert ContinuationSettings(first_step=1e-3).first_step > ContinuationSettings(largest_step=5e-5).largest_step


def test_functions_have_the_defaults_of_the_classes():
    assert (MotionSettings(), SearchSettings()) == (MOTION, SEARCH)
