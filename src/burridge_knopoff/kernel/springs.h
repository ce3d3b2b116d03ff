// The springs and dashpots of a chain or network and the static friction of its blocks: the forces on blocks at given
// positions and velocities.
//
// In co-moving coordinates x_i = U_i − vτ − e_i, with e the positions of uniform sliding, the spring force on block i
// is
//
//     s_i = f_i − (K x)_i,    f_i = θ_i Φ(w_i v),
//
// with K_ii the sum of all springs at block i and, off the diagonal, minus the springs to its neighbours. Dashpots
// in parallel with the springs add
//
//     Σ_j c_ij (U_j' − U_i') + c_i (v − U_i') = c_i v − (C U')_i.
//
// The block has mass m_i, sticks while the force on it is below its threshold θ_i, and slips against friction
// θ_i Φ(w_i U_i'), which grows with speed where the factor w_i is negative.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace bk {

// The neighbours of block i and the springs to them are at start[i] … start[i + 1] − 1.
struct Springs {
    // Number of blocks from which on groups are faster than a single group.
    static constexpr int MANY = 24;
    // Number of neighbours up to which the springs to all of them are added, and the number of operations for each
    // block that a network costs as a single group, relative to those for each pair of blocks in a group.
    static constexpr int FEW_NEIGHBOURS = 8;
    static constexpr double GROUPED = 3.0;
    int blocks;
    std::vector<double> diagonal, driving, threshold, weakening, sliding_force, mass;
    std::vector<int64_t> start;
    std::vector<int> neighbour;
    std::vector<double> strength;
    // Dashpots: c_ij of each spring, C_ii = Σ_j c_ij + c_i, and c_i v.
    std::vector<double> damping, damping_diagonal, damping_load;
    bool damped;
    // Neighbours are the blocks before and after, in this order; in a ring the first and the last are neighbours too.
    bool row, ring;
    // Bound on the angular frequencies of slipping blocks: the square root of the Collatz-Wielandt bound on the
    // eigenvalues of M⁻¹K. Any positive vector gives a bound, and a few steps of the power method tighten it.
    double fastest;
    // Gershgorin's bound on the eigenvalues of M⁻¹C, the rates at which dashpots damp velocities.
    double damping_rate;
    // The chain's own unit of time: 1 if the chain is as slow as the paper's, shorter if it is faster. It is a power of
    // 2, so that a rescaled chain gives the same motion to the bit.
    double unit;
    // Largest θ_i |w_i| / m_i, the factor of the law's slope in the rate at which friction changes velocities.
    double firmest;
    // Largest number of neighbours.
    int degree;
    // Whether blocks have so many neighbours that forces by increments from the blocks that slip are faster, and
    // whether the whole network is then faster as a single group.
    bool dense, single;

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
        dense = !row && blocks >= MANY && degree > FEW_NEIGHBOURS;
        single = dense && degree * double(degree) > GROUPED * blocks;
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
        firmest = damping_rate = 0.0;
        for (int i = 0; i < blocks; i++) {
            firmest = std::max(firmest, threshold[i] * std::fabs(weakening[i]) / mass[i]);
            double total = damping_diagonal[i];
            for (int64_t k = start[i]; k < start[i + 1]; k++) total += damping[k];
            damping_rate = std::max(damping_rate, total / mass[i]);
        }
        damped = damping_rate > 0.0;
    }

    // −(K x)_i for displacements x, or their rates. The neighbours are added first, as in Blocks and Trajectories.
    double pull(const double *x, int i) const { return pull(strength, diagonal, x, i); }
    // −(C u)_i for velocities u, or their rates.
    double drag(const double *u, int i) const { return pull(damping, damping_diagonal, u, i); }

  private:
    double pull(const std::vector<double> &joined, const std::vector<double> &own, const double *x, int i) const {
        double total = 0.0;
        for (int64_t k = start[i]; k < start[i + 1]; k++) total += joined[k] * x[neighbour[k]];
        return total - own[i] * x[i];
    }
};

}  // namespace bk
