"""Pairs of near points of a plane at ever smaller separations, for the fraction of pairs that a boundary separates.

At a small separation pairs with different labels are rare, and most of them are parts of such pairs at a larger
separation. Each pair is therefore divided into three, a third as far apart, with a third of the weight (splitting). A
random selection of these is kept: few from far inside a basin, most from near a boundary. Their weights are increased
accordingly, so that the mean of any sum over pairs is that of plain sampling.

Reference: H. Kahn and T. E. Harris, National Bureau of Standards Applied Mathematics Series 12 (1951) 27-30.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from burridge_knopoff.attractors.labels import UNDETERMINED

#: Number of parts into which each pair is divided.
PARTS = 3

#: Separations ε of the pairs, as fractions of the width of the plane.
SEPARATIONS = tuple(0.1 * PARTS**-k for k in range(13))

#: Number of independent groups of pairs, whose scatter gives the errors.
BATCHES = 20

# Ratio of the numbers of pairs that are kept of successive ages. The longer ago a pair has differed, the farther it is
# from the boundary that was seen, and the less often another boundary lies between its points. Of 0.5, 0.7, 0.85, and a
# quarter for pairs that differ with equal numbers for the rest, 0.85 gave the smallest errors for Cantor strips.
_AGE_FACTOR = 0.85

#: A function of points of the plane, shape (n, 2), that returns their labels, shape (n,): negative if undetermined.
Label = Callable[[np.ndarray], np.ndarray]


@dataclass(frozen=True)
class PairCounts:
    """Weights and numbers of the pairs at each separation.

    different, known : weights of the pairs with two different labels, and of all with two labels, shape (batches,
        separations)
    different_count, labelled_count : their numbers, shape (separations,)
    """

    different_weight: np.ndarray
    labelled_weight: np.ndarray
    different_count: np.ndarray
    labelled_count: np.ndarray


@dataclass(frozen=True, eq=False)
class _Pairs:
    """Pairs of points at one separation.

    start, direction : first points and unit vectors to the second ones, shape (n, 2); labels : of both, shape (2, n)
    batch, weight : shape (n,)
    age : number of separations since a pair that contains this one has differed, shape (n,)
    never : age of a pair if no pair that contains it has differed
    """

    start: np.ndarray
    direction: np.ndarray
    labels: np.ndarray
    batch: np.ndarray
    weight: np.ndarray
    age: np.ndarray
    never: int

    @property
    def is_labelled(self) -> np.ndarray:
        """Whether both points of each pair have a label."""
        return np.logical_and(*(self.labels >= 0))

    @property
    def is_different(self) -> np.ndarray:
        """Whether the points of each pair have different labels."""
        return self.is_labelled & (self.labels[0] != self.labels[1])

    def weights(self, chosen: np.ndarray) -> np.ndarray:
        """Return the weights of the chosen pairs in each batch."""
        return np.bincount(self.batch, self.weight * chosen, BATCHES)

    def select(self, size: int, generator: np.random.Generator) -> _Pairs:
        """Return about `size` pairs of each batch with its total weight; most of them are of the youngest ages."""
        age = np.where(self.is_different, 0, np.minimum(self.age + 1, self.never))
        indices, weights = [], []
        for batch in range(BATCHES):
            ages = np.unique(age[self.batch == batch])
            rooms = size * _AGE_FACTOR**ages / np.sum(_AGE_FACTOR**ages)
            for value, room in zip(ages, rooms, strict=True):
                members = np.flatnonzero((self.batch == batch) & (age == value))
                chosen, weight = _select(self.weight[members], max(1, int(room)), generator)
                indices.append(members[chosen])
                weights.append(weight)
        index = np.concatenate(indices)
        columns = (self.start[index], self.direction[index], self.labels[:, index], self.batch[index])
        return _Pairs(*columns, np.concatenate(weights), age[index], self.never)

    def divide(self, separation: float, label: Label) -> _Pairs:
        """Return all parts of the pairs, `separation` apart."""
        points = [self.start + part * separation * self.direction for part in range(PARTS)]
        between = label(np.concatenate(points[1:])).reshape(PARTS - 1, -1)
        labels = [self.labels[0], *between, self.labels[1]]
        return _Pairs(
            np.concatenate(points),
            np.tile(self.direction, (PARTS, 1)),
            np.array([np.concatenate(labels[:-1]), np.concatenate(labels[1:])]),
            np.tile(self.batch, PARTS),
            np.tile(self.weight / PARTS, PARTS),
            np.tile(self.age, PARTS),
            self.never,
        )


def follow_pairs(
    label: Label,
    first: Sequence[float],
    last: Sequence[float],
    count: int,
    seed: int,
    separations: Sequence[float] = SEPARATIONS,
) -> PairCounts:
    """Label pairs of points of a plane at several separations, each a third of the one before.

    first, last : ranges (low, high) of both coordinates
    count : approximate number of pairs that are kept at each separation; two points are labelled for each
    separations : as fractions of the width of the first range

    A pair counts if both points lie in the plane. Such pairs are uniform in position and direction.
    """
    generator = np.random.default_rng(seed)
    low, high = np.array([first, last], dtype=float).T
    width = high[0] - low[0]
    size = -(-count // BATCHES)

    def labels_of(points: np.ndarray) -> np.ndarray:
        labels = np.full(len(points), UNDETERMINED)
        inside = ((points >= low) & (points <= high)).all(axis=1)
        labels[inside] = label(points[inside])
        return labels

    longest, never = separations[0] * width, len(separations)
    batch = np.repeat(np.arange(BATCHES), size)
    # Parts of a pair that begins outside may lie in the plane; without them there would be too few near its edges.
    start = low - longest + (high - low + 2.0 * longest) * generator.random((len(batch), 2))
    angle = 2.0 * np.pi * generator.random(len(batch))
    direction = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    ends = np.array([labels_of(start), labels_of(start + longest * direction)])
    pairs = _Pairs(start, direction, ends, batch, np.ones(len(batch)), np.full(len(batch), never), never)
    rows = []
    for separation in (*separations[1:], 0.0):
        labelled, different = pairs.is_labelled, pairs.is_different
        rows.append((pairs.weights(different), pairs.weights(labelled), different.sum(), labelled.sum()))
        if separation and len(batch):
            pairs = pairs.select(size, generator).divide(separation * width, labels_of)
    weights, all_weights, counts, all_counts = (np.array(part) for part in zip(*rows, strict=True))
    return PairCounts(weights.T, all_weights.T, counts, all_counts)


def _select(weight: np.ndarray, count: int, generator: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Return the indices of selected weights, and their new weights, whose mean for each index is the old weight.

    All are selected unless there are more than `count`; then `count` are, by systematic sampling of their sum.
    """
    if len(weight) <= count:
        return np.arange(len(weight)), weight
    total = np.cumsum(weight)
    steps = total[-1] * (generator.random() + np.arange(count)) / count
    # Rounding may put the last step at the very end.
    chosen = np.minimum(np.searchsorted(total, steps, side="right"), len(weight) - 1)
    return chosen, np.full(count, total[-1] / count)
