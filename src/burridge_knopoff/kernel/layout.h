// The two layouts of blocks in vectors, with the constants of their motion.
#pragma once

#include <algorithm>
#include <type_traits>

#include "increments.h"
#include "law.h"
#include "springs.h"
#include "vector.h"

namespace bk {

// Times closer than this, in units of the chain, are one instant: the clock does not resolve them. Blocks whose motion
// is the same to the bit change together, regardless of rounding in the distance from their threshold.
constexpr double COINCIDENCE = 1e-14;

// A block that has slipped for less than this, in units of the chain, keeps the acceleration that has been propagated
// from its start, where it was exactly 0: 1 − s recomputed from positions would be rounding (1e-16), and its sign could
// stop the block.
constexpr double YOUNG = 1e-6;

// The springs, the friction and the driver of a chain or network.
struct Model {
    Springs springs;
    Law law;
    double v;
    bool symmetric;  // whether a block that is pulled below −θ_i slips backward
    // A block that can creep stops where its speed has fallen below minus this: unless the driver pulls the block on,
    // its speed tends to 0 and rounding decides the sign. 0 if no slip can creep.
    double creep_speed;
    // Under quasi-static loading, speed below which a slip is slow: the friction is then linear in the speed.
    double rest_speed;

    bool drops() const { return law.at_rest < 1.0; }
    double coincidence() const { return COINCIDENCE * springs.unit; }
    double young() const { return YOUNG * springs.unit; }
    // Bound on the rate at which perturbations change, but for friction if the law is steeper than at rest: its slope
    // is then bounded along each piece of the motion, see Tangent.
    double pace() const {
        const double slope = law.steepest_at_rest ? std::fabs(law.rate) : 0.0;
        return springs.fastest + springs.firmest * slope + springs.damping_rate;
    }

    // Whether trajectories of both may lie in the lanes of the same vectors.
    bool is_like(const Model &other) const {
        return springs.blocks == other.springs.blocks && springs.start == other.springs.start &&
               springs.neighbour == other.springs.neighbour && springs.damped == other.springs.damped &&
               law.is_like(other.law) && symmetric == other.symmetric && drops() == other.drops();
    }
};

// The common part of both layouts: constants of the blocks, one vector for each column, and of the model.
//
// Number : type of a constant of the model, one for all lanes or one for each lane
template <int COUNT, class Number_>
struct Layout : Lanes<COUNT> {
    static constexpr int ORDER = 22;
    using Number = Number_;
    using Rows = Vectors<COUNT>;
    using typename Lanes<COUNT>::mask;

    int columns = 0;
    Rows diagonal, threshold, sliding_force, mass, inverse_mass, damping_diagonal, damping_load;
    // Contribution of stuck neighbours outside the group to ds_i/dτ, see Blocks::outside.
    Rows drift;
    std::vector<mask> present;
    bool linear, steepest_at_rest, drops, symmetric, damped;
    Number v, at_rest, rate, coincidence, young, pace, creep_speed;
    Rows weakening;

    // The value for one lane, or for all lanes.
    static double of_lane(const Number &number, int lane) {
        if constexpr (std::is_same_v<Number, double>)
            return number;
        else
            return number[lane];
    }
    static void set_lane(Number &number, int lane, double value) {
        if constexpr (std::is_same_v<Number, double>)
            number = value;
        else
            number[lane] = value;
    }

    void widen(int count) {
        columns = count;
        for (Rows *row : {&diagonal, &threshold, &weakening, &sliding_force, &mass, &inverse_mass, &drift})
            row->reserve(count);
        if (damped)
            for (Rows *row : {&damping_diagonal, &damping_load}) row->reserve(count);
        if (int(present.size()) < count) present.resize(count);
    }

    // Set what all lanes share.
    void share(const Model &model) {
        linear = model.law.linear;
        steepest_at_rest = model.law.steepest_at_rest;
        drops = model.drops();
        symmetric = model.symmetric;
        damped = model.springs.damped;
    }

