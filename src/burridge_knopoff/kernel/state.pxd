cdef double COINCIDENCE
cdef double YOUNG
cdef double LONG
cdef double AT_THRESHOLD

cdef class State:
    cdef readonly Py_ssize_t blocks
    cdef readonly int nonlinear
    cdef readonly int symmetric
    cdef readonly double a
    cdef readonly double v
    cdef readonly double sliding_friction
    cdef double[::1] stiffness
    cdef double[::1] position
    cdef double[::1] velocity
    cdef double[::1] acceleration
    cdef double[::1] age
    cdef int[::1] slip
    cdef int[::1] touching

    cdef void place(self, double[::1] position, double[::1] velocity, int[::1] stuck) noexcept nogil
    cdef double spring_force(self, Py_ssize_t i) noexcept nogil
    cdef double force_rate(self, Py_ssize_t i) noexcept nogil
    cdef double friction(self, double speed) noexcept nogil
    cdef double slip_acceleration(self, Py_ssize_t i) noexcept nogil
    cdef int transition(self, Py_ssize_t i) noexcept nogil
    cdef int pending(self, Py_ssize_t i) noexcept nogil
