"""Observables taken from the motion while it passes, piece by piece, without storing it."""

from collections.abc import Sequence

import cython
import numpy as np
from cython.cimports.burridge_knopoff.kernel.bernstein import SearchedPolynomial
from cython.cimports.burridge_knopoff.kernel.distance import Distance
from cython.cimports.burridge_knopoff.kernel.piece import UNCERTAIN, Piece
from cython.cimports.burridge_knopoff.kernel.polynomial import evaluate
from cython.cimports.burridge_knopoff.kernel.record import Record
from cython.cimports.burridge_knopoff.kernel.search import SEAM
from cython.cimports.burridge_knopoff.kernel.state import State

TRANSIENT = 0
WINDOW = 1
UPWARD = 1
DOWNWARD = -1
NOTHING = -1e300


class Observer:
    """What one run measures.

    apart : U_N − U_1 in uniform sliding
    edge : batch boundaries, shape (batches + 1,); the first is the end of the transient, the last the end of the run
    distance_time : times at which J is sampled, shape (samples,)
    trajectory_time : times at which positions and velocities are sampled, shape (m,)
    section_only : whether J is not averaged, nor extremes followed
    section : block whose x_i is W, from 1 on; 0 if W is the sum of all x_i
    """

    section_only: cython.bint
    section: cython.Py_ssize_t

    begin: cython.double
    transient: cython.double
    end: cython.double
    edge: cython.double[::1]
    batch_integral: cython.double[::1]
    batch_rest: cython.double[::1]
    batch: cython.Py_ssize_t
    batches: cython.Py_ssize_t
    distance_time: cython.double[::1]
    distance_sample: cython.double[::1]
    next_distance: cython.Py_ssize_t
    trajectory_time: cython.double[::1]
    trajectory_position: cython.double[:, ::1]
    trajectory_velocity: cython.double[:, ::1]
    next_trajectory: cython.Py_ssize_t
    crossings: Record
    side: cython.int
    highest_speed: cython.double[::1]
    lowest_force: cython.double[::1]
    distance: Distance
    loaded: cython.bint
    polynomial: SearchedPolynomial

    def __init__(
        self,
        blocks: int,
        order: int,
        apart: float,
        edge: Sequence[float] | np.ndarray,
        distance_time: Sequence[float] | np.ndarray,
        trajectory_time: Sequence[float] | np.ndarray,
        section_only: bool,
        section: int,
    ) -> None:
        self.section_only = section_only
        self.begin = 0.0
        self.section = section
        self.transient = edge[0]
        self.end = edge[len(edge) - 1]
        self.edge = np.array(edge, dtype=float)
        self.batches = len(edge) - 1
        self.batch = 0
        self.batch_integral = np.zeros(self.batches)
        self.batch_rest = np.zeros(self.batches)
        self.distance_time = np.array(distance_time, dtype=float)
        self.distance_sample = np.full(len(distance_time), np.nan)
        self.next_distance = 0
        self.trajectory_time = np.array(trajectory_time, dtype=float)
        self.trajectory_position = np.full((len(trajectory_time), blocks), np.nan)
        self.trajectory_velocity = np.full((len(trajectory_time), blocks), np.nan)
        self.next_trajectory = 0
        self.crossings = Record(2)
        self.side = 0
        self.highest_speed = np.full(2, NOTHING)
        self.lowest_force = np.full(2, -NOTHING)
        self.distance = Distance(order, apart)
        self.loaded = False
        self.polynomial = SearchedPolynomial(order)

    def observe(
        self, state: State, piece: Piece, clock: cython.double, clock_rest: cython.double, length: cython.double
    ) -> None:
        """Take everything from the first `length` of a piece that starts at time clock + clock_rest."""
        until_begin: cython.double
        until_window: cython.double = (self.transient - clock) - clock_rest
        self.loaded = False
        if self.section_only:
            if length > until_window:
                self._cross(state, piece, clock, clock_rest, length)
            self._sample(piece, clock, clock_rest, length)
            return
        if length > until_window:
            self._average(piece, clock, clock_rest, length)
            self._cross(state, piece, clock, clock_rest, length)
            self._extreme(state, piece, WINDOW, max(0.0, until_window), length)
        if until_window > 0.0:
            until_begin = max(0.0, (self.begin - clock) - clock_rest)
            self._extreme(state, piece, TRANSIENT, until_begin, min(length, until_window))
        self._sample(piece, clock, clock_rest, length)

    def _load_distance(self, piece: Piece) -> None:
        """Load the distance of this piece, once, and only if it is needed."""
        if not self.loaded:
            self.distance.load(piece)
            self.loaded = True

    def _average(self, piece: Piece, clock: cython.double, clock_rest: cython.double, length: cython.double) -> None:
        """Add the integral of J to the batches that the piece touches (compensated sums)."""
        start: cython.double = max(0.0, (self.edge[self.batch] - clock) - clock_rest)
        stop: cython.double
        edge: cython.double
        term: cython.double
        total: cython.double
        while self.batch < self.batches:
            edge = (self.edge[self.batch + 1] - clock) - clock_rest
            stop = min(edge, length)
            if stop > start:
                self._load_distance(piece)
                term = self.distance.integral(start, stop)
                total = self.batch_integral[self.batch] + term
                self.batch_rest[self.batch] += (self.batch_integral[self.batch] - total) + term
                self.batch_integral[self.batch] = total
            if edge > length or self.batch == self.batches - 1:
                break
            self.batch += 1
            start = max(0.0, edge)

    def _sample(self, piece: Piece, clock: cython.double, clock_rest: cython.double, length: cython.double) -> None:
        """Take the samples of J and of the trajectory that fall into the piece."""
        i: cython.Py_ssize_t
        t: cython.double
        while self.next_distance < self.distance_time.shape[0]:
            t = (self.distance_time[self.next_distance] - clock) - clock_rest
            if t > length:
                break
            self._load_distance(piece)
            self.distance_sample[self.next_distance] = self.distance.value(t)
            self.next_distance += 1
        while self.next_trajectory < self.trajectory_time.shape[0]:
            t = (self.trajectory_time[self.next_trajectory] - clock) - clock_rest
            if t > length:
                break
            for i in range(piece.blocks):
                self.trajectory_position[self.next_trajectory, i] = evaluate(piece.position, i, piece.degree, t)
                self.trajectory_velocity[self.next_trajectory, i] = evaluate(piece.velocity, i, piece.degree, t)
            self.next_trajectory += 1

    def _cross(
        self, state: State, piece: Piece, clock: cython.double, clock_rest: cython.double, length: cython.double
    ) -> None:
        """Record where W changes its sign, with W' and the direction.

        The side on which W lies is remembered from piece to piece, so that rounding at a seam can neither hide a
        crossing nor make one.
        """
        k: cython.Py_ssize_t
        t: cython.double
        start: cython.double = 0.0
        until_window: cython.double = (self.transient - clock) - clock_rest
        value: cython.double
        if self.side != 0 and piece.crossing != UNCERTAIN:
            if piece.crossing >= 0.0:
                self._turn(state, piece, piece.crossing, clock, clock_rest)
            return
        self.polynomial.degree = piece.degree
        for k in range(piece.degree + 1):
            self.polynomial.coefficient[k] = piece.section_row(k)
        if self.side == 0:
            self.side = DOWNWARD if self.polynomial.value(max(0.0, until_window)) < 0.0 else UPWARD
            if until_window > 0.0:
                self.polynomial.shift(until_window)
                start = until_window
        value = self.side * self.polynomial.coefficient[0]
        if -SEAM < value < 0.0 and self.side * self.polynomial.coefficient[1] > 0.0:
            self.polynomial.coefficient[0] = 0.0
            self.polynomial.deflate()
        while start < length:
            if self.side < 0:
                self.polynomial.negate()
            t = self.polynomial.first_root(length - start)
            if self.side < 0:
                self.polynomial.negate()
            if t < 0.0:
                return
            start += t
            # The root is divided out, and with it what rounding leaves of W there. If the sign after it is the one
            # before it, W has touched 0 within rounding and not crossed.
            self.polynomial.shift(t)
            self.polynomial.coefficient[0] = 0.0
            self.polynomial.deflate()
            if self.side * self.polynomial.coefficient[0] >= 0.0:
                continue
            self._turn(state, piece, start, clock, clock_rest)

    def _turn(
        self, state: State, piece: Piece, t: cython.double, clock: cython.double, clock_rest: cython.double
    ) -> None:
        """Change the side and keep the crossing to it, at t within a piece: when, W' there, and the side."""
        row: cython.Py_ssize_t
        self.side = -self.side
        # A run that goes on repeats a piece of the one before, and has kept what it crossed there.
        if t <= (self.begin - clock) - clock_rest:
            return
        row = self.crossings.append(clock + (clock_rest + t))
        self.crossings.value[row, 0] = piece.section_rate(state.v, t)
        self.crossings.value[row, 1] = self.side

    def _extreme(
        self, state: State, piece: Piece, stage: cython.int, start: cython.double, stop: cython.double
    ) -> None:
        """Follow the highest slip speed and the lowest spring force on a stuck block, in transient or window."""
        i: cython.Py_ssize_t
        threshold: cython.double
        for i in range(piece.blocks):
            if state.slip[i] != 0:
                if piece.highest[i] <= self.highest_speed[stage]:
                    continue
                piece.load_speed(state, i, self.polynomial)
                if start > 0.0:
                    self.polynomial.shift(start)
                self.highest_speed[stage] = self.polynomial.maximum(stop - start, self.highest_speed[stage])
            else:
                threshold = state.springs.threshold[i]
                if piece.highest[i] <= threshold - self.lowest_force[stage]:
                    continue
                piece.load_gap(state, i, 1, self.polynomial)
                if start > 0.0:
                    self.polynomial.shift(start)
                self.lowest_force[stage] = threshold - self.polynomial.maximum(
                    stop - start, threshold - self.lowest_force[stage]
                )

    def results(self) -> dict:
        """Return all that was measured as NumPy arrays."""
        integral = np.asarray(self.batch_integral) + np.asarray(self.batch_rest)
        return {
            "batch_integral": integral,
            "distance": np.asarray(self.distance_sample),
            "position": np.asarray(self.trajectory_position),
            "velocity": np.asarray(self.trajectory_velocity),
            "crossing_time": self.crossings.times(),
            "crossing": self.crossings.values(),
            "highest_speed": np.asarray(self.highest_speed),
            "lowest_force": np.asarray(self.lowest_force),
        }
