from burridge_knopoff.kernel.bernstein cimport SearchedPolynomial
from burridge_knopoff.kernel.piece cimport Piece
from burridge_knopoff.kernel.state cimport State
from burridge_knopoff.kernel.vector cimport Vectors, mask, vec

# Degree of the bounds.
cdef enum:
    LOW = 8

cdef int GUESSES
cdef int ITERATIONS
cdef double CONVERGED
cdef double COMMON
cdef double NEAR
cdef double SEAM

cdef class EventSearch:
    cdef readonly double time
    cdef Py_ssize_t columns
    cdef SearchedPolynomial polynomial
    cdef Vectors gap
    cdef double[:, ::1] gap_table
    cdef Vectors scaled
    cdef Vectors quotient
    cdef Vectors corner
    cdef Vectors lowest
    cdef Vectors highest
    cdef Vectors root
    cdef double[::1] lowest_table
    cdef double[::1] highest_table
    cdef double[::1] root_table
    cdef Vectors fall
    cdef double[::1] fall_table
    cdef double[::1] inverse_binomial
    cdef double[::1] power
    cdef Py_ssize_t[::1] zeros
    cdef Py_ssize_t section
    cdef double least_section
    cdef int[::1] blocks_in

    cdef Py_ssize_t first(self, State state, Piece piece, double reach, int side) noexcept nogil
    cdef double crossing(self, double length) noexcept nogil
    cdef void _load(self, State state, Piece piece, int side) noexcept nogil
    cdef void _divide(self, Py_ssize_t column) noexcept nogil
    cdef bint _whole(self, State state, Piece piece, double reach) noexcept nogil
    cdef void _steepness(self, double length) noexcept nogil
    cdef void _measure(self, double length) noexcept nogil
    cdef void _scale(self, Py_ssize_t column) noexcept nogil
    cdef void _bound(self, Py_ssize_t column, mask near) noexcept nogil
    cdef vec _guess(self, double length) noexcept nogil
    cdef vec _refine(self, Py_ssize_t column, vec t, double reach, mask wanted) noexcept nogil
    cdef bint _proved(self, Piece piece, double t) noexcept nogil
    cdef Py_ssize_t _exhaustive(self, State state, Piece piece, double reach) noexcept nogil
