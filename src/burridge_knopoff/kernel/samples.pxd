from burridge_knopoff.kernel.lane_series cimport LaneSeries
from burridge_knopoff.kernel.lanes cimport Lanes
from burridge_knopoff.kernel.vector cimport Vectors, mask, vec

cdef class Samples:
    cdef double[::1] time
    cdef double[:, :, ::1] position
    cdef double[:, :, ::1] velocity
    cdef signed char[:, :, ::1] slip
    cdef Py_ssize_t[::1] next
    cdef Vectors target

    cdef void aim(self, int lane, Py_ssize_t k) noexcept nogil
    cdef void take(self, Lanes lanes, LaneSeries series, vec length, mask active) noexcept nogil
