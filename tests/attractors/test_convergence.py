"""When a trajectory counts as settled, and on which motion, tested with constructed returns."""

from dataclasses import replace

import numpy as np
import pytest

from burridge_knopoff import Model, SearchSettings
from burridge_knopoff.attractors import convergence as settling
from burridge_knopoff.attractors.convergence import SYMMETRY_WINDOW, Convergence
from burridge_knopoff.motion.section_returns import state_of
from tests.motion.stand_in import section

MODEL = Model("linearized", a=0.08)
#: Times are then numbers of transients or windows.
SETTINGS = SearchSettings(transient=1.0, window=100.0)
CLOSED, WIDE = 1e-7, 0.01
ONE, OTHER = np.array([[1.0, 0.0, 0.0, 0.0, 0.1, 0.1]]), np.array([[2.0, 0.0, 0.0, 0.0, 0.1, 0.1]])


@pytest.mark.parametrize(
    ("spacing", "symmetric", "drifts", "windows", "transients", "found"),
    [
        (CLOSED, False, [0.0], [1], [1], True),
        # Returns must fill a set that is not periodic: early if it is its own mirror image, else in the longest window.
        (WIDE, True, [0.0] * 3, [1, 2, 4], [1, 1, 1], True),
        (WIDE, False, [0.0] * 5, [1, 2, 4, 8, 16], [1] * 5, True),
        (WIDE, True, [1.0, 1.0, 0.0], [1, 2, 4], [1, 2, 4], True),
        # A motion that has not settled gets twice the time; it is abandoned if it drifts by more than ten resolutions.
        (CLOSED, False, [2e-5, 0.0], [1, 1], [1, 2], True),
        (CLOSED, False, [1.1e-2] * 5, [1] * 5, [1, 2, 4, 8, 16], False),
        (CLOSED, False, [1.0, None], [1, 1], [1, 2], False),
    ],
)
def test_a_motion_is_given_time_to_settle(script_answers, spacing, symmetric, drifts, windows, transients, found):
    mirror = ONE if symmetric else -ONE
    answers = [None if drift is None else section(ONE, mirror, spacing, drift) for drift in drifts]
    calls = script_answers(settling, "visit", answers)
    assert (Convergence(MODEL, SETTINGS).settle(state_of(ONE[0])) is not None) == found
    assert [arguments[2:4] for arguments in calls] == [(x, 100 * y) for x, y in zip(transients, windows, strict=True)]


def creeping(time, tau, size, window=100.0):
    """Return the returns of a periodic orbit that is approached as size · exp(−τ / tau), from `time` on."""
    drift = size * (np.exp(-time / tau) - np.exp(-(time + 0.5 * window) / tau))
    return section(ONE, ONE, CLOSED, drift, window=window)


@pytest.mark.parametrize("tau", [1e3, 1e5, 1e9])
def test_the_remaining_distance_follows_from_the_decay_of_the_drift(tau):
    first, later = creeping(0.0, tau, 0.3), creeping(5100.0, tau, 0.3)
    # Measured from the middle of the window, since the drift compares its halves.
    assert settling._remaining_distance(first, later, 5000.0) == pytest.approx(0.3 * np.exp(-5150.0 / tau), rel=1e-4)
    assert settling._remaining_distance(first, first, 5000.0) == np.inf


@pytest.mark.parametrize(("tau", "visits", "rests"), [(5.0, 1, True), (100.0, 3, True), (1e6, 5, False)])
def test_a_motion_that_drifts_is_followed_until_it_is_steady(script_answers, tau, visits, rests):
    """Waits double up to sixteen time limits; a motion that still drifts then is undetermined."""
    search, time, visited = Convergence(MODEL, SETTINGS), 0.0, []
    waits = [SETTINGS.time_limit * 2.0**k for k in range(5)]
    for wait in waits:
        time += wait + 100.0
        visited.append(creeping(time, tau * SETTINGS.time_limit / 100.0, 0.005))
    calls = script_answers(settling, "visit", visited[:visits])
    motion = search.follow_until_steady(creeping(0.0, tau * SETTINGS.time_limit / 100.0, 0.005))
    assert motion is (visited[visits - 1] if rests else None)
    assert [arguments[2] for arguments in calls] == waits[:visits]


