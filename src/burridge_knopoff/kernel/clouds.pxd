cdef int GROUP
cdef double WIDER

cdef class Clouds:
    cdef readonly Py_ssize_t count
    cdef readonly Py_ssize_t width
    cdef double[:, ::1] point
    cdef double[:, ::1] low
    cdef double[:, ::1] high
    cdef Py_ssize_t[::1] first
    cdef Py_ssize_t[::1] first_group
    cdef Py_ssize_t[::1] sorted_by
    cdef double[::1] radius

    cdef bint near(self, Py_ssize_t cloud, double[::1] state) noexcept nogil
    cdef bint _close(self, double[:, ::1] low, double[:, ::1] high, Py_ssize_t k, double[::1] state, double radius) noexcept nogil
