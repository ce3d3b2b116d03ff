"""Which of several known attractors a trajectory reaches: it is told as soon as it stays close to one of them.

An attractor is known by its returns: the states of all blocks at the instants at which the first block stops. A
trajectory has reached it when a number of its own successive returns lie within the attractor's radius of one of them.
"""

import cython
import numpy as np

if cython.compiled:
    from cython.cimports.burridge_knopoff.kernel.events import HALTED, RUNNING
else:
    from burridge_knopoff.kernel.events import HALTED, RUNNING

UNDETERMINED = -1


class Proximity:
    """Labels trajectories of one chain.

    solver : EventDriven that halts at the stops of the first block and ends at the time limit
    clouds : for each attractor its returns, shape (n, 2 blocks): positions x_i, then velocities U_i'
    radius : for each attractor the distance (largest difference of a coordinate) that counts as close
    returns : for each attractor how many successive returns have to be close
    """

    def __init__(self, solver, clouds, radius, returns) -> None:
        self.solver = solver
        self.attractors = len(clouds)
        width = 2 * solver.state.blocks
        ordered = [
            np.asarray(cloud, dtype=float)[np.argsort(np.asarray(cloud)[:, 0], kind="stable")] for cloud in clouds
        ]
        self.point = np.ascontiguousarray(np.concatenate([np.zeros((0, width)), *ordered]))
        self.first = np.cumsum([0, *(len(cloud) for cloud in clouds)]).astype(np.intp)
        self.radius = np.array(radius, dtype=float)
        self.streak = np.zeros(len(clouds), dtype=np.intp)
        self.returns = np.array(returns, dtype=np.intp)

    def label(self, position, velocity, stuck, label, time) -> None:
        """Fill `label` and `time`, shape (n,), for n initial states x_i, U_i' and stuck (int), shape (n, blocks).

        The label is the index of the attractor, or UNDETERMINED if none is reached by the solver's time limit; the
        time is that of the decision.
        """
        k: cython.Py_ssize_t
        count: cython.Py_ssize_t = len(label)
        positions: cython.double[:, ::1] = position
        velocities: cython.double[:, ::1] = velocity
        sticking: cython.int[:, ::1] = stuck
        labels: cython.int[::1] = label
        times: cython.double[::1] = time
        with cython.nogil:
            for k in range(count):
                labels[k] = self._follow(positions[k], velocities[k], sticking[k])
                times[k] = self.solver.clock

    def _follow(self, position, velocity, stuck):
        """Follow one trajectory until its label is certain, and return it."""
        i: cython.Py_ssize_t
        status: cython.int
        label: cython.int
        self.solver.state.place(position, velocity, stuck)
        self.solver.restart()
        for i in range(self.attractors):
            self.streak[i] = 0
        while True:
            status = self.solver._run()
            if status == HALTED:
                label = self._visit()
                if label != UNDETERMINED:
                    return label
            elif status != RUNNING:
                return UNDETERMINED

    def _visit(self):
        """Look at one return; give the attractor near which enough of them have been."""
        i: cython.Py_ssize_t
        for i in range(self.attractors):
            if self._near(i):
                self.streak[i] += 1
                if self.streak[i] >= self.returns[i]:
                    return i
            else:
                self.streak[i] = 0
        return UNDETERMINED

    def _near(self, attractor):
        """Tell whether the present state is within the radius of one of the attractor's returns."""
        i: cython.Py_ssize_t
        middle: cython.Py_ssize_t
        n: cython.Py_ssize_t = self.solver.state.blocks
        low: cython.Py_ssize_t = self.first[attractor]
        last: cython.Py_ssize_t = self.first[attractor + 1]
        high: cython.Py_ssize_t = last
        radius: cython.double = self.radius[attractor]
        least: cython.double = self.solver.state.position[0] - radius
        most: cython.double = self.solver.state.position[0] + radius
        while low < high:
            middle = (low + high) // 2
            if self.point[middle, 0] < least:
                low = middle + 1
            else:
                high = middle
        while low < last and self.point[low, 0] <= most:
            i = 1
            while i < n and abs(self.point[low, i] - self.solver.state.position[i]) <= radius:
                i += 1
            if i == n:
                i = 0
                while i < n and abs(self.point[low, n + i] - self.solver.state.velocity[i]) <= radius:
                    i += 1
                if i == n:
                    return True
            low += 1
        return False
