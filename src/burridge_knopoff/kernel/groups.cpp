// A run in groups: blocks that slip together, with their stuck neighbours, have their own piece of the motion; see
// run.h.
#include "run.h"

namespace bk {

// Put a stuck block with stuck neighbours into the queue for its start, whose time is known because the spring force
// grows at a constant rate.
void Run::wait(int i) {
    const Springs &springs = model.springs;
    const bool steady = loading == 0.0;
    const double rate = steady ? model.v * springs.driving[i] : loading * creep_rate(i);
    const double left = (springs.threshold[i] - waiting_force(i, alone[i].since)) / rate;
    begins[i] =
        rate > 0.0 ? (steady ? alone[i].since : alone[i].loaded).after(left > 0.0 ? left : 0.0) : Clock{NEVER, 0.0};
    version[i]++;
    if (rate > 0.0) starts().push({begins[i], i, false, version[i]});
}

// Plan a group's next piece and put its end into the queue; false if the motion cannot continue.
bool Run::schedule(Group &group) {
    if (!plan(group)) return false;
    group.version = ++versions;
    queue.push({group.start.after(group.length), group.number, true, group.version});
    if (observing) section_change += section_range(group);
    return true;
}

int Run::run_groups() {
    if (blind) {
        // The first pieces have no motion.
        now = observed;
        return DIVERGED;
    }
    count_stuck();
    for (;;) {
        drop_void(queue);
        if (const int reason = blocked()) return reason;
        // Under quasi-static loading the driver advances while nothing slips.
        const bool moving = loading == 0.0 || !queue.empty();
        if (!moving) drop_void(waiting);
        Queue &coming = moving ? queue : waiting;
        const Clock at = coming.empty() ? Clock{NEVER, 0.0} : coming.top().at;
        const bool completed = (!moving || loading == 0.0) && at.until(end) < 0.0;
        begin_exponents((moving ? now : load).until(completed ? Clock{end, 0.0} : at));
        if (!moving || loading == 0.0) pass_edges(completed ? Clock{end, 0.0} : at, completed);
        if (!moving) {
            load = completed ? Clock{end, 0.0} : at;
            if (completed) {
                remember();
                return COMPLETED;
            }
        } else if (completed) {
            remember();
            observe_all({end, 0.0}, at.time < NEVER ? at : Clock{end, 0.0});
            for (auto &group : groups) {
                if (!group || !group->alive || !group->planned) continue;
                const double to = group->start.until(end);
                if (catalogue) group->record(*catalogue, polynomial, group->observed, to, false);
                group->observed = to;
            }
            return COMPLETED;
        }
        take_next(coming);
        const bool halting = halting_block >= 0 && direction_of(halting_block) != 0.0;
        if (moving) observe_all(at, at);
        if (!process()) return DIVERGED;
        follow_groups();
        if (halting && direction_of(halting_block) == 0.0) return HALTED;
    }
}

// Drop entries of a queue that are no longer valid.
void Run::drop_void(Queue &queue) {
    while (!queue.empty()) {
        const Next &next = queue.top();
        const Group *group = next.is_group ? groups[next.number].get() : nullptr;
        const uint64_t valid = !next.is_group ? version[next.number] : group ? group->version : 0;
        if (next.version == valid && (next.is_group || group_of[next.number] < 0)) return;
        queue.pop();
    }
}

// Take all entries of a queue at the time of the first entry; the times of mirror images are equal to the bit.
void Run::take_next(Queue &queue) {
    const Clock at = queue.top().at;
    ending.clear();
    starting.clear();
    do {
        (queue.top().is_group ? ending : starting).push_back(queue.top().number);
        queue.pop();
        drop_void(queue);
    } while (!queue.empty() && queue.top().at.until(at) == 0.0);
}

// Carry out the next events. All changes are decided before any block changes, as in a chain that is integrated as a
// whole, so that the result does not depend on the order of blocks or groups.
bool Run::process() {
    const Springs &springs = model.springs;
    std::vector<int> changing = starting, members;
    int events = int(starting.size());
    Group *group = nullptr;
    exponents.forget_stops();
    for (int number : ending) {
        Group &own = *groups[number];
        end_piece(own, own.length);
        if (!own.event) continue;
        find_due(own);
        events++;
        group = &own;
        for (int k = 0; k < own.size(); k++)
            if (due[k / LANES] >> k % LANES & 1) changing.push_back(own.layout.member[k]);
    }
    bool moves = true;
    if (events > 0) {
        load_exponents();
        if (events > 1 || !group) {
            for (int i : changing) {
                gather(i, members);
                for (int64_t p = springs.start[i]; p < springs.start[i + 1]; p++) gather(springs.neighbour[p], members);
            }
            group = &collect(members);
        }
        std::sort(changing.begin(), changing.end());
        for (int i : changing) change(*group, lane_of[i], now);
        for (group = complete(group); !log.accumulating && settle(*group, now);) group = complete(group);
        moves = part(*group);
    }
    for (int number : ending)
        if (Group *own = groups[number].get(); own && own->alive && !own->planned)
            moves &= rests(*own) ? part(*own) : schedule(*own);
    return moves;
}

// Convert a state that was integrated in groups to a single group, or the reverse.
void Run::regroup() {
    std::vector<int> all(blocks);
    for (int i = 0; i < blocks; i++) all[i] = i;
    for (auto &group : groups) {
        if (!group || !group->alive) continue;
        const double length = group->start.until(now);
        blind |= !group->plan(0, 0, 0);
        group->advance(length);
        if (catalogue) group->record(*catalogue, polynomial, 0.0, length, true);
        for (int k = 0; k < group->size(); k++) {
            const int i = group->layout.member[k];
            group->state.position.lane(k) -= lag(i);
            end_creep(i);
        }
        retire(*group);
    }
    Group &group = collect(all);
    if (local) blind |= !part(group);
}

// Add a block to the members of a new group, together with its present group.
void Run::gather(int i, std::vector<int> &members) {
    const int number = group_of[i];
    if (number < 0) {
        if (observing && (i == 0 || i == blocks - 1)) observe_distance(now);
        members.push_back(i);
        return;
    }
    Group &group = *groups[number];
    end_piece(group, group.start.until(now));
    members.insert(members.end(), group.layout.member.begin(), group.layout.member.end());
    retire(group);
}

// Make a group of blocks that belong to no group.
Group &Run::collect(std::vector<int> &members) {
    std::sort(members.begin(), members.end());
    members.erase(std::unique(members.begin(), members.end()), members.end());
    for (int i : members) {
        if (alone[i].slip == 0.0 || alone[i].creeps) alone[i].x = position_at_rest(i, now);
        alone[i].since = now;
        end_creep(i);
        version[i]++;
    }
    return build(members, now);
}

// Take all neighbours of slipping blocks into a group.
Group *Run::complete(Group *group) {
    const Springs &springs = model.springs;
    for (;;) {
        const int number = group->number;
        std::vector<int> missing;
        for (int k = 0; k < group->size(); k++) {
            if (group->state.slip.lane(k) == 0.0) continue;
            const int i = group->layout.member[k];
            for (int64_t p = springs.start[i]; p < springs.start[i + 1]; p++)
                if (group_of[springs.neighbour[p]] != number) missing.push_back(springs.neighbour[p]);
        }
        if (missing.empty()) return group;
        std::vector<int> members = group->layout.member;
        retire(*group);
        for (int i : missing)
            if (std::find(members.begin(), members.end(), i) == members.end()) gather(i, members);
        group = &collect(members);
    }
}

// Divide a group into connected sets of slipping blocks with their stuck neighbours, and plan their pieces. Sets that
// creep leave it.
bool Run::part(Group &parted) {
    const Springs &springs = model.springs;
    Group *remaining = release(parted);
    if (!remaining) return true;
    Group &group = *remaining;
    const int number = group.number, n = group.size();
    std::vector<int> set(n, -1), reached;
    int sets = 0, placed = 0;
    for (int k = 0; k < n; k++) {
        if (set[k] >= 0 || group.state.slip.lane(k) == 0.0) continue;
        // All blocks that are connected by springs of slipping blocks.
        reached.assign(1, k);
        set[k] = sets;
        placed++;
        while (!reached.empty()) {
            const int own = reached.back(), i = group.layout.member[own];
            reached.pop_back();
            const bool slips = group.state.slip.lane(own) != 0.0;
            for (int64_t p = springs.start[i]; p < springs.start[i + 1]; p++) {
                const int j = springs.neighbour[p];
                if (group_of[j] != number) continue;
                const int other = lane_of[j];
                if (set[other] >= 0 || !(slips || group.state.slip.lane(other) != 0.0)) continue;
                set[other] = sets;
                placed++;
                reached.push_back(other);
            }
        }
        sets++;
    }
    if (sets == 1 && placed == n) return schedule(group);
    const std::vector<int> member = group.layout.member;
    retire(group);
    std::vector<std::vector<int>> members(sets);
    for (int k = 0; k < n; k++)
        if (set[k] >= 0) members[set[k]].push_back(member[k]);
    for (int k = 0; k < n; k++)
        if (set[k] < 0) wait(member[k]);
    bool moves = true;
    for (auto &own : members) {
        std::sort(own.begin(), own.end());
        moves &= schedule(build(own, now));
    }
    return moves;
}

// Observe a group's piece up to a time of it, and move its state there.
void Run::end_piece(Group &group, double to) {
    if (!group.planned) return;
    if (observing && !observer.section_only) group.extremes(observer, polynomial, group.observed, to);
    if (observing && holds_end(group)) observe_distance(group.start.after(to));
    if (exponents.running) propagate(group, to);
    group.advance(to);
    if (catalogue) group.record(*catalogue, polynomial, group.observed, to, true);
    group.observed = to;
}

bool Run::holds_end(const Group &group) const {
    const int number = group.number;
    return group_of[0] == number || group_of[blocks - 1] == number;
}

// A block's position, or its velocity, as a polynomial of the time since `at`.
Polynomial Run::motion_of(int i, bool speed, const Clock &at) {
    Polynomial made;
    if (group_of[i] < 0) {
        made.degree = 1;
        made.coefficient[0] = speed ? 0.0 : position_at_rest(i, at);
        made.coefficient[1] = speed ? 0.0 : -model.v;
        return made;
    }
    Group &group = *groups[group_of[i]];
    const Blocks::Rows &rows = speed ? group.series.velocity : group.series.position;
    made.load(&rows.lane(lane_of[i]), group.series.columns * LANES, Blocks::ORDER);
    made.shift(group.start.until(at));
    return made;
}

// Observe J up to a time at which the motion of an end block may change.
void Run::observe_distance(const Clock &at) {
    const double length = distance_from.until(at);
    if (length > 0.0 && observer.wants_distance(distance_from, length)) {
        Distance &d = observer.distance;
        for (bool speed : {false, true}) {
            const Polynomial last = motion_of(blocks - 1, speed, distance_from),
                             first = motion_of(0, speed, distance_from);
            double *terms = speed ? d.velocity : d.position;
            for (int k = 0; k <= Blocks::ORDER; k++)
                terms[k] =
                    (k <= last.degree ? last.coefficient[k] : 0.0) - (k <= first.degree ? first.coefficient[k] : 0.0);
        }
        d.position[0] += observer.apart;
        d.begin(Blocks::ORDER);
        observer.average(distance_from, 0.0, length);
        observer.compare(distance_from, 0.0, length);
    }
    distance_from = at;
}

// Observe everything that involves several groups up to a time. reach : the time before which nothing changes
void Run::observe_all(const Clock &at, const Clock &reach) {
    if (!observing) {
        now = observed = at;
        return;
    }
    while (observer.next_trajectory < observer.trajectory_time.size() &&
           observer.trajectory_time[observer.next_trajectory] <= at.time) {
        now = {observer.trajectory_time[observer.next_trajectory], 0.0};
        observer.sample([&](int i, double &position, double &speed) {
            double direction;
            state_of(i, position, speed, direction);
        });
    }
    now = at;
    const double window = observer.transient();
    if (!observer.section_only) {
        // The spring force on a waiting block grows: it is smallest at the start of the run or of the window.
        for (const Stage stage : {TRANSIENT, WINDOW}) {
            const double from = stage == WINDOW ? std::max(observer.begin, window) : observer.begin;
            if (waiting_seen[stage] || at.time < from || (stage == TRANSIENT && observer.begin >= window)) continue;
            waiting_seen[stage] = true;
            for (int i = 0; i < blocks; i++)
                if (group_of[i] < 0)
                    observer.lowest_force[stage] =
                        std::min(observer.lowest_force[stage], waiting_force(i, {from, 0.0}));
        }
    }
    if (at.until(end) <= 0.0) {
        for (auto &group : groups)
            if (group && group->alive && group->planned && !observer.section_only) {
                const double to = group->start.until(at);
                group->extremes(observer, polynomial, group->observed, to);
            }
        observe_distance(at);
    }
    if (at.until(window) < 0.0) observe_section(at, reach);
    observed = at;
}

// The force on a waiting block at a time; its neighbours do not move.
double Run::waiting_force(int i, const Clock &at) const {
    return (model.springs.sliding_force[i] + model.springs.damping_load[i]) + spring_pull(i, at);
}

// W at a time before the next change of any block.
double Run::section_value(const Clock &at) {
    double total = 0.0, position, speed, direction;
    const Clock before = now;
    now = at;
    for (int i = first; i < last; i++) {
        state_of(i, position, speed, direction);
        total += position;
    }
    now = before;
    return total;
}

// The lanes of a group over which W sums; false if there are none.
bool Run::section_lanes(const Group &group, int &begin, int &stop) const {
    begin = observer.section ? lane_of[first] : 0;
    stop = observer.section ? begin + 1 : group.size();
    return !observer.section || group_of[first] == group.number;
}

// Bound on the change of a group's part of W within its piece.
double Run::section_range(const Group &group) {
    int begin, stop;
    if (!section_lanes(group, begin, stop)) return 0.0;
    double most = 0.0, power = group.length;
    group.load_sum(polynomial, begin, stop);
    for (int k = 1; k <= Blocks::ORDER; k++, power *= group.length)
        most += std::fabs(polynomial.coefficient[k]) * power;
    return 2.0 * most;
}

// Record crossings of W up to a time. There is none while the last computed |W| exceeds the bound on its change since
// then. reach : the time before which nothing changes
void Run::observe_section(const Clock &at, const Clock &reach) {
    const bool begins = observer.side == 0 && observed.until(observer.transient()) > 0.0;
    const Clock from = begins ? Clock{observer.transient(), 0.0} : observed;
    const double length = from.until(at), drift = (last - first) * model.v;
    if (observer.side != 0 && std::fabs(section_at) > section_change + drift * section_from.until(at)) return;
    section_at = section_value(from);
    watch.worked(blocks);
    section_from = from;
    section_change = 0.0;
    // From now on the pieces that have not ended count.
    for (auto &group : groups) {
        if (!group || !group->alive || !group->planned) continue;
        section_change += section_range(*group);
    }
    if (observer.side != 0 && std::fabs(section_at) > section_change + drift * length) return;
    double terms[Blocks::ORDER + 1] = {section_at};
    for (int i = first; i < last; i++)
        if (group_of[i] < 0) terms[1] -= model.v;
    // In the order of their blocks, since the numbers of groups depend on the start of a run.
    std::vector<Group *> parts;
    for (auto &group : groups)
        if (group && group->alive && group->planned) parts.push_back(group.get());
    std::sort(parts.begin(), parts.end(), [](const Group *a, const Group *b) { return a->first < b->first; });
    for (Group *group : parts) {
        int begin, stop;
        if (!section_lanes(*group, begin, stop)) continue;
        group->load_sum(polynomial, begin, stop);
        polynomial.shift(group->start.until(from));
        for (int k = 1; k <= Blocks::ORDER; k++) terms[k] += polynomial.coefficient[k];
    }
    polynomial.load(terms, 1, Blocks::ORDER);
    observer.cross(polynomial, EventSearch<Blocks>::UNCERTAIN, from, 0.0, length, from.until(reach), [&](double t) {
        double rate = 0.0;
        for (int k = Blocks::ORDER; k > 0; k--) rate = rate * t + k * terms[k];
        return rate;
    });
}

}  // namespace bk
