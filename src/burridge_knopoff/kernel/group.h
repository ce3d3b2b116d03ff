// A group of blocks that share a clock: all blocks of a chain, or some that slip together with their stuck neighbours.
#pragma once

#include "catalogue.h"
#include "interrupt.h"
#include "observe.h"
#include "status.h"

namespace bk {

struct Group {
    static constexpr int LANES = Blocks::LANES;
    using vec = Blocks::vec;
    using mask = Blocks::mask;
    using Rows = Blocks::Rows;

    Blocks layout;
    State<Blocks> state;
    Series<Blocks> series;
    EventSearch<Blocks> search;
    Clock start;            // of the present piece
    double length = 0.0;    // of the piece: until the next event, or as far as the series goes
    double observed = 0.0;  // time up to which the piece has been observed
    double followed = 0.0;  // time of the piece to which the perturbations of its blocks belong
    bool planned = false, event = false;
    bool resting = false;  // whether the blocks stick or slip slowly at the end of the piece, see Run::plan
    int section = -1;      // lane of W in g
    int side = 0;          // the observer's side at the start of the piece
    uint64_t version = 0;
    int number = 0, first = 0;  // number of the group, and of its first block
    bool alive = false;         // whether the group has blocks

    Group(const Model &model, FrictionSeries<Blocks> &law, EventScratch<Blocks> &scratch)
        : layout(model), state(layout), series(layout, law), search(scratch) {}

    // The directions in which the blocks slip.
    const double *slip() const { return &state.slip.lane(0); }
    int size() const { return int(layout.member.size()); }
    // Number of blocks for which there is memory.
    size_t capacity() const { return layout.diagonal.size() * LANES; }

    // Expand the motion from the state and find the next event; false if the motion cannot continue. side : the sign of
    // W if its crossings are also searched for, otherwise 0; begin, end : the blocks whose sum is W
    bool plan(int wanted_side, int begin, int end) {
        const int n = size(), extra = wanted_side && n % LANES == 0;
        side = wanted_side;
        const vec reach = series.expand(state, extra);
        vec fastest{};
        for (int c = 0; c < layout.columns; c++) fastest = largest(fastest, magnitude(state.velocity[c]));
        // Near a pole of the law pieces become so short that the clock does not advance.
        if (!(start.time + reach[0] > start.time) || !(largest_lane(fastest) < ABSURD_SPEED)) return false;
        section = wanted_side ? n : -1;
        if (wanted_side) load_section(begin, end, extra);
        search.find(series, state, reach, Blocks::all_lanes(true), section);
        length = search.time[0];
        event = search.found[0];
        observed = followed = 0.0;
        planned = true;
        return true;
    }

    // Whether all blocks stick at a time of the piece, or slip slowly; limit, fastest : see State::rests
    bool rests_at(double t, double limit, double fastest) const {
        const vec at = Blocks::splat(t);
        for (int c = 0; c < layout.columns; c++) {
            const mask rests =
                state.rests(c, series.value(series.velocity, c, at), series.acceleration(c, at), limit, fastest);
            if (any(layout.present[c] & ~rests)) return false;
        }
        return true;
    }

    // Advance the state by t along the piece.
    void advance(double t) {
        series.move(state, Blocks::splat(t), Blocks::all_lanes(true));
        for (int c = 0; c < layout.columns; c++) layout.sliding_force[c] += layout.drift[c] * t;
        Rows &reference = layout.increments.reference;
        for (int c = 0; layout.increments.used && c < layout.columns; c++)
            reference[c] = select(state.slip[c] == vec{}, state.position[c], reference[c] - layout.v * t);
        start = start.after(t);
        planned = false;
    }

    // The coefficients of W = Σ x_i over some lanes.
    void load_sum(Polynomial &w, int begin, int end) const {
        w.degree = Blocks::ORDER;
        for (int k = 0; k <= Blocks::ORDER; k++) {
            const double *x = &series.position.lane(size_t(k) * series.columns * LANES);
            double total = 0.0;
            for (int i = begin; i < end; i++) total += x[i];
            w.coefficient[k] = total;
        }
    }
    // W' = Σ (U_i' − v) at time t.
    double sum_rate(int begin, int end, double t) const {
        double total = 0.0;
        for (int c = begin / LANES; c * LANES < end; c++) {
            const vec speed = series.value(series.velocity, c, Blocks::splat(t));
            for (int i = std::max(begin, c * LANES); i < std::min(end, (c + 1) * LANES); i++)
                total += speed[i % LANES] - layout.v;
        }
        return total;
    }

    // Load |U_i'| of the block in a lane, or θ_i − s_i if it sticks.
    Polynomial &load(Polynomial &polynomial, int lane) { return series.load(polynomial, state, lane); }

