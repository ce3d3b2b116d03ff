#include "ensemble.h"

namespace bk {

void Ensemble::run(const double *position, const double *velocity, const bool *stuck, const std::vector<double> &times,
                   Outcome &out, const Clouds *clouds, const std::vector<int> &returns,
                   const std::vector<int> &section) {
    this->out = &out;
    this->times = &times;
    this->clouds = clouds;
    streak.assign(size_t(LANES) * section.size(), 0);
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
            for (size_t k = 0; k < section.size(); k++) streak[lane * section.size() + k] = 0;
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
        move(returns, section);
    }
}

}  // namespace bk
