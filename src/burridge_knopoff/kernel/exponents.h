// Lyapunov exponents from perturbations that are orthonormalised repeatedly.
//
// While m blocks are stuck at once, their m velocity perturbations are 0. Hence at least as many exponents are −∞ as
// blocks are ever stuck at the same time. More are −∞ if a stuck block divides the chain into parts that lose
// perturbations one after the other. Lost vectors are dropped, and the growth of the others is summed in batches, at
// whose edges they are orthonormalised; under quasi-static loading of a chain as a whole, before the next start.
//
// Where several blocks stop or start at one instant, the derivative of the flow may depend on the order in which a
// perturbation lets them do so; the flow then has directional derivatives only. Two changes commute at first order
// unless a dashpot joins their blocks and one of them starts with a drop of friction: at once the dashpot changes the
// rate of the force on the other. Under quasi-static loading the order always matters: the driver stops at the first
// start. `Exponents` maps perturbations in one order, and reports the blocks for which it matters.
//
// References: G. Benettin, L. Galgani, A. Giorgilli and J.-M. Strelcyn, Meccanica 15 (1980) 9-30; S. A. Burden,
// S. S. Sastry, D. E. Koditschek and S. Revzen, SIAM J. Appl. Dyn. Syst. 15 (2016) 1227.
#pragma once

#include <algorithm>
#include <utility>

#include "gram_schmidt.h"
#include "record.h"
#include "tangent.h"

namespace bk {

constexpr double NEVER = 1e300;

// Growth of the perturbations of a run.
//
// start_time : the perturbations start with the piece of the motion that contains this time; until the first edge they
//     only align with the directions of fastest growth
// edge : boundaries of the batches
// at_rest : whether the perturbations are orthonormalised whenever a block starts after all blocks were stuck. A batch
//     whose edges lie in times of rest then contains whole slips. Its growth depends on no unit: all velocities are 0
//
// In a run in groups, the pieces of the motion begin and end at different times, and so do the perturbations of their
// blocks. Such a set of perturbations determines the set at one instant. It is orthonormalised as it is: linear
// combinations are the same at all times, and the growth between two instants does not depend on what is done between
// them. Only the edges of batches need one instant.
class Exponents {
  public:
    static constexpr int LANES = Blocks::LANES;

    Tangent<Blocks> tangent;
    // The perturbations of the blocks of one group, which are propagated together.
    Tangent<Blocks> in_group;
    const int blocks;
    bool running = false;
    int alive = 0, most_stuck = 0;
    // Smallest time between two orthonormalisations; in the paper's chain about the time between two events. Between
    // two of them the part of a vector that is independent of the others falls at worst to 1e-4 in a chain of three
    // blocks, and to 1e-11 in long chains.
    double interval = 1.0;
    // The chain's own unit of time, which relates velocities to displacements in the norm.
    double unit = 1.0;
    std::vector<double> growth, duration;
    const bool at_rest;
    const double start_time;
    // The first two blocks whose changes at one instant have an order that matters, apart from mirror blocks; the first
    // two mirror blocks; and the first two that start together under quasi-static loading. −1 for none.
    std::pair<int, int> unordered{-1, -1}, unordered_mirrors{-1, -1}, tied{-1, -1};
    // Changes closer than this time are simultaneous: rounding decides their order.
    double rounding = 0.0;

    Exponents(int blocks, int vectors, double start_time, std::vector<double> edges, bool at_rest)
        : tangent((blocks + LANES - 1) / LANES, vectors), in_group(1, vectors), blocks(blocks),
          growth((edges.size() - 1) * vectors), duration(edges.size() - 1), at_rest(at_rest),
          start_time(vectors > 0 ? start_time : NEVER), edge(std::move(edges)), batches(int(edge.size()) - 1),
          length(vectors), product(vectors, 1.0), deceleration(blocks), lost_speed(size_t(vectors) * blocks),
          latest(blocks) {}

    double *x(int v) { return &tangent.position.lane(size_t(v) * tangent.columns * LANES); }
    double *u(int v) { return &tangent.velocity.lane(size_t(v) * tangent.columns * LANES); }

    // Whether perturbations are only propagated, and not orthonormalised.
    bool is_carried() const { return tangent.vectors > 0 && start_time >= NEVER; }

    // Propagate perturbations from now on without orthonormalisation.
    void carry() {
        forget_stops();
        latest.assign(blocks, {});
        unordered = unordered_mirrors = tied = {-1, -1};
        running = true;
        due = NEVER;
        most_stuck = blocks;
    }

