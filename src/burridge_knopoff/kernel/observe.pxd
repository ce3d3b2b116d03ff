from burridge_knopoff.kernel.distance cimport Distance
from burridge_knopoff.kernel.piece cimport Piece
from burridge_knopoff.kernel.bernstein cimport SearchedPolynomial
from burridge_knopoff.kernel.record cimport Record
from burridge_knopoff.kernel.state cimport State

cdef int TRANSIENT
cdef int WINDOW
cdef int UPWARD
cdef int DOWNWARD
cdef double NOTHING

cdef class Observer:
    cdef readonly bint section_only
    cdef public double begin
    cdef readonly Py_ssize_t section
    cdef readonly double transient
    cdef readonly double end
    cdef double[::1] edge
    cdef double[::1] batch_integral
    cdef double[::1] batch_rest
    cdef Py_ssize_t batch
    cdef readonly Py_ssize_t batches
    cdef readonly double[::1] distance_time
    cdef double[::1] distance_sample
    cdef Py_ssize_t next_distance
    cdef readonly double[::1] trajectory_time
    cdef double[:, ::1] trajectory_position
    cdef double[:, ::1] trajectory_velocity
    cdef Py_ssize_t next_trajectory
    cdef readonly Record crossings
    cdef int side
    cdef double[::1] highest_speed
    cdef double[::1] lowest_force
    cdef Distance distance
    cdef bint loaded
    cdef SearchedPolynomial polynomial

    cdef void observe(self, State state, Piece piece, double clock, double clock_rest, double length) noexcept nogil
    cdef void _load_distance(self, Piece piece) noexcept nogil
    cdef void _average(self, Piece piece, double clock, double clock_rest, double length) noexcept nogil
    cdef void _sample(self, Piece piece, double clock, double clock_rest, double length) noexcept nogil
    cdef void _cross(self, State state, Piece piece, double clock, double clock_rest, double length) noexcept nogil
    cdef void _turn(self, State state, Piece piece, double t, double clock, double clock_rest) noexcept nogil
    cdef void _extreme(self, State state, Piece piece, int stage, double start, double stop) noexcept nogil
