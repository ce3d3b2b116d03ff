// Many trajectories of one chain at once: each lane holds a trajectory with its own clock and step.
//
// A lane whose trajectory has ended takes the next one from the list. The results of a trajectory do not depend on
// other lanes, nor on its end time, which only truncates the last piece.
#pragma once

#include "clouds.h"
#include "status.h"
#include "trajectory_lanes.h"

namespace bk {

// The results of n trajectories at their ends and at intermediate times.
struct Outcome {
    int count, blocks, times, kept;
    std::vector<int> status, label;
    std::vector<double> end, position, velocity, event_time;
    std::vector<signed char> slip;
    std::vector<long long> event_count;
    std::vector<int> event_block, event_kind;

    // kept : number of events stored for each trajectory
    Outcome(int count, int blocks, int times, int kept)
        : count(count), blocks(blocks), times(times), kept(kept), status(count), label(count, -1), end(count),
          position(size_t(count) * times * blocks, NAN), velocity(size_t(count) * times * blocks, NAN),
          event_time(size_t(count) * kept, NAN), slip(size_t(count) * times * blocks), event_count(count),
          event_block(size_t(count) * kept), event_kind(size_t(count) * kept) {}
};

// Where the trajectories that come near a cloud are compared with it: at the stops of a block, at the maxima of its
// velocity, or, for an equilibrium, at the end of every piece.
enum Section { STOPS, MAXIMA, EVERYWHERE };

// A cloud of states on a section, and after how many successive states near it a trajectory has reached it.
struct Target {
    int block;  // from 0
    Section section;
    int returns;
};

// The maxima of the velocities of all blocks from a time on, of a single trajectory: rows of time, block (from 1), x_1
// … x_N, U_1' … U_N'.
struct Maxima {
    double from;
    std::vector<double> rows;
};

class Ensemble : public TrajectoryLanes {
  public:
    const Model &model;
    long long rounds = 0;

    Ensemble(const Model &model, long long rate_limit)
        : TrajectoryLanes(model), model(model), rate_limit(double(rate_limit)), slipped(blocks), turn_position(blocks),
          turn_velocity(blocks), rising(blocks), turns(blocks) {}

    // Integrate trajectories from positions x_i, velocities U_i' and stuck blocks, shape (count, blocks), to the last
    // of some ascending times, and store their states at all these times. At an event the state before it is stored.
    //
    // clouds, targets : states (x_i, U_i') on a section, for each cloud. A trajectory ends with the label of a cloud
    // when enough successive states on this section have been near it
    // maxima : if given, the maxima of the velocities of the only trajectory are added to it
    void run(const double *position, const double *velocity, const bool *stuck, const std::vector<double> &times,
             Outcome &out, const Clouds *clouds = nullptr, const std::vector<Target> &targets = {},
             Maxima *maxima = nullptr);

  private:
    const double rate_limit;
    Trajectories::Rows slipped, turn_position, turn_velocity;
    std::vector<mask> rising;  // lanes in which the velocity of a block rises at the start of the piece
    std::vector<bool> turns;   // blocks of which the maxima of the velocity are needed
    vec target{}, count{}, unit_start{}, unit_count{};
    mask accumulating{};
    int member[LANES] = {}, next_time[LANES] = {};
    std::vector<int> streak;
    Outcome *out = nullptr;
    const std::vector<double> *times = nullptr;
    const Clouds *clouds = nullptr;
    Maxima *maxima = nullptr;

    // Store the next state of a lane at the k-th time.
    void aim(int lane, int k) {
        next_time[lane] = k;
        target[lane] = k < int(times->size()) ? (*times)[k] : LONG;
    }

    // Integrate every lane to its next event, or to the end of its series, and compare returns with the clouds.
    void move(const std::vector<Target> &targets) {
        for (int i = 0; i < blocks; i++) slipped[i] = state.slip[i];
        mask resting;
        const vec reach = expand(0, resting);
        finish(active & resting, DIVERGED);
        search.find(series, state, reach, active);
        const vec length = search.time;
        sample(length);
        for (int i = 0; i < blocks; i++)
            if (turns[i]) turn(i, length, targets);
        const mask ended = active & (until(Trajectories::splat(times->back())) <= length);
        if (any(ended)) {
            for (int k = 0; k < int(targets.size()); k++)
                if (targets[k].section == EVERYWHERE) arrive(k, ended);
            clock = select(ended, Trajectories::splat(times->back()), clock);
            finish(ended, COMPLETED);
        }
        advance(length, active);
        const mask event = active & search.found;
        if (any(event)) {
            change_due(event, [this](int i, mask where) { change(i, where); });
            settle_events(event);
        }
        for (int k = 0; k < int(targets.size()); k++) {
            const int i = targets[k].block;
            if (targets[k].section == EVERYWHERE) visit(k, targets, active, state.position, state.velocity);
            if (targets[k].section == STOPS && any(event))
                visit(k, targets, event & active & (slipped[i] != 0.0) & (state.slip[i] == 0.0), state.position,
                      state.velocity);
        }
    }

