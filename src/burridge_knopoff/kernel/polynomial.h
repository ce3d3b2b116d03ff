// One polynomial over one piece of the motion: its first root and its maximum, which cannot be missed.
//
// A polynomial of degree n over [0, h] is a convex combination of its n + 1 Bernstein coefficients. Hence
//
// - no negative coefficient: no root, however close to zero the polynomial comes between its ends;
// - exactly one change of sign, and neither end coefficient 0: exactly one root, and it is simple (Descartes' rule);
// - otherwise the interval is halved (de Casteljau) and the left half is searched first.
//
// Intervals are excluded by the first statement only, so that grazing contacts are found anywhere in the piece. Only
// dips within rounding remain undecided: the halving ends at intervals of 4e-15 of their distance from the start of the
// piece. The conversion has positive weights of at most 1, so its error is a few ulp of the largest scaled coefficient.
//
// Reference: R. T. Farouki, "The Bernstein polynomial basis: a centennial retrospective", Comput. Aided Geom. Des. 29
// (2012) 379-419.
#pragma once

#include <algorithm>
#include <cmath>

namespace bk {

// The largest order of a series.
constexpr int MOST_TERMS = 24;

inline constexpr auto BINOMIAL = [] {
    struct {
        double row[MOST_TERMS + 1][MOST_TERMS + 1];
        constexpr const double *operator[](int n) const { return row[n]; }
    } table{};
    for (int n = 0; n <= MOST_TERMS; n++) {
        table.row[n][0] = 1.0;
        for (int k = 1; k <= n; k++) table.row[n][k] = table.row[n][k - 1] * (n - k + 1) / k;
    }
    return table;
}();

class Polynomial {
  public:
    double coefficient[MOST_TERMS + 1] = {};
    int degree = 0;

    // Take every stride-th number as the coefficients, lowest power first.
    void load(const double *terms, int stride, int order, double factor = 1.0) {
        degree = order;
        for (int k = 0; k <= order; k++) coefficient[k] = factor * terms[k * stride];
    }

    double value(double t) const { return evaluate<0>(t); }

    // Divide out the roots at t = 0 (leading coefficients that are exactly 0) and return how many there were. A
    // polynomial that is identically zero keeps one coefficient.
    int deflate() {
        int zeros = 0;
        while (zeros < degree && coefficient[zeros] == 0.0) zeros++;
        degree -= zeros;
        for (int k = 0; zeros > 0 && k <= degree; k++) coefficient[k] = coefficient[k + zeros];
        return zeros;
    }

    // Move the origin to t: the polynomial p(t + ·).
    void shift(double t) {
        for (int j = 0; j < degree; j++)
            for (int k = degree - 1; k >= j; k--) coefficient[k] += t * coefficient[k + 1];
    }

    void negate() {
        for (int k = 0; k <= degree; k++) coefficient[k] = -coefficient[k];
    }

    // The first t in [0, length] at which the polynomial becomes negative, or −1 if it never does. The value at 0 must
    // not be negative by more than rounding: for a negative one 0 is returned.
    double first_root(double length) {
        const int n = scale(length);
        if (lowest > 0.0) return -1.0;
        convert(n);
        int top = 0;
        left[0] = 0.0;
        right[0] = length;
        while (top >= 0) {
            const double *b = bernstein[top];
            Signs signs;
            for (int k = 0; k <= n; k++) signs.add(b[k]);
            if (signs.first < 0) return left[top];
            if (signs.changes == 0) {
                top--;
            } else if (signs.changes == 1 && b[0] > 0.0 && b[n] < 0.0) {
                return root_between(top, n);
            } else if (top >= DEPTH || right[top] - left[top] <= 4e-15 * right[top]) {
                if (signs.last < 0) return right[top];
                top--;
            } else {
                split(top++, n);
            }
        }
        return -1.0;
    }

    // The larger of floor and the maximum over [0, length].
    double maximum(double length, double floor) {
        const int n = scale(length);
        if (highest <= floor) return floor;
        if (is_concave(n)) return std::max(floor, peak_between(0.0, length));
        convert(n);
        int top = 0;
        left[0] = 0.0;
        right[0] = length;
        while (top >= 0) {
            const double *b = bernstein[top];
            floor = std::max({floor, b[0], b[n]});
            double most = floor;
            Signs signs;
            for (int k = 0; k <= n; k++) {
                most = std::max(most, b[k]);
                if (k < n) signs.add(b[k + 1] - b[k]);
            }
            if (most <= floor) {
                top--;
            } else if (signs.changes == 1 && signs.first > 0) {
                floor = std::max(floor, peak_between(left[top], right[top]));
                top--;
            } else if (signs.changes <= 1 || top >= DEPTH) {
                top--;
            } else {
                split(top++, n);
            }
        }
        return floor;
    }

  private:
    static constexpr int DEPTH = 48, ITERATIONS = 80;
    // Scaled coefficients below this share of the largest one cannot change a value of the polynomial.
    static constexpr double NEGLIGIBLE = 1e-19;
    // A root is found when Newton's method moves it by no more than half an ulp.
    static constexpr double RESOLUTION = 1.2e-16;

