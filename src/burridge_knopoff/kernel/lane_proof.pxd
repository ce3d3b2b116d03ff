from burridge_knopoff.kernel.lane_series cimport LaneSeries
from burridge_knopoff.kernel.lanes cimport Lanes
from burridge_knopoff.kernel.vector cimport Vectors, mask, vec

cdef double CLOSE
cdef double SIMULTANEOUS

cdef extern from *:
    """
    /* Degree of the guesses and of the proof. */
    #define BK_LOW 8
    /* Turn BK_LOW + 1 terms over their binomials into Bernstein coefficients; return the least but the last. */
    BK_INLINE bk_vec bk_to_bernstein(bk_vec *b) {
        bk_vec a[BK_LOW + 1];
        #pragma GCC unroll 16
        for (int k = 0; k <= BK_LOW; k++) a[k] = b[k];
        #pragma GCC unroll 16
        for (int j = 1; j <= BK_LOW; j++)
            #pragma GCC unroll 16
            for (int k = BK_LOW; k >= j; k--) a[k] += a[k - 1];
        bk_vec smallest = a[0];
        #pragma GCC unroll 16
        for (int k = 1; k < BK_LOW; k++) smallest = bk_min(a[k], smallest);
        #pragma GCC unroll 16
        for (int k = 0; k <= BK_LOW; k++) b[k] = a[k];
        return smallest;
    }
    """
    const int LOW "BK_LOW"
    vec to_bernstein "bk_to_bernstein" (vec *b) noexcept nogil

cdef class LaneProof:
    cdef readonly Py_ssize_t order
    cdef Vectors bernstein
    cdef Vectors weight
    cdef Vectors cut
    cdef mask failed
    cdef double[::1] inverse_binomial

    cdef void prove(self, Lanes lanes, LaneSeries series, vec block, vec *candidate, mask where) noexcept nogil
    cdef vec _bound(self, vec *c, Py_ssize_t stride, LaneSeries series) noexcept nogil
    cdef mask _falls(self, vec *c, Py_ssize_t stride, LaneSeries series) noexcept nogil
    cdef void _shorten(self, vec rest, mask failing) noexcept nogil
