"""Continuation and matching on maps whose bifurcations are known in closed form."""

from dataclasses import dataclass, replace

import numpy as np
import pytest

from burridge_knopoff import MotionKind, SearchSettings
from burridge_knopoff.attractors.search import Search
from burridge_knopoff.continuation.attractor_continuation import continue_attractors
from burridge_knopoff.continuation.matching import Matcher
from burridge_knopoff.continuation.settings import RefinementSettings
from tests.maps import LOGISTIC, TWO_WELLS

WELLS = SearchSettings(
    samples=30, position=(-1.3, 1.3), fraction_width=0.1, transient=200.0, window=200.0, time_limit=2000.0
)
LINE = SearchSettings(
    samples=20, position=(0.05, 0.95), fraction_width=0.2, transient=1000.0, window=400.0, time_limit=2000.0
)
#: All states are so close to 0 that they reach the lower well for μ < 0 and the upper one for μ > 0.
NARROW = replace(WELLS, samples=3, position=(-1e-4, 1e-4))
#: Largest |μ| at which both wells exist.
FOLD = 2.0 / np.sqrt(27.0)


def where(continuation, branch):
    """Return the values of a at which a branch is known, and its attractors there."""
    pairs = [
        (model.parameter("a"), attractors[numbers.tolist().index(branch)])
        for model, attractors, numbers in zip(
            continuation.models, continuation.attractors, continuation.branch, strict=True
        )
        if branch in numbers
    ]
    return np.array([a for a, _ in pairs]), [item for _, item in pairs]


def test_each_well_is_one_branch_that_ends_at_its_fold(maps):
    """The lower well exists only for μ < 2/√27, the upper one only for μ > −2/√27."""
    fold, refine = FOLD, RefinementSettings(2e-3)
    grid = np.linspace(-0.45, 0.45, 19).tolist()
    continuation = continue_attractors([TWO_WELLS.at(1.0 + mu) for mu in grid], WELLS, refine=refine)
    assert {*np.concatenate(continuation.branch).tolist()} == {1, 2}
    ranges = {}
    for branch in (1, 2):
        a, items = where(continuation, branch)
        a = a - 1.0
        side = np.sign([item.motion.state().position[0] for item in items])
        assert np.ptp(side) == 0
        ranges[int(side[0])] = (a.min(), a.max())
    # Near a fold motion converges too slowly, so the branch may end slightly before it.
    assert fold - 2.0 * refine.resolution < ranges[-1][1] <= fold
    assert ranges[-1][0] == pytest.approx(-0.45)
    assert -fold <= ranges[1][0] < -fold + 2.0 * refine.resolution
    assert ranges[1][1] == pytest.approx(0.45)


@pytest.mark.parametrize("grid", [(-0.45, -0.3, -0.1, 0.1, 0.3, 0.45), (-0.3, -0.1, 0.1), (0.3, -0.3)], ids=str)
def test_attractors_at_one_value_seed_the_others(maps, grid):
    """They do so downward and upward, as far as they exist."""
    grid = sorted(grid)
    models = [TWO_WELLS.at(1.0 + mu) for mu in grid]
    for model in models:
        search = Search(model, NARROW)
        search.labels(search.starts((), "moving"))
        assert len(search.attractors) == 1
    continuation = continue_attractors(models, NARROW, refine=RefinementSettings(1.0))
    wells = [sorted(item.motion.state().position[0] for item in attractors) for attractors in continuation.attractors]
    for mu, found in zip(grid, wells, strict=True):
        expected = np.sort([root.real for root in np.roots([-1.0, 0.0, 1.0, mu]) if abs(root.imag) < 1e-9])[::2]
        assert found == pytest.approx(expected, abs=1e-6)


@pytest.mark.parametrize(
    ("grid", "remembers"),
    [
        ((0.0, 0.1, 0.2), True),
        ((0.0, 0.05, 0.1, 0.15, 0.2), False),
        ((0.0, 0.05, 0.1, 0.15, 0.2, 0.35), True),
    ],
    ids=str,
)
def test_a_branch_is_remembered_over_two_of_the_widest_steps(maps, grid, remembers):
    """So no branch ends only because the grid is coarser. The lower well is missing for 0.02 < a < 0.18 only."""

    def mu(a):
        return 0.5 * (0.02 < a < 0.18)

    model = replace(
        TWO_WELLS, map=lambda x, a: x + 0.5 * (mu(a) + x - x**3), slope=lambda x, a: 1.5 - 1.5 * np.square(x)
    )
    continuation = continue_attractors([model.at(a=a) for a in grid], WELLS, refine=RefinementSettings(1.0))
    numbers = [
        {round(item.motion.state().position[0]): number for item, number in zip(attractors, branch, strict=True)}
        for attractors, branch in zip(continuation.attractors, continuation.branch, strict=True)
    ]
    at = grid.index(0.2)
    assert [-1 in row for row in numbers] == [mu(a) == 0.0 for a in grid]
    assert (numbers[at][-1] == numbers[0][-1]) == remembers


