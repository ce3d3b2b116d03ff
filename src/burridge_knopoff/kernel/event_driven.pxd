from burridge_knopoff.kernel.events cimport EventLog
from burridge_knopoff.kernel.exponents cimport Exponents
from burridge_knopoff.kernel.modes cimport Modes
from burridge_knopoff.kernel.observe cimport Observer
from burridge_knopoff.kernel.piece cimport Piece
from burridge_knopoff.kernel.search cimport EventSearch
from burridge_knopoff.kernel.series cimport Series
from burridge_knopoff.kernel.state cimport State
from burridge_knopoff.kernel.tangent cimport Tangent
from burridge_knopoff.kernel.tangent_modes cimport TangentModes
from burridge_knopoff.kernel.tangent_series cimport TangentSeries

cdef double LONGEST_FOLLOW

cdef class EventDriven:
    cdef readonly State state
    cdef readonly EventLog log
    cdef readonly Observer observer
    cdef public bint observing
    cdef readonly Exponents exponents
    cdef readonly Tangent tangent
    cdef TangentSeries tangent_series
    cdef TangentModes tangent_modes
    cdef double since_tangent
    cdef public Py_ssize_t halting_block
    cdef public double end
    cdef Series series
    cdef Piece piece
    cdef readonly EventSearch search
    cdef Modes modes
    cdef bint closed_form
    cdef readonly double clock
    cdef readonly double clock_rest
    cdef readonly long long steps
    cdef long long step_limit
    cdef double since_event
    cdef bint settled
    cdef double[:, ::1] mark_state
    cdef int[:, ::1] mark_slip
    cdef double[::1] mark_clock

    cdef int restart(self, double time) except -1
    cdef void _mark(self) noexcept nogil
    cdef int _run(self) except? -9 nogil
    cdef int _follow(self, double length, bint due) except -1 nogil
    cdef double _fastest(self) noexcept nogil
    cdef void _advance(self, double t) noexcept nogil