    // The signs of a sequence of numbers, zeros left out: the first, the last, and how often they change.
    struct Signs {
        int first = 0, last = 0, changes = 0;

        void add(double number) {
            const int sign = (number > 0.0) - (number < 0.0);
            if (sign == 0) return;
            if (first == 0) first = sign;
            changes += last == -sign;
            last = sign;
        }
    };

    double bernstein[DEPTH + 2][MOST_TERMS + 1], left[DEPTH + 2], right[DEPTH + 2];
    double lowest, highest;

    // The value, or a derivative, at t. Even and odd powers are summed separately, to be computed in parallel.
    template <int DERIVATIVE>
    double evaluate(double t) const {
        const double square = t * t;
        double even = 0.0, odd = 0.0;
        auto term = [this](int k) {
            double made = coefficient[k];
            for (int d = 0; d < DERIVATIVE; d++) made *= k - d;
            return made;
        };
        int k = degree;
        if (k >= DERIVATIVE && (k - DERIVATIVE) % 2 == 0) even = even * square + term(k--);
        for (; k > DERIVATIVE; k -= 2) {
            odd = odd * square + term(k);
            even = even * square + term(k - 1);
        }
        return even + t * odd;
    }

    // Put the terms at t = length into the first row and return the degree without negligible terms. `lowest` and
    // `highest` become bounds of the polynomial over [0, length]: the sums of its negative and of its positive terms.
    int scale(double length) {
        double power = length, negative = 0.0, positive = 0.0;
        int n = degree;
        bernstein[0][0] = coefficient[0];
        for (int k = 1; k <= n; k++, power *= length) {
            const double term = coefficient[k] * power;
            bernstein[0][k] = term;
            negative += std::min(term, 0.0);
            positive += std::max(term, 0.0);
        }
        lowest = coefficient[0] + negative;
        highest = coefficient[0] + positive;
        const double small = NEGLIGIBLE * (std::fabs(coefficient[0]) + positive - negative);
        while (n > 0 && std::fabs(bernstein[0][n]) <= small) n--;
        return n;
    }

    // Whether the scaled polynomial is certain to be concave everywhere in the interval.
    bool is_concave(int n) const {
        double bend = 2.0 * bernstein[0][2];
        for (int k = 3; k <= n; k++) bend += std::max(0.0, k * (k - 1.0) * bernstein[0][k]);
        return n >= 2 && bend < 0.0;
    }

    // Convert the scaled terms in the first row to Bernstein coefficients.
    void convert(int n) {
        double *b = bernstein[0];
        for (int k = 1; k <= n; k++) b[k] /= BINOMIAL[n][k];
        for (int j = 1; j <= n; j++)
            for (int k = n; k >= j; k--) b[k] += b[k - 1];
    }

    // Halve the interval in row top: its right half stays there, its left half goes to row top + 1.
    void split(int top, int n) {
        double *whole = bernstein[top], *half = bernstein[top + 1];
        const double middle = 0.5 * (left[top] + right[top]);
        left[top + 1] = left[top];
        right[top + 1] = middle;
        left[top] = middle;
        for (int j = 0; j <= n; j++) {
            half[j] = whole[0];
            for (int k = 0; k < n - j; k++) whole[k] = 0.5 * (whole[k] + whole[k + 1]);
        }
    }

    // The only root in the interval of row top, where the sign changes from + to −: Halley's method in a bracket.
    double root_between(int top, int n) const {
        double low = left[top], high = right[top];
        const double at_low = bernstein[top][0], at_high = bernstein[top][n];
        double t = low + (high - low) * at_low / (at_low - at_high);
        for (int i = 0; i < ITERATIONS; i++) {
            const double value = evaluate<0>(t), slope = evaluate<1>(t);
            if (value == 0.0) return t;
            (value > 0.0 ? low : high) = t;
            double change = 0.5 * (low + high) - t;
            if (slope < 0.0) {
                if (std::fabs(value) <= -RESOLUTION * slope * t) return t;
                const double step = -(value * slope) / (slope * slope - 0.5 * value * evaluate<2>(t));
                if (low < t + step && t + step < high) change = step;
            }
            t += change;
            if (std::fabs(change) <= RESOLUTION * t) return t;
        }
        return t;
    }

    // The maximum in [low, high], where the derivative changes its sign from + to − at most once.
    double peak_between(double low, double high) const {
        if (evaluate<1>(low) <= 0.0) return value(low);
        if (evaluate<1>(high) >= 0.0) return value(high);
        double t = 0.5 * (low + high);
        for (int i = 0; i < ITERATIONS; i++) {
            const double slope = evaluate<1>(t), curvature = evaluate<2>(t);
            (slope > 0.0 ? low : high) = t;
            double change = 0.5 * (low + high) - t;
            if (curvature < 0.0) {
                const double next = t - slope / curvature;
                if (low < next && next < high) change = next - t;
            }
            t += change;
            // The maximum is flat: half of the digits of its position give all digits of its value.
            if (std::fabs(change) <= 1e-9 * high) break;
        }
        return value(t);
    }
};

}  // namespace bk
