from burridge_knopoff.kernel.polynomial cimport Polynomial

cdef int MAXIMUM_DEPTH
cdef int NEWTON_ITERATIONS
cdef double NEGLIGIBLE
cdef double RESOLUTION
cdef int LOW_DEGREE

cdef class SearchedPolynomial(Polynomial):
    cdef double[:, ::1] bernstein
    cdef double[:, :, ::1] weight
    cdef double[::1] left
    cdef double[::1] right
    cdef double[::1] power
    cdef double[::1] term
    cdef double length
    cdef readonly double lowest
    cdef readonly double highest

    cdef double first_root(self, double length) noexcept nogil
    cdef double maximum(self, double length, double floor) noexcept nogil
    cdef void _measure(self, double length) noexcept nogil
    cdef Py_ssize_t _scale(self, double length) noexcept nogil
    cdef bint _concave(self, Py_ssize_t degree) noexcept nogil
    cdef void _bound(self, Py_ssize_t degree) noexcept nogil
    cdef void _convert(self, Py_ssize_t row, Py_ssize_t degree) noexcept nogil
    cdef void _split(self, Py_ssize_t top, Py_ssize_t degree) noexcept nogil
    cdef double _root_between(self, Py_ssize_t top, Py_ssize_t degree) noexcept nogil
    cdef double _peak_between(self, double low, double high) noexcept nogil
