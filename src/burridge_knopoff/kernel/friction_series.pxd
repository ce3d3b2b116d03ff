from burridge_knopoff.kernel.vector cimport Vectors, vec

cdef int LINEAR
cdef int MULTIPLY
cdef int RECIPROCAL
cdef int POWER
cdef int EXP
cdef int LOG

cdef class FrictionSeries:
    cdef readonly Py_ssize_t columns
    cdef readonly Py_ssize_t length
    cdef readonly Py_ssize_t operations
    cdef readonly bint affine
    cdef readonly bint exponential
    cdef readonly double constant
    cdef readonly double slope
    cdef Vectors register
    cdef Vectors weighted
    cdef Vectors inverse
    cdef Py_ssize_t result
    cdef int[::1] code
    cdef int[::1] first
    cdef int[::1] second
    cdef double[::1] alpha
    cdef double[::1] beta
    cdef double[::1] gamma
    cdef double[::1] reciprocal

    cdef void begin(self, Py_ssize_t column) noexcept nogil
    cdef vec shorten(self, vec t) noexcept nogil
    cdef void extend(self, Py_ssize_t n) noexcept nogil
    cdef void _add(self, Py_ssize_t r, Py_ssize_t n) noexcept nogil
    cdef void _divide(self, Py_ssize_t r, Py_ssize_t n) noexcept nogil
    cdef void _convolve(self, Py_ssize_t r, Py_ssize_t n) noexcept nogil
