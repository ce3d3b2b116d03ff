// Tangent dynamics: the growth of small perturbations δx_i, δU_i' of a run, through stops and starts.
//
// Between events a perturbation obeys the linearized equations of the slipping blocks,
//
//     δx' = δU',    m_i δU_i'' = −(K δx)_i − (C δU')_i − θ_i (dΦ/dU') δU_i',    stuck blocks: δU_i' = 0.
//
// At a stop of block i, whose acceleration is A before and 0 after it, the saltation matrix 1 + (f⁺ − f⁻)nᵀ/(nᵀf⁻) with
// n along U_i' sets δU_i' to 0 and changes nothing else. At a start n is along the force F_i and f⁺ − f⁻ is the
// acceleration A⁺ of the starting block: δU_i' becomes A⁺ δF_i/F_i'. If friction does not drop at the start, A⁺ = 0 and
// the matrix is the identity. A block that reverses at once, beyond the threshold of a symmetric contact, has the
// acceleration A⁺ after the stop, and its perturbation is multiplied by A⁺/A.
//
// Reference: R. I. Leine and H. Nijmeijer, "Dynamics and Bifurcations of Non-Smooth Mechanical Systems" (Springer
// 2004).
#pragma once

#include "interrupt.h"
#include "series.h"

namespace bk {

template <class L>
class Tangent {
  public:
    static constexpr int LANES = L::LANES, CLOCKS = L::ONE_CLOCK ? 1 : LANES;
    using vec = typename L::vec;
    using mask = typename L::mask;
    using Rows = typename L::Rows;
    using Number = typename L::Number;

    const int vectors;
    int columns;
    long long steps = 0;  // parts of the motion along which perturbations were propagated
    // Vector v has its blocks in the lanes of the columns from v · columns on.
    Rows position, velocity;

    // columns : of a state
    Tangent(int columns, int vectors) : vectors(vectors) { widen(columns); }

    // Set the number of columns; the contents are lost.
    void widen(int count) {
        columns = count;
        for (Rows *row : {&position, &velocity}) row->reserve(size_t(vectors + 1) * count);
        for (Rows *row : {&moving, &pull_scale}) row->reserve(count);
        for (Rows *row : {&rows, &sums, &speed_rows}) row->reserve(size_t(count) * TOGETHER);
        // With one clock `Exponents` maps the perturbations through stops and starts.
        if (!L::ONE_CLOCK) {
            deceleration.reserve(count);
            lost.reserve(size_t(vectors) * count);
        }
        rates.reserve(size_t(count) * LENGTH);
        speeds.reserve(size_t(count) * LENGTH * TOGETHER);
    }

    // Discard what stops have removed, when time advances or a run starts.
    void forget_stops(mask where) {
        for (int c = 0; c < columns; c++) deceleration[c] = select(where, vec{}, deceleration[c]);
    }

    // Map the perturbations through the stops or starts that blocks of a column are about to make; `Exponents::change`
    // does this for a single block.
    void change(State<L> &state, int c, mask where) {
        const L &layout = state.layout;
        const vec zero{}, force = state.force(c);
        const mask stops = where & (state.slip[c] != zero), starts = where & ~stops;
        if (any(stops)) {
            deceleration[c] = select(stops, state.slip_acceleration(c, force, stops), deceleration[c]);
            for (int v = 0; v < vectors; v++) {
                vec &u = velocity[size_t(v) * columns + c], &kept = lost[size_t(v) * columns + c];
                kept = select(stops, u, kept);
                u = select(stops, zero, u);
            }
        }
        if (!any(starts)) return;
        const vec sign = select(force > 0.0, L::splat(1.0), L::splat(-1.0));
        const mask turns = starts & (deceleration[c] != zero);
        if (any(turns)) {
            const vec factor =
                (force - sign * (layout.threshold[c] * layout.at_rest)) / layout.mass[c] / deceleration[c];
            for (int v = 0; v < vectors; v++) {
                vec &u = velocity[size_t(v) * columns + c];
                u = select(turns, factor * lost[size_t(v) * columns + c], u);
            }
        }
        if (!layout.drops) return;
        state.measure();
        const vec rate = state.force_rate(c);
        // If the driver does not move, the perturbed block starts at the same time: the driver has advanced less or
        // more.
        const mask jumps = starts & ~turns & state.at_threshold(c, force) & (rate != zero);
        if (!any(jumps)) return;
        const vec factor = sign * state.start_acceleration(c) / rate;
        for (int v = 0; v < vectors; v++) {
            const vec *x = position.at(size_t(v) * columns), *speed = velocity.at(size_t(v) * columns);
            vec &u = velocity[size_t(v) * columns + c], change = layout.pull(x, c) - layout.diagonal[c] * x[c];
            if (layout.damped) change += state.damping(speed, c);
            u = select(jumps, factor * change, u);
        }
    }

