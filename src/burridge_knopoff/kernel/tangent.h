// Tangent dynamics: how small perturbations δx_i, δU_i' of a run grow, through stops and starts.
//
// Between events a perturbation obeys the linearized equations of the slipping blocks,
//
//     δx' = δU',    m_i δU_i'' = −(K δx)_i − θ_i (dΦ/dU') δU_i',    stuck blocks: δU_i' = 0.
//
// At a stop of block i, whose acceleration is A before and 0 after it, the saltation matrix 1 + (f⁺ − f⁻)nᵀ/(nᵀf⁻) with
// n along U_i' sets δU_i' to 0 and leaves all else. At a start n is along the spring force s_i and f⁺ − f⁻ is the
// acceleration A⁺ of a block that starts: δU_i' becomes A⁺ δs_i/s_i'. Where friction does not drop at the start, A⁺ = 0
// and the matrix is the identity. A block that turns round at once, beyond the threshold of a symmetric contact, has A⁺
// after the stop and its perturbation is multiplied by A⁺/A.
//
// Reference: R. I. Leine and H. Nijmeijer, "Dynamics and Bifurcations of Non-Smooth Mechanical Systems" (Springer
// 2004).
#pragma once

#include "interrupt.h"
#include "series.h"

namespace bk {

class Tangent {
  public:
    static constexpr int LANES = Blocks::LANES;
    using vec = Blocks::vec;
    using Rows = Blocks::Rows;

    const int blocks, vectors, columns;
    // Vector v has the lanes of its blocks in columns v · columns …
    Rows position, velocity;

    Tangent(int blocks, int vectors)
        : blocks(blocks), vectors(vectors), columns((blocks + LANES - 1) / LANES),
          position(size_t(vectors + 1) * columns), velocity(size_t(vectors + 1) * columns),
          lost(size_t(vectors) * blocks), deceleration(blocks), moving(columns), pull_scale(columns),
          rates(size_t(columns) * LENGTH), speeds(size_t(columns) * LENGTH * TOGETHER),
          rows(size_t(columns) * TOGETHER) {}

    double *x(int v) { return &position.lane(size_t(v) * columns * LANES); }
    double *u(int v) { return &velocity.lane(size_t(v) * columns * LANES); }

    // Forget what stops have taken away, as time moves on or begins again.
    void forget_stops() { std::fill(deceleration.begin(), deceleration.end(), 0.0); }

    // Carry the perturbations through a stop or start that this block is about to make.
    void change(const State<Blocks> &state, int i) {
        const int c = i / LANES, lane = i % LANES;
        const double force = state.force(c)[lane];
        if (state.slip.lane(i) != 0.0) {
            deceleration[i] = state.slip_acceleration(c, state.force(c))[lane];
            for (int v = 0; v < vectors; v++) {
                lost[size_t(v) * blocks + i] = u(v)[i];
                u(v)[i] = 0.0;
            }
            return;
        }
        const double sign = force > 0.0 ? 1.0 : -1.0, mass = state.layout.model.springs.mass[i];
        if (deceleration[i] != 0.0) {
            const double factor =
                (force - sign * (state.layout.model.springs.threshold[i] * state.layout.model.law.at_rest)) / mass / deceleration[i];
            for (int v = 0; v < vectors; v++) u(v)[i] = factor * lost[size_t(v) * blocks + i];
        } else if (state.layout.drops && state.at_threshold(c, state.force(c))[lane]) {
            Rows relative(columns);
            for (int k = 0; k < columns; k++) relative[k] = state.velocity[k] - state.layout.v;
            const double rate = state.force_rate(relative.at(), c)[lane];
            // Where the driver stands the perturbed block starts at the same time: the driver has gone less or more
            // far.
            if (rate == 0.0) return;
            const double factor = sign * state.start_acceleration(c)[lane] / rate;
            for (int v = 0; v < vectors; v++) u(v)[i] = factor * state.layout.model.springs.pull(x(v), i);
        }
    }

    // Carry the perturbations to the start of block i by the driver alone: it goes as far as takes s_i to the
    // threshold, x_j → x_j + δs_i/D_i for every block.
    void load_until_start(const Springs &springs, int i) {
        forget_stops();
        for (int v = 0; v < vectors; v++) {
            const double less = springs.pull(x(v), i) / springs.driving[i];
            for (int j = 0; j < blocks; j++) x(v)[j] += less;
        }
    }

