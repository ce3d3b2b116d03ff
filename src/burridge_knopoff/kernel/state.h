// The state of a chain as a solver moves it on, and the stick-slip rules that change it.
//
// Coordinates are co-moving: position is x_i = U_i − vτ − e_i with K e = −θ Φ(v), velocity is U_i' itself, so that a
// stuck block has velocity exactly 0. Nothing in the system depends on τ. A block slips against friction θ_i Φ, and
// starts where the spring force on it passes θ_i.
#pragma once

#include "law.h"
#include "springs.h"

namespace bk {

// Times closer than this, in units of the chain, are one instant: the clock does not resolve them. Blocks whose motion
// is the same to the bit change together, however far from their threshold rounding leaves them.
constexpr double COINCIDENCE = 1e-14;

// A block that has slipped for less than this, in units of the chain, keeps the acceleration that was carried along
// since its start, which began at exactly 0: 1 − s recomputed from positions would be rounding (1e-16), and its sign
// could stop the block.
constexpr double YOUNG = 1e-6;
constexpr double LONG = 1e300;

// Rounding of a spring force at its threshold, as a share of the terms that make it up.
constexpr double AT_THRESHOLD = 1e-13;

// The friction and the driver of a model.
struct Model {
    Springs springs;
    Law law;
    double v;
    bool symmetric;  // whether a block that is pulled below −θ_i slips backward

    bool drops() const { return law.at_rest < 1.0; }
    double coincidence() const { return COINCIDENCE * springs.unit; }
    double young() const { return YOUNG * springs.unit; }
};

// Positions x_i, velocities U_i', slip directions (0 stuck, 1 forward, −1 backward) and what the next event depends on.
//
// `touching` marks a block whose spring force is at its threshold exactly, because it has started (or started and
// stopped again) at this very instant. `age` is the time since the start of the present slip.
template <class L>
struct State {
    const Model &model;
    L &layout;
    Vectors position, velocity, acceleration, age, slip, touching;

    State(const Model &model, L &layout) : model(model), layout(layout) { widen(); }

    void widen() {
        for (Vectors *row : {&position, &velocity, &acceleration, &age, &slip, &touching}) row->reserve(layout.columns);
    }

    // Set one block, in lane k of all lanes: a stuck one has velocity 0.
    void place(size_t k, double x, double speed, bool stuck) {
        position.lane(k) = x;
        velocity.lane(k) = stuck ? 0.0 : speed;
        slip.lane(k) = stuck ? 0.0 : speed < 0.0 ? -1.0 : 1.0;
        acceleration.lane(k) = 0.0;
        age.lane(k) = LONG;
        touching.lane(k) = 0.0;
    }

    // The spring force s_i, and its rate.
    BK_INLINE vec force(int c) const {
        return layout.sliding_force[c] + (layout.pull(position.at(), c) - layout.diagonal[c] * position[c]);
    }
    BK_INLINE vec force_rate(const vec *relative, int c) const {
        return layout.drift[c] + (layout.pull(relative, c) - layout.diagonal[c] * relative[c]);
    }

    // Friction at a speed |U_i'|, one by one where it matters little how long that takes.
    BK_INLINE vec friction(vec speed) const {
        if (model.law.linear) return model.law.at_rest - model.law.rate * speed;
        return each(speed, [this](double u) { return model.law.at(u); });
    }

    // U_i'' of a block that starts at its threshold: 0, exactly, unless friction drops at the start.
    BK_INLINE vec start_acceleration(int c) const {
        return (layout.threshold[c] * (1.0 - model.law.at_rest)) * layout.inverse_mass[c];
    }

    // U_i'' of slipping blocks.
    BK_INLINE vec slip_acceleration(int c, vec force) const {
        const vec own = slip[c] * velocity[c];
        vec made = (force - slip[c] * (layout.threshold[c] * friction(own))) * layout.inverse_mass[c];
        made = select(age[c] < model.young(), acceleration[c], made);
        return select((touching[c] > 0.0), slip[c] * start_acceleration(c), made);
    }

    // Where blocks change at this very instant: they are past their threshold, or within COINCIDENCE of it.
    mask pending(const vec *relative, int c) const {
        const double coincidence = model.coincidence();
        const vec zero{}, s = force(c);
        const mask touches = touching[c] > 0.0, stuck = slip[c] == zero;
        const vec rate = force_rate(relative, c);
        vec gap = slip[c] * velocity[c];
        mask stopping = gap < zero;
        const mask close = (gap <= coincidence) & ~stuck & ~stopping & ~touches & layout.present[c];
        if (any(close)) stopping |= close & (gap < -coincidence * (slip[c] * slip_acceleration(c, s)));
        // At a start with Φ(0) < 1 the block has an acceleration, whatever the rate of the force.
        stopping &= ~touches;
        if (!model.drops()) stopping |= touches & (slip[c] * rate < zero);
        const vec near = coincidence * layout.diagonal[c];
        gap = layout.threshold[c] - s;
        mask starting = (gap < zero) | ((gap <= near) & (gap < coincidence * rate));
        if (model.symmetric) {
            gap = layout.threshold[c] + s;
            starting |= (gap < zero) | ((gap <= near) & (gap < -coincidence * rate));
        }
        return ((stopping & ~stuck) | (starting & stuck & ~touches)) & layout.present[c];
    }

    // Whether spring forces that start blocks are their thresholds, within rounding.
    BK_INLINE mask at_threshold(int c, vec s) const {
        const vec size = largest(layout.threshold[c], layout.diagonal[c] * magnitude(position[c]));
        return magnitude(s) - layout.threshold[c] <= AT_THRESHOLD * size;
    }

    // Let blocks stop if they slip and start if they are stuck.
    void transition(int c, mask where) {
        const vec zero{}, s = force(c);
        const mask starting = where & (slip[c] == zero);
        const vec direction = select(s > zero, splat(1.0), splat(-1.0));
        velocity[c] = select(where, zero, velocity[c]);
        acceleration[c] = select(where, zero, acceleration[c]);
        slip[c] = select(where, select(starting, direction, zero), slip[c]);
        age[c] = select(where, splat(LONG), age[c]);
        // A block that stopped beyond its threshold starts again with the acceleration that the excess gives it.
        const mask touches = starting & at_threshold(c, s);
        touching[c] = select(touches, splat(1.0), touching[c]);
        age[c] = select(touches, zero, age[c]);
        acceleration[c] = select(touches, direction * start_acceleration(c), acceleration[c]);
    }
};

}  // namespace bk
