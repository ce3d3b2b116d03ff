// Friction as the kernel computes it: the operations of a law's tape, applied to numbers.
//
// An operation computes one register from earlier ones; register 0 is the slip speed.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace bk {

// The codes of laws.tape.
enum Code { LINEAR, MULTIPLY, RECIPROCAL, POWER, EXP, LOG };

template <class Number>
struct Operation {
    int code, first, second;
    Number alpha, beta, gamma;
};

// Rounding of friction at rest.
constexpr double FRICTION_ROUNDING = 1e-12;

// One law: Φ is register `value` of the tape and its slope dΦ/dU' register `slope`.
struct Law {
    std::vector<Operation<double>> tape;
    int value, slope;
    bool linear;            // Φ is the straight line Φ(0) − rate U'
    bool hyperbolic;        // Φ is a constant plus a multiple of the reciprocal of a straight line, the most common law
    bool exponential;       // an operation is EXP, see FrictionSeries::shorten
    double rate;            // −dΦ/dU' at rest
    bool steepest_at_rest;  // whether the modulus of the slope is largest at rest
    double at_rest;         // Φ(0)

    double at(double speed) const {
        double number[64];
        number[0] = speed;
        for (int r = 0; r < value; r++) {
            const Operation<double> &o = tape[r];
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
                    made = std::exp(std::min(p, o.beta));
                    break;
                default:
                    made = std::log(p);
            }
            number[r + 1] = made;
        }
        return number[value];
    }

    // Whether both laws have the same operations, with any constants, and are bounded in the same way.
    bool is_like(const Law &other) const {
        if (value != other.value || slope != other.slope || linear != other.linear ||
            steepest_at_rest != other.steepest_at_rest || tape.size() != other.tape.size())
            return false;
        for (size_t r = 0; r < tape.size(); r++)
            if (tape[r].code != other.tape[r].code || tape[r].first != other.tape[r].first ||
                tape[r].second != other.tape[r].second)
                return false;
        return true;
    }

    void complete() {
        auto is = [&](int r, int code, int first) {
            return tape[r].code == code && tape[r].first == first && (code != LINEAR || tape[r].second < 0);
        };
        hyperbolic =
            (value == 2 || value == 3) && is(0, LINEAR, 0) && is(1, RECIPROCAL, 1) && (value == 2 || is(2, LINEAR, 2));
        exponential = std::any_of(tape.begin(), tape.begin() + value, [](auto &o) { return o.code == EXP; });
        at_rest = at(0.0);
        // Set to exactly 1: rounding must not accelerate a block at its start.
        if (std::fabs(at_rest - 1.0) < FRICTION_ROUNDING) at_rest = 1.0;
    }
};

}  // namespace bk
