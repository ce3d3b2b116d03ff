// Observables computed during the motion, piece by piece, without storing it.
#pragma once

#include "distance.h"
#include "events.h"
#include "record.h"

namespace bk {

constexpr double NOTHING = -1e300;
// J is certainly above a level from which it is this far, relative and absolute: more than rounding.
constexpr double CLEAR = 1e-9;
enum Stage { TRANSIENT, WINDOW };

// The measurements of one run.
//
// edge : batch boundaries; the first is the end of the transient, the last the end of the run
// distance_time : times at which J is sampled; trajectory_time : times at which positions and velocities are sampled
// level : levels of J; the last time at which J is at least at each of them is found
// section_only : whether averages of J and extremes are omitted
// section : block whose x_i is W, from 1 on; 0 if W is the sum of all x_i
struct Observer {
    const int blocks;
    const double apart;  // U_N − U_1 in uniform sliding
    const std::vector<double> edge, distance_time, trajectory_time, level;
    const bool section_only;
    const int section;
    double begin = 0.0;
    std::vector<double> batch_integral, batch_rest, distance_sample, trajectory_position, trajectory_velocity;
    size_t batch = 0, next_distance = 0, next_trajectory = 0;
    Record crossings;
    int side = 0;
    // Time since which the run that this run continues has searched for crossings.
    double section_from = UNKNOWN;
    double highest_speed[2] = {NOTHING, NOTHING}, lowest_force[2] = {-NOTHING, -NOTHING};
    Distance distance;
    // When J was last at least at each level: ∞ while it is, −∞ if it has not been.
    std::vector<double> last_at;
    // The levels next to J at the end of the piece before, which is at least at the lower one and below the higher one.
    double lower = -INFINITY, higher = INFINITY;

    Observer(int blocks, double apart, std::vector<double> edges, std::vector<double> distance_times,
             std::vector<double> trajectory_times, std::vector<double> levels, bool section_only, int section,
             double most_numbers)
        : blocks(blocks), apart(apart), edge(std::move(edges)), distance_time(std::move(distance_times)),
          trajectory_time(std::move(trajectory_times)), level(std::move(levels)), section_only(section_only),
          section(section), batch_integral(edge.size() - 1), batch_rest(edge.size() - 1),
          distance_sample(distance_time.size(), NAN), trajectory_position(trajectory_time.size() * blocks, NAN),
          trajectory_velocity(trajectory_time.size() * blocks, NAN), crossings(2, most_numbers),
          last_at(level.size(), -INFINITY) {
        for (double one : level) higher = std::min(higher, one);
    }

    double transient() const { return edge.front(); }
    double end() const { return edge.back(); }
    bool in_section(int block) const { return section == 0 || block == section - 1; }

    // Whether J is needed in a piece, up to a time of it.
    bool wants_distance(const Clock &start, double to) const {
        return !level.empty() || (!section_only && to > start.until(transient())) ||
               (next_distance < distance_time.size() && start.until(distance_time[next_distance]) <= to);
    }

    // Add the integral of J between two times of a piece, whose `distance` is loaded, and take samples.
    void average(const Clock &start, double from, double to) {
        if (!section_only && to > start.until(transient())) {
            double begins = std::max(from, start.until(edge[batch]));
            while (batch < batch_integral.size()) {
                const double ends = start.until(edge[batch + 1]), stop = std::min(ends, to);
                if (stop > begins) add(distance.integral(begins, stop));
                if (ends > to || batch == batch_integral.size() - 1) break;
                batch++;
                begins = std::max(from, ends);
            }
        }
        for (; next_distance < distance_time.size(); next_distance++) {
            const double t = start.until(distance_time[next_distance]);
            if (t > to) break;
            distance_sample[next_distance] = distance.value(t);
        }
    }

    // Find when J is last at least at each level between two times of a piece, whose `distance` is loaded.
    // ending : J at the later time within rounding, −∞ if it is not known: far above a level it need not be computed
    void compare(const Clock &start, double from, double to, double ending = -INFINITY) {
        // A continued run repeats a piece of the previous run.
        from = std::max(from, start.until(begin));
        if (!(from <= to)) return;
        const double most = higher < INFINITY ? distance.bound(to) : 0.0;
        const bool stays = lower == -INFINITY || ending - lower > CLEAR * (1.0 + lower);
        if (stays && most < higher) return;
        const double ends = distance.value(to);
        if (ends >= lower && most < higher) return;
        lower = -INFINITY;
        higher = INFINITY;
        for (size_t k = 0; k < level.size(); k++) {
            if (ends >= level[k]) {
                last_at[k] = INFINITY;
                lower = std::max(lower, level[k]);
                continue;
            }
            higher = std::min(higher, level[k]);
            if (most < level[k] && last_at[k] < INFINITY) continue;
            double last = distance.last_at(level[k], from, to);
            // Rounding may hide that J leaves the level between two pieces.
            if (last < from && last_at[k] == INFINITY) last = from;
            if (last >= from) last_at[k] = start.time + (start.rest + last);
        }
    }

    // Add a part of the integral of J to the present batch: compensated sums.
    void add(double term) {
        const double total = batch_integral[batch] + term;
        batch_rest[batch] += (batch_integral[batch] - total) + term;
        batch_integral[batch] = total;
    }

    // Store the state at the next time of the trajectory. value(i, x, u) sets position and velocity of block i
    template <class Value>
    void sample(Value &&value) {
        for (int i = 0; i < blocks; i++)
            value(i, trajectory_position[next_trajectory * blocks + i],
                  trajectory_velocity[next_trajectory * blocks + i]);
        next_trajectory++;
    }

