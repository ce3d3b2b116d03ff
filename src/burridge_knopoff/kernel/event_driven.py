"""The event-driven solvers `map` and `series`: smooth motion from event to event, each event where it truly lies.

Both look for events on the Taylor polynomials of the motion, in which none can be missed (see `bernstein`). `series`
also takes the state at the end of a piece from them; `map` takes it from the normal modes since the last event, so that
its only approximation is the event time.
"""

import cython
import numpy as np
from cython.cimports.burridge_knopoff.kernel.events import (
    ABSURD_SPEED,
    ACCUMULATING_EVENTS,
    COMPLETED,
    DIVERGED,
    FULL,
    HALTED,
    STEP_LIMIT,
    WORK_UNTIL_CHECK,
    EventLog,
    check_signals,
)
from cython.cimports.burridge_knopoff.kernel.exponents import Exponents
from cython.cimports.burridge_knopoff.kernel.modes import Modes
from cython.cimports.burridge_knopoff.kernel.observe import Observer
from cython.cimports.burridge_knopoff.kernel.piece import ORDER, Piece
from cython.cimports.burridge_knopoff.kernel.polynomial import evaluate, evaluate_slope
from cython.cimports.burridge_knopoff.kernel.search import EventSearch
from cython.cimports.burridge_knopoff.kernel.series import Series
from cython.cimports.burridge_knopoff.kernel.state import YOUNG, State
from cython.cimports.burridge_knopoff.kernel.tangent import Tangent
from cython.cimports.burridge_knopoff.kernel.tangent_modes import TangentModes
from cython.cimports.burridge_knopoff.kernel.tangent_series import TangentSeries

# Longest time over which perturbations are followed at once: without events, too, they have to be kept apart.
LONGEST_FOLLOW = 4.0