    // Expand −θ w Φ' / m along a piece of the motion, and determine the number of parts into which it is divided.
    // Coefficient k is multiplied by t^(k + 1), with t the length of a part, and is 0 where a block sticks.
    //
    // where : clocks whose perturbations are propagated
    void load(const State<L> &state, Series<L> &series, const Number &length, mask where) {
        const L &layout = state.layout;
        const Number pace = layout.steepest_at_rest ? layout.pace : pace_along(layout, series, length),
                     turn = pace * length;
        Number count{}, terms{};
        for (int k = 0; k < CLOCKS; k++) {
            parts[k] = where[k] ? 1 + int(L::of_lane(turn, k) / STRIDE) : 1;
            L::set_lane(count, k, parts[k]);
        }
        part = length / count;
        const Number x = (layout.linear ? pace : SLOWER * pace) * part;
        for (int n = 2; n < LENGTH - 1; n += 2) terms += x > ENOUGH.at[n] ? Number{} + 2.0 : Number{};
        for (int k = 0; k < CLOCKS; k++) {
            degree[k] = rate_terms[k] = 0;
            if (!where[k]) continue;
            rate_terms[k] = 1;
            degree[k] = 2 + int(L::of_lane(terms, k));
            if (layout.linear) continue;
            // Fewer rates than terms are needed: a neglected rate causes one error, whereas a term sums over all rates.
            rate_terms[k] = degree[k] - degree[k] / 5;
            if (parts[k] > 1) {
                degree[k] = LENGTH - 1;
                rate_terms[k] = L::ORDER;
            }
        }
        for (int c = 0; c < columns; c++) {
            moving[c] = series.slipping[c];
            pull_scale[c] = part * (moving[c] * layout.inverse_mass[c]);
            if (layout.linear)
                rates[size_t(c) * LENGTH] = pull_scale[c] * (layout.threshold[c] * (layout.weakening[c] * layout.rate));
        }
        for (int first = layout.steepest_at_rest ? 0 : L::ORDER; !layout.linear;) {
            const int terms = *std::max_element(rate_terms, rate_terms + CLOCKS);
            int fewest = terms;
            for (int k = 0; k < CLOCKS; k++)
                if (degree[k] > 0) fewest = std::min(fewest, rate_terms[k]);
            last_rate = lanes_of(rate_terms);
            for (int c = 0; c < columns; c++) expand_rates(state, series, c, first, fewest, terms);
            bool enough = true;
            for (int k = 0; k < CLOCKS; k++) {
                if (degree[k] == 0 || rate_terms[k] == L::ORDER || is_enough(k)) continue;
                rate_terms[k] = std::min(rate_terms[k] + 2, int(L::ORDER));
                degree[k] = std::min(degree[k] + 2, LENGTH - 1);
                enough = false;
            }
            if (enough) return;
            first = std::max(first, terms);
        }
    }

    // Number of parts of the piece of a clock.
    int parts_of(int clock) const { return parts[clock]; }
    int most_parts() const { return *std::max_element(parts, parts + CLOCKS); }

