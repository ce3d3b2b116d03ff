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

class Ensemble : public TrajectoryLanes {
  public:
    const Model &model;
    long long rounds = 0;

    Ensemble(const Model &model, long long rate_limit)
        : TrajectoryLanes(model), model(model), rate_limit(double(rate_limit)), slipped(blocks) {}

    // Integrate trajectories from positions x_i, velocities U_i' and stuck blocks, shape (count, blocks), to the last
    // of some ascending times, and store their states at all these times. At an event the state before it is stored.
    //
    // clouds : states (x_i, U_i') at stops. A trajectory ends with the label of a cloud when `returns` successive stops
    // of the block `section` of this cloud have been near it
    void run(const double *position, const double *velocity, const bool *stuck, const std::vector<double> &times,
             Outcome &out, const Clouds *clouds, const std::vector<int> &returns, const std::vector<int> &section);

  private:
    const double rate_limit;
    Trajectories::Rows slipped;
    vec target{}, count{}, unit_start{}, unit_count{};
    mask accumulating{};
    int member[LANES] = {}, next_time[LANES] = {};
    std::vector<int> streak;
    Outcome *out = nullptr;
    const std::vector<double> *times = nullptr;
    const Clouds *clouds = nullptr;

    // Store the next state of a lane at the k-th time.
    void aim(int lane, int k) {
        next_time[lane] = k;
        target[lane] = k < int(times->size()) ? (*times)[k] : LONG;
    }

    // Integrate every lane to its next event, or to the end of its series, and compare returns with the clouds.
    void move(const std::vector<int> &returns, const std::vector<int> &section) {
        for (int i = 0; i < blocks; i++) slipped[i] = state.slip[i];
        mask resting;
        const vec reach = expand(0, resting);
        finish(active & resting, DIVERGED);
        search.find(series, state, reach, active);
        const vec length = search.time;
        sample(length);
        const mask ended = active & (until(Trajectories::splat(times->back())) <= length);
        if (any(ended)) {
            clock = select(ended, Trajectories::splat(times->back()), clock);
            finish(ended, COMPLETED);
        }
        advance(length, active);
        const mask event = active & search.found;
        if (!any(event)) return;
        change_due(event, [this](int i, mask where) { change(i, where); });
        settle_events(event);
        for (size_t k = 0; k < section.size(); k++) {
            const int i = section[k];
            visit(int(k), returns[k], int(section.size()),
                  event & active & (slipped[i] != 0.0) & (state.slip[i] == 0.0));
        }
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

    // Compare the states of some lanes with a cloud; a lane is finished after enough successive returns near it.
    void visit(int cloud, int returns, int clouds_in_all, mask where) {
        std::vector<double> point(2 * blocks);
        for (int lane = 0; lane < LANES; lane++) {
            if (!where[lane]) continue;
            for (int i = 0; i < blocks; i++) {
                point[i] = state.position[i][lane];
                point[blocks + i] = state.velocity[i][lane];
            }
            int &near = streak[size_t(lane) * clouds_in_all + cloud];
            near = clouds->is_near(cloud, point.data()) ? near + 1 : 0;
            if (near < returns) continue;
            out->label[member[lane]] = cloud;
            mask own{};
            own[lane] = -1;
            finish(own, COMPLETED);
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
