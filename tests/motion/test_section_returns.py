"""The section returns of a motion and what they show, from hand-made events and sets."""

import numpy as np
import pytest

from burridge_knopoff import Chain, Model
from burridge_knopoff.motion import period
from burridge_knopoff.motion.period import orbit_length
from burridge_knopoff.motion.section_returns import has_same_stop_shares, returns_of, state_of
from tests.motion.stand_in import ROWS, section


@pytest.mark.parametrize(
    ("stopping", "block", "mirror_block"),
    [((1, 2, 3, 4), 1, 1), ((2, 3), 2, 2), ((1, 3), 1, 4), ((2,), 2, 3), ((3, 4), 4, 1), ((), None, None)],
)
def test_returns_are_taken_at_the_outermost_block_that_stops(stopping, block, mirror_block):
    """Of two blocks equally close to an end the first is taken; mirror images have their returns at mirror blocks."""
    number = np.tile(np.arange(1, 5), 20)
    states = np.random.default_rng(3).uniform(size=(80, 8))
    chain, stops = Model("linearized", a=0.1, blocks=4), np.isin(number, stopping)
    number, states = number[stops], states[stops]
    motion = returns_of(chain, 40.0, np.arange(len(number)), number, states.__getitem__)
    mirrored = returns_of(
        chain, 40.0, np.arange(len(number)), 5 - number, states[:, [3, 2, 1, 0, 7, 6, 5, 4]].__getitem__
    )
    if block is None:
        assert motion is None
        return
    assert (motion.block, motion.mirror_block) == (mirrored.mirror_block, mirrored.block) == (block, mirror_block)
    assert motion.window == 40.0
    assert (motion.returns == states[number == block]).all()
    assert (motion.returns == mirrored.mirror_returns).all()
    assert (motion.mirror_returns == mirrored.returns).all()


@pytest.mark.parametrize(
    ("first", "last", "symmetric", "seen"),
    [(8, 8, True, True), (7, 8, True, False), (8, 7, True, False), (8, 7, False, True), (7, 8, False, False)],
)
def test_eight_returns_show_a_set_and_its_mirror_image(first, last, symmetric, seen):
    """A mirror-symmetric chain shows both; in any other chain the stops of the first block count alone."""
    chain = Chain(3, threshold=1.0 if symmetric else (1.0, 1.0, 0.9))
    block = np.array([1] * first + [3] * last)
    states = np.random.default_rng(3).uniform(size=(len(block), 6))
    motion = returns_of(Model("linearized", a=0.1, chain=chain), 40.0, np.arange(len(block)), block, states.__getitem__)
    assert (motion is not None) == seen


@pytest.mark.parametrize(
    ("first", "second", "alike"),
    [
        ((10, 20, 30), (300, 200, 100), True),  # with returns at the other end, for ten times as long
        ((10, 20, 10), (10, 20, 10.6), True),
        ((10, 20, 10), (10, 22, 10), False),
        ((1, 0, 0, 1), (0, 1, 1, 0), False),
    ],
)
def test_motions_are_compared_by_the_stop_rates_of_mirror_blocks(first, second, alike):
    assert (
        has_same_stop_shares(np.array(first), np.array(second))
        == has_same_stop_shares(np.array(second), np.array(first))
        == alike
    )


@pytest.mark.parametrize(
    ("stops", "expected"),
    [
        ((7, 843, 332, 362, 795, 5), (2, 2)),
        ((28, 3372, 1328, 1448, 3180, 20), (2, 2)),
        ((100, 900, 900, 100), (1, 1)),
        ((300, 900, 900, 5), (1, 4)),
        ((5, 900, 900, 300), (4, 1)),
        ((0, 40, 0), (2, 2)),
        ((0, 0, 0), (1, 1)),
    ],
)
def test_a_block_that_rarely_stops_gives_no_returns(stops, expected):
    """This also holds in a window four times as long; the mirror image has its returns at the mirror block."""
    assert period.section_blocks(np.array(stops)) == expected
    assert period.section_blocks(np.array(stops[::-1])) == expected[::-1]


def test_a_block_without_velocity_sticks():
    state = state_of(np.array([1.0, 2.0, 3.0, 1e-14, -1e-14, 2e-14]))
    assert state.position.tolist() == [1.0, 2.0, 3.0]
    assert state.velocity.tolist() == [0.0, 0.0, 2e-14]
    assert state.stuck.tolist() == [True, True, False]


@pytest.mark.parametrize(
    ("spacing", "drift", "closed", "settled"),
    [
        (1e-6, 1e-5, True, True),  # a hundredth of the resolution
        (1e-6, 1.1e-5, True, False),
        (1.1e-6, 1e-3, False, True),  # the resolution
        (1.1e-6, 1.1e-3, False, False),
        (0.01, 0.03, False, True),  # three spacings
        (0.01, 0.031, False, False),
    ],
)
def test_which_motion_has_settled(spacing, drift, closed, settled):
    motion = section(ROWS, ROWS, spacing, drift)
    assert motion.has_periodic_spacing(1e-6) == closed
    assert motion.is_settled(1e-6, 1e-3) == settled


@pytest.mark.parametrize(
    ("rows", "spacing", "expected"),
    [
        (np.tile(ROWS[:5], (8, 1)), 1e-6, True),
        (np.tile(ROWS[:5], (8, 1)), 1.1e-6, False),
        (ROWS, 1e-6, False),
        # Bands of chaos that are visited in order and are wider than the tolerance.
        (np.tile(ROWS[:5], (8, 1)) + 5e-6 * ROWS, 1e-6, False),
        (np.tile(ROWS[:20], (2, 1)), 1e-6, False),  # not repeated in two thirds of the window
    ],
)
def test_a_periodic_orbit_repeats_its_returns(rows, spacing, expected):
    assert section(rows, rows, spacing, 0.0).is_periodic(1e-6) == expected


@pytest.mark.parametrize(
    ("length", "longest", "expected"), [(1, 60, 1), (3, 60, 3), (7, 7, 7), (9, 8, 8), (13, 60, 60)]
)
def test_the_length_of_an_orbit(length, longest, expected):
    """The first third of forty returns is left out; the remaining 27 show periods of at most 13 twice."""
    orbit = np.tile(ROWS[:length], (40, 1))[:40]
    orbit[:13] += 0.5
    assert orbit_length(orbit + 1e-7 * ROWS, 1e-6, longest) == expected
    assert orbit_length(orbit + 1e-5 * ROWS, 1e-6, longest) == longest
