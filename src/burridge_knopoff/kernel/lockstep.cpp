#include "lockstep.h"

namespace bk {

std::vector<int> run_in_lockstep(const std::vector<Run *> &runs) {
    std::vector<std::unique_ptr<Lockstep>> kinds;
    std::map<Run *, int> status;
    for (Run *run : runs) {
        if (!Lockstep::takes(*run)) {
            status[run] = run->run();
            continue;
        }
        auto kind = std::find_if(kinds.begin(), kinds.end(), [&](auto &one) { return one->is_like(*run); });
        if (kind == kinds.end()) kind = kinds.insert(kind, std::make_unique<Lockstep>(*run));
        (*kind)->add(*run);
    }
    for (auto &kind : kinds) kind->run(status);
    std::vector<int> found;
    for (Run *run : runs) found.push_back(status[run]);
    return found;
}

void Lockstep::run(std::map<Run *, int> &status) {
    this->status = &status;
    for (;;) {
        for (int lane = 0; lane < LANES && !waiting.empty(); lane++) {
            if (active[lane]) continue;
            enter(*waiting.front(), lane);
            waiting.pop_front();
        }
        if (waiting.empty() && __builtin_popcount(bits(active)) <= FEW) return finish(active);
        round();
    }
}

// Integrate a run in a lane from now on.
void Lockstep::enter(Run &run, int lane) {
    Group &group = run.whole();
    own[lane] = &run;
    layout.place(run.model, lane);
    law.place(run.model.law, lane);
    for (int i = 0; i < blocks; i++) {
        const size_t k = size_t(i) * LANES + lane;
        state.copy(k, group.state, i);
        in_section[i][lane] = -int64_t(run.first <= i && i < run.last);
    }
    clock[lane] = group.start.time;
    clock_rest[lane] = group.start.rest;
    end[lane] = run.end;
    since_event[lane] = run.since_event;
    longest_follow[lane] = Run::LONGEST_FOLLOW * run.follow_unit();
    observed[lane] = -int64_t(run.observing);
    averaged[lane] = -int64_t(run.observing && !run.observer.section_only);
    compared[lane] = -int64_t(run.observing && !run.observer.level.empty());
    transient[lane] = run.observer.transient();
    ends_apart[lane] = run.observer.apart;
    running[lane] = -int64_t(run.exponents.running);
    speed_weight[lane] = run.exponents.unit * run.exponents.unit;
    halts[lane] = -int64_t(run.halting_block >= 0);
    accumulating[lane] = -int64_t(run.log.accumulating);
    steps[lane] = double(run.steps);
    most_steps[lane] = double(run.step_limit);
    active[lane] = changed[lane] = -1;
    aim(lane);
    exchange(lane, false);
}

// Return a run in its present state, at the beginning of a piece.
void Lockstep::leave(int lane) {
    Run &run = *own[lane];
    Group &group = run.whole();
    for (int i = 0; i < blocks; i++) {
        const size_t k = size_t(i) * LANES + lane;
        group.state.copy(i, state, k);
        // All blocks of a free lane stick, which costs least time.
        state.place(k, 0.0, 0.0, true);
    }
    layout.place(model, lane);
    law.place(model.law, lane);
    group.start = run.now = clock_of(lane);
    group.planned = false;
    run.since_event = since_event[lane];
    run.steps = (long long)steps[lane];
    exchange(lane, true);
    active[lane] = running[lane] = observed[lane] = 0;
    side[lane] = 0.0;
}

// Let runs complete outside the lanes.
void Lockstep::finish(mask where) {
    for (int lane = 0; lane < LANES; lane++) {
        if (!where[lane]) continue;
        leave(lane);
        (*status)[own[lane]] = own[lane]->run();
    }
}

// Copy the next times and limits of an observer.
void Lockstep::aim(int lane) {
    const Observer &observer = own[lane]->observer;
    auto next = [](const std::vector<double> &times, size_t k) { return k < times.size() ? times[k] : NEVER; };
    batch_begin[lane] = observer.edge[observer.batch];
    batch_end[lane] = next(observer.edge, observer.batch + 1);
    distance_time[lane] = next(observer.distance_time, observer.next_distance);
    trajectory_time[lane] = next(observer.trajectory_time, observer.next_trajectory);
    side[lane] = observed[lane] ? observer.side : 0.0;
    lower[lane] = observer.lower;
    higher[lane] = observer.higher;
    for (int stage : {TRANSIENT, WINDOW}) {
        highest_speed[stage][lane] = averaged[lane] ? observer.highest_speed[stage] : NEVER;
        lowest_force[stage][lane] = averaged[lane] ? observer.lowest_force[stage] : -NEVER;
    }
}

// Integrate every lane to its next event, or to the end of its series.
void Lockstep::round() {
    watch.worked(blocks * LANES);
    mask resting;
    for (int lane = 0; lane < LANES && any(changed); lane++)
        changed[lane] = -int64_t(changed[lane] && active[lane] && own[lane]->blocked() != COMPLETED);
    changed |= active & (steps >= most_steps);
    if (any(changed)) finish(changed);
    changed = mask{};
    const bool crosses = any(side != vec{});
    const vec reach = expand(crosses, resting);
    if (any(active & resting)) finish(active & resting);
    if (crosses) load_section();
    search.find(series, state, reach, active, crosses ? blocks : -1);
    const vec length = search.time;
    const mask last = active & (until(end) <= length);
    if (any(last)) finish(last);
    steps += 1.0;
    if (any(active & observed)) observe(length);
    if (vectors > 0) follow(length);
    advance(length, active);
    since_event += length;
    const mask event = active & search.found;
    mask halting = event & halts;
    changed |= event;
    if (any(event)) {
        for (int lane = 0; lane < LANES && any(halting); lane++)
            if (halting[lane]) halting[lane] = -int64_t(state.slip[own[lane]->halting_block][lane] != 0.0);
        const auto change = [this](int i, mask where) { this->change(i, where); };
        change_due(event, change);
        settle(event, change, [this] { return ~accumulating; });
        since_event = select(event, vec{}, since_event);
    }
    // At events, so that all solvers orthonormalise at the same times.
    orthonormalise(clock, active & running & (event | (since_event >= longest_follow)));
    for (int lane = 0; any(halting) && lane < LANES; lane++) {
        if (!halting[lane] || state.slip[own[lane]->halting_block][lane] != 0.0) continue;
        leave(lane);
        (*status)[own[lane]] = HALTED;
    }
}

// The coefficients of W = Σ x_i, after the columns of the blocks.
void Lockstep::load_section() {
    for (int k = 0; k <= ORDER; k++) {
        const vec *x = series.x(k);
        vec total{};
        for (int i = 0; i < blocks; i++) total = select(in_section[i], total + x[i], total);
        series.g(k)[blocks] = side * total;
    }
}

// Stop or start a block now in some lanes, and store the events.
void Lockstep::change(int i, mask where) {
    const int starts = bits(state.slip[i] == vec{}), which = bits(where);
    for (int lane = 0; vectors > 0 && layout.drops && which >> lane; lane++)
        if (which >> lane & 1)
            own[lane]->exponents.meet(own[lane]->model.springs, i, starts >> lane & 1, clock_of(lane));
    if (vectors > 0) tangent.change(state, i, where);
    state.transition(i, where);
    for (int lane = 0; which >> lane; lane++) {
        if (!(which >> lane & 1)) continue;
        EventLog &log = own[lane]->log;
        log.add(i, starts >> lane & 1, clock[lane], [&](double *row) {
            for (int j = 0; j < blocks; j++) {
                row[j] = state.position[j][lane];
                row[blocks + j] = state.velocity[j][lane];
            }
        });
        accumulating[lane] = -int64_t(log.accumulating);
    }
}

// Take all observables from a piece.
void Lockstep::observe(vec length) {
    const mask in_window = active & observed & (length > until(transient));
    const mask wanted = active & observed & (compared | (averaged & in_window) | (until(distance_time) <= length));
    if (any(wanted)) average(length, wanted);
    if (any(in_window)) {
        using Search = EventSearch<Trajectories>;
        const vec unknown = Trajectories::splat(Search::UNCERTAIN);
        vec crossing = unknown;
        if (any(side != vec{}))
            crossing = select(side != vec{}, search.crossing_within(series, length, blocks), unknown);
        const int crossed = bits(in_window & (crossing != Search::NONE));
        const vec rate = crossed ? section_rate(crossing) : vec{};
        for (int lane = 0; crossed >> lane; lane++)
            if (crossed >> lane & 1) cross(crossing[lane], rate[lane], length[lane], lane);
    }
    extremes(length);
    const int sampled = bits(active & observed & (until(trajectory_time) <= length));
    for (int lane = 0; sampled >> lane; lane++)
        if (sampled >> lane & 1) sample(length[lane], lane);
}

// Average J over the piece, sample it, and compare it with the levels.
void Lockstep::average(vec length, mask where) {
    vec *d = apart.at(), *rate = apart_rate.at();
    mask resting = series.u(0)[blocks - 1] - series.u(0)[0] == vec{};
    for (int k = 0; k <= ORDER; k++) {
        d[k] = series.x(k)[blocks - 1] - series.x(k)[0];
        rate[k] = series.u(k)[blocks - 1] - series.u(k)[0];
        if (k > 0) resting &= (d[k] == vec{}) & (rate[k] == vec{});
    }
    d[0] += ends_apart;
    for (int due; (due = bits(where & (until(distance_time) <= length)));) {
        vec moved, sped;
        distance_at(d, rate, ORDER / 2, until(distance_time), moved, sped);
        const vec value = root(moved * moved + sped * sped);
        for (int lane = 0; due >> lane; lane++) {
            if (!(due >> lane & 1)) continue;
            Observer &observer = own[lane]->observer;
            observer.distance_sample[observer.next_distance++] = value[lane];
            aim(lane);
        }
    }
    compare(length, where & compared);
    const mask averaging = where & averaged & (length > until(transient));
    if (!any(averaging)) return;
    const vec ends = until(batch_end), begin = largest(vec{}, until(batch_begin)), stop = least(ends, length);
    const vec middle = 0.5 * (begin + stop), half = 0.5 * (stop - begin);
    vec value[NODES], error, moved, sped;
    for (int j = 0; j < NODES; j++) {
        distance_at(d, rate, ORDER / 2, middle + half * GAUSS.node[j], moved, sped);
        value[j] = root(moved * moved + sped * sped);
    }
    const vec mean = mean_of(value, error);
    const mask simple = ((error <= (RELATIVE_ERROR * mean + ABSOLUTE_ERROR) * mean) | resting) & (ends > length);
    const vec constant = (stop - begin) * root(d[0] * d[0] + rate[0] * rate[0]);
    const vec integral = select(resting, constant, 2.0 * half * mean);
    for (int lane = 0; lane < LANES; lane++) {
        if (!averaging[lane]) continue;
        Observer &observer = own[lane]->observer;
        if (simple[lane]) {
            if (stop[lane] > begin[lane]) observer.add(integral[lane]);
            continue;
        }
        load_distance(lane);
        observer.average(clock_of(lane), 0.0, length[lane]);
        aim(lane);
    }
}

// Compare J with the levels.
void Lockstep::compare(vec length, mask where) {
    if (!any(where)) return;
    const vec *d = apart.at(), *rate = apart_rate.at();
    vec moved, sped;
    distance_at(d, rate, ORDER / 2, length, moved, sped);
    mask passed = root(moved * moved + sped * sped) < lower;
    const mask below = higher < INFINITY;
    if (any(where & below)) passed |= below & (root(distance_bound(d, rate, ORDER / 2, length)) >= higher);
    const int which = bits(where & passed);
    for (int lane = 0; which >> lane; lane++) {
        if (!(which >> lane & 1)) continue;
        load_distance(lane);
        own[lane]->observer.compare(clock_of(lane), 0.0, length[lane]);
        aim(lane);
    }
}

void Lockstep::load_distance(int lane) {
    Distance &distance = own[lane]->observer.distance;
    for (int k = 0; k <= ORDER; k++) {
        distance.position[k] = apart[k][lane];
        distance.velocity[k] = apart_rate[k][lane];
    }
    distance.begin(ORDER);
}

// W' = Σ (U_i' − v) at times of the pieces.
Lockstep::vec Lockstep::section_rate(vec t) const {
    vec total{};
    for (int i = 0; i < blocks; i++)
        total = select(in_section[i], total + (series.value(series.velocity, i, t) - layout.v), total);
    return total;
}

// Record where W changes its sign. rate : W' at a crossing that the search has found
void Lockstep::cross(double crossing, double rate, double length, int lane) {
    Run &run = *own[lane];
    Observer &observer = run.observer;
    if (crossing == EventSearch<Trajectories>::UNCERTAIN) {
        polynomial.degree = ORDER;
        for (int k = 0; k <= ORDER; k++) {
            double total = 0.0;
            for (int i = run.first; i < run.last; i++) total += series.x(k)[i][lane];
            polynomial.coefficient[k] = total;
        }
    }
    observer.cross(polynomial, crossing, clock_of(lane), 0.0, length, length,
                   [&](double t) { return t == crossing ? rate : section_rate(Trajectories::splat(t))[lane]; });
    side[lane] = observer.side;
    changed[lane] = -1;
}

void Lockstep::extremes(vec length) {
    const vec until_window = until(transient);
    const mask in_transient = until_window > 0.0, in_window = length > until_window;
    for (int i = 0; i < blocks; i++) {
        const mask slips = state.slip[i] != vec{};
        const vec bound = search.bound_in_piece(i);
        const auto is_new = [&](Stage stage) {
            return bound > select(slips, highest_speed[stage], layout.threshold[i] - lowest_force[stage]);
        };
        const int which = bits(active & ((in_transient & is_new(TRANSIENT)) | (in_window & is_new(WINDOW))));
        for (int lane = 0; which >> lane; lane++) {
            if (!(which >> lane & 1)) continue;
            const size_t place = size_t(i) * LANES + lane;
            own[lane]->observer.extreme(state.slip.lane(place) != 0.0, layout.threshold.lane(place), bound[lane],
                                        clock_of(lane), 0.0, length[lane],
                                        [&]() -> Polynomial & { return series.load(polynomial, state, place); });
            aim(lane);
        }
    }
}

// Store the states at times of the trajectory that lie in the piece.
void Lockstep::sample(double length, int lane) {
    Observer &observer = own[lane]->observer;
    while (observer.next_trajectory < observer.trajectory_time.size()) {
        const vec t = Trajectories::splat(clock_of(lane).until(observer.trajectory_time[observer.next_trajectory]));
        if (t[0] > length) break;
        observer.sample([&](int i, double &position, double &speed) {
            position = series.value(series.position, i, t)[lane];
            speed = series.value(series.velocity, i, t)[lane];
        });
    }
    aim(lane);
}

// Propagate the perturbations along the piece, in each lane up to the edge of its batch, where they are
// orthonormalised, and on from there.
void Lockstep::follow(vec length) {
    mask moving{};
    for (int i = 0; i < blocks; i++) moving |= state.slip[i] != vec{};
    const int waiting = bits(active & ~running);
    for (int lane = 0; waiting >> lane; lane++) {
        Exponents &exponents = own[lane]->exponents;
        if (!(waiting >> lane & 1) || clock[lane] + length[lane] <= exponents.start_time) continue;
        exponents.begin_within(slip_of(lane), clock[lane], length[lane]);
        running[lane] = -1;
        exchange(lane, false);
    }
    mask where = active & running;
    tangent.forget_stops(where);
    vec from{};
    for (;;) {
        const vec edge = largest(from, until(batch_edge));
        const mask ends = where & (edge < length);
        const vec to = select(ends, edge, length);
        if (any(where & moving)) follow(from, to, where & moving);
        if (!any(ends)) return;
        for (int lane = 0; lane < LANES; lane++) {
            if (!ends[lane]) continue;
            exchange(lane, true);
            own[lane]->exponents.renew(slip_of(lane), batch_edge[lane], false);
            exchange(lane, false);
        }
        where = ends;
        from = to;
        if (!law.law.linear) series.restore_friction(state, from);
    }
}

// Propagate them between two times of the piece, in parts after which they can be orthonormalised.
void Lockstep::follow(vec from, vec to, mask where) {
    tangent.load(state, series, to - from, where);
    for (int done = 1;; done++) {
        tangent.follow(layout);
        if (tangent.most_parts() <= done) return;
        tangent.move_on(done);
        vec time = clock + from;
        mask within{};
        for (int lane = 0; lane < LANES; lane++) {
            const int parts = tangent.parts_of(lane);
            within[lane] = -int64_t(parts > done);
            time[lane] += done * ((to - from)[lane] / parts);
        }
        orthonormalise(time, within);
    }
}

// Orthonormalise the perturbations of the lanes in which this is due.
void Lockstep::orthonormalise(vec clock, mask where) {
    vec alive{};
    mask together{};
    const int which = bits(where);
    for (int lane = 0; which >> lane; lane++) {
        if (!(which >> lane & 1)) continue;
        Exponents &exponents = own[lane]->exponents;
        const double *directions = slip_of(lane);
        if (!exponents.is_due(directions, clock[lane])) continue;
        if (exponents.only_renews(directions, clock[lane])) {
            together[lane] = -1;
            alive[lane] = exponents.alive;
            continue;
        }
        exchange(lane, true);
        exponents.follow(directions, clock[lane], false);
        exchange(lane, false);
    }
    const int found = bits(together);
    if (!found) return;
    gram_schmidt(tangent.position.at(), tangent.velocity.at(), blocks, vectors, blocks, speed_weight, together, true,
                 alive, growth.at(), watch);
    for (int lane = 0; found >> lane; lane++)
        if (found >> lane & 1) own[lane]->exponents.renewed(clock[lane], int(alive[lane]), &growth.lane(lane), LANES);
}

// Copy the perturbations of a lane to its run, or from there.
void Lockstep::exchange(int lane, bool out) {
    Exponents &exponents = own[lane]->exponents;
    batch_edge[lane] = exponents.next_edge();
    for (int v = 0; v < vectors; v++)
        for (int i = 0; i < blocks; i++) {
            const size_t k = (size_t(v) * blocks + i) * LANES + lane;
            double &x = tangent.position.lane(k), &u = tangent.velocity.lane(k);
            (out ? exponents.x(v)[i] : x) = out ? x : exponents.x(v)[i];
            (out ? exponents.u(v)[i] : u) = out ? u : exponents.u(v)[i];
        }
}

// The directions in which the blocks of a lane slip.
const double *Lockstep::slip_of(int lane) {
    slip.resize(blocks);
    for (int i = 0; i < blocks; i++) slip[i] = state.slip[i][lane];
    return slip.data();
}

}  // namespace bk
