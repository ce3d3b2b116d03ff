"""When a trajectory counts as settled, and on what, told of made-up returns."""

from dataclasses import replace

import numpy as np
import pytest

from burridge_knopoff import Chain, Model, MotionKind, law_of
from burridge_knopoff.attractors import convergence as settling
from burridge_knopoff.attractors.convergence import Settling
from burridge_knopoff.motion.section_returns import state_of
from burridge_knopoff.motion.tuning import TUNING
from tests.attractors.test_search import CLOSED, MODEL, ONE, OTHER, SETTINGS, WIDE, motion
from tests.motion.stand_in import shown


@pytest.mark.parametrize(
    ("spacing", "symmetric", "drifts", "windows", "transients", "found"),
    [
        (CLOSED, False, [0.0], [1], [1], True),
        # A set that is no closed orbit has to fill: its own mirror image soon, any other in the longest window.
        (WIDE, True, [0.0] * 3, [1, 2, 4], [1, 1, 1], True),
        (WIDE, False, [0.0] * 5, [1, 2, 4, 8, 16], [1] * 5, True),
        (WIDE, True, [1.0, 1.0, 0.0], [1, 2, 4], [1, 2, 4], True),
        # What has not settled has twice the time, and is let go if it drifts by more than ten resolutions.
        (CLOSED, False, [2e-5, 0.0], [1, 1], [1, 2], True),
        (CLOSED, False, [1.1e-2] * 5, [1] * 5, [1, 2, 4, 8, 16], False),
        (CLOSED, False, [1.0, None], [1, 1], [1, 2], False),
    ],
)
def test_a_motion_is_given_time_to_settle(tell, spacing, symmetric, drifts, windows, transients, found):
    mirror = ONE if symmetric else -ONE
    answers = [None if drift is None else shown(ONE, mirror, spacing, drift) for drift in drifts]
    asked = tell(settling, "visit", answers)
    assert (Settling(MODEL, SETTINGS).settle(state_of(ONE[0])) is not None) == found
    assert [arguments[2:4] for arguments in asked] == [(x, 100 * y) for x, y in zip(transients, windows, strict=True)]


def creeping(time, tau, size, window=100.0):
    """Return what is seen of a closed orbit that is approached as size · exp(−τ / tau), from `time` on."""
    drift = size * (np.exp(-time / tau) - np.exp(-(time + 0.5 * window) / tau))
    return shown(ONE, ONE, CLOSED, drift, window=window)


@pytest.mark.parametrize("tau", [1e3, 1e5, 1e9])
def test_how_far_a_motion_still_is_follows_from_how_its_drift_dies_out(tau):
    first, later = creeping(0.0, tau, 0.3), creeping(5100.0, tau, 0.3)
    # After the half of the window between which and the one before it the drift was seen.
    assert settling._left(first, later, 5000.0) == pytest.approx(0.3 * np.exp(-5150.0 / tau), rel=1e-4)
    assert settling._left(first, first, 5000.0) == np.inf


@pytest.mark.parametrize(("tau", "visits", "rests"), [(5.0, 1, True), (100.0, 3, True), (1e6, 5, False)])
def test_a_motion_that_drifts_is_followed_until_it_is_there(tell, tau, visits, rests):
    """For times that double, up to sixteen time limits; what drifts on then is undetermined."""
    own, time, seen = Settling(MODEL, SETTINGS), 0.0, []
    waits = [SETTINGS.time_limit * 2.0**k for k in range(5)]
    for wait in waits:
        time += wait + 100.0
        seen.append(creeping(time, tau * SETTINGS.time_limit / 100.0, 0.005))
    asked = tell(settling, "visit", seen[:visits])
    found = own.at_rest(creeping(0.0, tau * SETTINGS.time_limit / 100.0, 0.005))
    assert found is (seen[visits - 1] if rests else None)
    assert [arguments[2] for arguments in asked] == waits[:visits]


