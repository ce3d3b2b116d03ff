#include "run.h"

namespace bk {

void Run::restart(const Clock &at, const Clock &loaded) {
    now = at;
    load = loaded;
    observer.begin = at.time;
    observer.section_from = NEVER;
    steps = stops = 0;
    since_event = 0.0;
    log.restart(at.time);
    if (catalogue) catalogue->restart();
    queue = waiting = {};
    spare.clear();
    for (int k = 0; k < int(groups.size()); k++) {
        if (groups[k]) groups[k]->version = ++versions;
        if (groups[k]) groups[k]->alive = false;
        spare.push_back(k);
    }
    std::fill(group_of.begin(), group_of.end(), -1);
    observed = distance_from = section_from = now;
    section_at = section_change = 0.0;
    waiting_seen[TRANSIENT] = waiting_seen[WINDOW] = blind = false;
}

void Run::resume(const Mark &mark, double time) {
    alone = mark.block;
    const Clock begin{time, 0.0};
    restart(loading > 0.0 ? mark.now : begin, loading > 0.0 ? mark.load : begin);
    since_event = mark.since_event;
    stops = mark.stops;
    if (catalogue && mark.catalogue) catalogue->resume(*mark.catalogue);
    // A section that is observed from now on keeps the sign of W of the previous run.
    if (observer.transient() <= time) {
        observer.side = mark.side;
        observer.section_from = mark.section_from;
    }
    settled = true;
    std::vector<std::vector<int>> members;
    for (int i = 0; i < blocks; i++) {
        if (mark.group[i] < 0) {
            begins[i] = mark.begins[i];
            if (local && begins[i].time < NEVER) starts().push({begins[i], i, false, version[i]});
            continue;
        }
        if (mark.group[i] >= int(members.size())) members.resize(mark.group[i] + 1);
        members[mark.group[i]].push_back(i);
    }
    for (auto &own : members) {
        if (own.empty()) continue;
        Group &group = build(own, alone[own[0]].since);
        // Equal to the bit, even if the blocks around the group have changed since.
        for (int k = 0; k < group.size(); k++) {
            group.layout.sliding_force.lane(k) = mark.sliding_force[group.layout.member[k]];
            group.layout.drift.lane(k) = mark.drift[group.layout.member[k]];
            if (group.layout.increments.used)
                group.layout.increments.reference.lane(k) = mark.reference[group.layout.member[k]];
        }
        if (local && mark.local) blind |= !schedule(group);
        if (modes) start_modes(group, mark);
    }
    marked = mark;
    if (local != mark.local)
        regroup();
    else if (local)
        observed = mark.now;
}

// Carry out the changes that are due when a run begins.
void Run::settle_first() {
    settled = true;
    std::vector<int> all(blocks);
    for (int i = 0; i < blocks; i++) all[i] = i;
    Group &group = build(all, now);
    while (!log.accumulating && settle(group, now)) {}
    if (local) blind = !part(group);
    if (modes) modes->start(group.state);
}

void Run::state_of(int i, double &position, double &speed, double &direction) {
    if (group_of[i] < 0) {
        position = position_at_rest(i, now);
        speed = alone[i].u;
        direction = alone[i].slip;
        return;
    }
    Group &group = *groups[group_of[i]];
    const int lane = lane_of[i];
    position = group.state.position.lane(lane) - lag(i);
    speed = group.state.velocity.lane(lane);
    direction = group.state.slip.lane(lane);
    const double t = group.start.until(now);
    if (group.planned && t > 0.0) {
        const int c = lane / LANES;
        position = group.series.value(group.series.position, c, Blocks::splat(t))[lane % LANES];
        if (direction != 0.0) speed = group.series.value(group.series.velocity, c, Blocks::splat(t))[lane % LANES];
    }
}

// The position at a time of a block that sticks, or creeps alone.
double Run::position_at_rest(int i, const Clock &at) const {
    if (group_of[i] < 0) return (alone[i].x - model.v * alone[i].since.until(at)) - lag(i);
    const Group &group = *groups[group_of[i]];
    return group.state.position.lane(lane_of[i]) - model.v * group.start.until(at);
}

// Make a group of connected blocks that belong to no group, in ascending order, from their stored states.
Group &Run::build(std::vector<int> members, const Clock &at) {
    if (spare.empty()) {
        spare.push_back(int(groups.size()));
        groups.push_back(nullptr);
    }
    const int number = spare.back(), n = int(members.size());
    spare.pop_back();
    // The memory of a much larger group is freed.
    if (!groups[number] || groups[number]->capacity() > 4 * size_t(n) + 64)
        groups[number] = std::make_unique<Group>(model, law, scratch);
    Group &group = *groups[number];
    // In the order along a ring, across its seam.
    if (model.springs.ring && n < blocks && members[0] == 0 && members[n - 1] == blocks - 1) {
        int gap = 0;
        while (members[gap + 1] == members[gap] + 1) gap++;
        std::rotate(members.begin(), members.begin() + gap + 1, members.end());
    }
    group.number = number;
    group.first = members[0];
    group.alive = true;
    group.layout.member = members;
    group.start = at;
    group.planned = group.event = group.resting = false;
    for (int k = 0; k < n; k++) {
        group_of[members[k]] = number;
        lane_of[members[k]] = k;
    }
    auto place = [&](int i) { return group_of[i] == number ? lane_of[i] : -1; };
    group.layout.lay(place);
    const bool dense = model.springs.dense;
    if (n < blocks && !dense) group.layout.outside(place, [&](int i) { return position_at_rest(i, at); });
    group.state.widen();
    for (size_t k = n; k < size_t(group.layout.columns) * LANES; k++) group.state.place(k, 0.0, 0.0, true);
    for (int k = 0; k < n; k++) {
        const Block &block = alone[members[k]];
        group.state.position.lane(k) = block.x;
        group.state.velocity.lane(k) = block.u;
        group.state.acceleration.lane(k) = block.acceleration;
        group.state.age.lane(k) = block.age;
        group.state.slip.lane(k) = block.slip;
        group.state.touching.lane(k) = block.touching;
    }
    if (dense) hold(group);
    return group;
}

// Take the present positions of the blocks of a group in a dense network as reference positions, and add up the forces.
void Run::hold(Group &group) {
    Blocks &layout = group.layout;
    layout.increments.begin(layout.columns);
    for (int k = 0; k < group.size(); k++) {
        const int i = layout.member[k];
        layout.increments.reference.lane(k) = group.state.position.lane(k);
        layout.sliding_force.lane(k) = model.springs.sliding_force[i] + spring_pull(i, group.start);
        layout.drift.lane(k) = layout.driving.lane(k) * model.v;
        if (group.state.slip.lane(k) != 0.0) layout.increments.start(model.springs, layout.member, k);
    }
}

// −(K x)_i at a time at which the neighbours stick, or belong to the group of the block.
double Run::spring_pull(int i, const Clock &at) const {
    const Springs &springs = model.springs;
    double pull = 0.0;
    for (int64_t p = springs.start[i]; p < springs.start[i + 1]; p++)
        pull += springs.strength[p] * position_at_rest(springs.neighbour[p], at);
    return pull - springs.diagonal[i] * position_at_rest(i, at);
}

// The state of the block in a lane of a group; loaded : the loading clock
Block Run::block_in(Group &group, int lane, const Clock &loaded) const {
    State<Blocks> &state = group.state;
    const Block &block = alone[group.layout.member[lane]];
    return {state.position.lane(lane),
            state.velocity.lane(lane),
            state.acceleration.lane(lane),
            state.age.lane(lane),
            state.slip.lane(lane),
            state.touching.lane(lane),
            group.start,
            loaded,
            block.creeps,
            block.creep,
            block.fades};
}

// Store the states of a group's blocks, and dissolve the group.
void Run::retire(Group &group) {
    for (int k = 0; k < group.size(); k++) {
        const int i = group.layout.member[k];
        alone[i] = block_in(group, k, load);
        group_of[i] = -1;
    }
    group.version = ++versions;
    group.alive = group.planned = false;
    spare.push_back(group.number);
    // If many groups are unused, for example after the whole chain has slipped, their memory is freed.
    if (2 * spare.size() > groups.size() + SPARE) groups[group.number] = nullptr;
}

bool Run::plan(Group &group) {
    steps++;
    watch.worked(group.size());
    expanded = &group;
    const bool seen = observing && !local;
    if (!group.plan(seen ? observer.side : 0, first, last)) return false;
    if (loading > 0.0 && model.creep_speed > 0.0) end_at_rest(group);
    return true;
}

// Stop or start the block in a lane now, and store the event.
void Run::change(Group &group, int lane, const Clock &at) {
    const int i = group.layout.member[lane];
    group.resting = false;
    if (exponents.tangent.vectors > 0) exponents.change(group.state, model.springs, i, lane, at);
    const int kind = group.state.slip.lane(lane) == 0.0;
    group.state.transition(lane / LANES, Blocks::from_bits(1 << lane % LANES));
    stops += !kind;
    if (!directions.empty()) {
        directions[i] = group.state.slip.lane(lane);
        sticking += kind ? -1 : 1;
    }
    if (catalogue && kind) catalogue->start(model.springs, i, at, loading_clock(at), group.state.position.lane(lane));
    if (catalogue && !kind)
        catalogue->stop(model.springs, model.v, loading, i, at, loading_clock(at), group.state.position.lane(lane));
    log.add(i, kind, at.time, [&](double *row) {
        double direction;
        watch.worked(blocks);
        const Clock before = now;
        now = at;
        for (int j = 0; j < blocks; j++) state_of(j, row[j], row[blocks + j], direction);
        now = before;
    });
}

// Stop or start the blocks that are due now, in order.
void Run::change_due(Group &group, const Clock &at) {
    for (int c = 0; c < group.layout.columns; c++)
        for (int lane = 0; due[c] >> lane; lane++)
            if (due[c] >> lane & 1) change(group, c * LANES + lane, at);
}

// Carry out every change that is due at this instant; return whether there was one.
bool Run::settle(Group &group, const Clock &at) {
    due.assign(group.layout.columns, 0);
    bool changing = false;
    watch.worked(group.size());
    group.state.measure();
    // All changes are decided before any block changes, so that the result does not depend on the order of blocks.
    for (int c = 0; c < group.layout.columns; c++) changing |= (due[c] = bits(group.state.pending(c))) != 0;
    if (changing) change_due(group, at);
    return changing;
}

// Find the blocks that have the event that ends a group's piece.
void Run::find_due(Group &group) {
    due.assign(group.layout.columns, 0);
    for (int c = 0; c < group.layout.columns; c++) due[c] = bits(group.search.due(group.series, c));
}

// Store the pieces that the end of a run truncates.
void Run::remember() {
    marked.block = alone;
    marked.begins = begins;
    marked.sliding_force.assign(blocks, 0.0);
    marked.drift.assign(blocks, 0.0);
    marked.reference.assign(model.springs.dense ? blocks : 0, 0.0);
    marked.stops = stops;
    marked.group = group_of;
    // The time up to which groups have been observed, which a run of zero length does not change.
    marked.now = local && loading == 0.0 ? observed : now;
    marked.load = load;
    marked.since_event = since_event;
    if (catalogue) marked.catalogue = catalogue->open();
    marked.side = observer.side;
    marked.section_from = std::min(observer.transient(), observer.section_from);
    marked.local = local;
    if (modes) {
        marked.origin = modes->origin;
        marked.origin_velocity = modes->origin_velocity;
    }
    for (int i = 0; i < blocks; i++) {
        if (group_of[i] < 0) continue;
        Group &group = *groups[group_of[i]];
        const int lane = lane_of[i];
        marked.block[i] = block_in(group, lane, alone[i].loaded);
        marked.sliding_force[i] = group.layout.sliding_force.lane(lane);
        marked.drift[i] = group.layout.drift.lane(lane);
        if (group.layout.increments.used) marked.reference[i] = group.layout.increments.reference.lane(lane);
        if (!local) marked.side = group.side;
    }
}

// Start the closed form at the last event of the previous run.
void Run::start_modes(Group &group, const Mark &mark) {
    const Blocks::Rows position = group.state.position, velocity = group.state.velocity;
    for (int i = 0; i < blocks; i++) {
        group.state.position.lane(i) = mark.origin[i];
        group.state.velocity.lane(i) = mark.origin_velocity[i];
    }
    modes->start(group.state);
    group.state.position = position;
    group.state.velocity = velocity;
}

// The reason why the run must end here, COMPLETED if there is none.
int Run::blocked() const {
    if (log.accumulating) return ACCUMULATING_EVENTS;
    if (log.full() || observer.crossings.full || (catalogue && catalogue->full)) return FULL;
    return steps >= step_limit ? STEP_LIMIT : COMPLETED;
}

int Run::run_whole() {
    Group &group = *groups[group_of[0]];
    for (;;) {
        if (const int reason = blocked()) return reason;
        // Once in so many stops, so that rounding does not accumulate.
        if (model.springs.dense && !group.planned && stops >= blocks) {
            hold(group);
            stops = 0;
        }
        if (loading > 0.0 && !group.planned && rests(group)) {
            const bool slips = halting_block >= 0 && group.state.slip.lane(halting_block) != 0.0;
            if (stop_slow(group)) {
                if (slips && group.state.slip.lane(halting_block) == 0.0) return HALTED;
                continue;
            }
            begin_creep(group);
            if (load_next(group)) continue;
            if (exponents.running) exponents.follow(group.slip(), load.time, true);
            return COMPLETED;
        }
        if (!group.planned && !plan(group)) {
            now = group.start;
            return DIVERGED;
        }
        // The loading clock, which ends a run, stops while blocks slip.
        const double remaining = loading > 0.0 ? NEVER : group.start.until(end),
                     length = std::min(group.length, remaining);
        const bool completed = group.length >= remaining, event = group.event && group.length <= remaining;
        const bool due = event || completed;
        // The end of the run does not enter the search, so that it does not change a bit of an event.
        if (completed) remember();
        if (observing) observe(group, length);
        if (exponents.tangent.vectors > 0) {
            exponents.begin_within(group.slip(), loading_clock(group.start).time, length);
            if (exponents.running) follow(group, length);
        }
        now = group.start.after(length);
        since_event += length;
        if (group.length > remaining && !exponents.running) {
            if (observing) observer.compare(group.start, group.observed, length);
            if (catalogue) group.record(*catalogue, polynomial, group.observed, length, false);
            group.observed = length;
            since_event -= length;
            return COMPLETED;
        }
        bool halting = false;
        if (event) {
            halting = halting_block >= 0 && group.state.slip.lane(halting_block) != 0.0;
            advance(group, length);
            find_due(group);
            exponents.before_start(group.slip(), now.time);
            change_due(group, now);
            while (!log.accumulating && settle(group, now)) {}
            since_event = 0.0;
            if (modes) modes->start(group.state);
            if (completed) remember();
        } else {
            advance(group, length);
        }
        // At events, so that all solvers orthonormalise at the same times.
        if (exponents.running && (due || since_event >= LONGEST_FOLLOW * follow_unit()))
            exponents.follow(group.slip(), loading_clock(now).time, completed);
        if (completed) return COMPLETED;
        if (halting && group.state.slip.lane(halting_block) == 0.0) return HALTED;
    }
}

// Advance the driver, which stops while blocks slip, until a block starts; false if the run ends before.
bool Run::load_next(Group &group) {
    Blocks &layout = group.layout;
    Blocks::Rows left(layout.columns), creep(layout.columns), rate(layout.columns);
    for (int i = 0; i < blocks; i++) creep.lane(lane_of[i]) = alone[i].creep;
    double least = NEVER;
    for (int c = 0; c < layout.columns; c++) {
        rate[c] = layout.driving[c] + layout.spring_pull(creep.at(), 2, c);
        const mask pulled = layout.present[c] & (group.state.slip[c] == vec{}) & (rate[c] > vec{});
        const vec gap = largest(layout.threshold[c] - group.state.force(c), vec{});
        left[c] = select(pulled, gap / (loading * rate[c]), Blocks::splat(NEVER));
        least = std::min(least, least_lane(left[c]));
    }
    // The state does not change from the last slip to the next start, but for creep.
    const Clock from = alone[0].loaded;
    if (exponents.tangent.vectors > 0) exponents.begin_within(group.slip(), from.time, least);
    if (from.until(end) < least) {
        load = {end, 0.0};
        remember();
        return false;
    }
    load = from.after(least);
    // A batch of exponents begins before an event.
    if (exponents.running) exponents.follow(group.slip(), load.time, false);
    for (int i = 0; i < blocks; i++) end_creep(i);
    due.assign(layout.columns, 0);
    for (int c = 0; c < layout.columns; c++) {
        group.state.position[c] -= loading * least * (1.0 - creep[c]);
        due[c] = bits(left[c] == least);
    }
    if (layout.increments.used) layout.recede(loading * least);
    if (exponents.running) {
        int first = 0;
        while (left.lane(first) != least) first++;
        const double rounding = rounding_of_starts(loading);
        for (int i = 0; i < blocks; i++)
            if (i != first && left.lane(i) - least <= rounding) exponents.tie(first, i);
        exponents.load_until_start(model.springs, first, &creep.lane(0), rate.lane(first));
    }
    change_due(group, now);
    while (!log.accumulating && settle(group, now)) {}
    since_event = 0.0;
    return true;
}

// Advance the state along the piece; in closed form, from the last event.
void Run::advance(Group &group, double length) {
    const Clock start = group.start;
    group.advance(length);
    if (observing) {
        const double *x = &group.state.position.lane(0), *u = &group.state.velocity.lane(0);
        const double apart = observer.apart + (x[blocks - 1] - x[0]), rate = u[blocks - 1] - u[0];
        observer.compare(start, group.observed, length, std::sqrt(apart * apart + rate * rate));
    }
    if (catalogue) group.record(*catalogue, polynomial, group.observed, length, true);
    group.observed = length;
    if (modes) modes->advance(group.state, since_event);
}

// Take all observables from a piece, up to a time of it.
void Run::observe(Group &group, double to) {
    const double from = group.observed;
    const Clock &start = group.start;
    const bool in_window = to > start.until(observer.transient());
    if (observer.wants_distance(start, to)) {
        Distance &d = observer.distance;
        const double *position = &group.series.position.lane(0), *speed = &group.series.velocity.lane(0);
        const size_t stride = size_t(group.series.columns) * LANES;
        for (int k = 0; k <= Blocks::ORDER; k++) {
            d.position[k] = position[k * stride + blocks - 1] - position[k * stride];
            d.velocity[k] = speed[k * stride + blocks - 1] - speed[k * stride];
        }
        d.position[0] += observer.apart;
        d.begin(Blocks::ORDER);
        observer.average(start, from, to);
    }
    if (in_window) {
        double crossing = EventSearch<Blocks>::UNCERTAIN;
        if (group.section >= 0) crossing = group.search.crossing_within(group.series, to, group.section);
        // This crossing may already have been found in the first part of the piece, with another last bit.
        if (from > 0.0 && crossing != EventSearch<Blocks>::NONE) crossing = EventSearch<Blocks>::UNCERTAIN;
        if (observer.side == 0 || crossing != EventSearch<Blocks>::NONE) {
            if (observer.side == 0 || crossing == EventSearch<Blocks>::UNCERTAIN)
                group.load_sum(polynomial, first, last);
            observer.cross(polynomial, crossing, start, from, to, group.length,
                           [&](double t) { return group.sum_rate(first, last, t); });
        }
    }
    if (!observer.section_only) group.extremes(observer, polynomial, from, to);
    while (observer.next_trajectory < observer.trajectory_time.size()) {
        const double t = start.until(observer.trajectory_time[observer.next_trajectory]);
        if (t > to) break;
        observer.sample([&](int i, double &position, double &speed) {
            position = group.series.value(group.series.position, i / LANES, Blocks::splat(t))[i % LANES];
            speed = group.series.value(group.series.velocity, i / LANES, Blocks::splat(t))[i % LANES];
        });
    }
}

// Propagate the perturbations along a piece, up to each edge of a batch, where they are orthonormalised.
void Run::follow(Group &group, double length) {
    exponents.forget_stops();
    double from = 0.0;
    // The loading clock, which defines the batches, stops while blocks slip under quasi-static loading.
    while (loading == 0.0) {
        const double edge = exponents.next_edge(), to = std::max(from, group.start.until(edge));
        if (!(to < length)) break;
        follow(group, from, to);
        exponents.renew(group.slip(), edge, false);
        from = to;
    }
    follow(group, from, length);
}

// Propagate them between two times of the piece, in parts after which they can be orthonormalised.
void Run::follow(Group &group, double from, double to) {
    // Nothing changes while all blocks stick, however slow the driver is.
    if (exponents.stuck(group.slip()) == blocks) return;
    if (from > 0.0 && !law.law.linear) group.series.restore_friction(group.state, from);
    exponents.tangent.load(group.state, group.series, to - from, Blocks::all_lanes(true));
    const int parts = exponents.tangent.parts_of(0);
    const double part = loading > 0.0 ? 0.0 : (to - from) / parts;
    for (int k = 1; k <= parts; k++) {
        exponents.tangent.follow(group.layout);
        if (k == parts) break;
        exponents.tangent.move_on(k);
        exponents.follow(group.slip(), (loading_clock(group.start).time + from) + k * part, false);
    }
}

}  // namespace bk
