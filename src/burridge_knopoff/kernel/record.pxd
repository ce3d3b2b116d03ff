cdef class Record:
    cdef readonly Py_ssize_t width
    cdef readonly Py_ssize_t count
    cdef Py_ssize_t most
    cdef readonly bint full
    cdef double[::1] time
    cdef double[:, ::1] value

    cdef Py_ssize_t append(self, double time) noexcept nogil
    cdef int _grow(self) except -1 with gil
