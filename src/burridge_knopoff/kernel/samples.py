"""States of many trajectories at given times, taken from the pieces of motion that hold them."""

from collections.abc import Sequence

import cython
import numpy as np
from cython.cimports.burridge_knopoff.kernel.lane_series import LaneSeries
from cython.cimports.burridge_knopoff.kernel.lanes import Lanes
from cython.cimports.burridge_knopoff.kernel.state import LONG
from cython.cimports.burridge_knopoff.kernel.vector import LANES, Vectors, at_most, bits, lane_of, mask, put, vec


class Samples:
    """States of n trajectories at the same times; none if there are no times.

    time : ascending, shape (times,)
    """

    time: cython.double[::1]
    position: cython.double[:, :, ::1]
    velocity: cython.double[:, :, ::1]
    slip: cython.schar[:, :, ::1]
    next: cython.Py_ssize_t[::1]
    target: Vectors

    def __init__(self, n: int, time: Sequence[float], blocks: int) -> None:
        shape = (n, len(time), blocks)
        self.time = np.array(time, dtype=float)
        self.position = np.full(shape, np.nan)
        self.velocity = np.full(shape, np.nan)
        self.slip = np.zeros(shape, dtype=np.int8)
        self.next = np.zeros(LANES, dtype=np.intp)
        self.target = Vectors(1)

    def aim(self, lane: cython.int, k: cython.Py_ssize_t) -> None:
        """Let the k-th time be the next at which the state of a lane is kept."""
        self.next[lane] = k
        put(self.target.at, lane, self.time[k] if k < self.time.shape[0] else LONG)

    def take(self, lanes: Lanes, series: LaneSeries, length: vec, active: mask) -> None:
        """Keep the states at the times that lie within the coming pieces."""
        i: cython.Py_ssize_t
        k: cython.Py_ssize_t
        member: cython.Py_ssize_t
        lane: cython.int
        due: cython.int
        ahead: vec
        x: vec
        w: vec
        while True:
            ahead = (self.target.at[0] - lanes.clock.at[0]) - lanes.clock_rest.at[0]
            due = bits(active & at_most(ahead, length))
            if not due:
                return
            for i in range(lanes.blocks):
                x = series.at_time(series.position, i, ahead)
                w = series.at_time(series.velocity, i, ahead)
                for lane in range(LANES):
                    if due >> lane & 1:
                        member, k = lanes.member[lane], self.next[lane]
                        self.position[member, k, i] = lane_of(x, lane)
                        self.velocity[member, k, i] = lane_of(w, lane)
                        self.slip[member, k, i] = cython.cast(cython.schar, lane_of(lanes.slip.at[i], lane))
            for lane in range(LANES):
                if due >> lane & 1:
                    self.aim(lane, self.next[lane] + 1)

    def results(self) -> dict[str, np.ndarray]:
        """Return position, velocity and slip, shape (n, times, blocks); NaN or 0 where a trajectory did not come to."""
        return {
            "position": np.asarray(self.position),
            "velocity": np.asarray(self.velocity),
            "slip": np.asarray(self.slip),
        }