    // Expand the rates about the end of a part (repeated Horner scheme). Clocks with at most `done` parts are finished.
    void move_on(int done) {
        for (int k = 0; k < CLOCKS; k++)
            if (parts[k] <= done) degree[k] = 0;
        const int terms = *std::max_element(rate_terms, rate_terms + CLOCKS);
        for (int c = 0; c < columns; c++) {
            vec *rate = rates.at(size_t(c) * LENGTH);
            for (int n = 0; n < terms - 1; n++)
                for (int j = terms - 2; j >= n; j--) rate[j] += rate[j + 1];
        }
    }

    // Propagate over one part of a piece that `load` has prepared.
    void follow(const L &layout) {
        steps++;
        int v = 0;
        // Several at once, to be computed in parallel.
        for (; v + 3 <= vectors; v += 3) {
            propagate<3>(layout, v);
            watch.worked(3 * columns * LANES);
        }
        if (v + 2 <= vectors) {
            propagate<2>(layout, v);
            v += 2;
        }
        if (v < vectors) propagate<1>(layout, v);
    }

  private:
    static constexpr int LENGTH = L::ORDER + 1, TOGETHER = 3;
    // Relative truncation error of a perturbation over one piece of the motion. The bounds below allow this error for
    // the rates and for the perturbations, about 1e-12 at worst together; usually it is less than 1e-13.
    static constexpr double NEGLIGIBLE = 5e-13;
    // Over a time x/(ω + a), with ω² a bound on the eigenvalues of M⁻¹K, the terms of the series fall at least like
    // x^n/n! if the rates are constant: with this x the first neglected term is rounding. The pieces of the motion may
    // be longer, since their terms are small relative to 1, however small the motion itself is.
    static constexpr double STRIDE = 2.4;
    // Rates fall like the terms of the motion, which reach 2^-53 in 22 steps at the end of a piece: usually each term
    // is this fraction of the previous one.
    static constexpr double FALL = 0.19;
    // If the rates vary, the terms of a perturbation finally fall like FALL^n, more slowly than x^n/n!. To allow for
    // this, x is increased by this factor.
    static constexpr double SLOWER = 1.25;

    // The x with x^(n+1)/(n+1)! = NEGLIGIBLE, rounded to digits on which all C libraries agree.
    struct Enough {
        double at[LENGTH];
        Enough() {
            double factorial = 1.0;
            for (int n = 0; n < LENGTH; n++) {
                factorial *= n + 1;
                at[n] = std::round(1e9 * std::pow(NEGLIGIBLE * factorial, 1.0 / (n + 1))) / 1e9;
            }
        }
    };
    static inline const Enough ENOUGH;

    Rows lost, deceleration, moving, pull_scale, rates, speeds, rows, sums, speed_rows;
    Number part{};
    vec last_rate{};
    int parts[CLOCKS] = {}, rate_terms[CLOCKS] = {}, degree[CLOCKS] = {};
    Watch watch;

    static vec lanes_of(const int *numbers) {
        vec made{};
        for (int k = 0; k < CLOCKS; k++) made[k] = numbers[k];
        return made;
    }

    // Bound on the rate at which perturbations change along a piece: the slope of friction is at most the sum of the
    // moduli of its terms. Its series is completed. A bound for all speeds up to the largest allowed one would divide
    // the pieces of a law with a high power of the speed into hundreds of parts.
    Number pace_along(const L &layout, Series<L> &series, const Number &length) const {
        vec fastest{};
        for (int c = 0; c < columns; c++) {
            series.law.complete_slope(c, 0, L::ORDER);
            const vec *slope = series.law.row(series.law.law.slope, c);
            vec steepest{};
            for (int n = L::ORDER - 1; n >= 0; n--) steepest = steepest * length + magnitude(slope[n]);
            const vec factor = layout.threshold[c] * layout.weakening[c] * layout.inverse_mass[c];
            fastest = largest(fastest, series.slipping[c] * magnitude(factor) * steepest);
        }
        if constexpr (L::ONE_CLOCK)
            return layout.pace + largest_lane(fastest);
        else
            return layout.pace + fastest;
    }