    // Record that block i stops, or starts with a drop of friction, and with which neighbours it does so at one
    // instant.
    void meet(const Springs &springs, int i, bool starts, const Clock &at) {
        if (!running || !springs.damped) return;
        for (int64_t k = springs.start[i]; k < springs.start[i + 1]; k++) {
            const int j = springs.neighbour[k];
            const Change &other = latest[j];
            if (springs.damping[k] == 0.0 || !(starts || other.starts) || other.at.until(at) > rounding) continue;
            auto &pair = i + j == blocks - 1 ? unordered_mirrors : unordered;
            if (pair.first < 0) pair = std::minmax(i, j);
        }
        latest[i] = {at, starts};
    }

    // Record that two blocks start together under quasi-static loading.
    void tie(int i, int j) {
        if (tied.first < 0) tied = std::minmax(i, j);
    }

    // Map the perturbations through the stop or start that block i, in a lane of a state, is about to make now.
    void change(State<Blocks> &state, const Springs &springs, int i, int lane, const Clock &now) {
        const Blocks &layout = state.layout;
        const bool starts = state.slip.lane(lane) == 0.0;
        if (layout.drops) meet(springs, i, starts, now);
        const int c = lane / LANES, own = lane % LANES;
        const Blocks::vec force = state.force(c);
        if (!starts) {
            deceleration[i] = state.slip_acceleration(c, force, Blocks::from_bits(1 << own))[own];
            stopped.push_back(i);
            for (int v = 0; v < tangent.vectors; v++) {
                lost_speed[size_t(v) * blocks + i] = u(v)[i];
                u(v)[i] = 0.0;
            }
            return;
        }
        const double sign = force[own] > 0.0 ? 1.0 : -1.0;
        if (deceleration[i] != 0.0) {
            const double friction = sign * (layout.threshold.lane(lane) * layout.at_rest);
            const double factor = (force[own] - friction) / layout.mass.lane(lane) / deceleration[i];
            for (int v = 0; v < tangent.vectors; v++) u(v)[i] = factor * lost_speed[size_t(v) * blocks + i];
            return;
        }
        if (!layout.drops) return;
        state.measure();
        const double rate = state.force_rate(c)[own];
        // If the driver does not move, the perturbed block starts at the same time: the driver has advanced less or
        // more.
        if (!(bits(state.at_threshold(c, force)) >> own & 1) || rate == 0.0) return;
        const double factor = sign * state.start_acceleration(c)[own] / rate;
        for (int v = 0; v < tangent.vectors; v++) {
            double change = springs.pull(x(v), i);
            if (springs.damped) change += springs.drag(u(v), i);
            u(v)[i] = factor * change;
        }
    }

    // Discard what stops have removed, when time advances.
    void forget_stops() {
        for (int i : stopped) deceleration[i] = 0.0;
        stopped.clear();
    }

    // slip : directions in which the blocks slip, 0 for those that stick
    //
    // Start the perturbations now if `start_time` lies within a piece of this length.
    void begin_within(const double *slip, double clock, double length) {
        if (running || clock + length <= start_time) return;
        running = true;
        seed(slip, 0);
        due = clock + interval;
        if (clock >= edge[0]) {
            batch = 0;
            batch_start = clock;
        }
    }

    // Orthonormalise the perturbations if this is due, after all changes at this instant.
    void follow(const double *slip, double clock, bool completed) {
        lose(stuck(slip));
        if (clock >= due || (completed && alive > 0)) renew(slip, clock, completed);
    }

    // Drop the vectors that are lost while this many blocks stick.
    void lose(int now) {
        if (now <= most_stuck) return;
        most_stuck = now;
        if (alive <= 2 * blocks - now) return;
        alive = 2 * blocks - now;
        orthonormalise(true);
    }

    // A block is about to start.
    void before_start(const double *slip, double clock) {
        if (at_rest && running && alive > 0 && stuck(slip) == blocks) renew(slip, clock, false);
    }

    // The end of the present batch, NEVER after the last one.
    double next_edge() const { return batch < batches ? edge[batch + 1] : NEVER; }

