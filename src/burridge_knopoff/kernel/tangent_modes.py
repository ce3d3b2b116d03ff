"""Perturbations between events in closed form: along the normal modes of the slipping blocks, for `map`."""

import cython
import numpy as np
from cython.cimports.burridge_knopoff.kernel.modes import Modes
from cython.cimports.burridge_knopoff.kernel.state import State
from cython.cimports.burridge_knopoff.kernel.tangent import Tangent
from cython.cimports.libc.math import cos, exp, sin, sqrt


class TangentModes:
    """Moves the perturbations of a Tangent."""

    vectors: cython.Py_ssize_t
    position: cython.double[:, ::1]
    velocity: cython.double[:, ::1]
    moved: cython.double[:, ::1]
    sped: cython.double[:, ::1]

    def __init__(self, tangent: Tangent) -> None:
        self.vectors = tangent.vectors
        self.position = tangent.position
        self.velocity = tangent.velocity
        self.moved = np.zeros((tangent.vectors, tangent.blocks))
        self.sped = np.zeros((tangent.vectors, tangent.blocks))

    def follow(self, state: State, modes: Modes, t: cython.double) -> None:
        """Propagate over a time t without events in closed form; `modes` holds the slipping blocks."""
        i: cython.Py_ssize_t
        k: cython.Py_ssize_t
        n: cython.Py_ssize_t
        c: cython.Py_ssize_t
        line: cython.Py_ssize_t
        first: cython.Py_ssize_t
        last: cython.Py_ssize_t
        factor: cython.double
        omega: cython.double
        eigenvalue: cython.double
        cosine: cython.double
        sine: cython.double
        q: cython.double
        rate: cython.double
        moved: cython.double
        left: cython.double
        right: cython.double
        half: cython.double = 0.5 * modes.rate
        growth: cython.double = exp(half * t)
        for c in range(self.vectors):
            for i in range(state.blocks):
                self.moved[c, i] = 0.0
                self.sped[c, i] = 0.0
        for n in range(modes.runs):
            first = modes.first[n]
            last = modes.last[n]
            for k in range(first, last + 1):
                line = modes.row[n] + k - first
                eigenvalue = modes.eigenvalue[line]
                omega = sqrt(eigenvalue - half * half)
                cosine = growth * cos(omega * t) - 1.0
                sine = growth * sin(omega * t) / omega
                left = modes.vector[line, 0] * state.springs.before[first] / eigenvalue
                right = modes.vector[line, last - first] * state.springs.after[last] / eigenvalue
                for c in range(self.vectors):
                    q = (
                        -left * self.position[c, state.springs.previous[first]]
                        - right * self.position[c, state.springs.next[last]]
                    )
                    rate = 0.0
                    for i in range(first, last + 1):
                        factor = modes.vector[line, i - first]
                        q += factor * self.position[c, i]
                        rate += factor * self.velocity[c, i]
                    moved = q * cosine + (rate - half * q) * sine
                    rate = rate * cosine + (half * rate - eigenvalue * q) * sine
                    for i in range(first, last + 1):
                        factor = modes.vector[line, i - first]
                        self.moved[c, i] += factor * moved
                        self.sped[c, i] += factor * rate
        for c in range(self.vectors):
            for i in range(state.blocks):
                self.position[c, i] += self.moved[c, i]
                self.velocity[c, i] += self.sped[c, i]