    // Set the constants of the model of one lane, or of all lanes.
    void take(const Model &model, int lane) {
        set_lane(v, lane, model.v);
        set_lane(at_rest, lane, model.law.at_rest);
        set_lane(rate, lane, model.law.rate);
        set_lane(coincidence, lane, model.coincidence());
        set_lane(young, lane, model.young());
        set_lane(pace, lane, model.pace());
        set_lane(creep_speed, lane, model.creep_speed);
    }
};

// Blocks in the lanes of vectors, LANES to a column, with one clock. There are at most four lanes, since usually few
// blocks slip together and narrow vectors are then faster. Lanes beyond the last block have no springs and a threshold
// of 1, which is never reached.
struct Blocks : Layout<std::min(WIDEST, 4), double> {
    static constexpr bool ONE_CLOCK = true;
    const Model &model;
    std::vector<int> member;  // the blocks of the group, in the order of the lanes
    bool row = true, closed = false;
    Rows driving;
    // Connections of blocks to their neighbours: to the blocks before and after in a row, and in a network `degree`
    // rows of columns · LANES, with the lanes of the neighbours.
    struct Links {
        Rows left, right;
        std::vector<double> of;
    };
    Links springs, dashpots;
    int degree = 0;
    std::vector<int> lane_of_neighbour;
    Increments<LANES> increments;

    explicit Blocks(const Model &model) : model(model) {
        share(model);
        take(model, 0);
    }

    const Law &law(int) const { return model.law; }

    // Place blocks, all or a connected group with its stuck neighbours, in ascending order, or in order along a ring.
    // place(i) : the lane of a block, −1 for a block outside the group
    template <class Place>
    void lay(Place &&place) {
        const Springs &chain = model.springs;
        const int n = int(member.size());
        widen((n + LANES - 1) / LANES);
        driving.reserve(columns);
        row = chain.row;
        closed = chain.ring && n == chain.blocks;
        for (int c = 0; c < columns; c++) {
            diagonal[c] = driving[c] = sliding_force[c] = drift[c] = vec{};
            if (damped) damping_diagonal[c] = damping_load[c] = vec{};
            threshold[c] = weakening[c] = mass[c] = inverse_mass[c] = splat(1.0);
            present[c] = from_bits(n >= (c + 1) * LANES ? -1 : (1 << (n - c * LANES)) - 1);
        }
        degree = row ? 0 : chain.degree;
        lane_of_neighbour.assign(size_t(degree) * columns * LANES, 0);
        clear(springs);
        if (damped) clear(dashpots);
        for (int k = 0; k < n; k++) {
            const int i = member[k];
            diagonal.lane(k) = chain.diagonal[i];
            driving.lane(k) = chain.driving[i];
            threshold.lane(k) = chain.threshold[i];
            weakening.lane(k) = chain.weakening[i];
            sliding_force.lane(k) = chain.sliding_force[i];
            mass.lane(k) = chain.mass[i];
            inverse_mass.lane(k) = 1.0 / chain.mass[i];
            if (damped) {
                damping_diagonal.lane(k) = chain.damping_diagonal[i];
                damping_load.lane(k) = chain.damping_load[i];
            }
            size_t slot = 0;
            for (int64_t p = chain.start[i]; p < chain.start[i + 1]; p++) {
                const int other = place(chain.neighbour[p]);
                if (other < 0) continue;
                // In a ring of two blocks each block is both before and after the other.
                const bool both = chain.blocks == 2 && chain.ring;
                const bool is_before =
                    both ? p == chain.start[i] : other == k - 1 || (closed && k == 0 && other == n - 1);
                const size_t at = slot++ * columns * LANES + k;
                auto join = [&](Links &links, double strength) {
                    (row ? (is_before ? links.left : links.right).lane(k) : links.of[at]) = strength;
                };
                join(springs, chain.strength[p]);
                if (damped) join(dashpots, chain.damping[p]);
                if (!row) lane_of_neighbour[at] = other;
            }
        }
    }

    // Add the forces of stuck blocks outside the group; `place` as in `lay`, x their positions. Their pulls are added
    // first, as in `pull`.
    template <class Place, class Position>
    void outside(Place &&place, Position &&x) {
        const Springs &springs = model.springs;
        for (int k = 0; k < int(member.size()); k++) {
            const int i = member[k];
            double pulls = 0.0;
            for (int64_t p = springs.start[i]; p < springs.start[i + 1]; p++) {
                if (place(springs.neighbour[p]) >= 0) continue;
                pulls += springs.strength[p] * x(springs.neighbour[p]);
                drift.lane(k) -= springs.strength[p] * v;
            }
            sliding_force.lane(k) += pulls;
        }
    }

