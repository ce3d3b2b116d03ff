"""Stops and starts: how they are carried out and kept, and when there are so many that they accumulate."""

import cython
import numpy as np
from cython.cimports.burridge_knopoff.kernel.record import Record
from cython.cimports.burridge_knopoff.kernel.state import State
from cython.cimports.burridge_knopoff.kernel.tangent import Tangent
from cython.cimports.cpython.exc import PyErr_CheckSignals

# Work between two looks at signals such as Ctrl-C, in blocks that a step moves, or perturbations of them: about 0.05 s.
WORK_UNTIL_CHECK = 200_000

# A speed that no real motion reaches. The linearized law drives blocks that may slip backward without bound.
ABSURD_SPEED = 1e9


def check_signals() -> cython.int:
    """Let Python handle the signals that have come; raises KeyboardInterrupt after Ctrl-C."""
    with cython.gil:
        PyErr_CheckSignals()
    return 0


class EventLog:
    """The event sequence of a run.

    `earlier_events` has rows (time | block, kind) for events before `states_from`; `events` has rows
    (time | block, kind, x_1 … x_N, U_1' … U_N') for those from `states_from` on. `stops_only` keeps of all these only
    the stops from `states_from` on. More than `rate_limit` events in one time unit count as an accumulation.
    """

    states_from: cython.double
    keep: cython.bint
    stops_only: cython.bint
    earlier_events: Record
    events: Record
    count: cython.longlong
    unit_start: cython.double
    unit_count: cython.longlong
    rate_limit: cython.longlong
    accumulating: cython.bint
    due: cython.int[::1]
    tangent: Tangent

    def __init__(self, blocks: int, states_from: float, keep: bool, rate_limit: int, stops_only: bool) -> None:
        self.states_from = states_from
        self.keep = keep
        self.stops_only = stops_only
        self.earlier_events = Record(2)
        self.events = Record(2 + 2 * blocks)
        self.rate_limit = rate_limit
        self.due = np.zeros(blocks, dtype=np.intc)
        self.tangent = Tangent(blocks, 0)
        self.restart()

    def carry(self, tangent: Tangent) -> None:
        """Let perturbations go through every change as well."""
        self.tangent = tangent

    def restart(self) -> cython.int:
        """Begin again without events; what has been read of those before stays as it is."""
        if self.earlier_events.count > 0:
            self.earlier_events = Record(self.earlier_events.width)
        if self.events.count > 0:
            self.events = Record(self.events.width)
        self.count = 0
        self.unit_start = 0.0
        self.unit_count = 0
        self.accumulating = False
        return 0

    def full(self) -> cython.bint:
        """Tell whether more events were to be kept than there is room for."""
        return self.earlier_events.full or self.events.full

    def change(self, state: State, block: cython.Py_ssize_t, clock: cython.double) -> None:
        """Let a block stop or start now, and keep the event."""
        i: cython.Py_ssize_t
        row: cython.Py_ssize_t
        kind: cython.int
        if self.tangent.vectors > 0:
            self.tangent.change(state, block)
        kind = state.transition(block)
        self.count += 1
        if clock >= self.unit_start + 1.0:
            self.unit_start = clock
            self.unit_count = 0
        self.unit_count += 1
        if self.unit_count > self.rate_limit:
            self.accumulating = True
        if not self.keep or (self.stops_only and (kind != 0 or clock < self.states_from)):
            return
        if clock < self.states_from:
            row = self.earlier_events.append(clock)
            self.earlier_events.value[row, 0] = block + 1
            self.earlier_events.value[row, 1] = kind
            return
        row = self.events.append(clock)
        self.events.value[row, 0] = block + 1
        self.events.value[row, 1] = kind
        for i in range(state.blocks):
            self.events.value[row, 2 + i] = state.position[i]
            self.events.value[row, 2 + state.blocks + i] = state.velocity[i]

    def settle(self, state: State, clock: cython.double) -> None:
        """Carry out every change that is due at this instant, to the last one, before time moves on."""
        i: cython.Py_ssize_t
        changing: cython.int = 1
        while changing and not self.accumulating:
            # Who changes is decided before anyone does: then no order of the blocks is preferred.
            changing = 0
            for i in range(state.blocks):
                self.due[i] = state.pending(i)
                changing |= self.due[i]
            if not changing:
                return
            for i in range(state.blocks):
                if self.due[i]:
                    self.change(state, i, clock)
