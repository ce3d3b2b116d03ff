from burridge_knopoff.kernel.events cimport EventLog
from burridge_knopoff.kernel.observe cimport Observer
from burridge_knopoff.kernel.piece cimport Piece
from burridge_knopoff.kernel.state cimport State

cdef int CUBIC

cdef class TimeStepping:
    cdef readonly State state
    cdef readonly EventLog log
    cdef readonly Observer observer
    cdef Piece piece
    cdef readonly double step
    cdef readonly double clock
    cdef readonly long long steps
    cdef long long earlier_steps
    cdef bint settled
    cdef double[:, ::1] speed
    cdef double[:, ::1] acceleration
    cdef double[::1] position
    cdef double[::1] velocity

    cdef int _run(self) except? -9 nogil
    cdef void _slope(self, Py_ssize_t stage) noexcept nogil
    cdef void _stage(self, Py_ssize_t stage, double step) noexcept nogil
    cdef void _interpolate(self, double step) noexcept nogil
