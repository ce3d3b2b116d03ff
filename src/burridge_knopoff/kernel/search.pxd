from burridge_knopoff.kernel.bernstein cimport SearchedPolynomial
from burridge_knopoff.kernel.bounds cimport Bounds
from burridge_knopoff.kernel.piece cimport Piece
from burridge_knopoff.kernel.state cimport State
from burridge_knopoff.kernel.vector cimport Vectors, mask, vec

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
    cdef Bounds bounds
    cdef Vectors gap
    cdef double[:, ::1] gap_table
    cdef Vectors root
    cdef double[::1] root_table
    cdef Py_ssize_t[::1] zeros
    cdef Py_ssize_t section
    cdef double least_section
    cdef int[::1] blocks_in

    cdef Py_ssize_t first(self, State state, Piece piece, double reach, int side) noexcept nogil
    cdef bint coincide(self, State state, Py_ssize_t block, Py_ssize_t other) noexcept nogil
    cdef double crossing(self, double length) noexcept nogil
    cdef void _load(self, State state, Piece piece, int side) noexcept nogil
    cdef void _divide(self, Py_ssize_t column) noexcept nogil
    cdef bint _whole(self, State state, Piece piece, double reach) noexcept nogil
    cdef vec _refine(self, Py_ssize_t column, vec t, double reach, mask wanted) noexcept nogil
    cdef bint _proved(self, Piece piece, double t) noexcept nogil
    cdef Py_ssize_t _exhaustive(self, State state, Piece piece, double reach) noexcept nogil
