// The distance J(τ) between the two end blocks in phase space, over one piece: its values, its integral, and its last
// time at a level.
//
// J = sqrt(d² + d'²) with d = U_N − U_1 is analytic wherever it is not 0. The error of Gauss-Legendre quadrature with m
// nodes is about the Legendre coefficient of degree 2m. The coefficients fall geometrically, so the squares of the last
// two that the nodes resolve, divided by the first, estimate the error. A panel whose estimate is too large is halved:
// near a close approach J is the modulus of a complex polynomial with a root near the real axis, where panels become
// short.
//
// level² − J² is a polynomial, so that its last root cannot be missed, see polynomial.h.
//
// Reference: L. N. Trefethen, "Is Gauss quadrature better than Clenshaw-Curtis?", SIAM Rev. 50 (2008) 67-87.
#pragma once

#include "polynomial.h"
#include "vector.h"

namespace bk {

constexpr int NODES = 16;

// Nodes and weights on [−1, 1], and weights that project on P_15 and P_14.
struct GaussLegendre {
    double node[NODES], weight[NODES], last[NODES], previous[NODES];

    // P_n at x, and the two below.
    static void legendre(int n, long double x, long double p[3]) {
        p[2] = 0;
        p[1] = 1;
        p[0] = x;
        for (int k = 2; k <= n; k++) {
            p[2] = p[1];
            p[1] = p[0];
            p[0] = ((2 * k - 1) * x * p[1] - (k - 1) * p[2]) / k;
        }
    }

    // Half of the nodes are found by Newton's method in long double; the other half is their mirror image.
    GaussLegendre() {
        for (int j = 0; j < NODES / 2; j++) {
            long double x = -std::cos(3.14159265358979323846L * (j + 0.75L) / (NODES + 0.5L)), p[3], slope;
            for (int i = 0; i < 6; i++) {
                legendre(NODES, x, p);
                x -= p[0] * (1 - x * x) / (NODES * (p[1] - x * p[0]));
            }
            legendre(NODES, x, p);
            slope = NODES * (p[1] - x * p[0]) / (1 - x * x);
            const long double w = 2 / ((1 - x * x) * slope * slope);
            const int k = NODES - 1 - j;
            node[j] = double(x);
            node[k] = -node[j];
            weight[j] = weight[k] = double(w / 2);
            last[j] = double((NODES - 0.5L) * w * p[1]);
            last[k] = -last[j];
            previous[j] = previous[k] = double((NODES - 1.5L) * w * p[2]);
        }
    }
};
inline const GaussLegendre GAUSS;

// Limits on the estimated error of a panel, relative to the mean of J in it and absolute.
constexpr double RELATIVE_ERROR = 1e-15, ABSOLUTE_ERROR = 1e-17;

// d and d' at t, from 2n + 2 coefficients of each. Even and odd powers are summed separately, so that the two sums can
// be computed in parallel.
template <class T, class C>
BK_INLINE void distance_at(const C *position, const C *velocity, int n, T t, T &d, T &rate) {
    const T square = t * t, zero = t - t;
    T even = zero + position[2 * n], odd = zero + position[2 * n + 1];
    T even_rate = zero + velocity[2 * n], odd_rate = zero + velocity[2 * n + 1];
    for (int k = n - 1; k >= 0; k--) {
        even = even * square + position[2 * k];
        odd = odd * square + position[2 * k + 1];
        even_rate = even_rate * square + velocity[2 * k];
        odd_rate = odd_rate * square + velocity[2 * k + 1];
    }
    d = even + t * odd;
    rate = even_rate + t * odd_rate;
}

// A bound on J² from 0 to t ≥ 0, from 2n + 2 coefficients of d and d'.
template <class T>
BK_INLINE T distance_bound(const T *position, const T *velocity, int n, T t) {
    const T zero = t - t, square = t * t;
    T even = zero, odd = zero, even_rate = zero, odd_rate = zero;
    auto size = [&](T x) { return x < zero ? -x : x; };
    for (int k = n; k >= 0; k--) {
        even = even * square + size(position[2 * k]);
        odd = odd * square + size(position[2 * k + 1]);
        even_rate = even_rate * square + size(velocity[2 * k]);
        odd_rate = odd_rate * square + size(velocity[2 * k + 1]);
    }
    const T d = even + t * odd, rate = even_rate + t * odd_rate;
    return d * d + rate * rate;
}

template <class T>
BK_INLINE T weigh(const double *weight, const T *value) {
    T part[8];
    for (int j = 0; j < 8; j++) part[j] = weight[j] * value[j] + weight[j + 8] * value[j + 8];
    return ((part[0] + part[1]) + (part[2] + part[3])) + ((part[4] + part[5]) + (part[6] + part[7]));
}

// The mean of J over a panel from its values at the nodes, and the square of an estimate of its error.
template <class T>
BK_INLINE T mean_of(const T *value, T &error) {
    const T last = weigh(GAUSS.last, value), previous = weigh(GAUSS.previous, value);
    error = last * last + previous * previous;
    return weigh(GAUSS.weight, value);
}

class Distance {
  public:
    // d and d' on the present piece, lowest power first.
    double position[MOST_TERMS + 2] = {}, velocity[MOST_TERMS + 2] = {};
    int degree = 0;

