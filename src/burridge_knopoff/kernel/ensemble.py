"""Many trajectories of one chain at once: a lane holds a trajectory with its own clock and step.

A lane whose trajectory has ended takes the next one from the list. No number of a trajectory depends on what goes on in
other lanes, nor on where it ends: the end only cuts off.
"""

from collections.abc import Sequence

import cython
import numpy as np
from cython.cimports.burridge_knopoff.kernel.clouds import Clouds
from cython.cimports.burridge_knopoff.kernel.events import (
    ABSURD_SPEED,
    ACCUMULATING_EVENTS,
    COMPLETED,
    DIVERGED,
    WORK_UNTIL_CHECK,
    check_signals,
)
from cython.cimports.burridge_knopoff.kernel.friction_series import FrictionSeries
from cython.cimports.burridge_knopoff.kernel.lane_events import LaneEvents
from cython.cimports.burridge_knopoff.kernel.lane_series import LaneSeries
from cython.cimports.burridge_knopoff.kernel.lanes import Lanes
from cython.cimports.burridge_knopoff.kernel.samples import Samples
from cython.cimports.burridge_knopoff.kernel.vector import (
    LANES,
    Vectors,
    at_most,
    bits,
    equal,
    from_bits,
    lane_of,
    largest,
    less,
    magnitude,
    mask,
    select,
    splat,
    vec,
)

# Label of a trajectory that comes close to no cloud.
UNDETERMINED = -1
# Of the Taylor series; even, since their terms are summed in pairs.
ORDER = 20