def test_a_set_that_is_no_closed_orbit_has_to_stay_where_it_is(tell):
    """Or it drifts: slowly along a torus, or to another motion."""
    own, moving = Settling(MODEL, SETTINGS), shown(ONE, ONE, WIDE, 1.0)
    tell(settling, "visit", [moving])
    assert own.at_rest(moving) is moving
    elsewhere = [shown(ONE + k, ONE + k, WIDE, 1.0) for k in range(1, 6)]
    tell(settling, "visit", elsewhere)
    assert own.at_rest(moving) is None


def test_a_set_is_its_own_mirror_image_if_it_covers_it(tell):
    """In its window or, where it touches its mirror image, in a longer time."""
    own, rows = Settling(MODEL, replace(SETTINGS, transient=3)), np.linspace(0.0, 1.0, 40)[:, None] * np.ones(6)
    touching = rows - 0.9995
    for mirror, symmetric in ((rows + 0.01, True), (touching, False), (rows + 3.0, False)):
        assert own.is_symmetric(shown(rows, mirror, WIDE, 0.0)) == symmetric
    both = np.concatenate([rows, touching])
    for later, changes in ((both, True), (rows, False)):
        asked = tell(settling, "visit", [shown(later, later, WIDE, 0.0)])
        assert own.changes_sides(shown(rows, touching, WIDE, 0.0)) == changes
        assert asked[0][2:4] == (0.0, TUNING.lasting * 3)
    for apart in (shown(rows, rows - 1.002, WIDE, 0.0), shown(rows, touching, CLOSED, 0.0)):
        assert not own.changes_sides(apart)
    # Where only one block of a mirror pair stops again and again, the two show different sets.
    assert not own.is_symmetric(replace(shown(rows, rows, WIDE, 0.0), mirror_block=3))


@pytest.mark.parametrize(
    ("kind", "later", "in_chaos"),
    [
        (MotionKind.CHAOTIC, WIDE, True),
        (MotionKind.CHAOTIC, CLOSED, False),  # chaos that ends on the orbit belongs to it
        (MotionKind.CHAOTIC, None, False),
        (MotionKind.QUASIPERIODIC, WIDE, False),
        (None, WIDE, False),
    ],
)
def test_what_surrounds_an_orbit_is_seen_from_a_push(tell, kind, later, in_chaos):
    measured = tell(settling, "measure", [None if kind is None else motion(kind=kind)])
    visited = tell(settling, "visit", [None if later is None else shown(ONE, OTHER, later, 0.0)])
    assert Settling(MODEL, SETTINGS).lies_in_chaos(shown(ONE, OTHER, CLOSED, 0.0)) == in_chaos
    ((_, start, *times, _),) = (arguments[:5] for arguments in measured)
    assert 0.0 < np.abs(start.position - ONE[0, :3]).max() <= TUNING.slow_push * 1e-3
    assert times == [TUNING.slow_time, 100 * TUNING.filling]
    assert [arguments[2:4] for arguments in visited] == [(SETTINGS.time_limit, 100)] * (kind == MotionKind.CHAOTIC)


def test_a_motion_that_has_left_for_another_one_is_not_listed(tell):
    """The other one is measured in its place, from where it has come to; nothing, if that leaves again and again."""
    left, there = state_of(OTHER[0]), shown(OTHER, OTHER, CLOSED, 0.0)
    first, other = motion(kind=MotionKind.UNDETERMINED, left_for=left), motion()
    visited = tell(settling, "visit", [there])
    tell(settling, "measure", [first, other])
    found, measured = Settling(MODEL, SETTINGS).measured(shown(ONE, ONE, WIDE, 0.0))
    assert found is there
    assert measured.returns is other.returns
    assert [(arguments[1], *arguments[2:4]) for arguments in visited] == [(left, 0.0, 100)]
    tell(settling, "visit", [there] * (TUNING.trials + 1))
    tell(settling, "measure", [first] * (TUNING.trials + 1))
    assert Settling(MODEL, SETTINGS).measured(shown(ONE, ONE, WIDE, 0.0)) is None