    // The reference positions recede from a driver that advances by a distance.
    void recede(double distance) {
        for (int c = 0; c < columns; c++) {
            sliding_force[c] += driving[c] * distance;
            increments.reference[c] -= distance;
        }
    }

    // Lane k of an array of vectors.
    static BK_INLINE auto lanes(const vec *x) {
        return [at = reinterpret_cast<const double *>(x)](int lane) { return at[lane]; };
    }

    // The springs of an open row in one column. A copy of them, and no other kinds of springs, leaves the compiler
    // enough registers for a recursion.
    struct OpenRow {
        vec left, right, diagonal;
        BK_INLINE vec pull(vec x) const { return (left * before(x, x) + right * after(x, x)) - diagonal * x; }
    };
    bool is_open_row() const { return columns == 1 && row && !closed; }
    OpenRow open_row() const { return {springs.left[0], springs.right[0], diagonal[0]}; }

    // The spring forces on the blocks of a column that follow from positions x (power 0), relative velocities (1), or
    // further coefficients of x in powers of the time, which are 0 for stuck blocks. t : the time of positions
    BK_INLINE vec spring_pull(const vec *x, int power, int c, double t = 0.0) const {
        if (__builtin_expect(row, true)) return pull_in_line(springs, x, c) - diagonal[c] * x[c];
        if (!increments.used) return pull(springs, x, c) - diagonal[c] * x[c];
        if (power > 1) return increments.springs(c, lanes(x));
        return pull_by_increments(x, power, c, t);
    }
    // Not inline: it would take the registers of rows, which are much more frequent.
    __attribute__((noinline)) vec pull_by_increments(const vec *x, int power, int c, double t) const {
        const auto at = lanes(x);
        if (power == 1) return increments.springs(c, [&](int lane) { return at(lane) + v; });
        return increments.springs(c, [&](int lane) { return at(lane) - (increments.reference.lane(lane) - v * t); });
    }
    // −(C u)_i for velocities u, or their rates.
    BK_INLINE vec dashpot_pull(const vec *u, int c) const {
        if (!increments.used) return drag(u, c) - damping_diagonal[c] * u[c];
        return increments.dashpots(c, lanes(u));
    }

    // The pulls of the neighbours on the blocks of one column, by springs or by dashpots.
    BK_INLINE vec pull(const vec *x, int c) const { return pull(springs, x, c); }
    BK_INLINE vec drag(const vec *u, int c) const { return pull(dashpots, u, c); }

    // The pulls of both neighbours are added first, so that a mirrored state has mirrored forces to the bit.
    BK_INLINE vec pull(const Links &links, const vec *x, int c) const {
        if (__builtin_expect(row, true)) return pull_in_line(links, x, c);
        vec total{};
        const double *position = reinterpret_cast<const double *>(x);
        for (int slot = 0; slot < degree; slot++) {
            const size_t first = (size_t(slot) * columns + c) * LANES;
            for (int lane = 0; lane < LANES; lane++)
                total[lane] += links.of[first + lane] * position[lane_of_neighbour[first + lane]];
        }
        return total;
    }
    BK_INLINE vec pull_in_line(const Links &links, const vec *x, int c) const {
        vec previous = before(c > 0 ? x[c - 1] : x[c], x[c]);
        vec following = after(x[c], c + 1 < columns ? x[c + 1] : x[c]);
        if (closed) {
            const int end = int(member.size()) - 1;
            if (c == 0) previous[0] = reinterpret_cast<const double *>(x)[end];
            if (c == end / LANES) following[end % LANES] = x[0][0];
        }
        return links.left[c] * previous + links.right[c] * following;
    }

    // The smallest value of all lanes, or whether any lane is set, in all lanes.
    static BK_INLINE vec least_of_clock(vec a) { return splat(least_lane(a)); }
    static BK_INLINE mask any_of_clock(mask a) { return all_lanes(any(a)); }

