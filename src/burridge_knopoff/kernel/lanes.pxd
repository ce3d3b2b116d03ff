from burridge_knopoff.kernel.friction_series cimport FrictionSeries
from burridge_knopoff.kernel.vector cimport Vectors, mask, vec

cdef class Lanes:
    cdef readonly Py_ssize_t blocks
    cdef readonly bint symmetric
    cdef readonly double v
    cdef readonly double static_friction
    cdef FrictionSeries friction
    cdef double[::1] diagonal
    cdef double[::1] left
    cdef double[::1] right
    cdef double[::1] threshold
    cdef double[::1] sliding_force
    cdef double[::1] slope
    cdef bint ring
    cdef Py_ssize_t[::1] lower
    cdef Py_ssize_t[::1] upper
    cdef Vectors position
    cdef Vectors velocity
    cdef Vectors acceleration
    cdef Vectors age
    cdef Vectors slip
    cdef Vectors touching
    cdef Vectors clock
    cdef Vectors clock_rest
    cdef Vectors count
    cdef Vectors unit_start
    cdef Vectors unit_count
    cdef double rate_limit
    cdef mask accumulating
    cdef Py_ssize_t[::1] member
    cdef int[::1] due
    cdef Py_ssize_t kept
    cdef double[:, ::1] event_time
    cdef int[:, ::1] event_block
    cdef int[:, ::1] event_kind

    cdef void place(self, int lane, Py_ssize_t member, double[::1] position, double[::1] velocity, int[::1] stuck) noexcept nogil
    cdef vec spring_force(self, Py_ssize_t i) noexcept nogil
    cdef vec force_rate(self, Py_ssize_t i) noexcept nogil
    cdef vec friction_of(self, Py_ssize_t i, vec speed) noexcept nogil
    cdef vec slip_acceleration(self, Py_ssize_t i, vec force) noexcept nogil
    cdef mask pending(self, Py_ssize_t i) noexcept nogil
    cdef void transition(self, Py_ssize_t i, mask where) noexcept nogil
    cdef void change(self, Py_ssize_t i, mask where) noexcept nogil
    cdef void settle(self, mask where) noexcept nogil
