from burridge_knopoff.kernel.vector cimport Vectors, mask, vec

# Degree of the bounds.
cdef enum:
    LOW = 8

cdef class Bounds:
    cdef Vectors scaled
    cdef Vectors quotient
    cdef Vectors corner
    cdef Vectors lowest
    cdef Vectors highest
    cdef Vectors fall
    cdef double[::1] lowest_table
    cdef double[::1] highest_table
    cdef double[::1] fall_table
    cdef double[::1] power
    cdef double[::1] inverse_binomial

    cdef void measure(self, double length) noexcept nogil
    cdef void scale(self, const vec *terms, Py_ssize_t stride) noexcept nogil
    cdef void bound(self, Py_ssize_t column, mask near) noexcept nogil
    cdef vec guess(self, double length) noexcept nogil
    cdef void steepness(self, double length) noexcept nogil
