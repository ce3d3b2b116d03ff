"""Branches of attractors along a, by the distance of sets."""

from dataclasses import replace

import numpy as np
import pytest

from burridge_knopoff.continuation.branches import branches
from burridge_knopoff.continuation.matching import COMPARED_RETURNS, SAME_SET, DistanceMatcher, Outline, outlines
from tests.motion.stand_in import ASYMMETRIC, MODEL, SYNCHRONIZED, at


def pair(place, ahead, mean=0.1):
    """Return a mirror pair; in the first motion block 1 is ahead by this distance."""
    first = at(place, symmetry=ASYMMETRIC, mean_distance=mean, partner=1, ahead=ahead)
    return [first, replace(first, motion=first.motion.mirrored(), partner=0)]


def follow_branches(attractors, memory):
    """Return the branches, and sides, of attractors at a = 0.1, 0.2, …"""
    numbers = branches(
        [(k + 1) / 10 for k in range(len(attractors))], attractors, range(len(attractors)), memory, DistanceMatcher()
    )
    return tuple([row.tolist() for row in values] for values in numbers)


def test_the_distance_of_sets_is_the_smaller_of_both_directions():
    """An orbit on a torus is close to it, although most of the torus is far from the orbit."""
    torus, orbit = at(*np.linspace(0.0, 1.0, 101)), at(0.5)
    one, other = (Outline(item) for item in (torus, orbit))
    # The distance within which 95 % of the returns lie.
    assert one.distances(other) == pytest.approx(np.array([[0.0, 0.48]] * 2))
    assert other.distances(one) == pytest.approx(np.array([[0.0, 0.48]] * 2))
    assert Outline(at(0.5, 0.8)).distances(other)[0] == pytest.approx([0.0, 0.285])
    # Mirror images: block 1 of one and block 3 of the other are ahead.
    left, right = (Outline(item) for item in pair(0.0, 0.2))
    assert left.distances(right) == pytest.approx(np.array([[0.2, 0.2], [0.0, 0.0]]))


def test_an_orbit_and_the_chaos_around_it_continue_as_separate_branches():
    """The chaotic sets are farther from each other than an orbit is from any of them."""
    chaos_before, chaos_after = np.linspace(0.0, 0.1, 6), np.linspace(0.008, 0.108, 6)
    before = outlines([at(*chaos_before, partner=0), at(0.041, partner=1)])
    after = outlines([at(0.042, partner=0), at(*chaos_after, partner=1)])
    assert DistanceMatcher().match(before, after) == {0: 1, 1: 0}
    # Alone, each may match the other.
    assert DistanceMatcher().match({0: before[0]}, {0: after[0]}) == {0: 0}
    assert DistanceMatcher().match({1: before[1]}, {1: after[1]}) == {1: 1}


def test_returns_are_thinned_out_evenly():
    returns = Outline(at(*np.linspace(0.0, 1.0, 1501))).returns[:, 0]
    assert returns == pytest.approx(np.linspace(0.0, 1.0, COMPARED_RETURNS), abs=1e-3)
    assert len(Outline(at(0.0, 1.0)).returns) == 2


def test_all_pairs_are_matched_together():
    """Of two sets close to one the closer is matched, if the other has another match; none matches beyond the limit."""
    before = outlines([at(0.0, partner=0), at(0.02, partner=1)])
    after = outlines([at(0.015, partner=0), at(0.035, partner=1)])
    assert DistanceMatcher().match(before, after) == {0: 0, 1: 1}
    assert DistanceMatcher().match(before, outlines([at(0.015, partner=0)])) == {0: 1}
    limit = SAME_SET
    for place, expected in ((0.99 * limit, {0: 0}), (1.01 * limit, {})):
        first = {0: Outline(at(0.0))}
        assert DistanceMatcher().match(first, {0: Outline(at(place))}) == expected
    faster = replace(MODEL, v=0.11)
    first, second = (Outline(at(place, model=faster)) for place in (0.0, 1.01 * limit))
    assert DistanceMatcher().match({0: first}, {0: second}) == {0: 0}
    assert DistanceMatcher().match({}, after) == {}


@pytest.mark.parametrize("place", [1.0, 1.2])
def test_sets_of_another_v_match_as_they_are_or_in_proportion_to_v(place):
    """The set is at 1 for v = 0.1, and at 1 or 1.2 for v = 0.12; at 1.1 it is another set."""
    slow, fast = at(1.0), at(place, model=replace(MODEL, v=0.12))
    assert Outline(fast).distances(Outline(slow)) == pytest.approx(np.zeros((2, 2)), abs=1e-12)
    assert DistanceMatcher().match(outlines([slow]), outlines([fast])) == {0: 0}
    assert DistanceMatcher().match(outlines([slow]), outlines([at(1.1, model=fast.model)])) == {}