    // Expand the rates of a column: `terms` of them, of which `fewest` are retained for all clocks.
    void expand_rates(const State<L> &state, Series<L> &series, int c, int first, int fewest, int terms) {
        const L &layout = state.layout;
        const vec *slope = series.law.row(series.law.law.slope, c);
        vec *rate = rates.at(size_t(c) * LENGTH),
            factor = -((layout.threshold[c] * layout.weakening[c]) * pull_scale[c]);
        series.law.complete_slope(c, first, terms);
        for (int n = 0; n < fewest; n++) {
            rate[n] = factor * slope[n];
            factor *= part;
        }
        for (int n = fewest; n < terms; n++) {
            rate[n] = select(last_rate > double(n), factor * slope[n], vec{});
            factor *= part;
        }
        rate[terms] = vec{};
    }

    // Whether the neglected rates are small enough, judged by the last two retained rates.
    bool is_enough(int clock) const {
        const double limit = NEGLIGIBLE * (rate_terms[clock] + 1);
        for (int c = 0; c < columns; c++) {
            const vec *last = rates.at(size_t(c) * LENGTH + rate_terms[clock] - 2);
            const mask more = limit < FALL * largest(magnitude(last[1]), FALL * magnitude(last[0]));
            if (L::ONE_CLOCK ? any(more) : bool(more[clock])) return false;
        }
        return true;
    }

    // With each coefficient multiplied by its power of t,
    //
    //     u_(n+1) = (t (pulls of x_n)/m + sum of rate_k u_(n−k))/(n + 1),      x_(n+1) = t u_n/(n + 1).
    template <int COUNT>
    void propagate(const L &layout, int v) {
        if (layout.damped) return propagate_columns<COUNT, 0, true>(layout, v);
        if constexpr (L::ONE_CLOCK) {
            if (layout.is_open_row()) return propagate_column<COUNT, true>(layout, v);
            if (columns == 1) return propagate_column<COUNT, false>(layout, v);
        } else {
            if (columns == 2 && layout.row) return propagate_columns<COUNT, 2>(layout, v);
            if (columns == 3 && layout.row) return propagate_columns<COUNT, 3>(layout, v);
        }
        propagate_columns<COUNT, 0>(layout, v);
    }

    // The sums of rate_k u_(n−k) over k = 1 … n, and those of the next order without their last term: both read the
    // same speeds. Rates from `most_rates` on are 0. step : between the speeds of one order and the next
    template <int COUNT>
    static BK_INLINE void sum(const vec *rate, const vec *speed, size_t step, int n, int most_rates, vec *change,
                              vec *later) {
        vec near[COUNT], far[COUNT];
        for (int i = 0; i < COUNT; i++) near[i] = far[i] = vec{};
        int k = std::min(n, most_rates - 1);
        const vec *u = speed + (n - k) * step;
        for (vec further = rate[k + 1]; k > 0; k--, u += step) {
            const vec own = rate[k];
            for (int i = 0; i < COUNT; i++) {
                near[i] += own * u[i];
                far[i] += further * u[i];
            }
            further = own;
        }
        for (int i = 0; i < COUNT; i++) {
            change[i] = near[i];
            later[i] = far[i];
        }
    }

    // Add the last term to the sums of an odd order.
    template <int COUNT>
    static BK_INLINE void complete(const vec *rate, const vec *speed, int most_rates, const vec *later, vec *change) {
        for (int i = 0; i < COUNT; i++) {
            change[i] = later[i];
            if (most_rates > 1) change[i] += rate[1] * speed[i];
        }
    }

