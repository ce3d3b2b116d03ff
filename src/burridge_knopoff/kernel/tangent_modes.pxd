from burridge_knopoff.kernel.modes cimport Modes
from burridge_knopoff.kernel.state cimport State

cdef class TangentModes:
    cdef Py_ssize_t vectors
    cdef double[:, ::1] position
    cdef double[:, ::1] velocity
    cdef double[:, ::1] moved
    cdef double[:, ::1] sped

    cdef void follow(self, State state, Modes modes, double t) noexcept nogil
