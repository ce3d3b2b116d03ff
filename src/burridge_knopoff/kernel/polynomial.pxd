cdef int MAXIMUM_DEPTH
cdef int NEWTON_ITERATIONS
cdef double NEGLIGIBLE
cdef double RESOLUTION
cdef int LOW_DEGREE
cdef int GUESSES

cdef double evaluate(double[:, ::1] coefficient, Py_ssize_t column, Py_ssize_t degree, double t) noexcept nogil

cdef class Polynomial:
    cdef readonly Py_ssize_t capacity
    cdef public Py_ssize_t degree
    cdef double[::1] coefficient
    cdef double[:, ::1] bernstein
    cdef double[:, ::1] inverse_binomial
    cdef double[::1] left
    cdef double[::1] right
    cdef double[::1] power
    cdef double length
    cdef readonly double lowest
    cdef readonly double highest

    cdef double value(self, double t) noexcept nogil
    cdef double slope(self, double t) noexcept nogil
    cdef Py_ssize_t deflate(self) noexcept nogil
    cdef void shift(self, double t) noexcept nogil
    cdef void negate(self) noexcept nogil
    cdef double first_root(self, double length) noexcept nogil
    cdef double maximum(self, double length, double floor) noexcept nogil
    cdef Py_ssize_t _scale(self, double length) noexcept nogil
    cdef void _bound(self, Py_ssize_t degree) noexcept nogil
    cdef void _convert(self, Py_ssize_t row, Py_ssize_t degree) noexcept nogil
    cdef void _split(self, Py_ssize_t top, Py_ssize_t degree) noexcept nogil
    cdef double _root_between(self, Py_ssize_t top, Py_ssize_t degree) noexcept nogil
    cdef double _peak_between(self, double low, double high) noexcept nogil
