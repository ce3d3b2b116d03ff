from burridge_knopoff.kernel.record cimport Record
from burridge_knopoff.kernel.state cimport State
from burridge_knopoff.kernel.tangent cimport Tangent

# The same as `running.status`.
cpdef enum Status:
    HALTED = -2
    FULL = -1
    COMPLETED = 0
    STEP_LIMIT = 1
    ACCUMULATING_EVENTS = 2
    DIVERGED = 3

cdef double ABSURD_SPEED
cdef int WORK_UNTIL_CHECK

cdef int check_signals() except -1 nogil

cdef class EventLog:
    cdef readonly double states_from
    cdef readonly bint keep
    cdef readonly bint stops_only
    cdef readonly Record earlier_events
    cdef readonly Record events
    cdef readonly long long count
    cdef double unit_start
    cdef long long unit_count
    cdef readonly long long rate_limit
    cdef readonly bint accumulating
    cdef int[::1] due
    cdef Tangent tangent

    cdef int restart(self) except -1
    cdef bint full(self) noexcept nogil
    cdef void change(self, State state, Py_ssize_t block, double clock) noexcept nogil
    cdef void settle(self, State state, double clock) noexcept nogil