    // Orthonormalise, and advance to the batch that contains the present time.
    void renew(const double *slip, double clock, bool completed) {
        orthonormalise(true);
        due = clock + interval;
        while (batch < batches && (clock >= edge[batch + 1] || (completed && batch == batches - 1))) {
            if (batch >= 0) {
                duration[batch] = clock - batch_start;
                for (int c = 0; c < alive; c++) collect(c);
            } else {
                // Blocks that were stuck in the transient only do not count for the window.
                seed(slip, alive);
            }
            batch++;
            batch_start = clock;
        }
    }

    // Make the vectors orthonormal. kept : whether they were orthonormal before; their lengths then count for the
    // batch, and vectors from the first lost one on are dropped. Otherwise they are seeds
    void orthonormalise(bool kept) {
        double count = alive;
        gram_schmidt(x(0), u(0), size_t(tangent.columns) * LANES, tangent.vectors, blocks, unit * unit, true, kept,
                     count, length.data(), watch);
        alive = int(count);
        if (kept) grow(length.data(), 1);
    }

    // Whether `follow` does nothing but orthonormalise within a batch.
    bool only_renews(const double *slip, double clock) const {
        return clock >= due && clock < next_edge() && stuck(slip) <= most_stuck;
    }
    // Record that this has been done outside, with lengths at every stride-th number, for `count` remaining vectors.
    void renewed(double clock, int count, const double *lengths, int stride) {
        alive = count;
        grow(lengths, stride);
        due = clock + interval;
    }

    // Map the perturbations to the start of block i under quasi-static loading: the driver advances until s_i reaches
    // the threshold. creep : displacement of each block relative to that of the driver; rate : that of s_i
    //
    //     x_j → x_j + (1 − creep_j) δs_i/rate.
    void load_until_start(const Springs &springs, int i, const double *creep, double rate) {
        forget_stops();
        // The slip clock has not advanced since the last stop, but the driver has.
        if (springs.damped) latest.assign(blocks, {});
        for (int v = 0; v < tangent.vectors; v++) {
            const double less = springs.pull(x(v), i) / rate;
            for (int j = 0; j < blocks; j++) x(v)[j] += less * (1.0 - creep[j]);
        }
    }

    // Whether `follow` changes the perturbations.
    bool is_due(const double *slip, double clock) const { return clock >= due || stuck(slip) > most_stuck; }

    int stuck(const double *slip) const {
        int count = 0;
        for (int i = 0; i < blocks; i++) count += slip[i] == 0.0;
        return count;
    }

    // Lower bound on the number of exponents −∞; exact if all 2 · blocks vectors are used.
    int lost() const { return std::max(most_stuck, alive < tangent.vectors ? 2 * blocks - alive : 0); }

  private:
    const std::vector<double> edge;
    const int batches;
    int batch = -1;
    double due = 0.0, batch_start = 0.0;
    // Products of lengths, whose logarithm is taken at the end of a batch, or before it could overflow.
    std::vector<double> length, product;
    // The latest stop or start of a block.
    struct Change {
        Clock at{-NEVER, 0.0};
        bool starts = false;
    };
    std::vector<Change> latest;
    // Of blocks that have stopped at this instant: their accelerations and velocity perturbations before.
    std::vector<double> deceleration, lost_speed;
    std::vector<int> stopped;
    Watch watch;

    bool counted() const { return batch >= 0 && batch < batches; }

    // Set the vectors from `first` on to directions without special symmetry, as many as the stuck blocks allow.
    void seed(const double *slip, int first) {
        most_stuck = stuck(slip);
        alive = std::min(tangent.vectors, 2 * blocks - most_stuck);
        for (int i = 0; i < blocks; i++) {
            watch.worked(tangent.vectors);
            for (int c = first; c < tangent.vectors; c++) {
                x(c)[i] = std::cos(1.0 + 2.3 * i + 3.7 * c + 1.9 * i * c);
                u(c)[i] = std::cos(2.0 + 1.7 * i + 2.9 * c + 2.3 * i * c) * (slip[i] != 0.0) / unit;
            }
        }
        orthonormalise(false);
    }

    // Count the lengths of the vectors for the present batch.
    void grow(const double *lengths, int stride) {
        for (int c = 0; c < alive && counted(); c++) {
            product[c] *= lengths[size_t(c) * stride];
            if (!(1e-100 < product[c] && product[c] < 1e100)) collect(c);
        }
    }

    // Add the growth of vector c since the last call to its batch.
    void collect(int c) {
        growth[size_t(batch) * tangent.vectors + c] += std::log(product[c]);
        product[c] = 1.0;
    }
};

}  // namespace bk
