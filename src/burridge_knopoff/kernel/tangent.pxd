from burridge_knopoff.kernel.state cimport State
from burridge_knopoff.kernel.vector cimport Vectors

cdef class Tangent:
    cdef readonly Py_ssize_t blocks
    cdef readonly Py_ssize_t vectors
    cdef readonly Py_ssize_t columns
    cdef readonly Py_ssize_t side
    cdef readonly Py_ssize_t packs
    cdef Vectors positions
    cdef Vectors velocities
    cdef double[:, ::1] position
    cdef double[:, ::1] velocity
    cdef double[:, ::1] lost
    cdef double[::1] deceleration

    cdef void forget_stops(self) noexcept nogil
    cdef void change(self, State state, Py_ssize_t block) noexcept nogil