class EventDriven:
    """One run of a solver that goes from event to event; `run` returns its status.

    exponents : the perturbations that are propagated beside the run; Exponents with no vectors for none
    """

    state: State
    log: EventLog
    observer: Observer
    observing: cython.bint
    exponents: Exponents
    tangent: Tangent
    tangent_series: TangentSeries
    tangent_modes: TangentModes
    since_tangent: cython.double
    halting_block: cython.Py_ssize_t
    end: cython.double
    series: Series
    piece: Piece
    search: EventSearch
    modes: Modes
    closed_form: cython.bint
    clock: cython.double
    clock_rest: cython.double
    steps: cython.longlong
    step_limit: cython.longlong
    since_event: cython.double
    settled: cython.bint
    mark_state: cython.double[:, ::1]
    mark_slip: cython.int[:, ::1]
    mark_clock: cython.double[::1]

    def __init__(
        self, state: State, log: EventLog, observer: Observer, exponents: Exponents, closed_form: bool, step_limit: int
    ) -> None:
        self.state = state
        self.log = log
        self.observer = observer
        self.observing = True
        self.exponents = exponents
        self.tangent = exponents.tangent
        self.tangent_series = TangentSeries(self.tangent)
        self.tangent_modes = TangentModes(self.tangent)
        self.since_tangent = 0.0
        self.halting_block = -1
        self.end = observer.end
        log.carry(self.tangent)
        self.series = Series(state.springs.columns)
        self.piece = Piece(state.blocks, ORDER, observer.section)
        self.search = EventSearch(state.blocks)
        self.modes = Modes(state.blocks)
        self.closed_form = closed_form
        self.step_limit = step_limit
        self.mark_state = np.zeros((4, state.blocks))
        self.mark_slip = np.zeros((2, state.blocks), dtype=np.intc)
        self.mark_clock = np.zeros(4)
        self.restart(0.0)

    def begin(self, position: np.ndarray, velocity: np.ndarray, stuck: np.ndarray, time: float = 0.0) -> None:
        """Begin again at a time from these positions x_i, velocities U_i' and stuck blocks."""
        self.state.begin(position, velocity, stuck)
        self.restart(time)

    def mark(self) -> tuple:
        """Return the state at the start of the last piece of a completed run: one that continues repeats it."""
        origin = np.array([self.modes.origin, self.modes.origin_velocity])
        return np.array(self.mark_state), np.array(self.mark_slip), np.array(self.mark_clock), origin

    def resume(self, mark: tuple, time: float) -> None:
        """Go on at a time from the mark of a run that ended then, with the same pieces as if it had not ended."""
        state, slip, clock, origin = mark
        n = self.state.blocks
        position, velocity = np.asarray(self.state.position), np.asarray(self.state.velocity)
        self.state.begin(origin[0], origin[1], slip[0] == 0)
        np.asarray(self.state.slip)[:] = slip[0]
        if self.closed_form:
            self.modes.start(self.state)
        self.restart(time)
        position[:n], velocity[:n] = state[0], state[1]
        np.asarray(self.state.acceleration)[:], np.asarray(self.state.age)[:] = state[2], state[3]
        np.asarray(self.state.touching)[:] = slip[1]
        self.clock, self.clock_rest, self.since_event = clock[0], clock[1], clock[2]
        # A section that is observed from now on is crossed from the side that the run was on.
        if self.observer.transient <= time:
            self.observer.side = int(clock[3])
        self.settled = True

    def restart(self, time: cython.double) -> cython.int:
        """Begin again at a time from what is now the state."""
        self.clock = time
        self.clock_rest = 0.0
        self.observer.begin = time
        self.settled = False
        self.steps = 0
        self.since_event = 0.0
        self.since_tangent = 0.0
        self.log.restart()
        return 0

    def run(self) -> int:
        """Run on, to the end of the observer's window at most; return COMPLETED or why the run has ended.

        HALTED means that the block to halt at has just stopped; the next call goes on from there.
        """
        status: cython.int
        with cython.nogil:
            status = self._run()
        return status

    def _run(self) -> cython.int:
        i: cython.Py_ssize_t
        block: cython.Py_ssize_t
        halting: cython.bint
        due: cython.bint
        length: cython.double
        reach: cython.double
        remaining: cython.double
        total: cython.double
        work: cython.longlong = 0
        if not self.settled:
            self.settled = True
            self.log.settle(self.state, self.clock)
            if self.closed_form:
                self.modes.start(self.state)
        while True:
            work += self.state.blocks * (1 + self.tangent.vectors)
            if work >= WORK_UNTIL_CHECK:
                check_signals()
                work = 0
            if self.log.accumulating:
                return ACCUMULATING_EVENTS
            if self.log.full() or self.observer.crossings.full:
                return FULL
            if self.steps >= self.step_limit:
                return STEP_LIMIT
            remaining = (self.end - self.clock) - self.clock_rest
            reach = self.series.expand(self.state, self.piece)
            self.steps += 1
            # Towards a pole of the law pieces shrink until the clock stands still.
            if not self.clock + reach > self.clock or not self._fastest() < ABSURD_SPEED:
                return DIVERGED
            # The end of the run has no part in the search: it must not move an event by a bit.
            block = self.search.first(self.state, self.piece, reach, self.observer.side if self.observing else 0)
            length = self.search.time
            if length > remaining:
                block = -1
                length = remaining
            due = block >= 0 or length >= remaining
            if length >= remaining:
                self._mark()
            if self.observing:
                self.piece.crossing = self.search.crossing(length)
                self.observer.observe(self.state, self.piece, self.clock, self.clock_rest, length)
            if self.tangent.vectors > 0:
                self.exponents.begin_within(self.state, self.clock, length)
                if self.exponents.running:
                    self._follow(length, due)
            self.since_event += length
            self._advance(length)
            if self.closed_form:
                self.modes.advance(self.state, self.since_event)
            total = self.clock + (self.clock_rest + length)
            self.clock_rest = (self.clock - total) + (self.clock_rest + length)
            self.clock = total
            halting = False
            if block >= 0:
                halting = self.halting_block >= 0 and self.state.slip[self.halting_block] != 0
                self.log.change(self.state, block, self.clock)
                # The first of those that coincide is the one that was found.
                for i in range(block + 1, self.state.blocks):
                    if self.search.coincide(self.state, block, i):
                        self.log.change(self.state, i, self.clock)
                self.log.settle(self.state, self.clock)
                self.since_event = 0.0
                if self.closed_form:
                    self.modes.start(self.state)
                if length >= remaining:
                    self._mark()
            # At events, so that all solvers look after them at the same times.
            if self.exponents.running and (due or self.since_event >= LONGEST_FOLLOW):
                self.exponents.follow(self.state, self.clock, length >= remaining)
            if length >= remaining:
                return COMPLETED
            if halting and self.state.slip[self.halting_block] == 0:
                return HALTED

    def _follow(self, length: cython.double, due: cython.bint) -> cython.int:
        """Carry the perturbations along a piece, in strides after which they can be kept apart.

        The closed form spans several pieces: there they wait for an event or LONGEST_FOLLOW.
        """
        k: cython.Py_ssize_t
        parts: cython.Py_ssize_t
        t: cython.double
        self.tangent.forget_stops()
        if self.exponents.stuck(self.state) == self.state.blocks:
            # However long a slow driver takes, nothing changes.
            return 0
        if not self.closed_form:
            parts = self.tangent_series.load(self.state, self.piece, length)
            t = length / parts
            for k in range(1, parts + 1):
                self.tangent_series.follow(self.state.springs, t)
                if k < parts:
                    self.tangent_series.move_on()
                    self.exponents.follow(self.state, self.clock + k * t, False)
            return 0
        self.since_tangent += length
        while self.since_tangent >= LONGEST_FOLLOW or (due and self.since_tangent > 0.0):
            t = min(self.since_tangent, LONGEST_FOLLOW)
            self.tangent_modes.follow(self.state, self.modes, t)
            self.since_tangent -= t
            if self.since_tangent > 0.0:
                self.exponents.follow(self.state, self.clock + (length - self.since_tangent), False)
        return 0

    def _mark(self) -> None:
        """Keep the present state, whose next piece is the last one of the run unless it ends with an event."""
        i: cython.Py_ssize_t
        for i in range(self.state.blocks):
            self.mark_state[0, i] = self.state.position[i]
            self.mark_state[1, i] = self.state.velocity[i]
            self.mark_state[2, i] = self.state.acceleration[i]
            self.mark_state[3, i] = self.state.age[i]
            self.mark_slip[0, i] = self.state.slip[i]
            self.mark_slip[1, i] = self.state.touching[i]
        self.mark_clock[0] = self.clock
        self.mark_clock[1] = self.clock_rest
        self.mark_clock[2] = self.since_event
        self.mark_clock[3] = self.observer.side

    def _fastest(self) -> cython.double:
        """Return the largest speed of a block."""
        i: cython.Py_ssize_t
        speed: cython.double = 0.0
        for i in range(self.state.blocks):
            speed = max(speed, abs(self.state.velocity[i]))
        return speed

    def _advance(self, t: cython.double) -> None:
        """Move the state on by t along the piece."""
        i: cython.Py_ssize_t
        if not self.closed_form:
            self.piece.move(self.state, t)
        for i in range(self.state.blocks):
            if t > 0.0:
                self.state.touching[i] = 0
            if self.state.slip[i] == 0:
                continue
            self.state.age[i] += t
            if self.state.age[i] < YOUNG:
                self.state.velocity[i] = evaluate(self.piece.velocity, i, self.piece.degree, t)
                self.state.acceleration[i] = evaluate_slope(self.piece.velocity, i, self.piece.degree, t)
