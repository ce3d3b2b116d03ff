// Lyapunov exponents of a run in groups: perturbations change in the group in which blocks slip; see Exponents.
#include "run.h"

namespace bk {

// Determine which blocks slip, when a run begins or is continued.
void Run::count_stuck() {
    if (exponents.tangent.vectors == 0) return;
    directions.resize(blocks);
    for (int i = 0; i < blocks; i++) directions[i] = direction_of(i);
    sticking = exponents.stuck(directions.data());
}

// Start the perturbations now if they start before the next change, after a time of this length.
void Run::begin_exponents(double length) {
    if (exponents.running || exponents.tangent.vectors == 0) return;
    exponents.begin_within(directions.data(), loading_clock(now).time, length);
    for (auto &group : groups)
        if (group && group->alive && group->planned) group->followed = group->start.until(now);
}

// Blocks are about to start because the driver has advanced under quasi-static loading.
void Run::load_exponents() {
    if (!exponents.running || loading == 0.0 || starting.empty()) return;
    std::vector<double> creep(blocks);
    for (int i = 0; i < blocks; i++) creep[i] = alone[i].creep;
    const int first = *std::min_element(starting.begin(), starting.end());
    for (int i : starting)
        if (i != first) exponents.tie(first, i);
    drop_void(waiting);
    if (!waiting.empty() && load.until(waiting.top().at) <= rounding_of_starts(loading))
        exponents.tie(first, waiting.top().number);
    exponents.load_until_start(model.springs, first, creep.data(), creep_rate(first));
}

// Orthonormalise the perturbations if this is due, after all changes at this instant.
void Run::follow_groups() {
    if (!exponents.running) return;
    exponents.lose(sticking);
    if (++changes <= blocks / BLOCKS_A_CHANGE) return;
    changes = 0;
    exponents.orthonormalise(true);
}

// End the batches that end before the next change, or with the run.
void Run::pass_edges(const Clock &next, bool completed) {
    while (exponents.running && (completed || exponents.next_edge() <= next.time)) {
        const bool last = exponents.next_edge() > next.time;
        const Clock at = last ? next : Clock{exponents.next_edge(), 0.0};
        for (auto &group : groups)
            if (group && group->alive && group->planned) propagate(*group, group->start.until(at));
        exponents.renew(directions.data(), at.time, last);
        if (last) return;
    }
}

// Propagate the perturbations of a group's blocks to a time of its piece.
void Run::propagate(Group &group, double to) {
    if (!(to > group.followed)) return;
    Tangent<Blocks> &tangent = exponents.in_group;
    tangent.widen(group.layout.columns);
    if (!law.law.linear && (expanded != &group || group.followed > 0.0)) {
        // They are kept for one group only.
        group.series.restore_friction(group.state, group.followed);
        expanded = group.followed > 0.0 ? nullptr : &group;
    }
    const double length = to - group.followed;
    group.followed = to;
    tangent.load(group.state, group.series, length, Blocks::all_lanes(true));
    const int parts = tangent.parts_of(0);
    exchange(group, false);
    for (int done = 1;; done++) {
        tangent.follow(group.layout);
        if (done == parts) break;
        if (done % PARTS == 0) {
            exchange(group, true);
            exponents.orthonormalise(true);
            exchange(group, false);
        }
        tangent.move_on(done);
    }
    exchange(group, true);
}

// Copy the perturbations of a group's blocks into its lanes, or from there.
void Run::exchange(const Group &group, bool out) {
    const size_t width = size_t(group.layout.columns) * LANES, n = group.size();
    for (int v = 0; v < exponents.tangent.vectors; v++) {
        double *x = exponents.x(v), *u = exponents.u(v);
        double *own_x = &exponents.in_group.position.lane(v * width),
               *own_u = &exponents.in_group.velocity.lane(v * width);
        for (size_t k = 0; k < n; k++) {
            const int i = group.layout.member[k];
            (out ? x[i] : own_x[k]) = out ? own_x[k] : x[i];
            (out ? u[i] : own_u[k]) = out ? own_u[k] : u[i];
        }
        for (size_t k = n; k < width; k++) own_x[k] = own_u[k] = 0.0;
    }
}

}  // namespace bk