    // Record where W changes its sign between two times of a piece, with W' and the direction.
    //
    // The sign of W is carried over from piece to piece, so that rounding between two pieces can neither hide nor
    // create a crossing.
    //
    // w : W as a polynomial
    // crossing : time of the sign change before `to`, if EventSearch has found it
    // reach : end of the piece. Sign changes are searched for up to there, so that the end of a run changes no bit
    // rate(t) : W' = Σ (U_i' − v)
    template <class Rate>
    void cross(Polynomial &w, double crossing, const Clock &start, double from, double to, double reach, Rate &&rate) {
        const double until_window = start.until(std::min(transient(), section_from));
        if (side != 0 && crossing != EventSearch<Blocks>::UNCERTAIN) {
            if (crossing >= from && crossing >= 0.0) turn(crossing, start, rate);
            return;
        }
        double begins = from;
        if (from > 0.0) w.shift(from);
        if (side == 0) {
            const double ahead = std::max(0.0, until_window - from);
            side = w.value(ahead) < 0.0 ? -1 : 1;
            w.shift(ahead);
            begins += ahead;
        }
        const double value = side * w.coefficient[0];
        if (-SEAM < value && value < 0.0 && side * w.coefficient[1] > 0.0) {
            w.coefficient[0] = 0.0;
            w.deflate();
        }
        while (begins < to) {
            if (side < 0) w.negate();
            const double t = w.first_root(reach - begins);
            if (side < 0) w.negate();
            if (t < 0.0 || begins + t > to) return;
            begins += t;
            // The root is divided out, together with the rounding error of W there. If the signs before and after it
            // are equal, W has touched 0 within rounding and not crossed it.
            w.shift(t);
            w.coefficient[0] = 0.0;
            w.deflate();
            if (side * w.coefficient[0] >= 0.0) continue;
            turn(begins, start, rate);
        }
    }

    // Update the highest slip speed and the lowest force on a stuck block, in transient and window, in a piece from one
    // time to another. |U_i'| or θ_i − s_i, a polynomial that `load` returns, is at most `bound` in the piece.
    template <class Load>
    void extreme(bool slips, double threshold, double bound, const Clock &start, double from, double to, Load &&load) {
        const double until_window = start.until(transient()), until_begin = start.until(begin);
        if (to > until_window) extreme_in(WINDOW, slips, threshold, bound, std::max(from, until_window), to, load);
        if (from < until_window)
            extreme_in(TRANSIENT, slips, threshold, bound, std::max(from, until_begin), std::min(to, until_window),
                       load);
    }

    bool is_new(Stage stage, bool slips, double threshold, double bound) const {
        return slips ? bound > highest_speed[stage] : bound > threshold - lowest_force[stage];
    }

  private:
    template <class Rate>
    void turn(double t, const Clock &start, Rate &&rate) {
        side = -side;
        // A continued run repeats a piece of the previous run, which has stored the crossings in this piece.
        if (t <= start.until(begin)) return;
        if (double *row = crossings.append(start.time + (start.rest + t))) {
            row[0] = rate(t);
            row[1] = side;
        }
    }

    template <class Load>
    void extreme_in(Stage stage, bool slips, double threshold, double bound, double from, double to, Load &&load) {
        if (!is_new(stage, slips, threshold, bound)) return;
        Polynomial &polynomial = load();
        from = std::max(from, 0.0);
        if (from > 0.0) polynomial.shift(from);
        if (slips)
            highest_speed[stage] = polynomial.maximum(to - from, highest_speed[stage]);
        else
            lowest_force[stage] = threshold - polynomial.maximum(to - from, threshold - lowest_force[stage]);
    }
};

// The event sequence of a run.
//
// `earlier` has rows (time | block, kind) for events before `states_from`; `events` has rows (time | block, kind, x_1 …
// x_N, U_1' … U_N') for those from `states_from` on. With `stops_only` only the stops from `states_from`
// on are stored. More than `rate_limit` events in one time unit of the chain count as an accumulation. All times are
// those of the slip clock.
struct EventLog {
    const double states_from;
    const bool keep, stops_only;
    const long long rate_limit;
    Record earlier, events;
    long long count = 0, unit_count = 0;
    double unit = 1.0, unit_start = 0.0;
    bool accumulating = false;

    EventLog(int blocks, double states_from, bool keep, long long rate_limit, bool stops_only, double most_numbers)
        : states_from(states_from), keep(keep), stops_only(stops_only), rate_limit(rate_limit),
          earlier(2, most_numbers), events(2 + 2 * blocks, most_numbers) {}

    void restart(double time) {
        earlier.clear();
        events.clear();
        count = unit_count = 0;
        unit_start = time;
        accumulating = false;
    }
    bool full() const { return earlier.full || events.full; }

    // Store an event: block (from 0), kind 0 stop | 1 start. states(row) writes x and U'
    template <class States>
    void add(int block, int kind, double clock, States &&states) {
        count++;
        if (clock >= unit_start + unit) {
            unit_start = clock;
            unit_count = 0;
        }
        accumulating |= ++unit_count > rate_limit;
        if (!keep || (stops_only && (kind != 0 || clock < states_from))) return;
        const bool early = clock < states_from;
        if (double *row = (early ? earlier : events).append(clock)) {
            row[0] = block + 1;
            row[1] = kind;
            if (!early) states(row + 2);
        }
    }
};

}  // namespace bk
