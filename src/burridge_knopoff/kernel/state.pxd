from burridge_knopoff.kernel.friction cimport Friction
from burridge_knopoff.kernel.springs cimport Springs
from burridge_knopoff.kernel.vector cimport Vectors

cdef double COINCIDENCE
cdef double YOUNG
cdef double LONG
cdef double AT_THRESHOLD

cdef class State:
    cdef readonly Py_ssize_t blocks
    cdef readonly Springs springs
    cdef readonly Friction friction
    cdef readonly int symmetric
    cdef readonly bint drops
    cdef readonly double v
    cdef Vectors positions
    cdef Vectors velocities
    cdef double[::1] position
    cdef double[::1] velocity
    cdef double[::1] acceleration
    cdef double[::1] age
    cdef int[::1] slip
    cdef int[::1] touching

    cdef void place(self, double[::1] position, double[::1] velocity, int[::1] stuck) noexcept nogil
    cdef double spring_force(self, Py_ssize_t i) noexcept nogil
    cdef double force_rate(self, Py_ssize_t i) noexcept nogil
    cdef double start_acceleration(self, Py_ssize_t i) noexcept nogil
    cdef bint at_threshold(self, Py_ssize_t i, double force) noexcept nogil
    cdef double slip_acceleration(self, Py_ssize_t i) noexcept nogil
    cdef int transition(self, Py_ssize_t i) noexcept nogil
    cdef int pending(self, Py_ssize_t i) noexcept nogil
