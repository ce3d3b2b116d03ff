from burridge_knopoff.kernel.springs cimport Springs
from burridge_knopoff.kernel.polynomial cimport Polynomial
from burridge_knopoff.kernel.state cimport State
from burridge_knopoff.kernel.vector cimport Vectors

# Order of the Taylor series, even: a compiler unrolls what it knows the length of.
cdef enum:
    ORDER = 22

cdef double UNKNOWN
cdef double UNCERTAIN

cdef class Piece:
    cdef readonly Py_ssize_t blocks
    cdef readonly Py_ssize_t order
    cdef public Py_ssize_t degree
    cdef readonly Py_ssize_t columns
    cdef Vectors positions
    cdef Vectors velocities
    cdef Vectors forces
    cdef Vectors direction
    cdef Vectors stuck
    cdef double[::1] direction_table
    cdef double[::1] stuck_table
    cdef double[:, ::1] position
    cdef double[:, ::1] velocity
    cdef double[:, ::1] force

    cdef double[::1] highest
    cdef double crossing
    cdef Py_ssize_t section_begin
    cdef Py_ssize_t section_end

    cdef void fill_force(self, Springs springs, Py_ssize_t n) noexcept nogil
    cdef void move(self, State state, double t) noexcept nogil
    cdef double section_row(self, Py_ssize_t k) noexcept nogil
    cdef double section_rate(self, double v, double t) noexcept nogil
    cdef void load_speed(self, State state, Py_ssize_t i, Polynomial polynomial) noexcept nogil
    cdef void load_gap(self, State state, Py_ssize_t i, int side, Polynomial polynomial) noexcept nogil
