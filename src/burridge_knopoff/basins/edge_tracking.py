"""Edge tracking: a trajectory on the boundary between two basins, kept there by restarted bisection.

The segment between two states in different basins is bisected, by the attractors that its points reach. Both states are
then advanced, and while they are close they shadow the boundary between them. Once they have separated, the segment
between them is bisected again.

The two states may differ in which blocks are stuck. A stuck block has velocity 0 and a spring force at most at its
threshold. Between a state in which a block is stuck and one in which it slips, its velocity is positive, so the block
slips; between two states in which it is stuck, it is stuck. All points of the segment in positions and velocities are
therefore states of the chain.

References: J. D. Skufca, J. A. Yorke and B. Eckhardt, Phys. Rev. Lett. 96 (2006) 174101; T. M. Schneider, B. Eckhardt
and J. A. Yorke, Phys. Rev. Lett. 99 (2007) 034502.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from burridge_knopoff.attractors.attractor import Attractor
from burridge_knopoff.attractors.labels import UNDETERMINED, label_arrays
from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.periodic_orbits.flow import OrbitError, mean_distance
from burridge_knopoff.periodic_orbits.without_stops import velocity_maxima
from burridge_knopoff.running.derivative import missing_derivative
from burridge_knopoff.running.runner import Runner
from burridge_knopoff.running.status import Status

# Number of parts into which a segment is divided: eight states within it take little longer than one.
PARTS = 9

# Fractions of the time limit. Most states near a boundary are decided by the first. Slow boundaries, and transient
# chaos, hold some for longer; they are followed further only if the others do not bring the two sides closer.
PROMPT = (0.01, 0.1, 1.0)

#: Distances of the two states, for v = 0.1 in the chain's own units: the segment between them is bisected down to the
#: first, a thousand times the rounding error, and again once they are the second apart.
BISECTED_DISTANCE, SEPARATED_DISTANCE = 2e-12, 1e-7

# Distance above which the direction between the two states is known to at least three digits.
DIRECTION_DISTANCE = 1e-9

# Time, in the chain's own unit, between two measurements of the distance. Of all motions seen, the fastest to leave a
# boundary takes twice as long for a factor e.
STEP = 5.0

# Distances from the two states, in units of their distance, at which the line through them is searched if both have
# come to the same side, as in strips of a fractal boundary thinner than the rounding error.
LINE_DISTANCES = np.geomspace(0.1, 100.0, 32)

# Steps after which perturbations are orthonormalized, and their growth is measured.
ORTHONORMALIZED = 4

# Growth of a perturbation in that time below which it counts as zero, as that of the velocity of a block that stops.
LEAST_GROWTH = 1e-12


class LabelError(Exception):
    """The label of a state near a boundary contradicts that of the trajectory that led to it."""


@dataclass(frozen=True, eq=False)
class _Piece:
    """The part of a track between two bisections.

    start, duration : of the trajectory on the first side
    times, values : of its events, in the form of the kernel
    growth : logarithms of the growth of perturbations in each step, shape (steps, vectors)
    place, direction : states at some of the steps, and unit vectors to the second side, shape (n, 2 blocks)
    """

    start: ChainState
    duration: float
    times: np.ndarray
    values: np.ndarray
    growth: np.ndarray
    place: np.ndarray
    direction: np.ndarray


@dataclass(frozen=True, eq=False)
class Lines:
    """Lines across a boundary: states on it, and unit vectors to the second side, both of shape (n, 2 blocks)."""

    place: np.ndarray
    direction: np.ndarray

    def __getitem__(self, chosen: np.ndarray) -> Lines:
        return Lines(self.place[chosen], self.direction[chosen])

    def displace(self, amount: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return states displaced along the lines, as positions, velocities and stuck blocks, shape (n, blocks).

        amount : displacements, positive towards the second side, for v = 0.1 in the chain's own units, shape (n,)
        """
        position, velocity = np.split(self.place + amount[:, None] * self.direction, 2, axis=1)
        # A displacement does not reverse a slip.
        slip = np.sign(np.split(self.place, 2, axis=1)[1])
        return position, np.where(velocity * slip > 0.0, velocity, 0.0), slip == 0.0


