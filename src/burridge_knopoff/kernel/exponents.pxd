from burridge_knopoff.kernel.state cimport State
from burridge_knopoff.kernel.tangent cimport Tangent

cdef double INTERVAL
cdef double LOST
cdef double NEVER

cdef class Exponents:
    cdef readonly Tangent tangent
    cdef double start_time
    cdef double[::1] edge
    cdef readonly bint running
    cdef readonly Py_ssize_t alive
    cdef readonly Py_ssize_t most_stuck
    cdef double due
    cdef Py_ssize_t batch
    cdef Py_ssize_t batches
    cdef double batch_start
    cdef double[::1] whole
    cdef double[::1] product
    cdef double[:, ::1] growth
    cdef double[::1] duration

    cdef int begin_within(self, State state, double clock, double length) except -1 nogil
    cdef int follow(self, State state, double clock, bint completed) except -1 nogil
    cdef Py_ssize_t stuck(self, State state) noexcept nogil
    cdef int _seed(self, State state, Py_ssize_t first) except -1 nogil
    cdef double _square(self, Py_ssize_t c) noexcept nogil
    cdef int _orthonormalise(self, bint kept, bint counted) except -1 nogil
    cdef void _collect(self, Py_ssize_t c) noexcept nogil
    cdef int _renew(self, State state, double clock, bint completed) except -1 nogil
