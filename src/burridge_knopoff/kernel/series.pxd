from burridge_knopoff.kernel.piece cimport Piece
from burridge_knopoff.kernel.state cimport State
from burridge_knopoff.kernel.vector cimport Vectors

cdef int TRUNCATION
cdef double LONGEST

cdef class Series:
    cdef double[::1] reciprocal
    cdef Vectors moving
    cdef Vectors signed
    cdef Vectors damping
    cdef Vectors pressed
    cdef double[::1] last_root
    cdef double[::1] previous_root

    cdef double expand(self, State state, Piece piece) noexcept nogil
    cdef void _extend(self, State state, Piece piece) noexcept nogil
    cdef void _extend_one(self, State state, Piece piece) noexcept nogil
    cdef double _step(self, Piece piece) noexcept nogil

cdef double _length(double coefficient, double[::1] root, int power) noexcept nogil