@dataclass(eq=False)
class EdgeTrack:
    """A trajectory on the boundary of a basin, as far as it has been followed.

    attractors : of the model; on_first_side : whether each is on the first side, shape (attractors,)
    first, second : states on the two sides
    time_limit : time by which a state has to reach an attractor
    vectors : number of perturbations whose growth is measured
    """

    model: Model
    attractors: Sequence[Attractor]
    on_first_side: np.ndarray
    first: ChainState
    second: ChainState
    time_limit: float
    vectors: int
    pieces: list[_Piece] = field(default_factory=list)

    def __post_init__(self) -> None:
        size = 2 * self.model.blocks
        self._basis = np.linalg.qr(np.random.default_rng(0).standard_normal((size, self.vectors)))[0]
        self._runners = Runner(self.model, keep_events=True, perturbations=self._basis), Runner(self.model)

    @property
    def step(self) -> float:
        """Time between two measurements of the distance."""
        return STEP * self.model.chain.own_units.time

    @property
    def duration(self) -> float:
        """Time for which the boundary has been followed."""
        return sum(piece.duration for piece in self.pieces)

    def advance(self, duration: float) -> None:
        """Follow the boundary for at least this time, up to the next separation.

        Raises OrbitError if the boundary is lost, LabelError if labels contradict each other.
        """
        end = self.duration + duration
        while self.duration < end:
            self._bisect()
            self._follow()

    def events(self, since: int) -> tuple[np.ndarray, np.ndarray]:
        """Return times and values of the events from piece `since` on, in the form of the kernel.

        Without events, they are those of the maxima of the velocities.
        """
        clock = np.cumsum([0.0, *(piece.duration for piece in self.pieces)])[since:-1]
        pieces = self.pieces[since:]
        events = [(piece.times, piece.values) for piece in pieces]
        if not any(len(times) for times, _ in events):
            events = [velocity_maxima(self.model, piece.start, 0.0, piece.duration) for piece in pieces]
        return (
            np.concatenate([begin + times for begin, (times, _) in zip(clock, events, strict=True)]),
            np.concatenate([values for _, values in events]),
        )

    def piece_at(self, time: float) -> int:
        """Return the index of the piece that contains a time."""
        ends = np.cumsum([piece.duration for piece in self.pieces])
        return min(int(np.searchsorted(ends, time, side="right")), len(ends) - 1)

    def mean_distance(self, since: int) -> float:
        """Return ⟨J⟩ from piece `since` on."""
        pieces = self.pieces[since:]
        total = sum(mean_distance(self.model, piece.start, piece.duration) * piece.duration for piece in pieces)
        return total / sum(piece.duration for piece in pieces)

    def growth(self, since: int) -> np.ndarray:
        """Return the growth rates of perturbations in each step from piece `since` on, shape (steps, vectors)."""
        return np.concatenate([piece.growth for piece in self.pieces[since:]]) / self.step

    def lines(self, since: int) -> Lines:
        """Return lines across the boundary from the states of the trajectory from piece `since` on."""
        pieces = self.pieces[since:]
        return Lines(*(np.concatenate([getattr(piece, name) for piece in pieces]) for name in ("place", "direction")))

    @cached_property
    def _scale(self) -> np.ndarray:
        return self.model.state_scale

    def _distance(self, first: ChainState, second: ChainState) -> float:
        return float(np.abs((first.vector() - second.vector()) / self._scale).max())

    def _bisect(self) -> None:
        """Bring the two states together. States between them that reach no attractor are ignored."""
        _, ours = self._sides(np.array([0.0, 1.0]), self.time_limit)
        if ours.tolist() != [True, False]:
            self._find_change()
        while self._distance(self.first, self.second) > BISECTED_DISTANCE:
            if not any(self._narrow(share * self.time_limit) for share in PROMPT):
                raise OrbitError(
                    f"time_limit: got {self.time_limit:g}, by which no state between the basins reaches an attractor, "
                    f"expected more ({self.model.place})"
                )

    def _narrow(self, time_limit: float) -> bool:
        """Replace the two states by nearer ones between them on different sides; return whether there are any."""
        states, ours = self._sides(np.arange(1, PARTS) / PARTS, time_limit)
        states, ours = [self.first, *states, self.second], np.concatenate([[True], ours, [False]])
        other = _widest_change(ours)
        first, second = states[other - 1 : other + 1]
        if self._distance(first, second) > (1.0 - 0.5 / PARTS) * self._distance(self.first, self.second):
            return False
        self.first, self.second = first, second
        return True

    def _sides(self, shares: np.ndarray, time_limit: float) -> tuple[list[ChainState], np.ndarray]:
        """Return states on the line through the two that reach an attractor, and whether each is on the first side.

        shares : positions on the line, 0 at the first state and 1 at the second, shape (n,)
        time_limit : time by which a state has to reach an attractor
        """
        first, second, share = self.first, self.second, shares[:, None]
        stuck = np.tile(first.stuck & second.stuck, (len(shares), 1))
        stuck[shares == 0.0], stuck[shares == 1.0] = first.stuck, second.stuck
        position = (1.0 - share) * first.position + share * second.position
        velocity = (1.0 - share) * first.velocity + share * second.velocity
        # Outside the segment a slip could be reversed.
        velocity[velocity * np.sign(first.velocity + second.velocity) < 0.0] = 0.0
        labels, _, _ = label_arrays(self.model, self.attractors, position, velocity, stuck, time_limit)
        index = np.flatnonzero(labels != UNDETERMINED)
        return [ChainState(position[k], velocity[k], stuck[k]) for k in index], self.on_first_side[labels[index]]

    def _find_change(self) -> None:
        """Replace two states on the same side by the nearest two on the line through them on different sides.

        Raises LabelError if there are none.
        """
        line = np.concatenate([-LINE_DISTANCES[::-1], [0.0, 1.0], 1.0 + LINE_DISTANCES])
        states, ours = self._sides(line, self.time_limit)
        changes = np.flatnonzero(np.diff(ours))
        if not len(changes):
            raise LabelError
        nearest = changes[np.argmin([self._distance(states[k], self.first) for k in changes])]
        both = states[nearest : nearest + 2]
        self.first, self.second = both if ours[nearest] else both[::-1]

    def _follow(self) -> None:
        """Advance both states until they have separated."""
        runner, other = self._runners
        start, clock, step = self.first, 0.0, self.step
        runner.begin(start, 0.0)
        runner.carry(self._basis)
        other.begin(self.second, 0.0)
        growth: list[np.ndarray] = []
        place, direction = [], []
        distance, blocks, steps = 0.0, self.model.blocks, 0
        while distance < SEPARATED_DISTANCE:
            clock += step
            if clock > self.time_limit:
                # Both states reach the same attractor, in contradiction to their labels.
                raise LabelError
            if any(solver.run(clock) != Status.COMPLETED for solver in (runner, other)):
                raise OrbitError(f"{self.model.place}: the run ends at τ = {clock:g} on the boundary")
            self.first, self.second = runner.state(), other.state()
            distance, steps = self._distance(self.first, self.second), steps + 1
            if steps == ORTHONORMALIZED or distance >= SEPARATED_DISTANCE:
                if reason := missing_derivative(runner):
                    raise OrbitError(f"{self.model.place}: on the boundary {reason}: no exponents")
                self._basis, triangle = np.linalg.qr(runner.perturbations)
                runner.carry(self._basis)
                size = np.abs(np.diag(triangle))
                rate = np.where(size > LEAST_GROWTH, np.log(np.maximum(size, LEAST_GROWTH)), -np.inf) / steps
                growth += [rate] * steps
                steps = 0
            if DIRECTION_DISTANCE < distance < SEPARATED_DISTANCE and (self.first.stuck == self.second.stuck).all():
                place.append(self.first.vector())
                direction.append((self.second.vector() - self.first.vector()) / distance)
        events = runner.log.events
        arrays = (np.reshape(values, (-1, 2 * blocks)) for values in (place, direction))
        self.pieces.append(_Piece(start, clock, events.times(), events.values(), np.array(growth), *arrays))


def _widest_change(ours: np.ndarray) -> int:
    """Return the index of the point after the change from the first to the second side with the widest runs around it.

    ours : whether each point is on the first side, shape (points,): the first is, the last is not

    A wide run is preferred because a basin may be a strip thinner than the rounding error.
    """
    edges = np.flatnonzero(np.diff(ours)) + 1
    runs = np.diff([0, *edges, len(ours)])
    # Runs on the first side have even numbers.
    leaving = np.arange(0, len(runs), 2)
    return int(edges[leaving[np.argmax(np.minimum(runs[leaving], runs[leaving + 1]))]])
