// A connected set of blocks that slip so slowly that friction is linear in their speeds, while the driver and their
// neighbours rest. With C the dashpots and the slope of friction at rest, θ_i w_i Φ'(0) on the diagonal, the velocities
// obey
//
//     M u'' + C u' + K u = 0.
//
// Below critical damping a velocity changes sign, however late, and that block stops. Above it none does.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "exponents.h"

namespace bk {

struct SlowSlip {
    const std::vector<int> members;
    // The velocities, their rates, and the directions of slip.
    std::vector<double> u, rate, direction;

    // members : the blocks; row_of : their rows, −1 for all other blocks
    SlowSlip(const Springs &springs, const Law &law, const std::vector<int> &members, const std::vector<int> &row_of,
             Watch &watch)
        : members(members), u(members.size()), rate(members.size()), direction(members.size(), 1.0), springs(springs),
          law(law), row_of(row_of), watch(watch), size(int(members.size())),
          row(ORDER + 1, std::vector<double>(members.size())) {}

    // The largest |u|.
    double fastest() const {
        double largest = 0.0;
        for (double speed : u) largest = std::max(largest, std::fabs(speed));
        return largest;
    }

    // Advance to the first stop, or to `end` if that is earlier, and return this time; NEVER if no block ever stops.
    // The velocity of each block that stops is then 0. noise : velocities that are below 0 by less are 0 within
    // rounding
    double first_stop(double noise, double end) {
        if (size == 1) return stop_of_block(end);
        const double first = fastest();
        const double step = 1.0 / (springs.fastest + springs.damping_rate + std::fabs(law.rate) * springs.firmest);
        double time = 0.0;
        for (int count = 0; count < MOST_STEPS; count++) {
            watch.worked(size);
            if (!(fastest() > LEAST) || settles(fastest() < FADED * first)) break;
            expand();
            const double length = std::min(step, end - time), stop = stop_within(length, noise * fastest() / first);
            if (stop <= length) return time + stop;
            move(length);
            if (length == end - time) return end;
            time += step;
        }
        return NEVER;
    }

  private:
    static constexpr int ORDER = 16, MOST_STEPS = 20000;
    // Discriminants above minus this share are 0 within rounding: damping is critical.
    static constexpr double CRITICAL = 1e-14;
    // Rates in proportion to velocities within this are those of a single mode.
    static constexpr double SINGLE_MODE = 1e-3;
    // Speeds relative to the first below which modes that decay faster no longer decide, and the least speed.
    static constexpr double FADED = 1e-7, LEAST = 1e-280;
    const Springs &springs;
    const Law &law;
    const std::vector<int> &row_of;
    Watch &watch;
    const int size;
    std::vector<std::vector<double>> row;  // Taylor coefficients of the velocities

    double damping(int i) const {
        return springs.damping_diagonal[i] - springs.threshold[i] * (springs.weakening[i] * law.rate);
    }

    // (C y)_m and (K x)_m.
    double damped(const std::vector<double> &y, int m) const {
        const int i = members[m];
        double pull = 0.0;
        for (int64_t p = springs.start[i]; p < springs.start[i + 1]; p++)
            if (const int other = row_of[springs.neighbour[p]]; other >= 0) pull += springs.damping[p] * y[other];
        return damping(i) * y[m] - pull;
    }
    double pulled(const std::vector<double> &x, int m) const {
        const int i = members[m];
        double pull = 0.0;
        for (int64_t p = springs.start[i]; p < springs.start[i + 1]; p++)
            if (const int other = row_of[springs.neighbour[p]]; other >= 0) pull += springs.strength[p] * x[other];
        return springs.diagonal[i] * x[m] - pull;
    }

