from burridge_knopoff.kernel.modes cimport Modes
from burridge_knopoff.kernel.piece cimport Piece
from burridge_knopoff.kernel.series cimport Series
from burridge_knopoff.kernel.state cimport State

cdef Py_ssize_t GROUP
cdef double NEGLIGIBLE
cdef double STRIDE

cdef class Tangent:
    cdef readonly Py_ssize_t blocks
    cdef readonly Py_ssize_t vectors
    cdef readonly Py_ssize_t lanes
    cdef double[:, ::1] position
    cdef double[:, ::1] velocity
    cdef double[:, ::1] lost
    cdef double[::1] deceleration
    cdef double[:, :, ::1] position_series
    cdef double[:, :, ::1] velocity_series
    cdef double[:, ::1] rate
    cdef Py_ssize_t rate_terms
    cdef double pace
    cdef double[::1] amplitude
    cdef double[::1] amplitude_rate
    cdef double[:, ::1] moved
    cdef double[:, ::1] sped

    cdef void forget_stops(self) noexcept nogil
    cdef void change(self, State state, Py_ssize_t block) noexcept nogil
    cdef void follow_modes(self, State state, Modes modes, double t) noexcept nogil
    cdef Py_ssize_t load_rates(
        self, State state, Piece piece, Series series, double length, double reach
    ) noexcept nogil
    cdef void move_rates(self, double t) noexcept nogil
    cdef void follow_series(self, State state, double t, double reach) noexcept nogil
    cdef Py_ssize_t _degree(self, Py_ssize_t order, double t, double reach) noexcept nogil
    cdef void _expand(self, State state, Py_ssize_t degree, Py_ssize_t group) noexcept nogil
