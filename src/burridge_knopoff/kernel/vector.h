// Vectors of doubles: every operation acts on all lanes at once, and on each lane as on a single double.
//
// WIDEST is 8 with AVX-512, 4 with AVX2, otherwise 2: the number of lanes of the processor. Operations with a special
// instruction give the same bits as the plain loop next to them, so that all widths give the same results.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

#ifndef BK_LANES
#if defined(__AVX512DQ__) && defined(__AVX512VL__)
#define BK_LANES 8
#elif defined(__AVX2__)
#define BK_LANES 4
#else
#define BK_LANES 2
#endif
#endif
#if defined(__SSE4_1__)
#include <immintrin.h>
#endif

#define BK_INLINE inline __attribute__((always_inline))

namespace bk {

constexpr int WIDEST = BK_LANES;

template <int COUNT>
struct VectorTypes;
#define BK_VECTOR_TYPES(COUNT)                                        \
    template <>                                                       \
    struct VectorTypes<COUNT> {                                       \
        typedef double vec __attribute__((vector_size(8 * COUNT)));   \
        typedef int64_t mask __attribute__((vector_size(8 * COUNT))); \
    };
BK_VECTOR_TYPES(2)
BK_VECTOR_TYPES(4)
BK_VECTOR_TYPES(8)

// Vectors of COUNT doubles.
template <int COUNT>
struct Lanes {
    static constexpr int LANES = COUNT;
    using vec = typename VectorTypes<COUNT>::vec;
    using mask = typename VectorTypes<COUNT>::mask;