    // Expand −θ dΦ/dU' / m along a piece of the motion; return into how many parts to divide its length. Coefficient k
    // is multiplied by t^(k + 1), with t the length of a part, and is 0 where a block sticks.
    int load(const State<Blocks> &state, Series<Blocks> &series, double length) {
        const Blocks &layout = state.layout;
        const Model &model = layout.model;
        const double pace = model.springs.fastest + model.springs.firmest * model.law.steepest;
        const int parts = 1 + int(pace * length / STRIDE);
        part = parts > 1 ? length / parts : length;
        const double x = model.law.linear ? pace * part : SLOWER * pace * part;
        rate_terms = 1;
        degree = LENGTH - 1;
        while (degree > 3 && x <= enough(degree - 2)) degree -= 2;
        for (int c = 0; c < columns; c++) {
            moving[c] = series.slipping[c];
            pull_scale[c] = part * (moving[c] * layout.inverse_mass[c]);
            if (model.law.linear) rates[size_t(c) * LENGTH] = pull_scale[c] * (layout.threshold[c] * model.law.rate);
        }
        if (model.law.linear) return parts;
        // Fewer rates than terms: one that is left out does harm by itself only, but in a term all rates add up.
        rate_terms = degree - degree / 5;
        if (parts > 1) {
            degree = LENGTH - 1;
            rate_terms = Blocks::ORDER;
        }
        for (int first = 0;;) {
            for (int c = 0; c < columns; c++) expand_rates(state, series, c, first);
            if (rate_terms == Blocks::ORDER || is_enough()) return parts;
            first = rate_terms;
            rate_terms = std::min(first + 2, int(Blocks::ORDER));
            degree = std::min(degree + 2, LENGTH - 1);
        }
    }

    // Take the rates as series about the end of a part (Horner's scheme, repeated).
    void move_on() {
        for (int c = 0; c < columns; c++) {
            vec *rate = rates.at(size_t(c) * LENGTH);
            for (int n = 0; n < rate_terms - 1; n++)
                for (int j = rate_terms - 2; j >= n; j--) rate[j] += rate[j + 1];
        }
    }

    // Propagate over one part of a piece with what `load` has made ready for it.
    void follow(const Blocks &layout) {
        int v = 0;
        // Several side by side, as each waits for itself.
        for (; v + 3 <= vectors; v += 3) {
            propagate<3>(layout, v);
            watch.worked(3 * blocks);
        }
        if (v + 2 <= vectors) {
            propagate<2>(layout, v);
            v += 2;
        }
        if (v < vectors) propagate<1>(layout, v);
    }

  private:
    static constexpr int LENGTH = Blocks::ORDER + 1, TOGETHER = 3;
    // What may be left out of a perturbation over one piece of the motion, as a share of it. Rates and perturbations
    // each leave out that much by the bounds below, about 1e-12 at worst together; as a rule it is less than 1e-13.
    static constexpr double NEGLIGIBLE = 5e-13;
    // Over x/(ω + a), ω² a bound on the eigenvalues of M⁻¹K, the terms of the series fall at least like x^n/n! if the
    // rates are constant: with this x the first neglected one is rounding. The pieces of the motion may be longer: they
    // are made for terms that are small beside 1, however small the motion itself is.
    static constexpr double STRIDE = 2.4;
    // Rates fall like the terms of the motion, which come down to 2^-53 in 22 steps at the end of a piece: each to this
    // share of the one before, as a rule.
    static constexpr double FALL = 0.19;
    // Slower than x^n/n!, rates that vary make the terms of a perturbation fall like FALL^n in the end. For them x is
    // taken larger by this factor.
    static constexpr double SLOWER = 1.25;

    std::vector<double> lost, deceleration;
    Rows moving, pull_scale, rates, speeds, rows;
    double part = 0.0;
    int rate_terms = 0, degree = 0;
    Watch watch;

    // The x with x^(n+1)/(n+1)! = NEGLIGIBLE, rounded to fewer digits than C libraries agree on.
    static double enough(int n) {
        static const auto table = [] {
            std::vector<double> made(LENGTH);
            double factorial = 1.0;
            for (int k = 0; k < LENGTH; k++) {
                factorial *= k + 1;
                made[k] = std::round(1e9 * std::pow(NEGLIGIBLE * factorial, 1.0 / (k + 1))) / 1e9;
            }
            return made;
        }();
        return table[n];
    }

    void expand_rates(const State<Blocks> &state, Series<Blocks> &series, int c, int first) {
        const vec *slope = series.law.row(state.layout.model.law.slope, c);
        vec *rate = rates.at(size_t(c) * LENGTH), factor = -(state.layout.threshold[c] * pull_scale[c]);
        series.law.complete_slope(c, first, rate_terms);
        for (int n = 0; n < rate_terms; n++) {
            rate[n] = factor * slope[n];
            factor *= part;
        }
        for (int n = rate_terms; n < degree; n++) rate[n] = vec{};
    }

