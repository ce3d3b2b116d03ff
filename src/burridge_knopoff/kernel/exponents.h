// Lyapunov exponents from perturbations that are orthonormalised again and again.
//
// While m blocks are stuck at once, their m velocity perturbations are 0, so that at least as many exponents are −∞ as
// blocks are ever stuck at the same time. There are more where a stuck block divides the chain into parts that lose
// perturbations one after the other. Vectors that are lost are dropped, and the growth of the others is collected batch
// by batch; a batch begins and ends with the first orthonormalisation after its edge.
//
// Reference: G. Benettin, L. Galgani, A. Giorgilli and J.-M. Strelcyn, Meccanica 15 (1980) 9-30.
#pragma once

#include "tangent.h"

namespace bk {

constexpr double NEVER = 1e300;

// Growth of the perturbations of a run.
//
// start_time : the perturbations start with the piece of the motion in which this time lies; until the first edge they
//     only turn into the growing directions
// edge : boundaries of the batches
// at_rest : whether the perturbations are orthonormalised whenever a block starts after all have stuck. A batch whose
//     edges lie in times of rest then has the growth of whole slips, which depends on no unit: all velocities are 0
class Exponents {
  public:
    Tangent<Blocks> tangent;
    const int blocks;
    bool running = false;
    int alive = 0, most_stuck = 0;
    // Least time between two orthonormalisations, in a chain as slow as the paper's about that between two events: in a
    // chain of three blocks a stop shortens a vector to 1e-4 of what the others leave of it at worst, in long chains to
    // 1e-11.
    double interval = 1.0;
    // The chain's own unit of time: velocities are compared with displacements by it.
    double unit = 1.0;
    std::vector<double> growth, duration;
    const bool at_rest;
    const double start_time;

    Exponents(int blocks, int vectors, double start_time, std::vector<double> edges, bool at_rest)
        : tangent((blocks + Blocks::LANES - 1) / Blocks::LANES, vectors), blocks(blocks),
          growth((edges.size() - 1) * vectors), duration(edges.size() - 1), at_rest(at_rest),
          start_time(vectors > 0 ? start_time : NEVER), edge(std::move(edges)), batches(int(edge.size()) - 1),
          whole(vectors), product(vectors, 1.0) {}

    double *x(int v) { return &tangent.position.lane(size_t(v) * tangent.columns * Blocks::LANES); }
    double *u(int v) { return &tangent.velocity.lane(size_t(v) * tangent.columns * Blocks::LANES); }

    // Carry perturbations from now on as they are, never orthonormalised.
    void carry() {
        tangent.forget_stops(Blocks::all_lanes(true));
        running = true;
        due = NEVER;
        most_stuck = blocks;
    }

    // slip : directions in which the blocks slip, 0 for those that stick
    //
    // Start the perturbations now if their time comes within a piece of this length.
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

    // Orthonormalise the perturbations if it is time to, after all changes of this instant.
    void follow(const double *slip, double clock, bool completed) {
        const int now = stuck(slip);
        if (now > most_stuck) {
            most_stuck = now;
            if (alive > 2 * blocks - now) {
                alive = 2 * blocks - now;
                orthonormalise(true);
            }
        }
        if (clock >= due || (completed && alive > 0)) renew(slip, clock, completed);
    }

    // A block is about to start.
    void before_start(const double *slip, double clock) {
        if (at_rest && running && alive > 0 && stuck(slip) == blocks) renew(slip, clock, false);
    }

    // Carry the perturbations to the start of block i by the driver alone: it goes as far as takes s_i to the
    // threshold, x_j → x_j + δs_i/D_i for every block.
    void load_until_start(const Springs &springs, int i) {
        tangent.forget_stops(Blocks::all_lanes(true));
        for (int v = 0; v < tangent.vectors; v++) {
            const double less = springs.pull(x(v), i) / springs.driving[i];
            for (int j = 0; j < blocks; j++) x(v)[j] += less;
        }
    }

    // Whether `follow` changes the perturbations.
    bool is_due(const double *slip, double clock) const { return clock >= due || stuck(slip) > most_stuck; }

    int stuck(const double *slip) const {
        int count = 0;
        for (int i = 0; i < blocks; i++) count += slip[i] == 0.0;
        return count;
    }

    // How many of the 2 blocks exponents are −∞, at least; exact if as many vectors were asked for.
    int lost() const { return std::max(most_stuck, alive < tangent.vectors ? 2 * blocks - alive : 0); }

  private:
    // A vector that has been shortened to less than this is one that stops have taken away: the rest is rounding.
    static constexpr double LOST = 1e-13;

    const std::vector<double> edge;
    const int batches;
    int batch = -1;
    double due = 0.0, batch_start = 0.0;
    // Lengths multiplied up, whose logarithm is taken at the end of a batch, or before it could overflow.
    std::vector<double> whole, product;
    Watch watch;

    bool counted() const { return batch >= 0 && batch < batches; }

    // Give the vectors from `first` on directions of no special symmetry, as many as the stuck blocks allow.
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

    double dot(int c, int d) {
        const double *x = this->x(c), *u = this->u(c), *y = this->x(d), *w = this->u(d);
        double moved = 0.0, sped = 0.0;
        for (int i = 0; i < blocks; i++) {
            moved += x[i] * y[i];
            sped += u[i] * w[i];
        }
        return moved + unit * unit * sped;
    }

    // Make the vectors orthonormal (modified Gram-Schmidt). kept : vectors that were orthonormal before are dropped
    // from the first one on that is lost, and their lengths are collected in a batch; else they are seeds
    void orthonormalise(bool kept) {
        const int n = blocks;
        for (int c = 0; c < alive; c++) whole[c] = dot(c, c);
        for (int c = 0; c < tangent.vectors; c++) {
            watch.worked((long long)n * std::max(alive - c, 1) / 8);
            double factor = 0.0;
            if (c < alive) {
                const double square = c == 0 ? whole[0] : dot(c, c);
                if (kept && square <= LOST * LOST * whole[c]) {
                    alive = c;
                } else {
                    const double length = std::sqrt(square);
                    factor = 1.0 / length;
                    if (kept && counted()) {
                        product[c] *= length;
                        if (!(1e-100 < product[c] && product[c] < 1e100)) collect(c);
                    }
                }
            }
            for (int i = 0; i < n; i++) {
                x(c)[i] *= factor;
                u(c)[i] *= factor;
            }
            for (int d = c + 1; d < alive; d++) {
                const double along = dot(c, d);
                for (int i = 0; i < n; i++) {
                    x(d)[i] -= along * x(c)[i];
                    u(d)[i] -= along * u(c)[i];
                }
            }
        }
    }

    // Add the growth of vector c since the last call to its batch.
    void collect(int c) {
        growth[size_t(batch) * tangent.vectors + c] += std::log(product[c]);
        product[c] = 1.0;
    }

    // Orthonormalise, and go on to the batch in which the time now lies.
    void renew(const double *slip, double clock, bool completed) {
        orthonormalise(true);
        due = clock + interval;
        while (batch < batches && (clock >= edge[batch + 1] || (completed && batch == batches - 1))) {
            if (batch >= 0) {
                duration[batch] = clock - batch_start;
                for (int c = 0; c < alive; c++) collect(c);
            } else {
                // Blocks that were stuck only in the transient cost no exponent of the window.
                seed(slip, alive);
            }
            batch++;
            batch_start = clock;
        }
    }
};

}  // namespace bk