  private:
    void clear(Links &links) {
        links.of.assign(size_t(degree) * columns * LANES, 0.0);
        for (Rows *side : {&links.left, &links.right}) {
            side->reserve(row ? columns : 0);
            for (int c = 0; row && c < columns; c++) (*side)[c] = vec{};
        }
    }
};

// Trajectories in the lanes of vectors, a column for each block: each lane has its own clock and its own model.
struct Trajectories : Layout<WIDEST, Lanes<WIDEST>::vec> {
    static constexpr bool ONE_CLOCK = false;
    int degree = 0;
    bool row;  // whether the only neighbours are the blocks before and after
    std::vector<int> neighbour;
    Rows spring, dashpot;

    // model : a model of the same kind as those of all lanes, which `place` sets
    explicit Trajectories(const Model &model) {
        const Springs &springs = model.springs;
        share(model);
        widen(springs.blocks);
        degree = std::max(springs.degree, 2);
        row = springs.row && !springs.ring;
        neighbour.assign(size_t(degree) * columns, 0);
        spring.reserve(size_t(degree) * columns);
        if (damped) dashpot.reserve(size_t(degree) * columns);
        for (int i = 0; i < columns; i++) {
            drift[i] = vec{};
            present[i] = all_lanes(true);
            for (int64_t p = springs.start[i]; p < springs.start[i + 1]; p++)
                neighbour[size_t(i) * degree + p - springs.start[i]] = springs.neighbour[p];
        }
        for (int lane = 0; lane < LANES; lane++) place(model, lane);
    }

    // Set the model of a lane.
    void place(const Model &model, int lane) {
        const Springs &springs = model.springs;
        for (int i = 0; i < columns; i++) {
            const size_t k = size_t(i) * LANES + lane;
            diagonal.lane(k) = springs.diagonal[i];
            threshold.lane(k) = springs.threshold[i];
            weakening.lane(k) = springs.weakening[i];
            sliding_force.lane(k) = springs.sliding_force[i];
            mass.lane(k) = springs.mass[i];
            inverse_mass.lane(k) = 1.0 / springs.mass[i];
            for (int64_t p = springs.start[i]; p < springs.start[i + 1]; p++)
                spring.lane((size_t(i) * degree + p - springs.start[i]) * LANES + lane) = springs.strength[p];
            if (!damped) continue;
            damping_diagonal.lane(k) = springs.damping_diagonal[i];
            damping_load.lane(k) = springs.damping_load[i];
            for (int64_t p = springs.start[i]; p < springs.start[i + 1]; p++)
                dashpot.lane((size_t(i) * degree + p - springs.start[i]) * LANES + lane) = springs.damping[p];
        }
        laws[lane] = &model.law;
        take(model, lane);
    }

    const Law &law(int lane) const { return *laws[lane]; }

    // As in Blocks, by all neighbours.
    BK_INLINE vec spring_pull(const vec *x, int, int i) const { return pull(x, i) - diagonal[i] * x[i]; }
    BK_INLINE vec dashpot_pull(const vec *u, int i) const { return drag(u, i) - damping_diagonal[i] * u[i]; }
    BK_INLINE vec pull(const vec *x, int i) const { return pull(spring, x, i); }
    BK_INLINE vec drag(const vec *u, int i) const { return pull(dashpot, u, i); }
    BK_INLINE vec pull(const Rows &links, const vec *x, int i) const {
        const int *other = &neighbour[size_t(i) * degree];
        const vec *strength = links.at(size_t(i) * degree);
        vec total = strength[0] * x[other[0]] + strength[1] * x[other[1]];
        for (int slot = 2; slot < degree; slot++) total += strength[slot] * x[other[slot]];
        return total;
    }
    // The same in a row with a number of blocks known at compile time.
    template <int COUNT>
    BK_INLINE vec pull_in_row(const vec *x, int i) const {
        const vec *strength = spring.at(2 * size_t(i));
        return strength[0] * x[i > 0 ? i - 1 : 1] + strength[1] * x[0 < i && i < COUNT - 1 ? i + 1 : 0];
    }

    static BK_INLINE vec least_of_clock(vec a) { return a; }
    static BK_INLINE mask any_of_clock(mask a) { return a; }

  private:
    const Law *laws[LANES];
};

}  // namespace bk
