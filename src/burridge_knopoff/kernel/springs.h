// The springs of a chain or network and the static friction of its blocks: the forces on blocks at given positions.
//
// In co-moving coordinates x_i = U_i − vτ − e_i, with e the positions of uniform sliding, the spring force on block i
// is
//
//     s_i = f_i − (K x)_i,    f_i = θ_i Φ(v),
//
// with K_ii the sum of all springs at block i and, off the diagonal, minus the springs to its neighbours. It has mass
// m_i, sticks while s_i is below its threshold θ_i, and slips against friction θ_i Φ.
#pragma once

#include <algorithm>

#include "vector.h"

namespace bk {

// The neighbours of block i and the springs to them are at start[i] … start[i + 1] − 1.
struct Springs {
    int blocks;
    std::vector<double> diagonal, driving, threshold, sliding_force, mass;
    std::vector<int64_t> start;
    std::vector<int> neighbour;
    std::vector<double> strength;
    // Neighbours are the blocks before and after, in this order; in a ring the first and the last are neighbours too.
    bool row, ring;
    // Bound on the angular frequencies of slipping blocks: the root of that of Collatz and Wielandt on the eigenvalues
    // of M⁻¹K. Any positive vector gives one, and a few steps of the power method tighten it.
    double fastest;
    // The chain's own unit of time: 1 where it is as slow as the paper's, else shorter as the chain is faster. A power
    // of 2, so that a chain in other units moves the same to the bit.
    double unit;
    // Largest threshold per mass.
    double firmest;
    // Largest number of neighbours.
    int degree;

    void complete() {
        row = true;
        degree = 0;
        ring = false;
        for (int i = 0; i < blocks; i++) {
            const int count = int(start[i + 1] - start[i]);
            degree = std::max(degree, count);
            for (int64_t k = start[i]; k < start[i + 1]; k++) {
                const int j = neighbour[k];
                const bool around = (i == 0 && j == blocks - 1) || (i == blocks - 1 && j == 0);
                if (std::abs(i - j) == 1 && blocks > 2) continue;
                if (blocks == 2 && count == 1) continue;
                if (around)
                    ring = true;
                else
                    row = false;
            }
        }
        if (!row) ring = false;
        std::vector<double> vector(blocks, 1.0), product(blocks);
        double largest = 0.0;
        for (int step = 0; step < 3; step++) {
            largest = 0.0;
            for (int i = 0; i < blocks; i++) {
                product[i] = diagonal[i] * vector[i];
                for (int64_t k = start[i]; k < start[i + 1]; k++) product[i] += strength[k] * vector[neighbour[k]];
                product[i] /= mass[i];
                largest = std::max(largest, product[i] / vector[i]);
            }
            for (int i = 0; i < blocks; i++) vector[i] = product[i] / largest;
        }
        fastest = std::sqrt(largest);
        unit = std::ldexp(1.0, 1 - std::max(1, std::ilogb(fastest)));
        firmest = 0.0;
        for (int i = 0; i < blocks; i++) firmest = std::max(firmest, threshold[i] / mass[i]);
    }

    // −(K x)_i for displacements x, or their rates. The neighbours are added first, as in Layout.
    double pull(const double *x, int i) const {
        double total = 0.0;
        for (int64_t k = start[i]; k < start[i + 1]; k++) total += strength[k] * x[neighbour[k]];
        return total - diagonal[i] * x[i];
    }
};

// What the two ways to lay blocks into vectors have in common: constants of the blocks, one vector for each column.
struct Layout {
    int columns = 0;
    Vectors diagonal, threshold, sliding_force, inverse_mass;
    // What stuck neighbours that do not take part add to ds_i/dτ, see Blocks::outside.
    Vectors drift;
    std::vector<mask> present;

    void widen(int count) {
        columns = count;
        for (Vectors *row : {&diagonal, &threshold, &sliding_force, &inverse_mass, &drift}) row->reserve(count);
        if (int(present.size()) < count) present.resize(count);
    }
};

// Blocks in the lanes of vectors, LANES to a column: all share one clock. Lanes beyond the last block have no springs
// and a threshold of 1, which nothing reaches.
struct Blocks : Layout {
    static constexpr bool ONE_CLOCK = true;
    static constexpr int ORDER = 22;
    std::vector<int> member;  // the blocks that take part, in the order of the lanes
    bool row = true, closed = false;
    Vectors driving, left, right;
    // In a network: springs and lanes of the neighbours, `degree` rows of columns · LANES.
    int degree = 0;
    std::vector<int> lane_of_neighbour;
    std::vector<double> spring;

