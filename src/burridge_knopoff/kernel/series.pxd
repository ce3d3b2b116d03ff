from burridge_knopoff.kernel.piece cimport Piece
from burridge_knopoff.kernel.state cimport State

cdef double TRUNCATION

cdef class Series:
    cdef double[:, ::1] friction
    cdef double[::1] reciprocal
    cdef double step_power_last
    cdef double step_power_previous

    cdef double expand(self, State state, Piece piece) noexcept nogil
    cdef double _step(self, Piece piece) noexcept nogil
