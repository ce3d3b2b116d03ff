"""The paper's own method, for comparison: Runge-Kutta of fourth order with a fixed step, events at step ends."""

import cython
import numpy as np
from cython.cimports.burridge_knopoff.kernel.events import (
    ABSURD_SPEED,
    ACCUMULATING_EVENTS,
    COMPLETED,
    DIVERGED,
    FULL,
    WORK_UNTIL_CHECK,
    EventLog,
    check_signals,
)
from cython.cimports.burridge_knopoff.kernel.observe import Observer
from cython.cimports.burridge_knopoff.kernel.piece import Piece
from cython.cimports.burridge_knopoff.kernel.state import State

CUBIC = 3


class TimeStepping:
    """One run with step h; between step ends the motion is the cubic through both states and their slopes."""

    state: State
    log: EventLog
    observer: Observer
    piece: Piece
    step: cython.double
    clock: cython.double
    steps: cython.longlong
    earlier_steps: cython.longlong
    settled: cython.bint
    speed: cython.double[:, ::1]
    acceleration: cython.double[:, ::1]
    position: cython.double[::1]
    velocity: cython.double[::1]

    def __init__(self, state: State, log: EventLog, observer: Observer, step: float) -> None:
        n = state.blocks
        self.state = state
        self.log = log
        self.observer = observer
        self.piece = Piece(n, CUBIC, observer.section)
        self.step = step
        self.steps = 0
        self.earlier_steps = 0
        self.settled = False
        self.clock = 0.0
        self.position = np.zeros(n)
        self.velocity = np.zeros(n)
        self.speed = np.zeros((4, n))
        self.acceleration = np.zeros((4, n))

    def begin(self, position: np.ndarray, velocity: np.ndarray, stuck: np.ndarray, time: float = 0.0) -> None:
        """Begin again at a time from these x_i, U_i' and stuck blocks; steps end at multiples of h."""
        self.state.begin(position, velocity, stuck)
        self.clock = time
        self.earlier_steps = int(time / self.step)
        while (self.earlier_steps + 1) * self.step <= time:
            self.earlier_steps += 1
        self.steps = 0
        self.settled = False
        self.observer.begin = time
        self.log.restart()

    def mark(self) -> tuple:
        """Return what `resume` needs besides the state: the slip directions."""
        return (self.state.values()[2],)

    def resume(self, mark: tuple, time: float) -> None:
        """Go on as if the run that has come to this state had not ended."""
        np.asarray(self.state.slip)[:] = mark[0]
        self.settled = True

    def run(self) -> int:
        """Run on, to the end of the observer's window at most; return COMPLETED or why the run has ended."""
        status: cython.int
        with cython.nogil:
            status = self._run()
        return status

    def _run(self) -> cython.int:
        i: cython.Py_ssize_t
        n: cython.Py_ssize_t = self.state.blocks
        after: cython.double
        step: cython.double
        rate: cython.double
        work: cython.longlong = 0
        if not self.settled:
            self.settled = True
            self.log.settle(self.state, self.clock)
        while self.clock < self.observer.end:
            work += n
            if work >= WORK_UNTIL_CHECK:
                check_signals()
                work = 0
            after = (self.earlier_steps + self.steps + 1) * self.step
            if after > self.observer.end:
                after = self.observer.end
            step = after - self.clock
            for i in range(n):
                self.position[i] = self.state.position[i]
                self.velocity[i] = self.state.velocity[i]
            self._slope(0)
            self._stage(0, 0.5 * step)
            self._slope(1)
            self._stage(1, 0.5 * step)
            self._slope(2)
            self._stage(2, step)
            self._slope(3)
            for i in range(n):
                rate = self.speed[0, i] + 2.0 * self.speed[1, i] + 2.0 * self.speed[2, i] + self.speed[3, i]
                self.state.position[i] = self.position[i] + step * rate / 6.0
                rate = self.acceleration[0, i] + 2.0 * self.acceleration[1, i] + 2.0 * self.acceleration[2, i]
                rate += self.acceleration[3, i]
                self.state.velocity[i] = self.velocity[i] + step * rate / 6.0
                self.state.touching[i] = 0
                if not abs(self.state.velocity[i]) < ABSURD_SPEED:
                    return DIVERGED
            self._slope(3)
            for i in range(n):
                # A step so long that a block passes its stop meets friction where the law does not describe any.
                if not abs(self.acceleration[3, i]) * step < ABSURD_SPEED:
                    return DIVERGED
            self._interpolate(step)
            self.observer.observe(self.state, self.piece, self.clock, 0.0, step)
            self.clock = after
            self.steps += 1
            self.log.settle(self.state, self.clock)
            if self.log.accumulating:
                return ACCUMULATING_EVENTS
            if self.log.full() or self.observer.crossings.full:
                return FULL
        return COMPLETED

    def _slope(self, stage: cython.Py_ssize_t) -> None:
        """Write x' and U'' at the current state into row `stage`."""
        i: cython.Py_ssize_t
        direction: cython.double
        for i in range(self.state.blocks):
            self.speed[stage, i] = self.state.velocity[i] - self.state.v
            self.acceleration[stage, i] = 0.0
            if self.state.slip[i] != 0:
                direction = self.state.slip[i]
                self.acceleration[stage, i] = self.state.spring_force(i) - direction * (
                    self.state.springs.threshold[i] * self.state.friction.at(direction * self.state.velocity[i])
                )

    def _stage(self, stage: cython.Py_ssize_t, step: cython.double) -> None:
        """Set the state to the one at the start of the step, moved on by `step` with the slope in row `stage`."""
        i: cython.Py_ssize_t
        for i in range(self.state.blocks):
            self.state.position[i] = self.position[i] + step * self.speed[stage, i]
            self.state.velocity[i] = self.velocity[i] + step * self.acceleration[stage, i]

    def _interpolate(self, step: cython.double) -> None:
        """Fill the piece with the cubics through both ends of the step; rows 0 and 3 hold the slopes there."""
        i: cython.Py_ssize_t
        k: cython.Py_ssize_t
        n: cython.Py_ssize_t = self.state.blocks
        change: cython.double
        for i in range(n):
            change = (self.state.position[i] - self.position[i]) / step
            self.piece.position[0, i] = self.position[i]
            self.piece.position[1, i] = self.speed[0, i]
            self.piece.position[2, i] = (3.0 * change - 2.0 * self.speed[0, i] - self.speed[3, i]) / step
            self.piece.position[3, i] = (self.speed[0, i] + self.speed[3, i] - 2.0 * change) / (step * step)
            change = (self.state.velocity[i] - self.velocity[i]) / step
            self.piece.velocity[0, i] = self.velocity[i]
            self.piece.velocity[1, i] = self.acceleration[0, i]
            self.piece.velocity[2, i] = (3.0 * change - 2.0 * self.acceleration[0, i] - self.acceleration[3, i]) / step
            self.piece.velocity[3, i] = (self.acceleration[0, i] + self.acceleration[3, i] - 2.0 * change) / (
                step * step
            )
        for k in range(CUBIC + 1):
            self.piece.fill_force(self.state.springs, k)
