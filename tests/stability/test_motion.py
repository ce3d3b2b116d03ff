"""Periods of section points and kinds of motion."""

import numpy as np
import pytest

from burridge_knopoff.stability.motion import (
    MotionKind,
    motion_kind,
    section_closed,
    section_period,
)
from burridge_knopoff.stability.settings import MOTION


@pytest.mark.parametrize("period", [1, 2, 3, 7, 40])
def test_period_of_a_repeating_sequence(period):
    random = np.random.default_rng(period)
    section = np.tile(random.normal(size=period), 400 // period)
    assert section_period(section, 1e-6, 60) == period
    assert section_period(section + 1e-9 * random.normal(size=len(section)), 1e-6, 60) == period
    assert section_period(section + 1e-3 * random.normal(size=len(section)), 1e-6, 60) == 0


def test_a_slow_approach_does_not_hide_a_period():
    k = np.arange(1000)
    assert section_period(1.0 + 0.5**k, 1e-6, 60) == 1


def test_quasiperiodic_and_short_sequences_have_no_period():
    golden = (np.sqrt(5) - 1) / 2
    assert section_period(np.cos(2 * np.pi * golden * np.arange(2000)), 1e-6, 60) == 0
    assert section_period(np.array([]), 1e-6, 60) == 0
    assert section_period(np.array([1.0, 1.0]), 1e-6, 60) == 0
    assert section_period(np.tile(np.arange(70.0), 20), 1e-6, 60) == 0
    # A slow drift is no period.
    assert section_period(1.0 + 1e-7 * np.arange(400), 1e-6, 60) == 0


def test_the_numbers_of_the_kinds():
    names = {-1: "undetermined", 0: "synchronized", 1: "periodic", 2: "quasiperiodic", 3: "chaotic"}
    assert {int(kind): kind.name.lower() for kind in MotionKind} == names


@pytest.mark.parametrize(
    ("mean_distance", "period", "exponents", "error", "kind"),
    [
        (1e-9, 1, (0.0, -0.01), 1e-5, MotionKind.SYNCHRONIZED),
        (0.1, 3, (1e-4, -1e-4), 1e-5, MotionKind.PERIODIC),
        (0.1, 0, (1e-4, -0.01), 1e-5, MotionKind.PERIODIC),
        (0.1, 0, (1e-4, -1e-4), 1e-5, MotionKind.QUASIPERIODIC),
        # With errors larger than the exponents of chaos only a repetition tells something.
        (0.1, 0, (1e-4, -0.01), 1e-2, MotionKind.UNDETERMINED),
        (0.1, 3, (1e-4, -0.01), 1e-2, MotionKind.PERIODIC),
        (0.1, 0, (2.3e-2, -3e-3), 1e-2, MotionKind.UNDETERMINED),
        (0.1, 0, (0.02, 0.0), 1e-3, MotionKind.CHAOTIC),
        (1e-9, 0, (0.02, 0.0), 1e-3, MotionKind.CHAOTIC),
        # Above the threshold but not above its error, or the other way round: no chaos.
        (0.1, 0, (2e-3, -0.01), 1e-3, MotionKind.PERIODIC),
        (0.1, 0, (9e-4, -0.01), 1e-5, MotionKind.UNDETERMINED),
        # Weak chaos or a torus: the error leaves both.
        (0.1, 0, (2e-3, 0.0), 1e-3, MotionKind.UNDETERMINED),
        (0.1, 0, (9e-4, 0.0), 1e-3, MotionKind.QUASIPERIODIC),
        (0.1, 0, (-0.01, -0.02), 1e-5, MotionKind.UNDETERMINED),
        # Without exponents only a repetition of the section points says something.
        (0.1, 5, (), 1e-5, MotionKind.PERIODIC),
        (0.1, 0, (), 1e-5, MotionKind.UNDETERMINED),
        (0.1, 0, (np.nan, np.nan), np.nan, MotionKind.UNDETERMINED),
        (1e-9, 1, (np.nan, np.nan), np.nan, MotionKind.SYNCHRONIZED),
        (0.1, 0, (0.0,), 1e-5, MotionKind.UNDETERMINED),
    ],
)
def test_kinds(mean_distance, period, exponents, error, kind):
    errors = np.full(len(exponents), error)
    assert motion_kind(mean_distance, period, np.array(exponents), errors, MOTION) == kind


def test_sections_that_repeat_after_however_many_points():
    random = np.random.default_rng(3)
    orbit = random.random(150)
    assert section_closed(np.tile(orbit, 8), 1e-6)
    assert section_period(np.tile(orbit, 8), 1e-6, 60) == 0
    golden = (np.sqrt(5) - 1) / 2
    assert not section_closed(np.cos(2 * np.pi * golden * np.arange(2000)), 1e-6)
    assert not section_closed(random.random(2000), 1e-6)
    assert not section_closed(np.ones(5), 1e-6)
    # Of the second half all but a twentieth have a neighbour, among twelve points at least.
    assert [section_closed(np.ones(count), 1e-6) for count in (22, 24)] == [False, True]
    pairs = np.repeat(np.arange(50.0), 2)
    for alone, closed in ((4, True), (6, False)):
        section = pairs + np.where(np.arange(100) < alone, 0.25 * (np.arange(100) % 2), 0.0)
        assert section_closed(np.concatenate([pairs, section]), 1e-6) == closed