    // Prepare for integrals, after d and d' have been filled.
    void begin(int order) {
        degree = order;
        position[order + 1] = velocity[order + 1] = 0.0;
        resting = velocity[0] == 0.0;
        for (int k = 1; resting && k <= order; k++) resting = position[k] == 0.0 && velocity[k] == 0.0;
    }

    double value(double t) const {
        double d, rate;
        distance_at(position, velocity, degree / 2, t, d, rate);
        return std::sqrt(d * d + rate * rate);
    }

    // A bound on J from 0 to t.
    double bound(double t) const { return std::sqrt(distance_bound(position, velocity, degree / 2, t)); }

    // The last time of a part of the piece at which J is at least at a level, −1 if it never is. It is below at the end
    // of the part.
    double last_at(double level, double from, double to) const {
        Polynomial below;
        // The terms of higher degrees are below the rounding error, as in the series of d.
        below.degree = std::min(2 * degree, MOST_TERMS);
        for (int k = 0; k <= below.degree; k++)
            for (int j = std::max(0, k - degree); j <= std::min(k, degree); j++)
                below.coefficient[k] -= position[j] * position[k - j] + velocity[j] * velocity[k - j];
        below.coefficient[0] += level * level;
        // Backwards from the end.
        below.shift(to);
        for (int k = 1; k <= below.degree; k += 2) below.coefficient[k] = -below.coefficient[k];
        const double back = below.first_root(to - from);
        return back < 0.0 ? -1.0 : to - back;
    }

    // The integral of J from start to stop, times of the piece.
    double integral(double start, double stop) const {
        if (resting) return (stop - start) * value(0.0);
        if (degree > 3) return panel(start, stop, 0);
        // The three-point rule, enough for the cubic pieces of a time-stepping solver, whose own error is larger.
        const double middle = 0.5 * (start + stop), half = 0.5 * (stop - start), aside = half * 0.7745966692414834;
        return half *
               (5.0 * value(middle - aside) / 9.0 + 8.0 * value(middle) / 9.0 + 5.0 * value(middle + aside) / 9.0);
    }

  private:
    using vec = Lanes<WIDEST>::vec;
    static constexpr int DEEPEST = 40;
    bool resting = false;

    double panel(double start, double stop, int depth) const {
        const double middle = 0.5 * (start + stop), half = 0.5 * (stop - start);
        alignas(64) double value[NODES];
        for (int j = 0; j < NODES; j += WIDEST) {
            vec node, d, rate;
            std::memcpy(&node, GAUSS.node + j, sizeof node);
            distance_at<vec>(position, velocity, degree / 2, middle + half * node, d, rate);
            const vec made = root(d * d + rate * rate);
            std::memcpy(value + j, &made, sizeof made);
        }
        double error;
        const double mean = mean_of(value, error);
        if (error <= (RELATIVE_ERROR * mean + ABSOLUTE_ERROR) * mean || depth >= DEEPEST) return 2.0 * half * mean;
        return panel(start, middle, depth + 1) + panel(middle, stop, depth + 1);
    }
};

}  // namespace bk