    // Find where the velocity of block i has a maximum in the present pieces, and compare the states there with clouds.
    // Whether it rises is carried over from piece to piece, so that rounding cannot hide a maximum between two pieces.
    void turn(int i, vec length, const std::vector<Target> &targets) {
        const mask rises = series.acceleration(i, length) > 0.0;
        mask top = active & (state.slip[i] != 0.0) & rising[i] & ~rises;
        rising[i] = rises & (state.slip[i] != 0.0);
        if (!any(top)) return;
        vec at{};
        for (int lane = 0; lane < LANES; lane++) {
            if (!top[lane]) continue;
            polynomial.degree = Trajectories::ORDER - 1;
            for (int k = 0; k < Trajectories::ORDER; k++)
                polynomial.coefficient[k] = (k + 1) * series.velocity[size_t(k + 1) * blocks + i][lane];
            at[lane] = polynomial.coefficient[0] > 0.0 ? std::max(polynomial.first_root(length[lane]), 0.0) : 0.0;
        }
        top &= at <= until(Trajectories::splat(times->back()));
        for (int j = 0; j < blocks; j++) {
            turn_position[j] = series.value(series.position, j, at);
            turn_velocity[j] = series.value(series.velocity, j, at);
        }
        for (int lane = 0; maxima && lane < LANES; lane++) {
            if (!top[lane] || clock[lane] + at[lane] < maxima->from) continue;
            maxima->rows.push_back(clock[lane] + (clock_rest[lane] + at[lane]));
            maxima->rows.push_back(i + 1);
            for (int j = 0; j < blocks; j++) maxima->rows.push_back(turn_position[j][lane]);
            for (int j = 0; j < blocks; j++) maxima->rows.push_back(turn_velocity[j][lane]);
        }
        for (int k = 0; k < int(targets.size()); k++)
            if (targets[k].section == MAXIMA && targets[k].block == i)
                visit(k, targets, active & top, turn_position, turn_velocity);
    }

    // Store the states at the times that lie within the present pieces.
    void sample(vec length) {
        for (;;) {
            const vec ahead = until(target);
            const int due = bits(active & (ahead <= length));
            if (!due) return;
            for (int i = 0; i < blocks; i++) {
                const vec x = series.value(series.position, i, ahead), u = series.value(series.velocity, i, ahead);
                for (int lane = 0; lane < LANES; lane++) {
                    if (!(due >> lane & 1)) continue;
                    const size_t at = (size_t(member[lane]) * out->times + next_time[lane]) * blocks + i;
                    out->position[at] = x[lane];
                    out->velocity[at] = u[lane];
                    out->slip[at] = (signed char)state.slip[i][lane];
                }
            }
            for (int lane = 0; lane < LANES; lane++)
                if (due >> lane & 1) aim(lane, next_time[lane] + 1);
        }
    }

    // Stop or start block i now, and count the event.
    void change(int i, mask where) {
        const mask fresh = where & (unit_start + model.springs.unit <= clock);
        state.transition(i, where);
        for (int lane = 0; out->kept && lane < LANES; lane++) {
            if (!where[lane] || count[lane] >= out->kept) continue;
            const size_t at = size_t(member[lane]) * out->kept + size_t(count[lane]);
            out->event_time[at] = clock[lane];
            out->event_block[at] = i + 1;
            out->event_kind[at] = state.slip[i][lane] != 0.0;
        }
        count = select(where, count + 1.0, count);
        unit_start = select(fresh, clock, unit_start);
        unit_count = select(fresh, vec{}, unit_count);
        unit_count = select(where, unit_count + 1.0, unit_count);
        accumulating |= where & (unit_count > rate_limit);
    }

    void settle_events(mask where) {
        settle(where, [this](int i, mask own) { change(i, own); }, [this] { return ~accumulating; });
    }

    // Compare the states of some lanes with a cloud; a lane is finished after enough successive states near it.
    void visit(int cloud, const std::vector<Target> &targets, mask where, const Trajectories::Rows &position,
               const Trajectories::Rows &velocity) {
        std::vector<double> point(2 * blocks);
        for (int lane = 0; lane < LANES; lane++) {
            if (!where[lane]) continue;
            for (int i = 0; i < blocks; i++) {
                point[i] = position[i][lane];
                point[blocks + i] = velocity[i][lane];
            }
            int &near = streak[size_t(lane) * targets.size() + cloud];
            near = clouds->is_near(cloud, point.data()) ? near + 1 : 0;
            if (near < targets[cloud].returns) continue;
            out->label[member[lane]] = cloud;
            mask own{};
            own[lane] = -1;
            finish(own, COMPLETED);
        }
    }

    // Label the trajectories that end near an equilibrium, where a single piece may last until the end.
    void arrive(int cloud, mask ended) {
        const vec rest = until(Trajectories::splat(times->back()));
        std::vector<double> point(2 * blocks);
        for (int lane = 0; lane < LANES; lane++) {
            if (!ended[lane]) continue;
            for (int i = 0; i < blocks; i++) {
                point[i] = series.value(series.position, i, rest)[lane];
                point[blocks + i] = series.value(series.velocity, i, rest)[lane];
            }
            if (clouds->is_near(cloud, point.data())) out->label[member[lane]] = cloud;
        }
    }

    // End the trajectories of some lanes.
    void finish(mask where, int status) {
        for (int lane = 0; lane < LANES && any(where); lane++) {
            if (!where[lane]) continue;
            out->end[member[lane]] = clock[lane];
            out->status[member[lane]] = status;
            out->event_count[member[lane]] = (long long)count[lane];
        }
        active &= ~where;
    }
};

}  // namespace bk