def test_a_motion_that_changes_again_and_again_is_listed_as_it_was_last(tell):
    first, second = (shown(ONE, ONE, WIDE, 0.0, stops) for stops in ((9, 9, 9), (9, 18, 9)))
    visited = tell(settling, "visit", [first, second, first])
    tell(settling, "measure", [motion(1.0, kind=MotionKind.QUASIPERIODIC, mean_distance_error=0.1)] * 3)
    found, _ = Settling(MODEL, SETTINGS).measured(second)
    assert found is second
    assert len(visited) == TUNING.trials + 1


@pytest.mark.parametrize(("spacing", "measured"), [(CLOSED, 800.0), (WIDE, 100 * TUNING.filling)])
def test_a_closed_orbit_is_measured_in_the_window_in_which_it_was_seen_to_close(tell, spacing, measured):
    """In a shorter one a long orbit does not repeat: its returns would lie apart."""
    asked = tell(settling, "measure", [None])
    Settling(MODEL, SETTINGS).measured(shown(ONE, ONE, spacing, 0.0, window=800.0))
    assert asked[0][3] == measured


def test_distances_grow_with_the_speed_of_the_driver():
    """In slower motion also those within which a closed orbit repeats are smaller."""
    for v, resolution, tolerance in ((0.2, 2e-3, 1e-6), (0.1, 1e-3, 1e-6), (0.05, 5e-4, 5e-7)):
        own = Settling(Model(Chain(3), law_of("linearized", 0.08), v), SETTINGS)
        assert (own.resolution, own.tolerance) == pytest.approx((resolution, tolerance))


def test_a_set_of_a_chain_without_a_mirror_image_has_to_fill_as_well(tell):
    """But not for as long as one that may be half of a set: it has no other half."""
    uneven = Model(Chain(3, threshold=(1.0, 1.0, 0.9)), law_of("linearized", 0.08))
    asked = tell(settling, "visit", [shown(ONE, ONE[:0], WIDE, 0.0)] * 3)
    assert Settling(uneven, SETTINGS).settle(state_of(ONE[0])) is not None
    assert [arguments[3] for arguments in asked] == [100, 200, 400]


def test_a_motion_is_followed_on_from_where_it_was_seen_last(tell):
    asked = tell(settling, "visit", [shown(OTHER, ONE, CLOSED, 1.0), shown(ONE, ONE, CLOSED, 0.0)])
    Settling(MODEL, SETTINGS).settle(state_of(ONE[0]))
    assert [arguments[1].position[0] for arguments in asked] == [1.0, 2.0]


def test_a_motion_touches_its_mirror_image_within_the_resolution(tell):
    own = Settling(MODEL, SETTINGS)
    for away, touches in ((0.9e-3, True), (1.1e-3, False)):
        assert own.touches(shown(ONE, ONE + away, WIDE, 0.0)) == touches
    assert not own.touches(shown(ONE, ONE[:0], WIDE, 0.0))
    # What leaves for another block, or ends, in the longer time does not cover its mirror image.
    found = shown(ONE, ONE + 0.9e-3, WIDE, 0.0)
    tell(settling, "visit", [found, replace(found, block=2), None])
    assert [own.changes_sides(found) for _ in range(3)] == [True, False, False]


def test_pushes_depend_on_the_seed(tell):
    """So that a search is the same whenever it is made."""
    pushes = []
    for seed in (3, 3, 4):
        asked = tell(settling, "measure", [None])
        Settling(MODEL, replace(SETTINGS, seed=seed)).lies_in_chaos(shown(ONE, OTHER, CLOSED, 0.0))
        pushes.append(asked[0][1].position.tolist())
    assert pushes[0] == pushes[1] != pushes[2]
