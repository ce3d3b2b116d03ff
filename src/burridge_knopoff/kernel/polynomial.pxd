cdef double evaluate(double[:, ::1] coefficient, Py_ssize_t column, Py_ssize_t degree, double t) noexcept nogil
cdef double evaluate_slope(double[:, ::1] coefficient, Py_ssize_t column, Py_ssize_t degree, double t) noexcept nogil

cdef class Polynomial:
    cdef readonly Py_ssize_t capacity
    cdef public Py_ssize_t degree
    cdef double[:, ::1] table
    cdef double[::1] coefficient

    cdef void derive(self, Py_ssize_t row) noexcept nogil
    cdef double at(self, Py_ssize_t row, double t) noexcept nogil
    cdef double value(self, double t) noexcept nogil
    cdef double slope(self, double t) noexcept nogil
    cdef Py_ssize_t deflate(self) noexcept nogil
    cdef void shift(self, double t) noexcept nogil
    cdef void negate(self) noexcept nogil
