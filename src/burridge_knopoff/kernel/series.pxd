from burridge_knopoff.kernel.piece cimport Piece
from burridge_knopoff.kernel.state cimport State

cdef double TRUNCATION
cdef double SPLITTER

cdef class Series:
    cdef double[:, ::1] friction
    cdef double[:, ::1] speed
    cdef double[::1] slipping
    cdef double[::1] reciprocal
    cdef double step_power_last
    cdef double step_power_previous

    cdef double expand(self, State state, Piece piece) noexcept nogil
    cdef void _start_friction(self, State state, Piece piece) noexcept nogil
    cdef void _nonlinear(self, State state, Piece piece, Py_ssize_t n) noexcept nogil
    cdef double _step(self, Piece piece) noexcept nogil
