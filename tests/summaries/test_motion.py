"""Periods of section points and common event orders."""

import numpy as np
import pytest

from burridge_knopoff.summaries.motion import (
    APERIODIC,
    PERIODIC,
    SYNCHRONIZED,
    UNDETERMINED,
    common_order,
    motion_kind,
    section_period,
)


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


def test_kinds():
    assert motion_kind(False, np.nan, 1e-6, 0) == UNDETERMINED
    assert motion_kind(True, 1e-9, 1e-6, 1) == SYNCHRONIZED
    assert motion_kind(True, 0.1, 1e-6, 3) == PERIODIC
    assert motion_kind(True, 0.1, 1e-6, 0) == APERIODIC


def sequence(time, block, kind):
    return np.array(time, float), np.array(block), np.array(kind)


def test_common_order():
    first = sequence([1, 2, 3, 4], [1, 2, 3, 1], [0, 0, 1, 1])
    assert common_order(first, first) == (4, np.inf)
    second = sequence([1.1, 2.1, 2.9, 3.0], [1, 2, 2, 1], [0, 0, 1, 1])
    assert common_order(first, second) == (2, 2.9)
    # One run goes on where the other has no more events.
    assert common_order(first, sequence([1, 2], [1, 2], [0, 0])) == (2, 3.0)
    assert common_order(sequence([], [], []), sequence([], [], [])) == (0, np.inf)
    # The kind counts, not the block alone.
    assert common_order(first, sequence([1, 2], [1, 2], [0, 1])) == (1, 2.0)


def test_simultaneous_events_may_come_in_either_order():
    first = sequence([1, 2, 2 + 1e-13, 4], [2, 1, 3, 2], [0, 0, 0, 1])
    swapped = sequence([1, 2, 2 + 1e-13, 4], [2, 3, 1, 2], [0, 0, 0, 1])
    assert common_order(first, swapped) == (4, np.inf)
    apart = sequence([1, 2, 2.1, 4], [2, 3, 1, 2], [0, 0, 0, 1])
    far = sequence([1, 2, 2.1, 4], [2, 1, 3, 2], [0, 0, 0, 1])
    assert common_order(far, apart) == (1, 2.0)
    rotated = [sequence([1, 1, 1, 2], blocks, [0, 0, 0, 1]) for blocks in ([1, 2, 3, 1], [3, 1, 2, 1])]
    assert common_order(*rotated) == (4, np.inf)
