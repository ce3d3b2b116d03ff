from burridge_knopoff.kernel.state cimport State

cdef class Modes:
    cdef readonly Py_ssize_t blocks
    cdef double[::1] eigenvalue
    cdef double[:, ::1] vector
    cdef Py_ssize_t[:, ::1] vector_row
    cdef Py_ssize_t rows
    cdef Py_ssize_t[::1] first
    cdef Py_ssize_t[::1] last
    cdef Py_ssize_t[::1] row
    cdef Py_ssize_t runs
    cdef double rate
    cdef double[::1] origin
    cdef double[::1] origin_velocity
    cdef double[::1] drift
    cdef double[::1] amplitude
    cdef double[::1] amplitude_rate

    cdef void start(self, State state) noexcept nogil
    cdef void advance(self, State state, double t) noexcept nogil
    cdef Py_ssize_t _row(self, Py_ssize_t first, Py_ssize_t last, State state) noexcept nogil
    cpdef Py_ssize_t _solve(self, Py_ssize_t first, Py_ssize_t last, State state) noexcept
