"""Divided pairs: their weighted fractions are those of plain sampling, whichever pairs are selected."""

import numpy as np
import pytest

from burridge_knopoff.basins.pair_separation import BATCHES, PARTS, SEPARATIONS, _select, follow_pairs
from tests.basins.boundaries import cantor, half_plane

UNIT = (0.0, 1.0)


def plain(label, separation, count, first=UNIT, last=UNIT, seed=5):
    """Return the fraction of pairs of a plane that differ, and its standard error, from uniformly drawn points."""
    generator = np.random.default_rng(seed)
    low, high = np.array([first, last]).T
    start = low - separation + (high - low + 2 * separation) * generator.random((count, 2))
    angle = 2.0 * np.pi * generator.random(count)
    end = start + separation * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    both = np.logical_and.reduce([((low <= points) & (points <= high)).all(axis=1) for points in (start, end)])
    start_label, end_label = label(start[both]), label(end[both])
    valid = (start_label >= 0) & (end_label >= 0)
    share = (start_label != end_label)[valid].mean()
    return share, np.sqrt(share * (1.0 - share) / valid.sum())


def check_fractions(label, ranges, count, seeds, drawn, separations):
    """Compare the fractions of pairs, by their mean and its error over seeds, with those of pairs drawn uniformly."""
    pairs = [follow_pairs(label, *ranges, count, seed) for seed in range(seeds)]
    fractions = [counts.different_weight.sum(axis=0) / counts.labelled_weight.sum(axis=0) for counts in pairs]
    mean, error = np.mean(fractions, axis=0), np.std(fractions, axis=0, ddof=1) / np.sqrt(seeds)
    for k in separations:
        expected, plain_error = plain(label, SEPARATIONS[k], drawn, *ranges)
        assert abs(mean[k] - expected) < 3.5 * np.hypot(error[k], plain_error), k


@pytest.mark.slow
@pytest.mark.parametrize("label", [half_plane, cantor(3)], ids=["half_plane", "cantor"])
@pytest.mark.parametrize("ranges", [(UNIT, UNIT), ((0.0, 1.0), (0.2, 0.7))], ids=["square", "strip"])
def test_the_fraction_is_that_of_plain_sampling(label, ranges):
    check_fractions(label, ranges, 200, 60, 1_000_000, (0, 1, 3, 5))


def test_undetermined_points_are_excluded():
    def label(points):
        return np.where(points[:, 1] > 0.6, -1, half_plane(points))

    check_fractions(label, (UNIT, UNIT), 400, 40, 400_000, (0, 2))


def test_weights_are_those_of_pairs_of_the_plane():
    """The total weight is the fraction of short pairs in the plane among those that begin up to 0.1 outside."""
    batches = []

    def label(points):
        batches.append(points)
        return np.zeros(len(points), dtype=int)

    pairs = follow_pairs(label, (-1.0, 3.0), (0.0, 2.0), 2000, 1)
    points = np.concatenate(batches)
    assert (points >= [-1.0, 0.0]).all()
    assert (points <= [3.0, 2.0]).all()
    assert not pairs.different_weight.any()
    assert not pairs.different_count.any()
    assert pairs.labelled_weight.shape == (BATCHES, len(SEPARATIONS))
    area = 4.0 * 2.0 / (4.8 * 2.8)
    assert pairs.labelled_weight[:, -1].sum() / 2000 == pytest.approx(area, abs=4 * np.sqrt(area * (1 - area) / 2000))
    # At most two points are labelled for each selected pair.
    assert len(points) < 2 * 2000 * len(SEPARATIONS)


def test_pairs_are_divided_into_thirds():
    """The points that are labelled after the ends of the pairs divide the pairs into thirds."""
    batches = []

    def label(points):
        batches.append(points)
        return half_plane(points)

    # The edges are so far away that almost no pair extends beyond the plane.
    follow_pairs(label, (0.0, 1.0), (0.0, 1e6), BATCHES, 2)
    assert PARTS == 3
    ends = np.concatenate(batches[:2])
    thirds = ((2.0 * ends[:, None] + ends[None]) / 3.0).reshape(-1, 2)
    there = [np.abs(thirds - point).max(axis=1).min() < 1e-9 for point in batches[2]]
    assert np.mean(there) > 0.6


def test_the_same_seed_gives_the_same_pairs():
    first, same, other = (follow_pairs(half_plane, UNIT, UNIT, 100, seed) for seed in (3, 3, 4))
    assert (first.different_weight == same.different_weight).all()
    assert (first.different_weight != other.different_weight).any()
    # A batch has at least one pair, unless there are none.
    assert (follow_pairs(half_plane, UNIT, UNIT, 1, 3).labelled_weight.sum(axis=1) > 0.0).mean() > 0.5
    none = follow_pairs(half_plane, UNIT, UNIT, 0, 3)
    assert not none.labelled_weight.any()
    assert none.labelled_count.tolist() == [0] * len(SEPARATIONS)


def test_selection_preserves_the_mean_weights():
    weight = np.array([0.1, 3.0, 0.5, 0.4, 1.0])
    generator = np.random.default_rng(1)
    mean = np.zeros(5)
    for _ in range(4000):
        chosen, new = _select(weight, 3, generator)
        assert len(chosen) == len(new) == 3
        np.add.at(mean, chosen, new / 4000)
    assert mean == pytest.approx(weight, rel=0.1)
    assert _select(weight, 5, generator)[1].tolist() == weight.tolist()
