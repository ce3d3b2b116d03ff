from burridge_knopoff.kernel.bernstein cimport SearchedPolynomial
from burridge_knopoff.kernel.lane_proof cimport LaneProof
from burridge_knopoff.kernel.lane_series cimport LaneSeries
from burridge_knopoff.kernel.lanes cimport Lanes
from burridge_knopoff.kernel.vector cimport Vectors, mask, vec

cdef int ITERATIONS
cdef double LAST_CHANGE
cdef double SHORTEST

cdef class LaneEvents:
    cdef readonly Py_ssize_t order
    cdef readonly long long searches
    cdef readonly LaneProof proof
    cdef Vectors time
    cdef Vectors block
    cdef Vectors candidate
    cdef Py_ssize_t[::1] offset
    cdef mask doubtful
    cdef SearchedPolynomial polynomial

    cdef void find(self, Lanes lanes, LaneSeries series, mask where) noexcept nogil
    cdef void begin_events(self, Lanes lanes, LaneSeries series) noexcept nogil
    cdef mask due(self, Lanes lanes, LaneSeries series, Py_ssize_t i, mask event) noexcept nogil
    cdef void _deflate(self, Lanes lanes, LaneSeries series, mask where) noexcept nogil
    cdef void _guess(self, LaneSeries series) noexcept nogil
    cdef void _improve(self, vec reach) noexcept nogil
    cdef void _solve(self, LaneSeries series, mask where) noexcept nogil
    cdef void _shorten(self, mask where) noexcept nogil
    cdef void _search(self, Lanes lanes, LaneSeries series, int lane) noexcept nogil
    cdef void _load(self, Lanes lanes, LaneSeries series, int lane, Py_ssize_t i, int side) noexcept nogil
