from burridge_knopoff.kernel.modes cimport Modes
from burridge_knopoff.kernel.piece cimport Piece
from burridge_knopoff.kernel.springs cimport Springs
from burridge_knopoff.kernel.state cimport State
from burridge_knopoff.kernel.vector cimport Vectors, vec

cdef double NEGLIGIBLE
cdef double STRIDE

cdef class Tangent:
    cdef readonly Py_ssize_t blocks
    cdef readonly Py_ssize_t vectors
    cdef readonly Py_ssize_t columns
    cdef Py_ssize_t length
    cdef Vectors positions
    cdef Vectors velocities
    cdef double[:, ::1] position
    cdef double[:, ::1] velocity
    cdef double[:, ::1] lost
    cdef double[::1] deceleration
    cdef Vectors series
    cdef Vectors row
    cdef Vectors rates
    cdef Py_ssize_t rate_terms
    cdef double pace
    cdef double[::1] reciprocal
    cdef double[::1] enough
    cdef double[:, ::1] moved
    cdef double[:, ::1] sped

    cdef void forget_stops(self) noexcept nogil
    cdef void change(self, State state, Py_ssize_t block) noexcept nogil
    cdef void follow_modes(self, State state, Modes modes, double t) noexcept nogil
    cdef Py_ssize_t load_rates(self, State state, Piece piece, double length, double reach) noexcept nogil
    cdef void move_rates(self, double t) noexcept nogil
    cdef void follow_series(self, State state, Piece piece, double t, double reach) noexcept nogil
    cdef void _follow(self, Springs springs, Piece piece, Py_ssize_t v, Py_ssize_t degree, double t) noexcept nogil
    cdef void _follow_three(self, Springs springs, vec stuck, Py_ssize_t v, Py_ssize_t degree, double t) noexcept nogil
    cdef Py_ssize_t _degree(self, Py_ssize_t order, double t, double reach) noexcept nogil