    // In closed form: the roots of m λ² + c λ + k are complex below critical damping.
    double stop_of_block(double end) {
        const int i = members[0];
        const double mass = springs.mass[i], half = 0.5 * damping(i) / mass,
                     excess = half * half - springs.diagonal[i] / mass;
        const bool oscillates = excess < -CRITICAL * half * half;
        const double root = oscillates ? std::sqrt(-excess) : std::sqrt(std::max(excess, 0.0));
        const double speed = std::max(direction[0] * u[0], 0.0), change = direction[0] * rate[0],
                     turned = change + half * speed;
        double time = NEVER;
        if (speed == 0.0 && change <= 0.0)
            time = 0.0;
        else if (oscillates)
            time = std::atan2(speed * root, -turned) / root;
        else if (turned < -root * speed)
            time = root > 0.0 ? std::atanh(-root * speed / turned) / root : -speed / turned;
        if (time <= end) {
            if (time < NEVER) u[0] = 0.0;
            return time;
        }
        const double size = std::exp(-half * end);
        const double even = oscillates ? std::cos(root * end) : std::cosh(root * end);
        const double odd = root == 0.0 ? end : (oscillates ? std::sin(root * end) : std::sinh(root * end)) / root;
        const double square = oscillates ? -root * root : root * root;
        u[0] = direction[0] * size * (speed * even + turned * odd);
        rate[0] = direction[0] * size * (turned * even + square * speed * odd) - half * u[0];
        return end;
    }

    // Whether no velocity changes its sign any more: all blocks slip on and slow down as a single mode that does not
    // oscillate, or they have faded and a mode of their shape does not oscillate.
    bool settles(bool faded) const {
        double uu = 0.0, uw = 0.0, ww = 0.0, c = 0.0, k = 0.0;
        for (int m = 0; m < size; m++) {
            const double mass = springs.mass[members[m]];
            if (!faded && !(direction[m] * u[m] > 0.0)) return false;
            uu += mass * u[m] * u[m];
            uw += mass * u[m] * rate[m];
            ww += mass * rate[m] * rate[m];
            c += u[m] * damped(u, m);
            k += u[m] * pulled(u, m);
        }
        const double excess = c * c - 4.0 * uu * k;
        if (!(excess >= -CRITICAL * c * c)) return false;
        const double single = ww * uu - uw * uw, most = 0.5 * (c + std::sqrt(std::max(excess, 0.0)));
        return faded || (single <= SINGLE_MODE * SINGLE_MODE * uw * uw && -uw < most);
    }

    // Taylor series of the velocities.
    void expand() {
        row[0] = u;
        row[1] = rate;
        for (int k = 0; k + 2 <= ORDER; k++)
            for (int m = 0; m < size; m++)
                row[k + 2][m] = -((k + 1) * damped(row[k + 1], m) + pulled(row[k], m)) /
                                (springs.mass[members[m]] * (k + 1) * (k + 2));
    }
    double speed_at(int m, double t) const {
        double value = 0.0;
        for (int k = ORDER; k >= 0; k--) value = value * t + row[k][m];
        return value;
    }
    double rate_at(int m, double t) const {
        double value = 0.0;
        for (int k = ORDER; k > 0; k--) value = value * t + k * row[k][m];
        return value;
    }
    void move(double t) {
        for (int m = 0; m < size; m++) {
            u[m] = speed_at(m, t);
            rate[m] = rate_at(m, t);
        }
    }

    // The first time up to `step` at which a velocity falls to 0, and the motion there; NEVER if there is none.
    double stop_within(double step, double noise) {
        std::vector<double> stop(size, NEVER);
        double first = NEVER;
        for (int m = 0; m < size; m++) {
            auto speed = [&](double t) { return direction[m] * speed_at(m, t); };
            auto change = [&](double t) { return direction[m] * rate_at(m, t); };
            // The lowest velocity: at the end, or where the rate changes sign.
            const double lowest = change(0.0) < 0.0 && change(step) > 0.0
                                      ? bisect(step, [&](double t) { return change(t) < 0.0; })
                                      : step;
            if (!(speed(lowest) < -noise)) continue;
            stop[m] = speed(0.0) > 0.0 ? bisect(lowest, [&](double t) { return speed(t) > 0.0; }) : 0.0;
            first = std::min(first, stop[m]);
        }
        if (first == NEVER) return NEVER;
        move(first);
        for (int m = 0; m < size; m++)
            if (stop[m] == first) u[m] = 0.0;
        return first;
    }

    // The last time below `end` before which a condition holds.
    template <class Condition>
    static double bisect(double end, Condition holds) {
        double before = 0.0;
        for (double middle; (middle = 0.5 * (before + end)) > before && middle < end;)
            (holds(middle) ? before : end) = middle;
        return end;
    }
};

}  // namespace bk
