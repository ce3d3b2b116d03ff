// Orthonormalisation of perturbations by the modified Gram-Schmidt method, of one run or of runs in the lanes of
// vectors.
#pragma once

#include <algorithm>
#include <type_traits>

#include "interrupt.h"
#include "vector.h"

namespace bk {

// A vector that has been shortened to less than this has been removed by stops: the remainder is rounding.
constexpr double LOST = 1e-13;

// Make perturbations orthonormal in the norm Σ (δx_i² + weight δU_i'²).
//
// T : double, or a vector with a run in each lane; where : the runs, others keep their perturbations
// x, u : block i of vector c is at c · stride + i
// kept : whether the vectors were orthonormal before; they are then lost from the first one on that has become short
// alive : number of vectors that are not lost; the others become 0
// length : the lengths of these vectors, orthogonal to those before
template <class T, class Where>
void gram_schmidt(T *x, T *u, size_t stride, int vectors, int blocks, T weight, Where where, bool kept, T &alive,
                  T *length, Watch &watch) {
    constexpr bool SINGLE = std::is_same_v<T, double>;
    const auto most_alive = [&] {
        if constexpr (SINGLE)
            return int(alive);
        else
            return int(largest_lane(alive));
    };
    const auto dot = [=](int c, int d) __attribute__((always_inline)) {
        const T *a = x + c * stride, *b = x + d * stride, *p = u + c * stride, *q = u + d * stride;
        T moved{}, sped{};
        for (int i = 0; i < blocks; i++) {
            moved += a[i] * b[i];
            sped += p[i] * q[i];
        }
        return moved + weight * sped;
    };
    const T zero{}, one = zero + 1.0;
    int most = most_alive();
    for (int c = 0; c < most; c++) length[c] = dot(c, c);
    for (int c = 0; c < vectors; c++) {
        watch.worked((long long)blocks * std::max(most - c, 1) / 8);
        T *a = x + c * stride, *p = u + c * stride, factor = where ? zero : one;
        if (c < most) {
            const T square = c > 0 ? dot(c, c) : length[0];
            if (kept) {
                const auto lost = (alive > double(c)) & (square <= (LOST * LOST) * length[c]);
                alive = lost ? zero + double(c) : alive;
                most = most_alive();
            }
            const auto here = where & (alive > double(c));
            length[c] = here ? root(square) : one;
            factor = here ? one / length[c] : factor;
        }
        for (int i = 0; i < blocks; i++) {
            a[i] *= factor;
            p[i] *= factor;
        }
        for (int d = c + 1; d < most; d++) {
            const T along = dot(c, d);
            T *b = x + d * stride, *q = u + d * stride;
            const auto own = where & (alive > double(d));
            for (int i = 0; i < blocks; i++) {
                const T y = b[i] - along * a[i], w = q[i] - along * p[i];
                // All vectors of a single run that come here are alive.
                if constexpr (SINGLE) {
                    b[i] = y;
                    q[i] = w;
                } else {
                    b[i] = own ? y : b[i];
                    q[i] = own ? w : q[i];
                }
            }
        }
    }
}

}  // namespace bk
