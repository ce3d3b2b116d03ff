// The state of a chain during integration, and the stick-slip rules that change it.
//
// Coordinates are co-moving: position is x_i = U_i − vτ − e_i with K e = −θ Φ(w v), velocity is U_i' itself, so that a
// stuck block has velocity exactly 0. Nothing in the system depends on τ. A block slips against friction θ_i Φ(w_i
// |U_i'|), and starts where the force of its springs and dashpots passes θ_i.
#pragma once

#include "layout.h"

namespace bk {

constexpr double LONG = 1e300;

// Rounding of a spring force at its threshold, as a share of the terms that make it up.
constexpr double AT_THRESHOLD = 1e-13;

// Positions x_i, velocities U_i', slip directions (0 stuck, 1 forward, −1 backward) and what the next event depends on.
//
// `touching` marks a block on which the force is exactly at its threshold, because it has started (or started and
// stopped again) at this instant. `age` is the time since the start of the present slip.
template <class L>
struct State {
    using vec = typename L::vec;
    using mask = typename L::mask;

    L &layout;
    typename L::Rows position, velocity, acceleration, age, slip, touching;
    // Set by `measure`: U_i' − v and, with dashpots, U_i''.
    typename L::Rows relative, slope;

    explicit State(L &layout) : layout(layout) { widen(); }

    void widen() {
        for (auto *row : {&position, &velocity, &acceleration, &age, &slip, &touching, &relative, &slope})
            row->reserve(layout.columns);
    }

    // Set the block in lane k of all lanes; a stuck block has velocity 0.
    void place(size_t k, double x, double speed, bool stuck) {
        position.lane(k) = x;
        velocity.lane(k) = stuck ? 0.0 : speed;
        slip.lane(k) = stuck ? 0.0 : speed < 0.0 ? -1.0 : 1.0;
        acceleration.lane(k) = 0.0;
        age.lane(k) = LONG;
        touching.lane(k) = 0.0;
    }

    // Set the block in lane k of all lanes to the block in a lane of another state.
    template <class Other>
    void copy(size_t k, const State<Other> &from, size_t other) {
        position.lane(k) = from.position.lane(other);
        velocity.lane(k) = from.velocity.lane(other);
        acceleration.lane(k) = from.acceleration.lane(other);
        age.lane(k) = from.age.lane(other);
        slip.lane(k) = from.slip.lane(other);
        touching.lane(k) = from.touching.lane(other);
    }

    // The force of springs and dashpots on slipping and stuck blocks, and its rate. relative, slope : U_i' − v and
    // U_i''
    BK_INLINE vec force(int c) const {
        vec made = layout.sliding_force[c] + layout.spring_pull(position.at(), 0, c);
        if (layout.damped) made += layout.damping_load[c] + damping(velocity.at(), c);
        return made;
    }
    BK_INLINE vec force_rate(const vec *relative, const vec *slope, int c) const {
        vec made = layout.drift[c] + layout.spring_pull(relative, 1, c);
        if (layout.damped) made += damping(slope, c);
        return made;
    }
    vec force_rate(int c) const { return force_rate(relative.at(), slope.at(), c); }
    // −(C u)_i for velocities u, or their rates.
    BK_INLINE vec damping(const vec *u, int c) const { return layout.dashpot_pull(u, c); }

    // Compute what the rates of forces depend on.
    void measure() {
        const vec zero{};
        for (int c = 0; c < layout.columns; c++) relative[c] = velocity[c] - layout.v;
        for (int c = 0; layout.damped && c < layout.columns; c++) {
            const mask slips = slip[c] != zero;
            slope[c] = select(slips, slip_acceleration(c, force(c), slips), zero);
        }
    }

    // Friction at w_i |U_i'|, in some lanes: lane by lane, since few are needed.
    BK_INLINE vec friction(vec argument, mask where) const {
        if (layout.linear) return layout.at_rest - layout.rate * argument;
        const int which = bits(where);
        return each(argument, [&](double u, int lane) { return which >> lane & 1 ? layout.law(lane).at(u) : 0.0; });
    }

    // U_i'' of a block that starts at its threshold: exactly 0 unless friction drops at the start.
    BK_INLINE vec start_acceleration(int c) const {
        return (layout.threshold[c] * (1.0 - layout.at_rest)) * layout.inverse_mass[c];
    }