    static BK_INLINE vec splat(double x) { return x - vec{}; }
    static BK_INLINE mask all_lanes(bool yes) { return mask{} - int64_t(yes); }
    // One bit for each lane.
    static BK_INLINE mask from_bits(int found) {
        mask where;
        for (int lane = 0; lane < COUNT; lane++) where[lane] = -int64_t(found >> lane & 1);
        return where;
    }
};

template <class V>
using Of = Lanes<sizeof(V) / 8>;

template <class V>
BK_INLINE V select(typename Of<V>::mask where, V a, V b) {
#if defined(__AVX2__)
    if constexpr (sizeof(V) == 32) return (V)_mm256_blendv_pd((__m256d)b, (__m256d)a, (__m256d)where);
#endif
    return where ? a : b;
}

template <class M>
BK_INLINE int bits(M where) {
#if defined(__AVX512DQ__) && defined(__AVX512VL__)
    if constexpr (sizeof(M) == 64) return _mm512_movepi64_mask((__m512i)where);
#endif
#if defined(__AVX2__)
    if constexpr (sizeof(M) == 32) return _mm256_movemask_pd((__m256d)where);
#endif
#if defined(__SSE4_1__)
    if constexpr (sizeof(M) == 16) return _mm_movemask_pd((__m128d)where);
#endif
    int found = 0;
    for (int lane = 0; lane < Of<M>::LANES; lane++) found |= int(where[lane] & 1) << lane;
    return found;
}
template <class M>
BK_INLINE bool any(M where) {
    return bits(where) != 0;
}

// An operation with a special instruction for every width, and its definition.
#if defined(__AVX512DQ__) && defined(__AVX512VL__)
#define BK_WIDE(name, ...) \
    if constexpr (sizeof(V) == 64) return _mm512_##name(__VA_ARGS__)
#else
#define BK_WIDE(name, ...)
#endif
#if defined(__AVX2__)
#define BK_MIDDLE(name, ...) \
    if constexpr (sizeof(V) == 32) return _mm256_##name(__VA_ARGS__)
#else
#define BK_MIDDLE(name, ...)
#endif
#if defined(__SSE4_1__)
#define BK_NARROW(name, ...) \
    if constexpr (sizeof(V) == 16) return _mm_##name(__VA_ARGS__)
#else
#define BK_NARROW(name, ...)
#endif
#define BK_INSTRUCTION(name, ...) \
    BK_WIDE(name, __VA_ARGS__);   \
    BK_MIDDLE(name, __VA_ARGS__); \
    BK_NARROW(name, __VA_ARGS__)

template <class V>
BK_INLINE V least(V a, V b) {
    BK_INSTRUCTION(min_pd, a, b);
    return a < b ? a : b;
}
template <class V>
BK_INLINE V largest(V a, V b) {
    BK_INSTRUCTION(max_pd, a, b);
    return a > b ? a : b;
}
BK_INLINE double root(double a) {
    return std::sqrt(a);
}
template <class V>
BK_INLINE V root(V a) {
    BK_INSTRUCTION(sqrt_pd, a);
    for (int lane = 0; lane < Of<V>::LANES; lane++) a[lane] = std::sqrt(a[lane]);
    return a;
}
template <class V>
BK_INLINE V magnitude(V a) {
    return (V)((typename Of<V>::mask)a & INT64_MAX);
}
// function(x, lane) of every lane.
template <class V, class F>
BK_INLINE V each(V a, F function) {
    for (int lane = 0; lane < Of<V>::LANES; lane++) a[lane] = function(a[lane], lane);
    return a;
}

// The smallest and the largest lane; the order of the lanes does not matter.
template <class V>
BK_INLINE double least_lane(V a) {
    double found = a[0];
    for (int lane = 1; lane < Of<V>::LANES; lane++) found = a[lane] < found ? a[lane] : found;
    return found;
}
template <class V>
BK_INLINE double largest_lane(V a) {
    double found = a[0];
    for (int lane = 1; lane < Of<V>::LANES; lane++) found = a[lane] > found ? a[lane] : found;
    return found;
}

// Lane k of the result is lane k − 1, or k + 1, of the row of lanes that consists of `left` and `right`.
#if defined(__clang__) || __GNUC__ >= 12
#define BK_SHUFFLE(...) return __builtin_shufflevector(left, right, __VA_ARGS__)
#else
#define BK_SHUFFLE(...) return __builtin_shuffle(left, right, typename Of<V>::mask{__VA_ARGS__})
#endif
template <class V>
BK_INLINE V before(V left, V right) {
    if constexpr (sizeof(V) == 64)
        BK_SHUFFLE(7, 8, 9, 10, 11, 12, 13, 14);
    else if constexpr (sizeof(V) == 32)
        BK_SHUFFLE(3, 4, 5, 6);
    else
        BK_SHUFFLE(1, 2);
}
template <class V>
BK_INLINE V after(V left, V right) {
    if constexpr (sizeof(V) == 64)
        BK_SHUFFLE(1, 2, 3, 4, 5, 6, 7, 8);
    else if constexpr (sizeof(V) == 32)
        BK_SHUFFLE(1, 2, 3, 4);
    else
        BK_SHUFFLE(1, 2);
}

// An array of vectors of COUNT lanes, set to 0.
template <int COUNT>
class Vectors {
  public:
    using vec = typename Lanes<COUNT>::vec;

    explicit Vectors(size_t count = 0) : storage(count, Vec{vec{}}) {}
    BK_INLINE vec &operator[](size_t k) { return storage[k].v; }
    BK_INLINE const vec &operator[](size_t k) const { return storage[k].v; }
    BK_INLINE vec *at(size_t k = 0) { return &storage[0].v + k; }
    BK_INLINE const vec *at(size_t k = 0) const { return &storage[0].v + k; }
    // A lane of the whole array. Rows of lanes are read from here: a vector's element has no address in every compiler.
    BK_INLINE double &lane(size_t k) { return reinterpret_cast<double *>(storage.data())[k]; }
    BK_INLINE const double &lane(size_t k) const { return reinterpret_cast<const double *>(storage.data())[k]; }
    size_t size() const { return storage.size(); }
    // Allocate this many vectors; the contents are lost.
    void reserve(size_t count) {
        if (storage.size() < count) storage.assign(count + count / 8, Vec{vec{}});
    }

  private:
    // A vector type itself loses its alignment as a template argument.
    struct alignas(8 * COUNT) Vec {
        vec v;
    };
    std::vector<Vec> storage;
};

// The exponent of a double as it is stored: 0 to 2047, x in [2^(e − 1023), 2^(e − 1022)).
BK_INLINE int exponent(double x) {
    int64_t stored;
    std::memcpy(&stored, &x, 8);
    return int(stored >> 52 & 2047);
}
}  // namespace bk