    // Whether the rates that are left out are negligible, by the last two that are there.
    bool is_enough() const {
        const double limit = NEGLIGIBLE * (rate_terms + 1);
        for (int c = 0; c < columns; c++) {
            const vec *last = rates.at(size_t(c) * LENGTH + rate_terms - 2);
            if (any(limit < FALL * largest(magnitude(last[1]), FALL * magnitude(last[0])))) return false;
        }
        return true;
    }

    // With all coefficients multiplied by the power of t that they belong to,
    //
    //     u_(n+1) = (t (pulls of x_n)/m + sum of rate_k u_(n−k))/(n + 1),      x_(n+1) = t u_n/(n + 1).
    template <int COUNT>
    void propagate(const Blocks &layout, int v) {
        if (columns > 1)
            propagate_columns<COUNT>(layout, v);
        else if (layout.row && !layout.closed)
            propagate_column<COUNT, true>(layout, v);
        else
            propagate_column<COUNT, false>(layout, v);
    }

    // In one column all that a row needs, but for the speeds before, stays in registers.
    template <int COUNT, bool OPEN>
    void propagate_column(const Blocks &layout, int v) {
        const vec *rate = rates.at(), first_rate = rate[0], scale = pull_scale[0], diagonal = layout.diagonal[0];
        const vec left = OPEN ? layout.left[0] : vec{}, right = OPEN ? layout.right[0] : vec{};
        vec *speed = speeds.at(), x[COUNT], u[COUNT], position[COUNT], velocity[COUNT];
        for (int i = 0; i < COUNT; i++) {
            x[i] = position[i] = this->position[v + i];
            velocity[i] = this->velocity[v + i];
            u[i] = speed[i] = velocity[i] * moving[0];
        }
        const int before_rates = rate_terms > 1 ? 0 : degree;
        for (int n = 0; n < degree; n++) {
            const double factor = INVERSE[n + 1];
            vec change[COUNT]{};
            for (int j = before_rates; j < n; j++)
                for (int i = 0; i < COUNT; i++) change[i] += rate[n - j] * speed[j * COUNT + i];
            for (int i = 0; i < COUNT; i++) {
                vec pull;
                if constexpr (OPEN)
                    pull = left * before(x[i], x[i]) + right * after(x[i], x[i]);
                else
                    pull = layout.pull(x + i, 0);
                change[i] += scale * (pull - diagonal * x[i]);
                const vec next = (change[i] + first_rate * u[i]) * factor;
                x[i] = u[i] * (part * factor);
                position[i] += x[i];
                velocity[i] += next;
                u[i] = speed[(n + 1) * COUNT + i] = next;
            }
        }
        for (int i = 0; i < COUNT; i++) {
            this->position[v + i] = position[i];
            this->velocity[v + i] = velocity[i];
        }
    }

    template <int COUNT>
    void propagate_columns(const Blocks &layout, int v) {
        // x_n of vector i is row[i · columns + c], u_n is speed[(n · columns + c) · COUNT + i].
        const int count = columns;
        vec *row = rows.at(), *speed = speeds.at();
        vec *position = this->position.at(size_t(v) * count), *velocity = this->velocity.at(size_t(v) * count);
        for (int i = 0; i < COUNT; i++)
            for (int c = 0; c < count; c++) {
                speed[c * COUNT + i] = velocity[i * count + c] * moving[c];
                row[i * count + c] = position[i * count + c];
            }
        const bool vary = rate_terms > 1;
        for (int n = 0; n < degree; n++) {
            const double factor = INVERSE[n + 1];
            const vec *now = speed + size_t(n) * count * COUNT;
            vec *next = speed + size_t(n + 1) * count * COUNT;
            for (int c = 0; c < count; c++) {
                const vec *rate = rates.at(size_t(c) * LENGTH);
                vec change[COUNT]{};
                if (vary)
                    for (int j = 0; j < n; j++)
                        for (int i = 0; i < COUNT; i++)
                            change[i] += rate[n - j] * speed[(size_t(j) * count + c) * COUNT + i];
                for (int i = 0; i < COUNT; i++) {
                    const vec *own = row + i * count;
                    change[i] += pull_scale[c] * (layout.pull(own, c) - layout.diagonal[c] * own[c]);
                    next[c * COUNT + i] = (change[i] + rate[0] * now[c * COUNT + i]) * factor;
                    velocity[i * count + c] += next[c * COUNT + i];
                }
            }
            for (int c = 0; c < count; c++)
                for (int i = 0; i < COUNT; i++) {
                    row[i * count + c] = now[c * COUNT + i] * (part * factor);
                    position[i * count + c] += row[i * count + c];
                }
        }
    }
};

}  // namespace bk