    // U_i'' of slipping blocks, in some lanes.
    BK_INLINE vec slip_acceleration(int c, vec force, mask where) const {
        const vec own = (slip[c] * layout.weakening[c]) * velocity[c];
        const mask young = age[c] < layout.young, touches = touching[c] > 0.0;
        const vec resistance = slip[c] * (layout.threshold[c] * friction(own, where & ~young & ~touches));
        const vec made = select(young, acceleration[c], (force - resistance) * layout.inverse_mass[c]);
        return select(touches, slip[c] * start_acceleration(c), made);
    }

    // Where blocks change at this instant: they are beyond their threshold, or within COINCIDENCE of it. Call `measure`
    // first.
    mask pending(int c) const {
        const auto coincidence = layout.coincidence;
        const vec zero{}, s = force(c);
        const mask touches = touching[c] > 0.0, stuck = slip[c] == zero;
        const vec rate = force_rate(c);
        vec gap = slip[c] * velocity[c] + layout.creep_speed;
        mask stopping = gap < zero;
        const mask close = (gap <= coincidence) & ~stuck & ~stopping & ~touches & layout.present[c];
        if (any(close)) stopping |= close & (gap < -coincidence * (slip[c] * slip_acceleration(c, s, close)));
        // At a start with Φ(0) < 1 the block has an acceleration, whatever the rate of the force.
        stopping &= ~touches;
        if (!layout.drops) stopping |= touches & (slip[c] * rate < zero);
        vec near = coincidence * layout.diagonal[c];
        if (layout.damped) near += coincidence * layout.damping_diagonal[c];
        gap = layout.threshold[c] - s;
        mask starting = (gap < zero) | ((gap <= near) & (gap < coincidence * rate));
        if (layout.symmetric) {
            gap = layout.threshold[c] + s;
            starting |= (gap < zero) | ((gap <= near) & (gap < -coincidence * rate));
        }
        return ((stopping & ~stuck) | (starting & stuck & ~touches)) & layout.present[c];
    }

    // Whether forces that start blocks are at their thresholds within rounding.
    BK_INLINE mask at_threshold(int c, vec s) const {
        vec size = largest(layout.threshold[c], layout.diagonal[c] * magnitude(position[c]));
        if (layout.damped) size = largest(size, layout.damping_diagonal[c] * fastest());
        return magnitude(s) - layout.threshold[c] <= AT_THRESHOLD * size;
    }
    // Where a block sticks, or its slip has become slower than a limit; fastest : the highest angular frequency of the
    // chain, above the rate at which the speed of an overdamped slip decays
    mask rests(int c, double limit, double fastest) const {
        return rests(c, velocity[c], slip_acceleration(c, force(c), slip[c] != vec{}), limit, fastest);
    }
    // The same for a slip of another speed and acceleration.
    mask rests(int c, vec speed, vec change, double limit, double fastest) const {
        return (slip[c] == vec{}) | ((magnitude(speed) <= limit) & (magnitude(change) <= fastest * limit));
    }
    // The largest |U_i'| of all blocks.
    vec fastest() const {
        vec found{};
        for (int c = 0; c < layout.columns; c++) found = largest(found, magnitude(velocity[c]));
        return L::ONE_CLOCK ? L::splat(largest_lane(found)) : found;
    }

    // Stop blocks that slip, and start blocks that are stuck.
    void transition(int c, mask where) {
        const vec zero{}, s = force(c);
        const mask starting = where & (slip[c] == zero);
        const vec direction = select(s > zero, L::splat(1.0), L::splat(-1.0));
        velocity[c] = select(where, zero, velocity[c]);
        acceleration[c] = select(where, zero, acceleration[c]);
        slip[c] = select(where, select(starting, direction, zero), slip[c]);
        age[c] = select(where, L::splat(LONG), age[c]);
        // A block that stopped beyond its threshold starts again with the acceleration that the excess gives it.
        const mask touches = starting & at_threshold(c, s);
        touching[c] = select(touches, L::splat(1.0), touching[c]);
        age[c] = select(touches, zero, age[c]);
        acceleration[c] = select(touches, direction * start_acceleration(c), acceleration[c]);
        if constexpr (L::ONE_CLOCK)
            if (layout.increments.used) follow(c, bits(where));
    }

    // Forces by increments: blocks of a column have stopped or started.
    void follow(int c, int which) {
        for (int lane = 0; which >> lane; lane++) {
            if (!(which >> lane & 1)) continue;
            const int k = c * L::LANES + lane;
            if (slip.lane(k) != 0.0)
                layout.increments.start(layout.model.springs, layout.member, k);
            else
                layout.increments.stop(layout.sliding_force, k, position.lane(k));
        }
    }
};

}  // namespace bk
