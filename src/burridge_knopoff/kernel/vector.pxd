"""A vector of LANES doubles: every operation works on all lanes at once, and each lane as on a double alone.

To Cython a `vec` is a double, so that +, -, *, / read as usual, with a variable of type double too; a vector is made of a
literal by `splat` only. A `mask` tells lanes apart: it comes from a comparison, goes through &, | and ~, and `select`
takes lanes by it. LANES is 8 with AVX-512, 4 with AVX2, else 2, or what BK_LANES says at compilation. An operation that
has an instruction of its own gives what the plain loop beside it gives, bit for bit.
"""

cdef extern from *:
    """
    #ifndef BK_LANES
    #if defined(__AVX512DQ__)
    #define BK_LANES 8
    #elif defined(__AVX2__)
    #define BK_LANES 4
    #else
    #define BK_LANES 2
    #endif
    #endif
    #if BK_LANES == 8 && defined(__AVX512DQ__)
    #define BK_MM(name) _mm512_##name
    #elif BK_LANES == 4 && defined(__AVX2__)
    #define BK_MM(name) _mm256_##name
    #elif BK_LANES == 2 && defined(__SSE4_1__)
    #define BK_MM(name) _mm_##name
    #endif
    #ifdef BK_MM
    #include <immintrin.h>
    #endif
    #include <math.h>
    #include <stdint.h>
    #include <string.h>

    typedef double bk_vec __attribute__((vector_size(8 * BK_LANES), aligned(8)));
    typedef int64_t bk_index __attribute__((vector_size(8 * BK_LANES), aligned(8)));

    #define BK_INLINE static inline __attribute__((always_inline, unused))
    #define BK_EACH for (int lane = 0; lane < BK_LANES; lane++)

    BK_INLINE bk_vec bk_splat(double x) { return x - (bk_vec){0.0}; }
    BK_INLINE double bk_lane(bk_vec a, int lane) { return a[lane]; }
    BK_INLINE void bk_put(bk_vec *at, int lane, double x) { (*at)[lane] = x; }

    #if BK_LANES == 8 && defined(BK_MM)
    typedef __mmask8 bk_mask;
    #define BK_COMPARE(name, how, sign) \
        BK_INLINE bk_mask name(bk_vec a, bk_vec b) { return _mm512_cmp_pd_mask(a, b, how); }
    BK_INLINE bk_vec bk_select(bk_mask m, bk_vec a, bk_vec b) { return _mm512_mask_blend_pd(m, b, a); }
    BK_INLINE int bk_bits(bk_mask m) { return m; }
    BK_INLINE bk_mask bk_from_bits(int bits) { return (bk_mask)bits; }
    #else
    typedef bk_index bk_mask;
    #define BK_COMPARE(name, how, sign) \
        BK_INLINE bk_mask name(bk_vec a, bk_vec b) { return (bk_mask)(a sign b); }
    #ifdef BK_MM
    BK_INLINE bk_vec bk_select(bk_mask m, bk_vec a, bk_vec b) { return BK_MM(blendv_pd)(b, a, (bk_vec)m); }
    BK_INLINE int bk_bits(bk_mask m) { return BK_MM(movemask_pd)((bk_vec)m); }
    #else
    BK_INLINE bk_vec bk_select(bk_mask m, bk_vec a, bk_vec b) { return (bk_vec)((m & (bk_mask)a) | (~m & (bk_mask)b)); }
    BK_INLINE int bk_bits(bk_mask m) { int bits = 0; BK_EACH bits |= (int)(m[lane] & 1) << lane; return bits; }
    #endif
    BK_INLINE bk_mask bk_from_bits(int bits) { bk_mask m; BK_EACH m[lane] = -(int64_t)(bits >> lane & 1); return m; }
    #endif
    BK_COMPARE(bk_less, _CMP_LT_OQ, <)
    BK_COMPARE(bk_at_most, _CMP_LE_OQ, <=)
    BK_COMPARE(bk_equal, _CMP_EQ_OQ, ==)

    #ifdef BK_MM
    BK_INLINE bk_vec bk_min(bk_vec a, bk_vec b) { return BK_MM(min_pd)(a, b); }
    BK_INLINE bk_vec bk_max(bk_vec a, bk_vec b) { return BK_MM(max_pd)(a, b); }
    BK_INLINE bk_vec bk_sqrt(bk_vec a) { return BK_MM(sqrt_pd)(a); }
    #else
    BK_INLINE bk_vec bk_min(bk_vec a, bk_vec b) { BK_EACH a[lane] = a[lane] < b[lane] ? a[lane] : b[lane]; return a; }
    BK_INLINE bk_vec bk_max(bk_vec a, bk_vec b) { BK_EACH a[lane] = a[lane] > b[lane] ? a[lane] : b[lane]; return a; }
    BK_INLINE bk_vec bk_sqrt(bk_vec a) { BK_EACH a[lane] = sqrt(a[lane]); return a; }
    #endif
    BK_INLINE bk_vec bk_abs(bk_vec a) { return (bk_vec)((bk_index)a & INT64_MAX); }
    BK_INLINE bk_vec bk_exp(bk_vec a) { BK_EACH a[lane] = exp(a[lane]); return a; }
    BK_INLINE bk_vec bk_log(bk_vec a) { BK_EACH a[lane] = log(a[lane]); return a; }
    BK_INLINE bk_vec bk_pow(bk_vec a, double x) { BK_EACH a[lane] = pow(a[lane], x); return a; }

    /* Lane k of the result is lane index[k] of a, or index[k] - LANES of b. */
    BK_INLINE bk_vec bk_shuffle(bk_vec a, bk_vec b, bk_index index) {
    #ifdef __clang__
        double both[2 * BK_LANES];
        memcpy(both, &a, sizeof a);
        memcpy(both + BK_LANES, &b, sizeof b);
        BK_EACH a[lane] = both[index[lane]];
        return a;
    #else
        return __builtin_shuffle(a, b, index);
    #endif
    }
    /* Lane k of the result is lane k of at[index of lane k]. */
    BK_INLINE bk_vec bk_gather(const bk_vec *at, const Py_ssize_t *index) {
        bk_vec a;
        BK_EACH a[lane] = at[index[lane]][lane];
        return a;
    }
    /* The sum of a[k] b[n - k] over k = 1 ... n - 1. */
    BK_INLINE bk_vec bk_terms(const bk_vec *a, const bk_vec *b, Py_ssize_t n) {
        bk_vec first = bk_splat(0.0), second = first, third = first, fourth = first;
        Py_ssize_t k = n - 1;
        for (; k >= 4; k -= 4) {
            first += a[k] * b[n - k];
            second += a[k - 1] * b[n - k + 1];
            third += a[k - 2] * b[n - k + 2];
            fourth += a[k - 3] * b[n - k + 3];
        }
        for (; k >= 1; k--) first += a[k] * b[n - k];
        return (second + fourth) + (third + first);
    }
    /* The same with a case for each length of a series: a processor need not guess where a loop ends. */
    #define BK_CASE(m) case m: return bk_terms(a, b, m);
    BK_INLINE bk_vec bk_convolution(const bk_vec *a, const bk_vec *b, Py_ssize_t n) {
        switch (n) {
            BK_CASE(1) BK_CASE(2) BK_CASE(3) BK_CASE(4) BK_CASE(5) BK_CASE(6) BK_CASE(7) BK_CASE(8) BK_CASE(9)
            BK_CASE(10) BK_CASE(11) BK_CASE(12) BK_CASE(13) BK_CASE(14) BK_CASE(15) BK_CASE(16) BK_CASE(17) BK_CASE(18)
            BK_CASE(19) BK_CASE(20) BK_CASE(21) BK_CASE(22)
        }
        return bk_terms(a, b, n);
    }
    /* The exponent of a double as it is stored: 0 to 2047, x in [2^(e - 1023), 2^(e - 1022)). */
    BK_INLINE int bk_exponent(double x) { int64_t bits; memcpy(&bits, &x, 8); return (int)(bits >> 52 & 2047); }
    /* x 2^e, for numbers that are not subnormal. */
    BK_INLINE double bk_scale(double x, int e) {
        int64_t bits = (int64_t)(e + 1023) << 52; double power; memcpy(&power, &bits, 8); return x * power; }
    BK_INLINE bk_vec *bk_aligned(void *start) {
        return (bk_vec *)(((uintptr_t)start + sizeof(bk_vec) - 1) / sizeof(bk_vec) * sizeof(bk_vec));
    }
    """
    const int LANES "BK_LANES"
    ctypedef double vec "bk_vec"
    ctypedef long long mask "bk_mask"
    ctypedef long long index "bk_index"

    vec splat "bk_splat" (double x) noexcept nogil
    double lane_of "bk_lane" (vec a, int lane) noexcept nogil
    void put "bk_put" (vec *at, int lane, double x) noexcept nogil
    mask less "bk_less" (vec a, vec b) noexcept nogil
    mask at_most "bk_at_most" (vec a, vec b) noexcept nogil
    mask equal "bk_equal" (vec a, vec b) noexcept nogil
    vec select "bk_select" (mask where, vec a, vec b) noexcept nogil
    int bits "bk_bits" (mask where) noexcept nogil
    mask from_bits "bk_from_bits" (int bits) noexcept nogil
    vec least "bk_min" (vec a, vec b) noexcept nogil
    vec largest "bk_max" (vec a, vec b) noexcept nogil
    vec magnitude "bk_abs" (vec a) noexcept nogil
    vec root "bk_sqrt" (vec a) noexcept nogil
    vec each_exp "bk_exp" (vec a) noexcept nogil
    vec each_log "bk_log" (vec a) noexcept nogil
    vec each_power "bk_pow" (vec a, double exponent) noexcept nogil
    vec shuffle "bk_shuffle" (vec a, vec b, index lanes) noexcept nogil
    vec gather "bk_gather" (const vec *at, const Py_ssize_t *index) noexcept nogil
    vec convolution "bk_convolution" (const vec *a, const vec *b, Py_ssize_t n) noexcept nogil
    int exponent "bk_exponent" (double x) noexcept nogil
    double scale "bk_scale" (double x, int exponent) noexcept nogil
    vec *aligned "bk_aligned" (void *start) noexcept nogil


cdef class Vectors:
    cdef readonly Py_ssize_t count
    cdef double[::1] storage
    cdef vec *at

cdef inline double sum_of_eight(const double *part) noexcept nogil:
    return ((part[0] + part[1]) + (part[2] + part[3])) + ((part[4] + part[5]) + (part[6] + part[7]))

cdef inline vec value_at(const vec *term, Py_ssize_t stride, Py_ssize_t degree, double t) noexcept nogil:
    """Return the sum of term[k stride] t^k over k = 0 ... degree: even and odd powers apart, as each sum waits."""
    cdef Py_ssize_t k
    cdef double square = t * t
    cdef vec even = splat(0.0)
    cdef vec odd = even
    for k in range(degree // 2, 0, -1):
        even = (even + term[2 * k * stride]) * square
    for k in range((degree + 1) // 2 - 1, 0, -1):
        odd = (odd + term[(2 * k + 1) * stride]) * square
    if degree > 0:
        odd = odd + term[stride]
    return term[0] + (even + t * odd)