class Ensemble:
    """Moves trajectories of one chain.

    diagonal, left, right, threshold, sliding_force, v, symmetric, rate_limit : see `Lanes`
    code, first, second, alpha, beta, gamma, value : the friction law, see `FrictionSeries`
    """

    lanes: Lanes
    series: LaneSeries
    events: LaneEvents
    blocks: cython.Py_ssize_t
    rounds: cython.longlong
    active: mask
    fresh: mask
    end: cython.double
    position: cython.double[:, ::1]
    velocity: cython.double[:, ::1]
    stuck: cython.int[:, ::1]
    next_member: cython.Py_ssize_t
    status: cython.int[::1]
    time: cython.double[::1]
    clouds: Clouds
    streak: cython.Py_ssize_t[:, ::1]
    returns: cython.Py_ssize_t[::1]
    section: cython.Py_ssize_t[::1]
    slipped: Vectors
    point: cython.double[::1]
    label_of: cython.int[::1]
    samples: Samples
    event_count: cython.longlong[::1]

    def __init__(
        self,
        diagonal: np.ndarray,
        left: np.ndarray,
        right: np.ndarray,
        threshold: np.ndarray,
        sliding_force: np.ndarray,
        v: float,
        symmetric: bool,
        code: np.ndarray,
        first: np.ndarray,
        second: np.ndarray,
        alpha: np.ndarray,
        beta: np.ndarray,
        gamma: np.ndarray,
        value: int,
        rate_limit: int,
    ) -> None:
        self.blocks = len(diagonal)
        friction = FrictionSeries(self.blocks, ORDER, code, first, second, alpha, beta, gamma, value)
        self.lanes = Lanes(diagonal, left, right, threshold, sliding_force, v, symmetric, friction, rate_limit)
        self.series = LaneSeries(self.blocks, ORDER)
        self.events = LaneEvents(ORDER)
        self.point = np.zeros(2 * self.blocks)
        self.slipped = Vectors(self.blocks)
        self.rounds = 0

    def label(
        self,
        position: np.ndarray,
        velocity: np.ndarray,
        stuck: np.ndarray,
        clouds: Clouds,
        returns: Sequence[int],
        section: Sequence[int],
        end: float,
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return which cloud each state comes close to, when that was certain, and where the others are in the end.

        Labels and times have the shape (n,): −1 where a state comes close to no cloud by time `end`. The states at that
        time, (x_i, U_i'), have the shape (n, 2 blocks): NaN where a label was certain before.

        position, velocity, stuck : x_i, U_i' and which blocks stick, shape (n, blocks)
        clouds : Clouds of states (x_i, U_i') at stops of one block each
        returns : for each cloud how many successive stops of its block have to be close to it
        section : for each cloud its block, from 0 on
        """
        n = len(position)
        labels = np.full(n, UNDETERMINED, dtype=np.intc)
        times = np.zeros(n)
        self.clouds = clouds
        self.returns = np.array(returns, dtype=np.intp)
        self.section = np.array(section, dtype=np.intp)
        self.streak = np.zeros((LANES, clouds.count), dtype=np.intp)
        self.label_of = labels
        self.samples = samples = Samples(n, [end], self.blocks)
        self.lanes.kept = 0
        self.end = end
        self._begin(position, velocity, stuck, times, np.zeros(n, dtype=np.intc), np.zeros(n, dtype=np.int64))
        last = samples.results()
        return labels, times, np.concatenate([last["position"][:, 0], last["velocity"][:, 0]], axis=1)

    def run(
        self, position: np.ndarray, velocity: np.ndarray, stuck: np.ndarray, times: Sequence[float], events: int = 0
    ) -> dict[str, np.ndarray]:
        """Return the states of all trajectories at some times, and their first events.

        times : one at least, ascending; a state is that before the events of the same instant; the last is the end
        events : how many are kept of each trajectory

        Keys: position, velocity, slip of shape (n, times, blocks), after the last of a trajectory's times NaN or 0;
        status (COMPLETED or why a trajectory ended), end (when it did) and event_count of shape (n,); event_time,
        event_block (from 1) and event_kind (0 stop, 1 start) of shape (n, events), NaN or 0 where there was none.
        """
        n = len(position)
        samples = Samples(n, times, self.blocks)
        status, end = np.zeros(n, dtype=np.intc), np.zeros(n)
        event_count = np.zeros(n, dtype=np.int64)
        event_time = np.full((n, events), np.nan)
        event_block, event_kind = np.zeros((n, events), dtype=np.intc), np.zeros((n, events), dtype=np.intc)
        # No state is near any cloud where there is none.
        self.section = np.zeros(0, dtype=np.intp)
        self.samples = samples
        self.lanes.kept = events
        self.lanes.event_time, self.lanes.event_block, self.lanes.event_kind = event_time, event_block, event_kind
        self.end = times[len(times) - 1]
        self._begin(position, velocity, stuck, end, status, event_count)
        return {
            **samples.results(),
            "status": status,
            "end": end,
            "event_count": event_count,
            "event_time": event_time,
            "event_block": event_block,
            "event_kind": event_kind,
        }

    def _begin(
        self,
        position: np.ndarray,
        velocity: np.ndarray,
        stuck: np.ndarray,
        time: np.ndarray,
        status: np.ndarray,
        count: np.ndarray,
    ) -> None:
        """Run all trajectories, with what is known of each at its end in these arrays."""
        if not np.shape(position) == np.shape(velocity) == np.shape(stuck) == (len(position), self.blocks):
            shapes = ", ".join(str(np.shape(values)) for values in (position, velocity, stuck))
            raise ValueError(f"position, velocity, stuck: got shapes {shapes}, expected (n, {self.blocks}) for each")
        self.position = np.ascontiguousarray(position, dtype=float)
        self.velocity = np.ascontiguousarray(velocity, dtype=float)
        self.stuck = np.ascontiguousarray(stuck, dtype=np.intc)
        self.time, self.status, self.event_count = time, status, count
        self.next_member = 0
        self.active = self.fresh = from_bits(0)
        with cython.nogil:
            self._run()

    def _run(self) -> cython.int:
        """Go on until every trajectory has ended."""
        work: cython.longlong = 0
        self._refill()
        while bits(self.active):
            self.rounds += 1
            work += self.blocks * LANES
            if work >= WORK_UNTIL_CHECK:
                check_signals()
                work = 0
            if bits(self.fresh):
                self.lanes.settle(self.fresh)
            self._finish(self.active & self.lanes.accumulating, ACCUMULATING_EVENTS)
            self.series.expand(self.lanes)
            self._move()
            self._refill()
        return 0

    def _move(self) -> None:
        """Move every lane to its next event, or as far as its series goes, and look at the returns among the events."""
        i: cython.Py_ssize_t
        cloud: cython.Py_ssize_t
        zero: vec = splat(0.0)
        fastest: vec = zero
        length: vec
        left: vec
        total: vec
        ended: mask
        event: mask
        for i in range(self.blocks):
            fastest = largest(fastest, magnitude(self.lanes.velocity.at[i]))
            self.slipped.at[i] = self.lanes.slip.at[i]
        # Towards a pole of the law pieces shrink until the clock stands still.
        left = self.lanes.clock.at[0]
        ended = less(left, left + self.series.reach.at[0]) & less(fastest, splat(ABSURD_SPEED))
        self._finish(self.active & ~ended, DIVERGED)
        self.events.find(self.lanes, self.series, self.active)
        length = self.events.time.at[0]
        self.samples.take(self.lanes, self.series, length, self.active)
        left = (self.end - self.lanes.clock.at[0]) - self.lanes.clock_rest.at[0]
        ended = self.active & at_most(left, length)
        if bits(ended):
            self.lanes.clock.at[0] = select(ended, splat(self.end), self.lanes.clock.at[0])
            self._finish(ended, COMPLETED)
        self.series.move(self.lanes, length, self.active)
        left = self.lanes.clock.at[0]
        total = left + (self.lanes.clock_rest.at[0] + length)
        self.lanes.clock_rest.at[0] = (left - total) + (self.lanes.clock_rest.at[0] + length)
        self.lanes.clock.at[0] = total
        event = self.active & at_most(zero, self.events.block.at[0])
        if not bits(event):
            return
        self.events.begin_events(self.lanes, self.series)
        for i in range(self.blocks):
            ended = self.events.due(self.lanes, self.series, i, event)
            if bits(ended):
                self.lanes.change(i, ended)
        self.lanes.settle(event)
        for cloud in range(self.section.shape[0]):
            i = self.section[cloud]
            self._visit(
                cloud, event & self.active & ~equal(self.slipped.at[i], zero) & equal(self.lanes.slip.at[i], zero)
            )

    def _visit(self, cloud: cython.Py_ssize_t, where: mask) -> None:
        """Look at the returns of some lanes to a cloud; a lane is done when enough of them have been near it."""
        i: cython.Py_ssize_t
        lane: cython.int
        returned: cython.int = bits(where)
        if not returned:
            return
        for lane in range(LANES):
            if not returned >> lane & 1:
                continue
            for i in range(self.blocks):
                self.point[i] = lane_of(self.lanes.position.at[i], lane)
                self.point[self.blocks + i] = lane_of(self.lanes.velocity.at[i], lane)
            if not self.clouds.near(cloud, self.point):
                self.streak[lane, cloud] = 0
                continue
            self.streak[lane, cloud] += 1
            if self.streak[lane, cloud] >= self.returns[cloud]:
                self.label_of[self.lanes.member[lane]] = cloud
                self._finish(from_bits(1 << lane), COMPLETED)

    def _finish(self, where: mask, status: cython.int) -> None:
        """End the trajectories of some lanes."""
        lane: cython.int
        ending: cython.int = bits(where)
        if not ending:
            return
        for lane in range(LANES):
            if ending >> lane & 1:
                self.time[self.lanes.member[lane]] = lane_of(self.lanes.clock.at[0], lane)
                self.status[self.lanes.member[lane]] = status
                self.event_count[self.lanes.member[lane]] = cython.cast(
                    cython.longlong, lane_of(self.lanes.count.at[0], lane)
                )
        self.active = self.active & ~where

    def _refill(self) -> None:
        """Let the next trajectories begin in the lanes that are free."""
        lane: cython.int
        i: cython.Py_ssize_t
        free: cython.int = ~bits(self.active)
        self.fresh = from_bits(0)
        for lane in range(LANES):
            if not free >> lane & 1 or self.next_member >= self.position.shape[0]:
                continue
            self.lanes.place(
                lane,
                self.next_member,
                self.position[self.next_member],
                self.velocity[self.next_member],
                self.stuck[self.next_member],
            )
            for i in range(self.section.shape[0]):
                self.streak[lane, i] = 0
            self.samples.aim(lane, 0)
            self.next_member += 1
            self.fresh = self.fresh | from_bits(1 << lane)
        self.active = self.active | self.fresh