    // Lay some blocks, all or a connected group with its stuck borders, in ascending order (in a ring: along it).
    // place(i) : the lane of a block, −1 for one that does not take part
    template <class Place>
    void lay(const Springs &springs, Place &&place) {
        const int n = int(member.size());
        widen((n + LANES - 1) / LANES);
        driving.reserve(columns);
        row = springs.row;
        closed = springs.ring && n == springs.blocks;
        for (int c = 0; c < columns; c++) {
            diagonal[c] = driving[c] = sliding_force[c] = drift[c] = vec{};
            threshold[c] = inverse_mass[c] = splat(1.0);
            present[c] = from_bits(n >= (c + 1) * LANES ? -1 : (1 << (n - c * LANES)) - 1);
        }
        if (row) {
            left.reserve(columns);
            right.reserve(columns);
            for (int c = 0; c < columns; c++) left[c] = right[c] = vec{};
        } else {
            degree = springs.degree;
            lane_of_neighbour.assign(size_t(degree) * columns * LANES, 0);
            spring.assign(size_t(degree) * columns * LANES, 0.0);
        }
        for (int k = 0; k < n; k++) {
            const int i = member[k];
            diagonal.lane(k) = springs.diagonal[i];
            driving.lane(k) = springs.driving[i];
            threshold.lane(k) = springs.threshold[i];
            sliding_force.lane(k) = springs.sliding_force[i];
            inverse_mass.lane(k) = 1.0 / springs.mass[i];
            int slot = 0;
            for (int64_t p = springs.start[i]; p < springs.start[i + 1]; p++) {
                const int other = place(springs.neighbour[p]);
                if (other < 0) continue;
                if (row) {
                    // Of two blocks in a ring each is before and after the other.
                    const bool both = springs.blocks == 2 && springs.ring;
                    const bool is_before =
                        both ? p == springs.start[i] : other == k - 1 || (closed && k == 0 && other == n - 1);
                    (is_before ? left : right).lane(k) = springs.strength[p];
                } else {
                    lane_of_neighbour[size_t(slot) * columns * LANES + k] = other;
                    spring[size_t(slot++) * columns * LANES + k] = springs.strength[p];
                }
            }
        }
    }

    // Let stuck blocks that do not take part pull on those that do; `place` as in `lay`, x their positions. Their pulls
    // are added first, as in `pull`.
    template <class Place, class Position>
    void outside(const Springs &springs, Place &&place, double v, Position &&x) {
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

    // The pulls of the neighbours on the blocks of one column. Both are added first, so that a mirrored state has
    // mirrored forces to the bit.
    BK_INLINE vec pull(const vec *x, int c) const {
        if (__builtin_expect(row, true)) {
            vec previous = before(c > 0 ? x[c - 1] : x[c], x[c]);
            vec following = after(x[c], c + 1 < columns ? x[c + 1] : x[c]);
            if (closed) {
                const int end = int(member.size()) - 1;
                if (c == 0) previous[0] = reinterpret_cast<const double *>(x)[end];
                if (c == end / LANES) following[end % LANES] = x[0][0];
            }
            return left[c] * previous + right[c] * following;
        }
        vec total{};
        const double *position = reinterpret_cast<const double *>(x);
        for (int slot = 0; slot < degree; slot++) {
            const size_t first = (size_t(slot) * columns + c) * LANES;
            for (int lane = 0; lane < LANES; lane++)
                total[lane] += spring[first + lane] * position[lane_of_neighbour[first + lane]];
        }
        return total;
    }

    // The same value in all lanes, of the least or largest of them.
    static BK_INLINE vec least_of_clock(vec a) { return splat(least_lane(a)); }
    static BK_INLINE vec largest_of_clock(vec a) { return splat(largest_lane(a)); }
    static BK_INLINE mask any_of_clock(mask a) { return all_lanes(any(a)); }
};

// Trajectories in the lanes of vectors, a column for each block: each lane has its own clock.
struct Trajectories : Layout {
    static constexpr bool ONE_CLOCK = false;
    static constexpr int ORDER = 20;
    int degree = 0;
    std::vector<int> neighbour;
    std::vector<double> spring;

    explicit Trajectories(const Springs &springs) {
        widen(springs.blocks);
        degree = std::max(springs.degree, 2);
        neighbour.assign(size_t(degree) * columns, 0);
        spring.assign(size_t(degree) * columns, 0.0);
        for (int i = 0; i < columns; i++) {
            diagonal[i] = splat(springs.diagonal[i]);
            threshold[i] = splat(springs.threshold[i]);
            sliding_force[i] = splat(springs.sliding_force[i]);
            inverse_mass[i] = splat(1.0 / springs.mass[i]);
            drift[i] = vec{};
            present[i] = all_lanes(true);
            for (int64_t p = springs.start[i]; p < springs.start[i + 1]; p++) {
                neighbour[size_t(i) * degree + p - springs.start[i]] = springs.neighbour[p];
                spring[size_t(i) * degree + p - springs.start[i]] = springs.strength[p];
            }
        }
    }

    BK_INLINE vec pull(const vec *x, int i) const {
        const int *other = &neighbour[size_t(i) * degree];
        const double *strength = &spring[size_t(i) * degree];
        vec total = strength[0] * x[other[0]] + strength[1] * x[other[1]];
        for (int slot = 2; slot < degree; slot++) total += strength[slot] * x[other[slot]];
        return total;
    }

    static BK_INLINE vec least_of_clock(vec a) { return a; }
    static BK_INLINE vec largest_of_clock(vec a) { return a; }
    static BK_INLINE mask any_of_clock(mask a) { return a; }
};

}  // namespace bk