    // In one column everything except the earlier speeds stays in registers.
    template <int COUNT, bool OPEN>
    void propagate_column(const L &layout, int v) {
        const int degree = this->degree[0];
        const vec *rate = rates.at(), first_rate = rate[0], scale = pull_scale[0], diagonal = layout.diagonal[0];
        Blocks::OpenRow open;
        if constexpr (OPEN) open = layout.open_row();
        vec *speed = speeds.at(), x[COUNT], u[COUNT], position[COUNT], velocity[COUNT];
        for (int i = 0; i < COUNT; i++) {
            x[i] = position[i] = this->position[v + i];
            velocity[i] = this->velocity[v + i];
            u[i] = speed[i] = velocity[i] * moving[0];
        }
        vec change[COUNT], later[COUNT];
        for (int n = 0; n < degree; n++) {
            const double factor = INVERSE[n + 1];
            if (n % 2 == 0)
                sum<COUNT>(rate, speed, COUNT, n, rate_terms[0], change, later);
            else
                complete<COUNT>(rate, speed + (n - 1) * COUNT, rate_terms[0], later, change);
            for (int i = 0; i < COUNT; i++) {
                vec force;
                if constexpr (OPEN)
                    force = open.pull(x[i]);
                else
                    force = layout.pull(x + i, 0) - diagonal * x[i];
                change[i] += scale * force;
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

    static BK_INLINE void add(vec &sum, vec term, mask own) {
        sum = L::ONE_CLOCK ? sum + term : select(own, sum + term, sum);
    }

    // COLUMNS : the number of columns of a short row of blocks, 0 for any; see Series::fill
    template <int COUNT, int COLUMNS, bool DAMPED = false>
    void propagate_columns(const L &layout, int v) {
        // x_n of vector i is row[i · columns + c], u_n is speed[(n · columns + c) · COUNT + i].
        const int count = COLUMNS ? COLUMNS : columns, last = *std::max_element(degree, degree + CLOCKS);
        const int most_rates = *std::max_element(rate_terms, rate_terms + CLOCKS);
        const vec own_terms = lanes_of(degree);
        vec known[COLUMNS ? 2 * COLUMNS * COUNT : 1], *row = COLUMNS ? known : rows.at(), *speed = speeds.at();
        vec *sums = COLUMNS ? known + COLUMNS * COUNT : this->sums.at();
        vec *position = this->position.at(size_t(v) * count), *velocity = this->velocity.at(size_t(v) * count);
        for (int i = 0; i < COUNT; i++)
            for (int c = 0; c < count; c++) {
                speed[c * COUNT + i] = velocity[i * count + c] * moving[c];
                row[i * count + c] = position[i * count + c];
            }
        for (int n = 0; n < last; n++) {
            const double factor = INVERSE[n + 1];
            const mask own = own_terms > double(n);
            const vec *now = speed + size_t(n) * count * COUNT;
            vec *next = speed + size_t(n + 1) * count * COUNT;
            for (int c = 0; DAMPED && c < count; c++)
                for (int i = 0; i < COUNT; i++) speed_rows[i * count + c] = now[c * COUNT + i];
            for (int c = 0; c < count; c++) {
                const vec *rate = rates.at(size_t(c) * LENGTH), scale = pull_scale[c], diagonal = layout.diagonal[c];
                vec change[COUNT], *later = sums + c * COUNT;
                if (n % 2 == 0)
                    sum<COUNT>(rate, speed + c * COUNT, size_t(count) * COUNT, n, most_rates, change, later);
                else
                    complete<COUNT>(rate, now + (c - count) * COUNT, most_rates, later, change);
                for (int i = 0; i < COUNT; i++) {
                    const vec *x = row + i * count;
                    vec pull;
                    if constexpr (COLUMNS)
                        pull = layout.template pull_in_row<COLUMNS>(x, c);
                    else
                        pull = layout.pull(x, c);
                    vec force = pull - diagonal * x[c];
                    if constexpr (DAMPED) {
                        const vec *u = speed_rows.at(size_t(i) * count);
                        force += layout.drag(u, c) - layout.damping_diagonal[c] * u[c];
                    }
                    change[i] += scale * force;
                    next[c * COUNT + i] = (change[i] + rate[0] * now[c * COUNT + i]) * factor;
                    add(velocity[i * count + c], next[c * COUNT + i], own);
                }
            }
            for (int c = 0; c < count; c++)
                for (int i = 0; i < COUNT; i++) {
                    row[i * count + c] = now[c * COUNT + i] * (part * factor);
                    add(position[i * count + c], row[i * count + c], own);
                }
        }
    }
};

}  // namespace bk
