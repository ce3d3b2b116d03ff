// A vector of LANES doubles: every operation works on all lanes at once, and on each lane as on a double alone.
//
// LANES is 8 with AVX-512, 4 with AVX2, else 2. An operation that has an instruction of its own gives what the plain
// loop beside it gives, bit for bit. So all widths give the same numbers.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

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

#define BK_INLINE inline __attribute__((always_inline))

namespace bk {

constexpr int LANES = BK_LANES;
typedef double vec __attribute__((vector_size(8 * BK_LANES)));
typedef int64_t mask __attribute__((vector_size(8 * BK_LANES)));

// A vector as the element of a container: a vector type itself loses its alignment as a template argument.
struct alignas(8 * BK_LANES) Vec {
    vec v;
};

BK_INLINE vec splat(double x) {
    return x - vec{};
}
BK_INLINE mask all_lanes(bool yes) {
    return mask{} - int64_t(yes);
}
BK_INLINE vec select(mask where, vec a, vec b) {
#if BK_LANES == 4 && defined(BK_MM)
    return _mm256_blendv_pd(b, a, (vec)where);
#else
    return where ? a : b;
#endif
}

// One bit for each lane.
BK_INLINE int bits(mask where) {
#if BK_LANES == 8 && defined(BK_MM)
    return _mm512_movepi64_mask((__m512i)where);
#elif defined(BK_MM)
    return BK_MM(movemask_pd)((vec)where);
#else
    int found = 0;
    for (int lane = 0; lane < LANES; lane++) found |= int(where[lane] & 1) << lane;
    return found;
#endif
}
BK_INLINE mask from_bits(int found) {
    mask where;
    for (int lane = 0; lane < LANES; lane++) where[lane] = -int64_t(found >> lane & 1);
    return where;
}
BK_INLINE bool any(mask where) {
    return bits(where) != 0;
}

BK_INLINE vec least(vec a, vec b) {
#ifdef BK_MM
    return BK_MM(min_pd)(a, b);
#else
    return a < b ? a : b;
#endif
}
BK_INLINE vec largest(vec a, vec b) {
#ifdef BK_MM
    return BK_MM(max_pd)(a, b);
#else
    return a > b ? a : b;
#endif
}
BK_INLINE vec root(vec a) {
#ifdef BK_MM
    return BK_MM(sqrt_pd)(a);
#else
    for (int lane = 0; lane < LANES; lane++) a[lane] = std::sqrt(a[lane]);
    return a;
#endif
}
BK_INLINE vec magnitude(vec a) {
    return (vec)((mask)a & INT64_MAX);
}
template <class F>
BK_INLINE vec each(vec a, F function) {
    for (int lane = 0; lane < LANES; lane++) a[lane] = function(a[lane]);
    return a;
}

// The least and the largest lane; the order of the lanes does not matter.
BK_INLINE double least_lane(vec a) {
    double found = a[0];
    for (int lane = 1; lane < LANES; lane++) found = a[lane] < found ? a[lane] : found;
    return found;
}
BK_INLINE double largest_lane(vec a) {
    double found = a[0];
    for (int lane = 1; lane < LANES; lane++) found = a[lane] > found ? a[lane] : found;
    return found;
}

// Lane k of the result is lane k − 1 of a row of lanes that goes from `left` on to `right`; or lane k + 1.
#if BK_LANES == 8
#define BK_BEFORE 7, 8, 9, 10, 11, 12, 13, 14
#define BK_AFTER 1, 2, 3, 4, 5, 6, 7, 8
#elif BK_LANES == 4
#define BK_BEFORE 3, 4, 5, 6
#define BK_AFTER 1, 2, 3, 4
#else
#define BK_BEFORE 1, 2
#define BK_AFTER 1, 2
#endif
#if defined(__clang__) || __GNUC__ >= 12
BK_INLINE vec before(vec left, vec right) {
    return __builtin_shufflevector(left, right, BK_BEFORE);
}
BK_INLINE vec after(vec left, vec right) {
    return __builtin_shufflevector(left, right, BK_AFTER);
}
#else
BK_INLINE vec before(vec left, vec right) {
    return __builtin_shuffle(left, right, mask{BK_BEFORE});
}
BK_INLINE vec after(vec left, vec right) {
    return __builtin_shuffle(left, right, mask{BK_AFTER});
}
#endif

// An array of vectors, set to 0.
class Vectors {
  public:
    explicit Vectors(size_t count = 0) : storage(count, Vec{vec{}}) {}
    BK_INLINE vec &operator[](size_t k) { return storage[k].v; }
    BK_INLINE const vec &operator[](size_t k) const { return storage[k].v; }
    BK_INLINE vec *at(size_t k = 0) { return &storage[0].v + k; }
    BK_INLINE const vec *at(size_t k = 0) const { return &storage[0].v + k; }
    // A lane of the whole array. Rows of lanes are read from here: a vector's element has no address in every compiler.
    BK_INLINE double &lane(size_t k) { return reinterpret_cast<double *>(storage.data())[k]; }
    BK_INLINE const double &lane(size_t k) const { return reinterpret_cast<const double *>(storage.data())[k]; }
    size_t size() const { return storage.size(); }
    // Make room for as many; what was there is lost.
    void reserve(size_t count) {
        if (storage.size() < count) storage.assign(count + count / 2, Vec{vec{}});
    }

  private:
    std::vector<Vec> storage;
};

// The exponent of a double as it is stored: 0 to 2047, x in [2^(e − 1023), 2^(e − 1022)).
BK_INLINE int exponent(double x) {
    int64_t stored;
    std::memcpy(&stored, &x, 8);
    return int(stored >> 52 & 2047);
}
// x 2^e, for numbers that are not subnormal.
BK_INLINE double scaled_by_two(double x, int e) {
    int64_t stored = int64_t(e + 1023) << 52;
    double power;
    std::memcpy(&power, &stored, 8);
    return x * power;
}

}  // namespace bk
