// Friction as the kernel computes it: the operations of a law's tape, on numbers and on Taylor series in lanes.
//
// An operation makes one register of earlier ones; register 0 is the slip speed. A coefficient of a register follows
// from coefficients of the same and of lower order.
//
// Reference: A. Griewank and A. Walther, "Evaluating Derivatives" (SIAM 2008), Chapter 13.
#pragma once

#include <algorithm>

#include "vector.h"

namespace bk {

// The codes of laws.tape.
enum Code { LINEAR, MULTIPLY, RECIPROCAL, POWER, EXP, LOG };

struct Operation {
    int code, first, second;
    double alpha, beta, gamma;
};

// Rounding of friction at rest.
constexpr double FRICTION_ROUNDING = 1e-12;

// One law: Φ is register `value` of the tape and its slope dΦ/dU' register `slope`.
struct Law {
    std::vector<Operation> tape;
    int value, slope;
    bool linear;       // Φ is the straight line Φ(0) − rate U'
    bool hyperbolic;   // Φ is a multiple of the reciprocal of a straight line, the most usual law
    bool exponential;  // an operation is EXP, see FrictionSeries::shorten
    double rate;       // −dΦ/dU' at rest
    double steepest;   // largest modulus of the slope that occurs
    double at_rest;    // Φ(0)

    double at(double speed) const {
        double number[64];
        number[0] = speed;
        for (int r = 0; r < value; r++) {
            const Operation &o = tape[r];
            const double p = number[o.first];
            double made;
            switch (o.code) {
                case LINEAR:
                    made = o.alpha * p + o.gamma;
                    if (o.second >= 0) made += o.beta * number[o.second];
                    break;
                case MULTIPLY:
                    made = p * number[o.second];
                    break;
                case RECIPROCAL:
                    made = 1.0 / p;
                    break;
                case POWER:
                    made = std::pow(p, o.alpha);
                    break;
                case EXP:
                    made = std::exp(p);
                    break;
                default:
                    made = std::log(p);
            }
            number[r + 1] = made;
        }
        return number[value];
    }

    void complete() {
        auto is = [&](int r, int code, int first) {
            return tape[r].code == code && tape[r].first == first && (code != LINEAR || tape[r].second < 0);
        };
        hyperbolic =
            (value == 2 || value == 3) && is(0, LINEAR, 0) && is(1, RECIPROCAL, 1) && (value == 2 || is(2, LINEAR, 2));
        exponential = std::any_of(tape.begin(), tape.begin() + value, [](auto &o) { return o.code == EXP; });
        at_rest = at(0.0);
        // Exactly 1: rounding must not give a block an acceleration at its start.
        if (std::fabs(at_rest - 1.0) < FRICTION_ROUNDING) at_rest = 1.0;
    }
};

// The sum of p_k q_(n−k) over k = 1 … n − 1; what was computed last comes last.
BK_INLINE vec inner(const vec *p, const vec *q, const int n) {
    if (n < 2) return vec{};
    vec first{}, second{}, third{}, fourth{};
    int k = n - 2;
    for (; k >= 5; k -= 4) {
        first += p[k] * q[n - k];
        second += p[k - 1] * q[n - k + 1];
        third += p[k - 2] * q[n - k + 2];
        fourth += p[k - 3] * q[n - k + 3];
    }
    for (; k >= 2; k--) first += p[k] * q[n - k];
    const vec middle = (second + fourth) + (third + first);
    return n == 2 ? p[1] * q[1] : (middle + p[n - 1] * q[1]) + p[1] * q[n - 1];
}

// The sum of p_k q_(n−k) over k = 0 … n.
BK_INLINE vec product(const vec *p, const vec *q, int n) {
    return n == 0 ? p[0] * q[0] : (inner(p, q, n) + p[0] * q[n]) + p[n] * q[0];
}

// Coefficients first … count − 1 of p², two at a time, which read the same coefficients of p.
inline void squares(const vec *p, vec *out, int first, int count) {
    for (int m = first / 2; m < (count + 1) / 2; m++) {
        vec even{}, odd{}, next = p[2 * m + 1];
        for (int k = 0; k < m; k++) {
            const vec factor = p[2 * m - k];
            even += p[k] * factor;
            odd += p[k] * next;
            next = factor;
        }
        out[2 * m] = 2.0 * even + p[m] * p[m];
        if (2 * m + 1 < count) out[2 * m + 1] = 2.0 * (odd + p[m] * p[m + 1]);
    }
}

// The sum of (weight k + shift) p_k q_(n−k) over k = 0 … n.
BK_INLINE vec weighted(const vec *p, const vec *q, int n, double weight, double shift) {
    vec total{};
    for (int k = 0; k <= n; k++) total += (weight * k + shift) * (p[k] * q[n - k]);
    return total;
}

// The series of a law's registers along the motion of `columns` vectors of blocks, to a given order.
class FrictionSeries {
  public:
    // How far the argument of an exponential may change in a series, per order. Its coefficients y_n follow from p_n,
    // those of the argument, by n y_n = Σ k p_k y_(n−k). Where Σ k |p_k| t^k is at most n/2, terms from n on are at
    // most half of the largest before. Else they grow unseen from next to nothing, as exp(−U'/w) does where a block
    // brakes.
    static constexpr double FOLLOWED = 0.5;
    // Modulus of the argument beyond which an exponential, or its reciprocal, is less than what rounding leaves.
    static constexpr double SPENT = 50.0;

