// Normal modes of the slipping blocks: the paper's mapping between events, in closed form.
//
// The friction is a straight line, θ Φ = f − a U' with one threshold for all blocks, and the chain has open ends,
// springs of equal strength c between blocks, and unit masses. Stuck blocks divide it into runs of consecutive slipping
// blocks that are independent of each other. In a run
//
//     x'' = −K x + a x' + b − g v τ,        b_i = c Σ x_j(0) over stuck neighbours j (+ 2f where i slips backward),
//                                           g_i = c times the number of stuck neighbours
//
// and with K = Q diag(λ) Qᵀ each mode q = Qᵀx is a particular solution p + r τ plus
//
//     z(τ) = exp(aτ/2) [z0 cos ωτ + (z0' − a z0/2)/ω sin ωτ],     ω² = λ − a²/4,
//
//     r = −v Qᵀg / λ,     p = (a r + Qᵀb) / λ.
//
// No λ is smaller than the strength of the weakest spring to the driver, because K is the Laplacian of the springs
// between blocks plus diag(D): all modes oscillate if a < 2 √min D, or a < 2 in the paper's chain. The matrix of a run
// depends only on its length and on the ends of the chain that it contains. There are at most 4N such matrices, and
// each is diagonalised once, when it is first needed.
#pragma once

#include <functional>
#include <map>

#include "state.h"

namespace bk {

class Modes {
  public:
    struct Matrix {
        std::vector<double> eigenvalue, vector;  // row k of `vector` is mode k
    };
    // Diagonalises K of the blocks first … last.
    using Solve = std::function<Matrix(int first, int last)>;

    // Positions and velocities at the origin of time.
    std::vector<double> origin, origin_velocity;

    Modes(const Model &model, Solve solve)
        : origin(model.springs.blocks), origin_velocity(model.springs.blocks), model(model), solve(std::move(solve)),
          blocks(model.springs.blocks), drift(blocks), amplitude(blocks), amplitude_rate(blocks) {}

    // Take the state as the origin of the motion: find the runs and their mode amplitudes.
    void start(const State<Blocks> &state) {
        const double coupling = blocks > 1 ? model.springs.strength[0] : 0.0;
        const double turned = 2.0 * (model.springs.threshold[0] * model.law.at_rest);
        rate = model.springs.threshold[0] * model.law.rate;
        for (int i = 0; i < blocks; i++) {
            origin[i] = state.position.lane(i);
            origin_velocity[i] = state.velocity.lane(i);
        }
        runs.clear();
        for (int i = 0; i < blocks; i++) {
            if (state.slip.lane(i) == 0.0) continue;
            const int first = i;
            while (i + 1 < blocks && state.slip.lane(i + 1) != 0.0) i++;
            const int last = i, length = last - first + 1;
            const Matrix &matrix = of(first, last);
            runs.push_back({first, last, &matrix});
            for (int k = 0; k < length; k++) {
                const double *vector = &matrix.vector[size_t(k) * length], eigenvalue = matrix.eigenvalue[k];
                double q = 0.0, speed = 0.0, push = 0.0;
                // From both ends inward, adding each block to its mirror image first: a mirrored state gives the same
                // sums to the bit, and a symmetric state gives exactly 0 for every antisymmetric mode.
                for (int m = 0; m <= length - 1 - m; m++) {
                    const int near = first + m, far = last - m;
                    const double factor = vector[m], other = near != far ? vector[length - 1 - m] : 0.0;
                    auto both = [&](auto &&value) { return factor * value(near) + other * value(far); };
                    q += both([&](int j) { return origin[j]; });
                    speed += both([&](int j) { return origin_velocity[j] - model.v; });
                    push += both([&](int j) { return turned * (state.slip.lane(j) < 0.0); });
                }
                const double left = first > 0 ? coupling * vector[0] : 0.0;
                const double right = last < blocks - 1 ? coupling * vector[length - 1] : 0.0;
                push +=
                    left * (first > 0 ? origin[first - 1] : 0.0) + right * (last < blocks - 1 ? origin[last + 1] : 0.0);
                drift[first + k] = -model.v * (left + right) / eigenvalue;
                amplitude[first + k] = q - (rate * drift[first + k] + push) / eigenvalue;
                amplitude_rate[first + k] = speed - drift[first + k];
            }
        }
    }

    // Set the state's positions and velocities to those at time t after the origin.
    //
    // A block that has just started keeps its velocity: it is about s' t²/2, less than the rounding error of the sum
    // over modes, whose sign could stop the block.
    void advance(State<Blocks> &state, double t) const {
        const double half = 0.5 * rate, growth = std::exp(half * t);
        for (int i = 0; i < blocks; i++) {
            const bool slips = state.slip.lane(i) != 0.0;
            state.position.lane(i) = slips ? origin[i] : origin[i] - model.v * t;
            if (slips && state.age.lane(i) >= state.layout.model.young()) state.velocity.lane(i) = origin_velocity[i];
        }
        for (const Slipping &run : runs) {
            const int length = run.last - run.first + 1;
            for (int k = 0; k < length; k++) {
                const double *vector = &run.matrix->vector[size_t(k) * length], eigenvalue = run.matrix->eigenvalue[k];
                const double a = amplitude[run.first + k], b = amplitude_rate[run.first + k];
                const double omega = std::sqrt(eigenvalue - half * half);
                const double cosine = growth * std::cos(omega * t), sine = growth * std::sin(omega * t) / omega;
                // Changes since the origin, so that rounding in the modes affects the change only.
                const double q = a * (cosine - 1.0) + (b - half * a) * sine + drift[run.first + k] * t;
                const double speed = b * (cosine - 1.0) + (half * b - eigenvalue * a) * sine;
                for (int i = run.first; i <= run.last; i++) {
                    state.position.lane(i) += vector[i - run.first] * q;
                    if (state.age.lane(i) >= state.layout.model.young())
                        state.velocity.lane(i) += vector[i - run.first] * speed;
                }
            }
        }
    }

  private:
    struct Slipping {
        int first, last;
        const Matrix *matrix;
    };
    const Model &model;
    const Solve solve;
    const int blocks;
    double rate = 0.0;
    std::vector<double> drift, amplitude, amplitude_rate;
    std::vector<Slipping> runs;
    std::map<std::pair<int, int>, Matrix> known;

    const Matrix &of(int first, int last) {
        const std::pair key(last - first, 2 * (first == 0) + (last == blocks - 1));
        auto found = known.find(key);
        if (found == known.end()) found = known.emplace(key, solve(first, last)).first;
        return found->second;
    }
};

}  // namespace bk
