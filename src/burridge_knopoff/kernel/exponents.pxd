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

    cdef void begin_within(self, State state, double clock, double length) noexcept nogil
    cdef void follow(self, State state, double clock, bint completed) noexcept nogil
    cdef Py_ssize_t stuck(self, State state) noexcept nogil
    cdef void _seed(self, State state, Py_ssize_t first) noexcept nogil
    cdef double _square(self, Py_ssize_t c) noexcept nogil
    cdef void _orthonormalise(self, bint kept, bint counted) noexcept nogil
    cdef void _collect(self, Py_ssize_t c) noexcept nogil
    cdef void _renew(self, State state, double clock, bint completed) noexcept nogil