    // Update the extremes over all blocks between two times of the piece.
    void extremes(Observer &observer, Polynomial &polynomial, double from, double to) {
        for (int c = 0; c < layout.columns; c++) {
            const mask slips = state.slip[c] != vec{};
            const vec bound = search.bound_in_piece(c);
            const vec speed = Blocks::splat(std::min(observer.highest_speed[0], observer.highest_speed[1]));
            const vec gap = layout.threshold[c] - std::max(observer.lowest_force[0], observer.lowest_force[1]);
            const int which = bits(layout.present[c] & (bound > select(slips, speed, gap)));
            for (int lane = 0; which >> lane; lane++) {
                if (!(which >> lane & 1)) continue;
                const int place = c * LANES + lane;
                observer.extreme(state.slip.lane(place) != 0.0, layout.threshold.lane(place), bound[lane], start, from,
                                 to, [&]() -> Polynomial & { return load(polynomial, place); });
            }
        }
    }

    // Add the motion of the blocks between two times of the piece to their slip events.
    // advanced : whether the state is at the later time; otherwise it is at the start of the piece
    void record(Catalogue &catalogue, Polynomial &polynomial, double from, double to, bool advanced) {
        const double t = to - from, v = layout.v;
        if (!(t > 0.0)) return;
        if (from > 0.0 || !advanced) {
            for (Rows *row : {&begun, &ended}) row->reserve(layout.columns);
            for (int c = 0; c < layout.columns; c++) {
                begun[c] = series.value(series.position, c, Blocks::splat(from));
                ended[c] = series.value(series.position, c, Blocks::splat(to));
            }
        }
        if (layout.damped) dissipate(from, to);
        const vec *first = from > 0.0 || !advanced ? begun.at() : series.x(0);
        const vec *last = advanced ? state.position.at() : ended.at();
        const double drifted = advanced ? 0.0 : to;
        for (int c = 0; c < layout.columns; c++) {
            const int slips = bits(layout.present[c] & (state.slip[c] != vec{}));
            if (!slips) continue;
            const vec far = (last[c] - first[c]) + v * t, load = layout.driving[c] * v;
            const vec before = force(first, c, drifted - t), after = force(last, c, drifted);
            vec energy = 0.5 * (before + (after - load * t)) * far;
            if (v > 0.0) {
                vec path = series.integral(c, Blocks::splat(to));
                if (from > 0.0) path -= series.integral(c, Blocks::splat(from));
                energy += load * (t * (far - 0.5 * v * t) - (path - first[c] * t));
            }
            const vec bound = search.bound_in_piece(c);
            const vec speed = state.slip[c] * (advanced ? state.velocity[c] : vec{});
            for (int lane = 0; slips >> lane; lane++) {
                const int place = c * LANES + lane;
                Catalogue::Event *event = slips >> lane & 1 ? catalogue.of(layout.member[place]) : nullptr;
                if (!event) continue;
                event->energy += energy[lane];
                if (layout.damped) event->damped += damped[c][lane];
                event->peak_velocity = std::max(event->peak_velocity, speed[lane]);
                if (bound[lane] <= event->peak_velocity) continue;
                load_speed(polynomial, place, from);
                catalogue.consider(*event, polynomial, t, bound[lane]);
            }
        }
    }

  private:
    Rows begun, ended, speeds, damped;

    // Energy dissipated by dashpots between two times of the piece, per block. The sum over slipping blocks equals the
    // sum over dashpots.
    void dissipate(double from, double to) {
        for (Rows *row : {&speeds, &damped}) row->reserve(layout.columns);
        for (int c = 0; c < layout.columns; c++) damped[c] = vec{};
        for (int j = 0; j < NODES; j++) {
            const vec at = Blocks::splat(0.5 * ((from + to) + (to - from) * GAUSS.node[j]));
            const double weight = GAUSS.weight[j] * (to - from);
            for (int c = 0; c < layout.columns; c++) speeds[c] = series.value(series.velocity, c, at);
            for (int c = 0; c < layout.columns; c++)
                damped[c] += weight * (layout.damping_load[c] * (layout.v - 2.0 * speeds[c]) -
                                       speeds[c] * state.damping(speeds.at(), c));
        }
    }

    // The spring forces on a column of blocks at positions x, at a time of the piece.
    vec force(const vec *x, int c, double t) const {
        return layout.sliding_force[c] + layout.drift[c] * t + layout.spring_pull(x, 0, c, t);
    }

    void load_speed(Polynomial &polynomial, int lane, double from) {
        load(polynomial, lane);
        if (from > 0.0) polynomial.shift(from);
    }

    void load_section(int begin, int end, int extra) {
        const int n = size();
        for (int k = 0; k <= Blocks::ORDER; k++) {
            const double *x = &series.position.lane(size_t(k) * series.columns * LANES);
            double total = 0.0;
            for (int i = begin; i < end; i++) total += x[i];
            vec *g = series.g(k);
            if (extra) g[series.columns] = Blocks::splat(k == 0 ? 1.0 : 0.0);
            g[n / LANES][n % LANES] = side * total;
        }
    }
};

}  // namespace bk