    FrictionSeries(const Law &law, int columns, int order) : law(law), length(order + 1) { widen(columns); }

    // Make room for more columns; what was there is lost.
    void widen(int count) {
        if (count <= columns) return;
        columns = count;
        const size_t registers = law.tape.size() + 1;
        coefficients = Vectors(law.linear ? 0 : registers * columns * length);
        inverse = Vectors(registers * columns);
        derivatives = Vectors((law.value + 1) * columns);
    }

    BK_INLINE vec *row(int r, int column) { return coefficients.at((size_t(r) * columns + column) * length); }
    // Derivatives of all registers by the speed at the start of the series.
    BK_INLINE vec *slopes(int column) { return derivatives.at(size_t(column) * (law.value + 1)); }
    BK_INLINE vec friction(int column, int n) { return row(law.value, column)[n]; }

    // Fill coefficient 0 of all registers from a speed, and their derivatives by it.
    void start(int column, vec speed) {
        if (law.hyperbolic) {
            const vec line = law.tape[0].alpha * speed + law.tape[0].gamma;
            const vec inverse_line = 1.0 / line;
            row(1, column)[0] = line;
            row(2, column)[0] = inverse_line;
            slopes(column)[1] = splat(law.tape[0].alpha);
            slopes(column)[2] = -((law.tape[0].alpha * inverse_line) * inverse_line);
            if (law.value == 3) {
                row(3, column)[0] = law.tape[2].alpha * inverse_line + law.tape[2].gamma;
                slopes(column)[3] = law.tape[2].alpha * slopes(column)[2];
            }
            return;
        }
        row(0, column)[0] = speed;
        fill(column, 0, 0, law.value);
        // In a series whose speed is linear in time, with slope 1, coefficients of first order are the derivatives.
        row(0, column)[1] = splat(1.0);
        fill(column, 1, 0, law.value);
        for (int r = 0; r <= law.value; r++) slopes(column)[r] = row(r, column)[1];
    }

    // Fill coefficient n of all registers but for what follows from that of the speed, which `settle` adds.
    BK_INLINE vec prepare(int column, int n) {
        row(0, column)[n] = vec{};
        fill(column, n, 0, law.value);
        return row(law.value, column)[n];
    }

    // Add to coefficient n of all registers what follows from that of the speed, which enters linearly.
    BK_INLINE void settle(int column, int n, vec speed) {
        row(0, column)[n] = speed;
        for (int r = 1; r <= law.value; r++) row(r, column)[n] += slopes(column)[r] * speed;
    }

    // Fill coefficients first … count − 1 of the registers of the slope, when those of Φ are complete.
    void complete_slope(int column, int first, int count) {
        for (int r = law.value; r < law.slope; r++) {
            const Operation &o = law.tape[r];
            if (o.code == MULTIPLY && o.first == o.second) {
                squares(row(o.first, column), row(r + 1, column), first, count);
            } else if (o.code == LINEAR && o.second < 0) {
                const vec *p = row(o.first, column);
                vec *out = row(r + 1, column);
                for (int n = first; n < count; n++) out[n] = o.alpha * p[n] + (n == 0 ? o.gamma : 0.0);
            } else {
                for (int n = first; n < count; n++) fill(column, n, r, r + 1);
            }
        }
    }

    // Times, t or parts of them, over which every exponential is followed or spent; all coefficients but the last have
    // been filled. The least time of the columns counts where they share one clock.
    vec shorten(vec t, int used) {
        const vec limit = splat(FOLLOWED * (length - 1));
        for (int r = 0; r < law.value; r++) {
            if (law.tape[r].code != EXP) continue;
            for (int c = 0; c < used; c++) {
                const vec *argument = row(law.tape[r].first, c);
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

    // Fill coefficient n of the registers first + 1 … last; those of lower order are there already.
    void fill(int column, int n, int first, int last) {
        for (int r = first; r < last; r++) {
            const Operation &o = law.tape[r];
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
                       : o.code == POWER    ? each(p[0], [&](double x) { return std::pow(x, o.alpha); })
                       : o.code == EXP      ? each(p[0], [](double x) { return std::exp(x); })
                                            : each(p[0], [](double x) { return std::log(x); });
            } else if (o.code == RECIPROCAL) {
                made = -((inner(p, out, n) + p[n] * out[0]) * out[0]);
            } else if (o.code == POWER) {
                // n p_0 y_n is the sum of ((α + 1) k − n) p_k y_(n−k) over k = 1 … n.
                made = weighted(p + 1, out, n - 1, o.alpha + 1.0, o.alpha + 1.0 - n) * (1.0 / n) * reciprocal;
            } else if (o.code == EXP) {
                // n y_n is the sum of k p_k y_(n−k) over k = 1 … n.
                made = weighted(p + 1, out, n - 1, 1.0, 1.0) * (1.0 / n);
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
    int columns = 0, length;
    Vectors coefficients, inverse, derivatives;
};

}  // namespace bk
