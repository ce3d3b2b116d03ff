from burridge_knopoff.kernel.lanes cimport Lanes
from burridge_knopoff.kernel.vector cimport Vectors, mask, vec

cdef double TRUNCATION
cdef double RATIO
cdef double LONGEST

cdef class LaneSeries:
    cdef readonly Py_ssize_t blocks
    cdef readonly Py_ssize_t order
    cdef readonly Py_ssize_t width
    cdef Vectors position
    cdef Vectors velocity
    cdef Vectors gap
    cdef Vectors slipping
    cdef Vectors stuck
    cdef Vectors grip
    cdef Vectors power
    cdef Vectors reach
    cdef double[::1] reciprocal
    cdef double[::1] step_of_last
    cdef double[::1] step_of_previous

    cdef void expand(self, Lanes lanes) noexcept nogil
    cdef void _begin(self, Lanes lanes) noexcept nogil
    cdef void _close_ring(self, Lanes lanes, Py_ssize_t n) noexcept nogil
    cdef void _affine_row(self, Lanes lanes, Py_ssize_t n) noexcept nogil
    cdef void _row(self, Lanes lanes, Py_ssize_t n) noexcept nogil
    cdef void _last_row(self, Lanes lanes) noexcept nogil
    cdef void _bound(self) noexcept nogil
    cdef void raise_powers(self, vec t) noexcept nogil
    cdef void move(self, Lanes lanes, vec t, mask where) noexcept nogil
    cdef vec at_time(self, Vectors series, Py_ssize_t i, vec t) noexcept nogil
