from burridge_knopoff.kernel.piece cimport Piece
from burridge_knopoff.kernel.vector cimport Vectors

cdef int NODES
cdef int MAXIMUM_DEPTH
cdef double RELATIVE_ERROR
cdef double ABSOLUTE_ERROR
cdef double THREE_POINT

cdef class Distance:
    cdef Py_ssize_t degree
    cdef double apart
    cdef double[::1] position
    cdef double[::1] velocity
    cdef double[::1] node
    cdef double[::1] weight
    cdef double[::1] last
    cdef double[::1] previous
    cdef Vectors nodes
    cdef Vectors value_at_node
    cdef double[::1] values
    cdef bint resting
    cdef bint short

    cdef void load(self, Piece piece) noexcept nogil
    cdef double value(self, double t) noexcept nogil
    cdef double integral(self, double start, double stop) noexcept nogil
    cdef double _panel(self, double start, double stop, int depth) noexcept nogil
