from burridge_knopoff.kernel.clouds cimport Clouds
from burridge_knopoff.kernel.lane_events cimport LaneEvents
from burridge_knopoff.kernel.lane_series cimport LaneSeries
from burridge_knopoff.kernel.lanes cimport Lanes
from burridge_knopoff.kernel.samples cimport Samples
from burridge_knopoff.kernel.vector cimport Vectors, mask

cdef class Ensemble:
    cdef readonly Lanes lanes
    cdef readonly LaneSeries series
    cdef readonly LaneEvents events
    cdef readonly Py_ssize_t blocks
    cdef readonly long long rounds
    cdef mask active
    cdef mask fresh
    cdef double end
    cdef double[:, ::1] position
    cdef double[:, ::1] velocity
    cdef int[:, ::1] stuck
    cdef Py_ssize_t next_member
    cdef int[::1] status
    cdef double[::1] time
    cdef Clouds clouds
    cdef Py_ssize_t[:, ::1] streak
    cdef Py_ssize_t[::1] returns
    cdef Py_ssize_t[::1] section
    cdef Vectors slipped
    cdef double[::1] point
    cdef int[::1] label_of
    cdef Samples samples
    cdef long long[::1] event_count

    cdef void _refill(self) noexcept nogil
    cdef int _run(self) except -1 nogil
    cdef void _move(self) noexcept nogil
    cdef void _finish(self, mask where, int status) noexcept nogil
    cdef void _visit(self, Py_ssize_t cloud, mask where) noexcept nogil