def test_fractions_are_those_of_the_basins(maps):
    """States are uniform, so the fraction of a well is the length of its side of the unstable fixed point."""
    grid = [-0.2, 0.0, 0.3]
    continuation = continue_attractors([TWO_WELLS.at(1.0 + mu) for mu in grid], WELLS, refine=RefinementSettings(1.0))
    for mu, attractors, sample in zip(grid, continuation.attractors, continuation.samples, strict=True):
        middle = np.sort(np.roots([-1.0, 0.0, 1.0, mu]).real)[1]
        for index, item in enumerate(attractors):
            share = (1.3 - middle) / 2.6 if item.motion.state().position[0] > 0.0 else (middle + 1.3) / 2.6
            # Half the width of the 95 % interval is 0.1 at most: a deviation of twice that has a chance below 1e-4.
            assert np.mean(sample == index) == pytest.approx(share, abs=0.2)


def test_sweeps_show_the_hysteresis_of_two_folds(maps):
    """Swept upward, motion leaves the lower well beyond its fold; swept downward, it leaves the upper one."""
    grid = [-0.45, -0.3, 0.0, 0.3, 0.45]
    continuation = continue_attractors([TWO_WELLS.at(1.0 + mu) for mu in grid], WELLS, refine=RefinementSettings(1.0))

    def swept(steps, following):
        index, x = 0, []
        for k in steps:
            x.append(np.sign(continuation.attractors[k][index].motion.state().position[0]))
            index = following[k][index]
        return x

    assert swept(range(5), continuation.upward) == [-1, -1, -1, -1, 1]
    assert swept(range(4, -1, -1), continuation.downward) == [1, 1, 1, 1, -1]


@pytest.mark.parametrize(
    ("grid", "at", "periods"), [((2.8, 2.9, 3.1, 3.2), 3.0, (1, 2)), ((3.35, 3.4, 3.5), 1.0 + np.sqrt(6.0), (2, 4))]
)
def test_a_period_doubling_is_located_to_the_resolution(maps, grid, at, periods):
    """The logistic map doubles the period at 3 and at 1 + √6; the doubled orbit continues under the same number."""
    refine = RefinementSettings(0.01)
    continuation = continue_attractors([LOGISTIC.at(r) for r in grid], LINE, refine=refine)
    a, items = where(continuation, 1)
    period = np.array([item.motion.section_period for item in items])
    assert {*np.concatenate(continuation.branch).tolist()} == {1}
    assert all(item.motion.kind == MotionKind.PERIODIC for item in items)
    assert (np.diff(period) >= 0).all()
    last, first = a[period == periods[0]].max(), a[period == periods[1]].min()
    assert first - last <= 2.0 * refine.resolution
    # Near a doubling orbits converge slowly, so the change of period is seen slightly late.
    assert last - 0.01 <= at <= first + 0.01


def test_results_do_not_depend_on_other_values(maps):
    """The attractors at a value of a do not depend on the other values."""
    alone = continue_attractors([TWO_WELLS.at(1.1)], WELLS, refine=RefinementSettings(1.0))
    several = continue_attractors(
        [TWO_WELLS.at(1.0 + mu) for mu in (0.0, 0.1, 0.2)], WELLS, refine=RefinementSettings(1.0)
    )
    both = alone.attractors[0], several.attractors[1]
    states = [sorted(item.motion.state().position[0] for item in attractors) for attractors in both]
    assert states[0] == pytest.approx(states[1], abs=1e-9)


@dataclass(frozen=True)
class OrderMatcher(Matcher):
    """Matches attractors in the order of their positions, whatever their kinds and periods."""

    def match(self, before, after):
        def ordered(sets):
            return sorted(sets, key=lambda k: sets[k].attractor.motion.mean_distance)

        return dict(zip(ordered(after), ordered(before), strict=False))

    def is_unchanged(self, before, after):
        return True


def test_another_matcher_decides_what_is_the_same(maps):
    """By order, the only well beyond a fold continues the lowest branch; a doubled period is no change to locate.

    By distance, the well has moved too far in a step, and is another branch.
    """
    models, refine = [TWO_WELLS.at(1.0 + mu) for mu in (0.3, 0.45)], RefinementSettings(1.0)
    by_distance, by_order = (
        continue_attractors(models, WELLS, refine=refine, **share) for share in ({}, {"matcher": OrderMatcher()})
    )
    for continuation, beyond in ((by_distance, 3), (by_order, 1)):
        lower, upper = np.argsort([item.motion.mean_distance for item in continuation.attractors[0]])
        assert continuation.branch[0][[lower, upper]].tolist() == [1, 2]
        assert continuation.branch[1].tolist() == [beyond]
    grid, refine = (2.9, 3.1), RefinementSettings(0.05)
    counts = [
        len(continue_attractors([LOGISTIC.at(r) for r in grid], LINE, refine=refine, **share).models)
        for share in ({}, {"matcher": OrderMatcher()})
    ]
    assert counts[0] > counts[1] == len(grid)
