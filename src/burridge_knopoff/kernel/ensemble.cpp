#include "ensemble.h"

namespace bk {

void Ensemble::run(const double *position, const double *velocity, const bool *stuck, const std::vector<double> &times,
                   Outcome &out, const Clouds *clouds, const std::vector<Target> &targets, Maxima *maxima) {
    this->out = &out;
    this->times = &times;
    this->clouds = clouds;
    this->maxima = maxima;
    streak.assign(size_t(LANES) * targets.size(), 0);
    turns.assign(blocks, maxima != nullptr);
    for (const Target &target : targets)
        if (target.section == MAXIMA) turns[target.block] = true;
    int next = 0;
    active = mask{};
    Watch watch;
    auto refill = [&] {
        mask fresh{};
        for (int lane = 0; lane < LANES && next < out.count; lane++) {
            if (active[lane]) continue;
            const size_t first = size_t(next) * blocks;
            for (int i = 0; i < blocks; i++)
                state.place(size_t(i) * LANES + lane, position[first + i], velocity[first + i], stuck[first + i]);
            clock[lane] = clock_rest[lane] = count[lane] = unit_start[lane] = unit_count[lane] = 0.0;
            for (size_t k = 0; k < targets.size(); k++) streak[lane * targets.size() + k] = 0;
            for (int i = 0; i < blocks; i++) rising[i][lane] = 0;
            aim(lane, 0);
            member[lane] = next++;
            fresh[lane] = -1;
            accumulating[lane] = 0;
        }
        active |= fresh;
        if (any(fresh)) settle_events(fresh);
    };
    for (refill(); any(active); refill()) {
        rounds++;
        watch.worked(blocks * LANES);
        finish(active & accumulating, ACCUMULATING_EVENTS);
        move(targets);
    }
}

}  // namespace bk
