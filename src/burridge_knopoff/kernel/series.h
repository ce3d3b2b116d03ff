// Taylor series of the motion between two events, with a step that leaves no remainder.
//
// Coefficients follow from x' = U' − v and m U'' = F − θ Φ by recursion, with F the force of springs and dashpots;
// those of Φ follow from the operations of the law. The step size is set by the last two coefficients (Jorba and Zou):
// the last retained terms stay below TRUNCATION, and the neglected terms are smaller still. For the linearized law this
// is guaranteed by a bound: all derivatives of the motion obey the same linear equation, whose energy, formed from
// pairs of successive derivatives of all blocks, grows at most like exp(2aτ) within a step.
//
// Reference: A. Jorba and M. Zou, "A software package for the numerical integration of ODEs by means of high-order
// Taylor methods", Exp. Math. 14 (2005) 99-117.
#pragma once

#include <utility>

#include "friction_series.h"
#include "polynomial.h"
#include "state.h"

namespace bk {

// Terms are neglected below 2 to minus this power.
constexpr int TRUNCATION = 53;

// Longest piece, while nothing slips; its high powers are still finite.
constexpr double LONGEST = 1e9;

// About the times at which terms with the last two powers reach TRUNCATION, by the exponent of their coefficients.
template <int ORDER>
struct StepLengths {
    double last[2048], previous[2048];
    StepLengths() {
        for (int e = 0; e < 2048; e++) {
            last[e] = length(e, ORDER);
            previous[e] = length(e, ORDER - 1);
        }
    }
    static double length(int exponent, int power) {
        const int digits = 1022 - TRUNCATION - exponent, whole = int(std::floor(double(digits) / power));
        // Roots of 2 are truncated to 30 bits because C libraries differ in the last bit.
        const double root = std::floor(std::exp2(30.0 + double(digits - whole * power) / power));
        return std::min(std::ldexp(root, whole - 30), LONGEST);
    }
};
template <int ORDER>
inline const StepLengths<ORDER> STEP_LENGTHS;

inline constexpr auto INVERSE = [] {
    struct {
        double at[MOST_TERMS + 2];
        constexpr double operator[](int n) const { return at[n]; }
    } table{};
    for (int n = 1; n < MOST_TERMS + 2; n++) table.at[n] = 1.0 / n;
    return table;
}();

// One piece of the motion: positions x_i, velocities U_i' and the event functions g_i as polynomials of the time since
// its start.
//
// Coefficient k of column c is in row k · width + c. g_i is the speed |U_i'| of a slipping block and θ_i − F_i of a
// stuck one: the block changes where g_i falls below 0. Rows of g may have an additional column for the section.
template <class L>
struct Series {
    static constexpr int ORDER = L::ORDER;
    using vec = typename L::vec;
    using mask = typename L::mask;
    using Rows = typename L::Rows;
    using Number = typename L::Number;

    L &layout;
    int columns = 0, width = 0;
    Rows position, velocity, gap;
    Rows slipping, stuck;  // 1 where a block slips, or sticks
    // Series of the piece that was expanded last, by this object or another that shares them.
    FrictionSeries<L> &law;

    Series(L &layout, FrictionSeries<L> &law) : layout(layout), law(law) {}

    // Expand the motion from the state; return the time for which the series is valid, 0 if it is not finite. extra :
    // number of columns of g beyond those of the blocks
    vec expand(const State<L> &state, int extra) {
        begin(state, extra);
        if (law.law.linear)
            rows<LINEAR_LAW>(state);
        else if (law.law.hyperbolic)
            rows<HYPERBOLIC_LAW>(state);
        else
            rows<ANY_LAW>(state);
        vec reach = step();
        if (law.law.exponential) {
            reach = law.shorten(reach, columns);
            if (L::ONE_CLOCK) reach = L::least_of_clock(reach);
        }
        return reach;
    }

    BK_INLINE vec *x(int n) { return position.at(size_t(n) * columns); }
    BK_INLINE vec *u(int n) { return velocity.at(size_t(n) * columns); }
    BK_INLINE vec *g(int n) { return gap.at(size_t(n) * width); }

