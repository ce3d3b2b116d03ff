"""Clouds of states, and whether a state is within the radius of one of them.

The points of a cloud are sorted along the coordinate in which it is widest and lie in groups of neighbours, each in a
box. A box that is too far off has no close point, to the last bit: rounding keeps the order of differences.
"""

from collections.abc import Sequence

import cython
import numpy as np

GROUP = 16
WIDER = 1.000001


class Clouds:
    """Several clouds of points, each with a radius in the largest difference of a coordinate.

    clouds : arrays of shape (n, width), n may differ and may be 0
    radius : one for each cloud
    """

    count: cython.Py_ssize_t
    width: cython.Py_ssize_t
    point: cython.double[:, ::1]
    low: cython.double[:, ::1]
    high: cython.double[:, ::1]
    first: cython.Py_ssize_t[::1]
    first_group: cython.Py_ssize_t[::1]
    sorted_by: cython.Py_ssize_t[::1]
    radius: cython.double[::1]

    def __init__(self, clouds: Sequence[np.ndarray], width: int, radius: Sequence[float]) -> None:
        self.count = len(clouds)
        self.width = width
        points, lows, highs, axes = [np.zeros((0, width))], [np.zeros((0, width))], [np.zeros((0, width))], []
        for cloud in clouds:
            cloud = np.asarray(cloud, dtype=float).reshape(-1, width)
            axis = int(np.argmax(np.ptp(cloud, axis=0))) if len(cloud) else 0
            cloud = cloud[np.argsort(cloud[:, axis], kind="stable")]
            starts = np.arange(0, len(cloud), GROUP)
            points.append(cloud)
            lows.append(np.minimum.reduceat(cloud, starts) if len(cloud) else cloud)
            highs.append(np.maximum.reduceat(cloud, starts) if len(cloud) else cloud)
            axes.append(axis)
        self.point = np.ascontiguousarray(np.concatenate(points))
        self.low = np.ascontiguousarray(np.concatenate(lows))
        self.high = np.ascontiguousarray(np.concatenate(highs))
        self.first = np.cumsum([len(cloud) for cloud in points]).astype(np.intp)
        self.first_group = np.cumsum([len(boxes) for boxes in lows]).astype(np.intp)
        self.sorted_by = np.array(axes, dtype=np.intp)
        self.radius = np.array(radius, dtype=float)

    def is_near(self, cloud: int, state: np.ndarray) -> bool:
        """Do the work of `near` from Python."""
        return bool(self.near(cloud, np.array(state, dtype=float)))

    def near(self, cloud: cython.Py_ssize_t, state: cython.double[::1]) -> cython.bint:
        """Tell whether a state, shape (width,), is within the radius of a point of the cloud."""
        k: cython.Py_ssize_t
        middle: cython.Py_ssize_t
        axis: cython.Py_ssize_t = self.sorted_by[cloud]
        group: cython.Py_ssize_t = self.first_group[cloud]
        last: cython.Py_ssize_t = self.first_group[cloud + 1]
        high: cython.Py_ssize_t = last
        radius: cython.double = self.radius[cloud]
        # Rounding must not hide a group; whether a point is close `_close` decides.
        wide: cython.double = WIDER * radius
        while group < high:
            middle = (group + high) // 2
            if state[axis] - self.high[middle, axis] > wide:
                group = middle + 1
            else:
                high = middle
        while group < last and self.low[group, axis] - state[axis] <= wide:
            if self._close(self.low, self.high, group, state, radius):
                k = self.first[cloud] + GROUP * (group - self.first_group[cloud])
                high = min(k + GROUP, self.first[cloud + 1])
                while k < high:
                    if self._close(self.point, self.point, k, state, radius):
                        return True
                    k += 1
            group += 1
        return False

    def _close(
        self,
        low: cython.double[:, ::1],
        high: cython.double[:, ::1],
        k: cython.Py_ssize_t,
        state: cython.double[::1],
        radius: cython.double,
    ) -> cython.bint:
        """Tell whether a state is within the radius of the k-th box."""
        i: cython.Py_ssize_t
        for i in range(1, self.width):
            if low[k, i] - state[i] > radius or state[i] - high[k, i] > radius:
                return False
        return low[k, 0] <= state[0] + radius and high[k, 0] >= state[0] - radius
