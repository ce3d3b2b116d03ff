// Friction along the motion: the operations of a law's tape applied to Taylor series in lanes.
//
// A coefficient of a register follows from coefficients of the same and of lower order.
//
// Reference: A. Griewank and A. Walther, "Evaluating Derivatives" (SIAM 2008), Chapter 13.
#pragma once

#include "layout.h"

namespace bk {

// The sum of p_k q_(n−k) over k = 1 … n − 1. The coefficients that were computed last are added last.
template <class V>
BK_INLINE V inner(const V *p, const V *q, const int n) {
    if (n < 2) return V{};
    V first{}, second{}, third{}, fourth{};
    int k = n - 2;
    for (; k >= 5; k -= 4) {
        first += p[k] * q[n - k];
        second += p[k - 1] * q[n - k + 1];
        third += p[k - 2] * q[n - k + 2];
        fourth += p[k - 3] * q[n - k + 3];
    }
    for (; k >= 2; k--) first += p[k] * q[n - k];
    const V middle = (second + fourth) + (third + first);
    return n == 2 ? p[1] * q[1] : (middle + p[n - 1] * q[1]) + p[1] * q[n - 1];
}

// The sum of p_k q_(n−k) over k = 0 … n.
template <class V>
BK_INLINE V product(const V *p, const V *q, int n) {
    return n == 0 ? p[0] * q[0] : (inner(p, q, n) + p[0] * q[n]) + p[n] * q[0];
}

// Coefficients first … count − 1 of p², two at a time, since both read the same coefficients of p.
template <class V>
void squares(const V *p, V *out, int first, int count) {
    for (int m = first / 2; m < (count + 1) / 2; m++) {
        V even{}, odd{}, next = p[2 * m + 1];
        for (int k = 0; k < m; k++) {
            const V factor = p[2 * m - k];
            even += p[k] * factor;
            odd += p[k] * next;
            next = factor;
        }
        out[2 * m] = 2.0 * even + p[m] * p[m];
        if (2 * m + 1 < count) out[2 * m + 1] = 2.0 * (odd + p[m] * p[m + 1]);
    }
}

// The sum of (weight k + shift) p_k q_(n−k) over k = 0 … n.
template <class V, class Number>
BK_INLINE V weighted(const V *p, const V *q, int n, Number weight, Number shift) {
    V total{};
    for (int k = 0; k <= n; k++) total += (weight * double(k) + shift) * (p[k] * q[n - k]);
    return total;
}

// The series of a law's registers along the motion of `columns` vectors of blocks.
template <class L>
class FrictionSeries {
  public:
    static constexpr int ORDER = L::ORDER;
    using vec = typename L::vec;
    using mask = typename L::mask;
    using Rows = typename L::Rows;
    using Number = typename L::Number;

    std::vector<Operation<Number>> tape;

    // Limit on the change of the argument of an exponential in a series, per order. The coefficients y_n follow from
    // those of the argument, p_n, by n y_n = Σ k p_k y_(n−k). If Σ k |p_k| t^k is at most n/2, terms from n on are at
    // most half of the largest term before. Otherwise they may grow from negligible values after the last term, as
    // those of exp(−U'/w) do when a block slows down.
    static constexpr double FOLLOWED = 0.5;
    // Modulus of the argument beyond which an exponential, or its reciprocal, is below rounding.
    static constexpr double SPENT = 50.0;

    // law : a law with the same operations as those of all lanes
    FrictionSeries(const Law &law, int columns, int order = ORDER)
        : tape(law.tape.size()), law(law), length(order + 1) {
        widen(columns);
        for (int lane = 0; lane < (L::ONE_CLOCK ? 1 : L::LANES); lane++) place(law, lane);
    }

    // Set the constants of the law of a lane, or of all lanes.
    void place(const Law &law, int lane) {
        for (size_t r = 0; r < tape.size(); r++) {
            const Operation<double> &from = law.tape[r];
            Operation<Number> &to = tape[r];
            to.code = from.code;
            to.first = from.first;
            to.second = from.second;
            L::set_lane(to.alpha, lane, from.alpha);
            L::set_lane(to.beta, lane, from.beta);
            L::set_lane(to.gamma, lane, from.gamma);
        }
    }

    // Allocate more columns; the contents are lost.
    void widen(int count) {
        if (count <= columns) return;
        columns = count;
        const size_t registers = tape.size() + 1;
        coefficients = Rows(law.linear ? 0 : registers * columns * length);
        inverse = Rows(registers * columns);
        derivatives = Rows((law.value + 1) * columns);
    }

    BK_INLINE vec *row(int r, int column) { return coefficients.at((size_t(r) * columns + column) * length); }
    // Derivatives of all registers by the speed at the start of the series.
    BK_INLINE vec *slopes(int column) { return derivatives.at(size_t(column) * (law.value + 1)); }
    BK_INLINE vec friction(int column, int n) { return row(law.value, column)[n]; }