def test_a_set_that_is_not_periodic_must_not_drift(script_answers):
    """Otherwise it drifts along a torus, or to another motion."""
    search, moving = Convergence(MODEL, SETTINGS), section(ONE, ONE, WIDE, 1.0)
    script_answers(settling, "visit", [moving])
    assert search.follow_until_steady(moving) is moving
    elsewhere = [section(ONE + k, ONE + k, WIDE, 1.0) for k in range(1, 6)]
    script_answers(settling, "visit", elsewhere)
    assert search.follow_until_steady(moving) is None


def test_a_set_is_its_own_mirror_image_if_it_covers_it(script_answers):
    """In its window or, if it is close to its mirror image, in a longer time."""
    search, rows = Convergence(MODEL, replace(SETTINGS, transient=3)), np.linspace(0.0, 1.0, 40)[:, None] * np.ones(6)
    touching = rows - 0.9995
    for mirror, symmetric in ((rows + 0.01, True), (touching, False), (rows + 3.0, False)):
        assert search.is_symmetric(section(rows, mirror, WIDE, 0.0)) == symmetric
    both = np.concatenate([rows, touching])
    for later, changes in ((both, True), (rows, False)):
        calls = script_answers(settling, "visit", [section(later, later, WIDE, 0.0)])
        assert search.is_eventually_symmetric(section(rows, touching, WIDE, 0.0)) == changes
        assert calls[0][2:4] == (0.0, SYMMETRY_WINDOW * 3)
    for apart in (section(rows, rows - 1.002, WIDE, 0.0), section(rows, touching, CLOSED, 0.0)):
        assert not search.is_eventually_symmetric(apart)
    # If only one block of a mirror pair stops regularly, the returns are at different blocks.
    assert not search.is_symmetric(replace(section(rows, rows, WIDE, 0.0), mirror_block=3))


def test_distances_grow_with_the_speed_of_the_driver():
    """The tolerance within which a periodic orbit repeats scales with v as well."""
    for v, resolution, tolerance in ((0.2, 2e-3, 1e-6), (0.1, 1e-3, 1e-6), (0.05, 5e-4, 5e-7)):
        search = Convergence(Model("linearized", a=0.08, v=v), SETTINGS)
        assert (search.resolution, search.tolerance) == pytest.approx((resolution, tolerance))


def test_a_set_of_an_asymmetric_chain_must_be_filled_by_its_returns(script_answers):
    """This takes less time than for a set that may be one of two mirror images."""
    uneven = Model("linearized", a=0.08, threshold=(1.0, 1.0, 0.9))
    calls = script_answers(settling, "visit", [section(ONE, ONE[:0], WIDE, 0.0)] * 3)
    assert Convergence(uneven, SETTINGS).settle(state_of(ONE[0])) is not None
    assert [arguments[3] for arguments in calls] == [100, 200, 400]


def test_a_motion_touches_its_mirror_image_within_the_resolution(script_answers):
    search = Convergence(MODEL, SETTINGS)
    for away, touches in ((0.9e-3, True), (1.1e-3, False)):
        assert search.is_close_to_mirror_image(section(ONE, ONE + away, WIDE, 0.0)) == touches
    assert not search.is_close_to_mirror_image(section(ONE, ONE[:0], WIDE, 0.0))
    # A motion with returns at another block, or without any, in the longer time does not cover its mirror image.
    motion = section(ONE, ONE + 0.9e-3, WIDE, 0.0)
    script_answers(settling, "visit", [motion, replace(motion, block=2), None])
    assert [search.is_eventually_symmetric(motion) for _ in range(3)] == [True, False, False]
