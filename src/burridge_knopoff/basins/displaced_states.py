"""States displaced from an edge state to either side of the boundary, and the attractors that they reach."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from burridge_knopoff.attractors.labels import UNDETERMINED, label_arrays
from burridge_knopoff.basins.edge_tracking import EdgeTrack, Lines
from burridge_knopoff.basins.settings import EdgeSettings
from burridge_knopoff.model.model import ChainState

#: Range of the displacements, for v = 0.1 in the chain's own units: much larger than the distance of the two sides of a
#: track, and small enough for the motion to be linear.
DISPLACEMENTS = (1e-6, 1e-4)

# Fraction of the time limit by which displaced states have to reach an attractor: those that stay longer in transient
# chaos are not counted.
DISPLACED_SHARE = 0.1

# Displacements, relative to that of a state beyond the boundary, among which the nearest one on this side is sought.
NEARBY = np.geomspace(0.1, 10.0, 65)


class DisplacedStates:
    """States displaced from a set on a boundary, in the direction in which the two sides separate.

    track, since : a trajectory on the boundary, which has settled on the set from piece `since` on
    settings : number of states for each side, and the seed
    """

    def __init__(self, track: EdgeTrack, since: int, settings: EdgeSettings) -> None:
        self.track, self.since, self.samples = track, since, settings.samples
        self.generator = np.random.default_rng(settings.seed)
        self._beyond: list[tuple[Lines, float]] = []

    def counts(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the numbers of states that reach each attractor, (2, attractors), and that cross the boundary, (2,).

        The latter reach an attractor of the other side. The logarithm of the displacements is uniform, so that they
        cover all of the unstable manifold.
        """
        low, high = np.log(DISPLACEMENTS)
        counts, beyond = [], []
        for side in (-1.0, 1.0):
            amount = side * np.exp(self.generator.uniform(low, high, self.samples))
            lines = self._lines()
            labels, _ = self._label(lines.displace(amount))
            counts.append(np.bincount(labels[labels != UNDETERMINED], minlength=len(self.track.attractors)))
            is_beyond = (labels != UNDETERMINED) & (self.track.on_first_side[labels] != (side < 0.0))
            beyond.append(np.count_nonzero(is_beyond))
            self._beyond += [(lines[np.array([k])], amount[k]) for k in np.flatnonzero(is_beyond)]
        return np.array(counts), np.array(beyond)

    def crossings(self) -> Iterator[tuple[ChainState, ChainState]]:
        """Yield a state on the first and one on the second side for each state that `counts` found beyond the boundary.

        One of the two is that state; the other is the nearest one on the same line that reaches an attractor of the
        other side. States without such a neighbour are left out.
        """
        for line, amount in self._beyond:
            arrays = line[np.zeros(len(NEARBY), dtype=int)].displace(amount * NEARBY)
            labels, _ = self._label(arrays)
            place = len(NEARBY) // 2
            ours = self.track.on_first_side[labels]
            across = np.flatnonzero((labels != UNDETERMINED) & (ours != ours[place]))
            if len(across):
                nearest = across[np.argmin(np.abs(across - place))]
                one, other = (ChainState(*(array[k] for array in arrays)) for k in (place, nearest))
                yield (one, other) if ours[place] else (other, one)

    def lifetime(self) -> tuple[float, float]:
        """Return the mean time for which uniformly displaced states stay, and its error.

        It is that of the exponential tail of the times at which labels are certain: the last quarter of each side.
        Beyond the median alone it would be up to a quarter too long.
        """
        left = []
        for side in (-1.0, 1.0):
            amount = side * DISPLACEMENTS[1] * self.generator.random(self.samples)
            labels, times = self._label(self._lines().displace(amount))
            late = np.sort(times[labels != UNDETERMINED])
            late = late[3 * len(late) // 4 :]
            left.append(late[1:] - late[:1])
        tail = np.concatenate(left)
        return float(tail.mean()), float(tail.mean()) / math.sqrt(len(tail))

    def _lines(self) -> Lines:
        """Return lines across the boundary from random points of the trajectory."""
        lines = self.track.lines(self.since)
        return lines[self.generator.integers(len(lines.place), size=self.samples)]

    def _label(self, states: tuple[np.ndarray, np.ndarray, np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
        """Return the labels of states, as `Lines.displace` returns them, and the times at which they are certain."""
        limit = DISPLACED_SHARE * self.track.time_limit
        labels, times, _ = label_arrays(self.track.model, self.track.attractors, *states, limit)
        return labels, times