    // Fill coefficient 0 of all registers from a speed, and their derivatives by it.
    void start(int column, vec speed) {
        if (law.hyperbolic) {
            const vec line = tape[0].alpha * speed + tape[0].gamma;
            const vec inverse_line = 1.0 / line;
            row(1, column)[0] = line;
            row(2, column)[0] = inverse_line;
            slopes(column)[1] = tape[0].alpha - vec{};
            slopes(column)[2] = -((tape[0].alpha * inverse_line) * inverse_line);
            if (law.value == 3) {
                row(3, column)[0] = tape[2].alpha * inverse_line + tape[2].gamma;
                slopes(column)[3] = tape[2].alpha * slopes(column)[2];
            }
            return;
        }
        row(0, column)[0] = speed;
        fill(column, 0, 0, law.value);
        // In a series whose speed is linear in time, with slope 1, coefficients of first order are the derivatives.
        row(0, column)[1] = L::splat(1.0);
        fill(column, 1, 0, law.value);
        for (int r = 0; r <= law.value; r++) slopes(column)[r] = row(r, column)[1];
    }

    // Fill coefficient n of all registers except the part that follows from that of the speed, which `settle` adds.
    BK_INLINE vec prepare(int column, int n) {
        row(0, column)[n] = vec{};
        fill(column, n, 0, law.value);
        return row(law.value, column)[n];
    }

    // Add to coefficient n of all registers the part that follows from that of the speed, which enters linearly.
    BK_INLINE void settle(int column, int n, vec speed) {
        row(0, column)[n] = speed;
        for (int r = 1; r <= law.value; r++) row(r, column)[n] += slopes(column)[r] * speed;
    }

    // Fill coefficients first … count − 1 of the registers of the slope, when those of Φ are complete.
    void complete_slope(int column, int first, int count) {
        for (int r = law.value; r < law.slope; r++) {
            const Operation<Number> &o = tape[r];
            if (o.code == MULTIPLY && o.first == o.second) {
                squares(row(o.first, column), row(r + 1, column), first, count);
            } else if (o.code == LINEAR && o.second < 0) {
                const vec *p = row(o.first, column);
                vec *out = row(r + 1, column);
                for (int n = first; n < count; n++) out[n] = n == 0 ? o.alpha * p[n] + o.gamma : o.alpha * p[n] + 0.0;
            } else {
                for (int n = first; n < count; n++) fill(column, n, r, r + 1);
            }
        }
    }

    // Times, at most t, over which the series of every exponential are valid or the exponential is negligible. All
    // coefficients except the last have been filled. If the columns share one clock, their smallest time is used.
    vec shorten(vec t, int used) {
        const vec limit = L::splat(FOLLOWED * (length - 1));
        for (int r = 0; r < law.value; r++) {
            if (tape[r].code != EXP) continue;
            for (int c = 0; c < used; c++) {
                const vec *argument = row(tape[r].first, c);
                for (;;) {
                    vec total{};
                    for (int k = length - 2; k > 0; k--) total = (total + double(k) * magnitude(argument[k])) * t;
                    const mask far = (limit < total) & (magnitude(argument[0]) - SPENT < total);
                    if (!any(far)) break;
                    t = select(far, 0.5 * t, t);
                }
            }
        }
        return t;
    }

    // Fill coefficient n of the registers first + 1 … last, after those of lower order.
    void fill(int column, int n, int first, int last) {
        for (int r = first; r < last; r++) {
            const Operation<Number> &o = tape[r];
            const vec *p = row(o.first, column), *q = o.second >= 0 ? row(o.second, column) : nullptr;
            vec *out = row(r + 1, column), made;
            vec &reciprocal = inverse[size_t(r) * columns + column];
            if (o.code == LINEAR) {
                made = o.alpha * p[n];
                if (q) made += o.beta * q[n];
                if (n == 0) made += o.gamma;
            } else if (o.code == MULTIPLY) {
                made = product(p, q, n);
            } else if (n == 0) {
                if (o.code != EXP) reciprocal = 1.0 / p[0];
                made = o.code == RECIPROCAL ? reciprocal
                       : o.code == POWER
                           ? each(p[0], [&](double x, int lane) { return std::pow(x, L::of_lane(o.alpha, lane)); })
                       : o.code == EXP
                           ? each(p[0], [&](double x, int k) { return std::exp(std::min(x, L::of_lane(o.beta, k))); })
                           : each(p[0], [](double x, int) { return std::log(x); });
            } else if (o.code == RECIPROCAL) {
                made = -((inner(p, out, n) + p[n] * out[0]) * out[0]);
            } else if (o.code == POWER) {
                // n p_0 y_n is the sum of ((α + 1) k − n) p_k y_(n−k) over k = 1 … n.
                made = weighted(p + 1, out, n - 1, o.alpha + 1.0, o.alpha + 1.0 - double(n)) * (1.0 / n) * reciprocal;
            } else if (o.code == EXP) {
                // n y_n is the sum of k p_k y_(n−k) over k = 1 … n; 0 where the exponential is constant.
                made = weighted(p + 1, out, n - 1, 1.0, 1.0) * (1.0 / n);
                made = select(p[0] > o.beta, vec{}, made);
            } else {
                // n p_0 y_n is n p_n minus the sum of (n − k) p_k y_(n−k) over k = 1 … n − 1.
                made = p[n];
                if (n > 1) made -= weighted(p + 1, out + 1, n - 2, -1.0, n - 1.0) * (1.0 / n);
                made *= reciprocal;
            }
            out[n] = made;
        }
    }

    const Law &law;

  private:
    int columns = 0;
    const int length;
    Rows coefficients, inverse, derivatives;
};

}  // namespace bk