    // Positions or velocities of a column at t. Even and odd powers are summed separately, to be computed in parallel.
    BK_INLINE vec value(const Rows &series, int c, vec t) const {
        const vec *term = series.at(c), square = t * t;
        vec even = term[size_t(ORDER) * columns], odd = term[size_t(ORDER - 1) * columns];
        for (int k = ORDER - 2; k > 0; k -= 2) {
            even = even * square + term[size_t(k) * columns];
            odd = odd * square + term[size_t(k - 1) * columns];
        }
        return (even * square + t * odd) + term[0];
    }

    // The derivative of the velocities of a column at t.
    BK_INLINE vec acceleration(int c, vec t) const {
        vec slope{};
        for (int k = ORDER; k > 0; k--) slope = slope * t + double(k) * velocity[size_t(k) * columns + c];
        return slope;
    }

    // The integral of the positions of a column from 0 to t.
    vec integral(int c, vec t) const {
        const vec *term = position.at(c), square = t * t;
        vec even = INVERSE[ORDER + 1] * term[size_t(ORDER) * columns],
            odd = INVERSE[ORDER] * term[size_t(ORDER - 1) * columns];
        for (int k = ORDER - 2; k > 0; k -= 2) {
            even = even * square + INVERSE[k + 1] * term[size_t(k) * columns];
            odd = odd * square + INVERSE[k] * term[size_t(k - 1) * columns];
        }
        return t * ((even * square + t * odd) + term[0]);
    }

    // Load |U_i'| of the block in a lane of the state, or θ_i − F_i if it sticks.
    Polynomial &load(Polynomial &polynomial, const State<L> &state, size_t place) {
        const int c = int(place / L::LANES), lane = int(place % L::LANES);
        const double slip = state.slip.lane(place);
        if (slip != 0.0) {
            polynomial.load(&velocity.lane(place), columns * L::LANES, ORDER, slip);
            return polynomial;
        }
        polynomial.degree = ORDER;
        for (int k = 0; k <= ORDER; k++) {
            polynomial.coefficient[k] = -layout.spring_pull(x(k), k, c)[lane];
            if (layout.damped) polynomial.coefficient[k] -= state.damping(u(k), c)[lane];
        }
        polynomial.coefficient[0] += layout.threshold[c][lane] - layout.sliding_force[c][lane];
        if (layout.damped) polynomial.coefficient[0] -= layout.damping_load[c][lane];
        polynomial.coefficient[1] -= layout.drift[c][lane];
        return polynomial;
    }

    // Compute the series of friction along the piece again, about a time of it. They are otherwise those of the piece
    // that was expanded last, about its start.
    void restore_friction(const State<L> &state, const Number &from) {
        const bool later = any(vec{} + from > vec{});
        for (int c = 0; c < columns; c++) {
            const vec along = state.slip[c] * layout.weakening[c];
            vec speed[ORDER + 1];
            for (int k = 0; k <= ORDER; k++) speed[k] = along * u(k)[c];
            // Repeated Horner scheme.
            for (int n = 0; n < ORDER && later; n++)
                for (int k = ORDER - 1; k >= n; k--) speed[k] += from * speed[k + 1];
            for (int k = 0; k <= ORDER; k++) {
                law.row(0, c)[k] = speed[k];
                law.fill(c, k, 0, law.law.value);
            }
        }
    }

    // Advance the state by t where `moved` is set.
    void move(State<L> &state, vec t, mask moved) {
        const vec zero{};
        for (int c = 0; c < columns; c++) {
            state.position[c] = select(moved, value(position, c, t), state.position[c]);
            state.velocity[c] = select(moved, value(velocity, c, t), state.velocity[c]);
            state.touching[c] = select(moved & (t > zero), zero, state.touching[c]);
            state.age[c] = select(moved & (slipping[c] > zero), state.age[c] + t, state.age[c]);
            const mask young = moved & (state.age[c] < layout.young);
            if (!any(young)) continue;
            state.acceleration[c] = select(young, acceleration(c, t), state.acceleration[c]);
        }
    }

  private:
    enum Kind { LINEAR_LAW, HYPERBOLIC_LAW, ANY_LAW };
    Rows signed_threshold, friction_slope, pressed, force;
    // Quantities of a column for the recursion, and its last row; along : the derivative of w_i |U_i'|, the argument of
    // the law, by U_i'
    struct Column {
        vec slip, along, stuck, moving, friction_slope, pressed, line_slope, inverse_slope, start, force, speed;
        vec *line, *inverse;
        bool rests;  // whether all blocks of the column stick
    };
    std::vector<Column> column;