def test_synchrony_is_matched_only_with_synchrony():
    """This holds however far it has moved."""
    still, far = (at(place, symmetry=SYNCHRONIZED) for place in (0.0, 9.0))
    for before, after, expected in ((still, at(0.0), {}), (at(0.0), still, {}), (still, far, {0: 0})):
        assert DistanceMatcher().match(outlines([before]), outlines([after])) == expected


def test_several_synchronized_attractors_are_several_branches():
    first, second = (
        at(place, symmetry=SYNCHRONIZED, mean_distance=0.0, partner=k) for k, place in enumerate((0.0, 1.0))
    )
    swapped = [replace(second, partner=0), replace(first, partner=1)]
    branch, side = branches(
        [0.1, 0.2, 0.3], [[first, second], swapped, [replace(second, partner=0)]], range(3), 0.1, DistanceMatcher()
    )
    assert [row.tolist() for row in branch] == [[0, 1], [1, 0], [1]]
    assert not np.concatenate(side).any()


def test_branches_are_matched_across_a_pitchfork():
    """The synchronized branch ends, its mirror pair begins, and another branch continues unchanged."""
    before = [at(0.0, symmetry=SYNCHRONIZED, mean_distance=0.0), at(1.0, partner=1, mean_distance=0.14)]
    after = [*pair(0.0, -0.005, mean=0.01), at(1.001, partner=2, mean_distance=0.15)]
    later = [*pair(0.0, 0.006, mean=0.01), at(1.002, partner=2, mean_distance=0.15)]
    branch, side = follow_branches([before, after, later], 0.2)
    assert branch == [[0, 1], [2, 2, 1], [2, 2, 1]]
    # The one that is closer to the first of the previous pair has its side.
    assert side == [[0, 0], [-1, 1, 0], [1, -1, 0]]


def test_the_side_is_that_of_the_end_block_ahead_in_position():
    first = pair(0.0, 0.1)[0]
    faster = np.array([0.0, 0.0, 0.0, 0.3, 0.0, 0.0])
    returns, mirrored = first.motion.returns + faster, first.motion.mirror_returns + faster[[2, 1, 0, 5, 4, 3]]
    first = replace(first, motion=replace(first.motion, returns=returns, mirror_returns=mirrored))
    assert follow_branches([[first, replace(first, motion=first.motion.mirrored(), partner=0)]], 0.2)[1] == [[1, -1]]


def test_an_attractor_that_has_vanished_is_remembered_for_a_while():
    there, else_where = at(0.0), at(1.0)
    attractors = [[there], [else_where], [there], [else_where], [else_where]]
    assert follow_branches(attractors, 0.2)[0] == [[1], [2], [1], [2], [2]]
    assert follow_branches(attractors, 0.1)[0] == [[1], [2], [3], [4], [4]]
    # Branches at the previous value are matched first.
    assert follow_branches([[there], [at(0.015)], [at(0.012)]], 0.2)[0] == [[1], [1], [1]]
    # A value without attractors does not end a branch.
    assert follow_branches([[there], [], [there]], 0.2)[0] == [[1], [], [1]]


def test_an_unchanged_branch_keeps_its_number_across_inserted_values():
    """At the inserted value 0.2 only the changing attractor is followed, and it lies close to the other one."""
    still, again = (at(place, partner=0, section_period=4) for place in (0.0, 0.002))
    new = at(0.004, partner=1, section_period=7)
    alone = replace(new, partner=0)
    for between, expected in (
        ([alone], [[1], [2], [1, 2]]),
        # An attractor to which a trajectory has left is recognised by its kind, symmetry and period.
        ([again], [[1], [1], [1, 2]]),
        ([again, new], [[1], [1, 2], [1, 2]]),
    ):
        numbers, _ = branches([0.1, 0.2, 0.3], [[still], between, [again, new]], [0, 2], 0.3, DistanceMatcher())
        assert [row.tolist() for row in numbers] == expected


def test_branches_are_numbered_by_their_mean_distance():
    """At one a in the order of ⟨J⟩; the motion that replaces synchrony is another branch."""
    first = [at(float(k), partner=k, mean_distance=mean) for k, mean in enumerate((0.3, 0.1, 0.2))]
    assert follow_branches([first], 1.0) == ([[3, 1, 2]], [[0, 0, 0]])
    # If ⟨J⟩ differs by rounding only, attractors keep the order in which they were found.
    for apart, numbers in ((1e-9, [1, 2, 3]), (2e-6, [2, 1, 3])):
        alike = [at(float(k), partner=k, mean_distance=mean) for k, mean in enumerate((0.1 + apart, 0.1, 0.2))]
        assert follow_branches([alike], 1.0)[0] == [numbers]
    still = [at(0.0, symmetry=SYNCHRONIZED, mean_distance=0.0)]
    assert follow_branches([still, first[:1], still], 0.1)[0] == [[0], [1], [0]]
