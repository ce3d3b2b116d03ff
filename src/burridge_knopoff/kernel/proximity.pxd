from burridge_knopoff.kernel.event_driven cimport EventDriven

cdef int UNDETERMINED

cdef class Proximity:
    cdef readonly EventDriven solver
    cdef readonly Py_ssize_t attractors
    cdef double[:, ::1] point
    cdef Py_ssize_t[::1] first
    cdef double[::1] radius
    cdef Py_ssize_t[::1] streak
    cdef Py_ssize_t[::1] returns

    cdef int _follow(self, double[::1] position, double[::1] velocity, int[::1] stuck) noexcept nogil
    cdef int _visit(self) noexcept nogil
    cdef bint _near(self, Py_ssize_t attractor) noexcept nogil