    // Fill the rows 0 and 1 that follow from the state.
    void begin(const State<L> &state, int extra) {
        columns = layout.columns;
        width = columns + extra;
        const size_t rows = ORDER + 1;
        position.reserve(rows * columns);
        velocity.reserve(rows * columns);
        gap.reserve(rows * width);
        for (Rows *row : {&slipping, &stuck, &signed_threshold, &friction_slope, &pressed, &force})
            row->reserve(columns);
        law.widen(columns);
        for (int c = 0; c < columns; c++) {
            x(0)[c] = state.position[c];
            u(0)[c] = state.velocity[c];
            x(1)[c] = state.velocity[c] - layout.v;
        }
        for (int c = 0; c < columns; c++) {
            const vec slip = state.slip[c], own = slip * u(0)[c], s = state.force(c);
            const vec along = slip * layout.weakening[c], argument = own * layout.weakening[c];
            slipping[c] = slip * slip;
            stuck[c] = 1.0 - slipping[c];
            // With the sign of the slip direction, as friction; divided by the mass, as accelerations.
            signed_threshold[c] = (slip * layout.threshold[c]) * layout.inverse_mass[c];
            vec friction, slope;
            if (law.law.linear) {
                friction = layout.at_rest - layout.rate * argument;
                slope = -layout.rate - vec{};
            } else {
                law.start(c, argument);
                friction = law.friction(c, 0);
                slope = law.slopes(c)[law.law.value];
            }
            friction_slope[c] = signed_threshold[c] * (slope * along);
            if (law.law.hyperbolic) {
                const Number scale = law.law.value == 3 ? law.tape[2].alpha : Number{} + 1.0;
                pressed[c] = -(signed_threshold[c] * (scale * law.row(2, c)[0]));
            }
            vec acceleration = slipping[c] * (s * layout.inverse_mass[c]) - signed_threshold[c] * friction;
            const mask young = (slip != vec{}) & ((state.touching[c] > 0.0) | (state.age[c] < layout.young));
            if (any(young)) acceleration = select(young, state.slip_acceleration(c, s, young), acceleration);
            u(1)[c] = acceleration;
            g(0)[c] = own + (slipping[c] * layout.creep_speed + stuck[c] * (layout.threshold[c] - s));
        }
        for (int c = 0; c < columns; c++) force[c] = state.force_rate(x(1), u(1), c);
    }

    // Fill row n of g, and row n + 1 of positions and velocities, from the rows before: n = 1 … ORDER − 1. Friction in
    // row n is its slope at the start times U'_n, plus a part that follows from the rows before, so that it can be
    // computed before U'_n.
    template <Kind KIND>
    void rows(const State<L> &state) {
        constexpr int FEW = L::ONE_CLOCK ? 1 : 3, FEWER = L::ONE_CLOCK ? 1 : 2;
        if (layout.damped) return fill<KIND, 0, true>(state);
        if constexpr (L::ONE_CLOCK)
            if (layout.is_open_row()) return fill<KIND, 1, false, true>(state);
        columns == FEW ? fill<KIND, FEW>(state) : columns == FEWER ? fill<KIND, FEWER>(state) : fill<KIND, 0>(state);
    }

    // COLUMNS : the number of columns, 0 for any. If it is known, the compiler keeps a row in registers.
    // OPEN : whether the blocks are an open row in one column
    template <Kind KIND, int COLUMNS, bool DAMPED = false, bool OPEN = false>
    void fill(const State<L> &state) {
        const int count = COLUMNS ? COLUMNS : columns;
        Column known[COLUMNS ? COLUMNS : 1];
        if (!COLUMNS && int(column.size()) < count) column.resize(count);
        Column *own = COLUMNS ? known : column.data();
        for (int c = 0; c < count; c++) {
            Column &at = own[c];
            at.slip = state.slip[c];
            at.stuck = stuck[c];
            at.moving = slipping[c] * layout.inverse_mass[c];
            at.rests = L::ONE_CLOCK && !COLUMNS && KIND == HYPERBOLIC_LAW && !any(at.slip != vec{});
            at.friction_slope = friction_slope[c];
            at.force = force[c];
            at.speed = u(1)[c];
            if constexpr (KIND != LINEAR_LAW) at.along = at.slip * layout.weakening[c];
            if constexpr (KIND == HYPERBOLIC_LAW) {
                at.line = law.row(1, c);
                at.inverse = law.row(2, c);
                at.line_slope = law.slopes(c)[1] * at.along;
                at.inverse_slope = law.slopes(c)[2] * at.along;
                at.start = at.inverse[0];
            }
            at.pressed = KIND == HYPERBOLIC_LAW ? pressed[c] : signed_threshold[c];
        }
        Blocks::OpenRow open;
        if constexpr (OPEN) open = layout.open_row();
        vec *position = x(2), *velocity = u(2), *g = this->g(1);
        const size_t step = COLUMNS ? COLUMNS : columns, gap_step = width;
        auto row = [&](auto n) __attribute__((always_inline)) {
            const double factor = INVERSE[n + 1];
            for (int c = 0; c < count; c++) {
                Column &at = own[c];
                if (!COLUMNS && at.rests) {
                    g[c] = -at.force;
                    at.line[n] = at.inverse[n] = at.speed = velocity[c] = position[c] = vec{};
                    continue;
                }
                const vec speed = at.speed;
                g[c] = at.slip * speed - at.stuck * at.force;
                vec next = (at.moving * factor) * at.force;
                if constexpr (KIND == HYPERBOLIC_LAW) {
                    const vec total = inner(at.line, at.inverse, n);
                    next -= (at.pressed * factor) * total;
                    at.line[n] = at.line_slope * speed;
                    at.inverse[n] = at.inverse_slope * speed - at.start * total;
                } else if constexpr (KIND == ANY_LAW) {
                    next -= (at.pressed * factor) * law.prepare(c, n);
                    law.settle(c, n, at.along * speed);
                }
                at.speed = velocity[c] = next - (at.friction_slope * factor) * speed;
                position[c] = speed * factor;
            }
            for (int c = 0; c < count; c++) {
                if constexpr (OPEN)
                    own[c].force = open.pull(position[c]);
                else
                    own[c].force = layout.spring_pull(position, n + 1, c);
                if constexpr (DAMPED) own[c].force += state.damping(velocity, c);
            }
            position += step;
            velocity += step;
            g += gap_step;
        };
        // Unrolled rows need no predicted branches. With several columns there are so many instructions that they are
        // only worth decoding if each acts on eight lanes.
        if constexpr ((COLUMNS == 1 && KIND != ANY_LAW) || (COLUMNS > 1 && KIND == HYPERBOLIC_LAW && L::LANES == 8)) {
            [&]<int... K>(std::integer_sequence<int, K...>) {
                (row(std::integral_constant<int, K + 1>{}), ...);
            }(std::make_integer_sequence<int, ORDER - 1>{});
        } else {
            for (int n = 1; n < ORDER; n++) row(n);
        }
        for (int c = 0; c < count; c++) g[c] = own[c].slip * own[c].speed - own[c].stuck * own[c].force;
    }

    // The time over which the last retained terms stay below TRUNCATION; LONGEST if nothing slips; 0 if a term is NaN.
    // The sum of the terms is tested, since the maximum of NaN and a number may be the number.
    vec step() {
        vec last{}, previous{}, total{};
        for (int c = 0; c < columns; c++) {
            const vec one = magnitude(u(ORDER)[c]), other = magnitude(u(ORDER - 1)[c]);
            last = largest(last, one);
            previous = largest(previous, other);
            total += one + other;
        }
        const mask finite = total < 1e300;
        if (L::ONE_CLOCK) {
            if (bits(finite) != bits(L::all_lanes(true))) return vec{};
            return L::splat(length(exponent(largest_lane(last)), exponent(largest_lane(previous))));
        }
        const mask of_last = (mask)last >> 52, of_previous = (mask)previous >> 52;
        vec reach;
        for (int lane = 0; lane < L::LANES; lane++) reach[lane] = length(of_last[lane], of_previous[lane]);
        return select(finite, reach, vec{});
    }

    static double length(int64_t last, int64_t previous) {
        return std::min(STEP_LENGTHS<ORDER>.last[last], STEP_LENGTHS<ORDER>.previous[previous]);
    }
};

}  // namespace bk
