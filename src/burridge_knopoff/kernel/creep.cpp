// Creep under quasi-static loading.
//
// Behind a driver that does not move, the speed of an overdamped slip tends to 0 and does not change its sign: the
// block does not stop. The force on it stays equal to the kinetic friction at zero speed, s_i = θ_i Φ(0), and it moves
// as the driver advances. With C the blocks that creep, the others stuck, a displacement of the driver moves them in
// proportion to
//
//     w_C = K_CC⁻¹ D_C,    0 ≤ w_i ≤ 1,
//
// until the force on a stuck block reaches its threshold. This is the limit of a slow driver, behind which these blocks
// slip at the velocity w_i v. K_CC is positive definite, and only non-negative solutions occur, so that no block that
// creeps stops before another one starts.
//
// A slip below critical damping stops, however slow it has become. Where all slips are slow, friction is linear in the
// speed, and their further motion decides which of them stop, and when (slow_slip.h).
#include "run.h"
#include "slow_slip.h"

namespace bk {

// End a piece without an event where its last slip has become slow. This time does not depend on how the motion is
// divided into pieces.
void Run::end_at_rest(Group &group) {
    const double fastest = model.springs.fastest;
    group.resting = !group.event && group.rests_at(group.length, model.rest_speed, fastest);
    if (!group.resting) return;
    double before = 0.0;
    for (double middle; (middle = 0.5 * (before + group.length)) > before && middle < group.length;)
        (group.rests_at(middle, model.rest_speed, fastest) ? group.length : before) = middle;
}

// Whether all blocks of a group stick or slip slowly.
bool Run::rests(const Group &group) const {
    if (loading == 0.0 || group.resting) return loading > 0.0;
    for (int c = 0; c < group.layout.columns; c++)
        if (any(group.layout.present[c] & ~group.state.rests(c, model.rest_speed, model.springs.fastest))) return false;
    return true;
}

// The connected sets of slipping blocks of a group, as lanes.
std::vector<std::vector<int>> Run::slipping_sets(const Group &group) const {
    const Springs &springs = model.springs;
    const State<Blocks> &state = group.state;
    std::vector<bool> reached(group.size());
    std::vector<std::vector<int>> sets;
    for (int k = 0; k < group.size(); k++) {
        if (reached[k] || state.slip.lane(k) == 0.0) continue;
        std::vector<int> lanes{k};
        reached[k] = true;
        for (size_t m = 0; m < lanes.size(); m++) {
            const int i = group.layout.member[lanes[m]];
            for (int64_t p = springs.start[i]; p < springs.start[i + 1]; p++) {
                const int j = springs.neighbour[p];
                if (group_of[j] != group.number || reached[lane_of[j]] || state.slip.lane(lane_of[j]) == 0.0) continue;
                reached[lane_of[j]] = true;
                lanes.push_back(lane_of[j]);
            }
        }
        std::sort(lanes.begin(), lanes.end());
        sets.push_back(std::move(lanes));
    }
    return sets;
}

// Advance the slow slips of a group to the first stop, and return the time until then; NEVER if no block stops. The
// velocity of the blocks that stop is then 0; the sets in which no block stops do not change.
double Run::fade(Group &group) {
    const Springs &springs = model.springs;
    State<Blocks> &state = group.state;
    std::vector<SlowSlip> sets;
    std::vector<double> times, noise;
    auto load = [&](SlowSlip &slow) {
        bool fades = true;
        for (size_t m = 0; m < slow.members.size(); m++) {
            const int i = slow.members[m], lane = lane_of[i], c = lane / LANES;
            row_of[i] = int(m);
            slow.u[m] = state.velocity.lane(lane);
            slow.direction[m] = state.slip.lane(lane);
            slow.rate[m] = alone[i].fades ? state.acceleration.lane(lane)
                                          : state.slip_acceleration(c, state.force(c),
                                                                    Blocks::from_bits(1 << lane % LANES))[lane % LANES];
            fades &= alone[i].fades;
        }
        return fades;
    };
    for (const auto &lanes : slipping_sets(group)) {
        std::vector<int> members;
        for (int lane : lanes) members.push_back(group.layout.member[lane]);
        sets.emplace_back(springs, model.law, members, row_of, watch);
        SlowSlip &slow = sets.back();
        const bool fades = load(slow);
        // Blocks that crept before have the velocities of rounding.
        const bool moves = fades || slow.fastest() > model.creep_speed;
        noise.push_back(std::min(model.creep_speed, NOISE * slow.fastest()));
        times.push_back(moves ? slow.first_stop(noise.back(), NEVER) : NEVER);
    }
    const double first = times.empty() ? NEVER : *std::min_element(times.begin(), times.end());
    std::vector<int> moved;
    for (size_t s = 0; s < sets.size(); s++) {
        SlowSlip &slow = sets[s];
        if (times[s] < NEVER) {
            if (times[s] > first) {
                load(slow);
                slow.first_stop(noise[s], first);
            }
            for (size_t m = 0; m < slow.members.size(); m++) {
                const int i = slow.members[m];
                state.velocity.lane(lane_of[i]) = slow.u[m];
                state.acceleration.lane(lane_of[i]) = slow.rate[m];
                alone[i].fades = true;
                moved.push_back(i);
            }
        }
        for (int i : slow.members) row_of[i] = -1;
    }
    if (!moved.empty()) balance(group, moved);
    return first;
}

// Stop the first blocks of a group that rests whose slow slips end, and return whether there are any.
bool Run::stop_slow(Group &group) {
    const double time = fade(group);
    if (time == NEVER) return false;
    group.start = group.start.after(time);
    now = group.start;
    exponents.forget_stops();
    for (int k = 0; k < group.size(); k++) {
        bool &fades = alone[group.layout.member[k]].fades;
        if (!fades || group.state.velocity.lane(k) != 0.0) continue;
        fades = false;
        change(group, k, now);
    }
    if (exponents.running) exponents.follow(group.slip(), load.time, false);
    group.resting = true;
    return true;
}

// Move slipping blocks to where the forces balance kinetic friction exactly. Their perturbations follow from those of
// the others.
void Run::balance(Group &group, const std::vector<int> &members) {
    const Springs &springs = model.springs;
    State<Blocks> &state = group.state;
    std::vector<double> right(members.size());
    for (size_t m = 0; m < members.size(); m++) {
        const int lane = lane_of[members[m]], c = lane / LANES;
        const Blocks &layout = state.layout;
        const vec *x = state.position.at();
        const double spring = (layout.increments.used ? layout.sliding_force[c] + layout.spring_pull(x, 0, c)
                                                      : layout.sliding_force[c] + layout.pull(x, c) -
                                                            layout.diagonal[c] * x[c])[lane % LANES];
        right[m] = spring - state.slip.lane(lane) * springs.threshold[members[m]] * model.law.at_rest;
    }
    const std::vector<double> rest = solve(members, right);
    for (size_t m = 0; m < members.size(); m++) {
        state.position.lane(lane_of[members[m]]) += rest[m];
        add_creep(members[m], rest[m]);
    }
    for (int v = 0; v < exponents.tangent.vectors; v++) {
        for (int i : members) exponents.x(v)[i] = exponents.u(v)[i] = 0.0;
        for (size_t m = 0; m < members.size(); m++) right[m] = springs.pull(exponents.x(v), members[m]);
        const std::vector<double> follows = solve(members, right);
        for (size_t m = 0; m < members.size(); m++) exponents.x(v)[members[m]] = follows[m];
    }
}

// Let the slipping blocks of a group that rests creep from now on.
void Run::begin_creep(Group &group) {
    State<Blocks> &state = group.state;
    // A block that slips backward would change its direction as the driver advances.
    due.assign(group.layout.columns, 0);
    for (int k = 0; k < group.size(); k++)
        if (state.slip.lane(k) < 0.0) due[k / LANES] |= 1 << k % LANES;
    change_due(group, now);
    std::vector<int> members;
    std::vector<double> right;
    for (int k = 0; k < group.size(); k++) {
        const int i = group.layout.member[k];
        alone[i].fades = false;
        if (state.slip.lane(k) == 0.0 || alone[i].creeps) continue;
        members.push_back(i);
        right.push_back(model.springs.driving[i]);
        state.velocity.lane(k) = state.acceleration.lane(k) = state.touching.lane(k) = 0.0;
        state.age.lane(k) = LONG;
    }
    if (members.empty()) return;
    const std::vector<double> creep = solve(members, right);
    balance(group, members);
    for (size_t m = 0; m < members.size(); m++) {
        alone[members[m]].creeps = true;
        alone[members[m]].creep = creep[m];
    }
}

// Take the connected sets of slipping blocks that slip slowly out of a group; return the group of the remaining blocks,
// nullptr if there are none. They creep, or wait for the first stop in their set.
Group *Run::release(Group &group) {
    if (loading == 0.0 || model.creep_speed == 0.0) return &group;
    const State<Blocks> &state = group.state;
    const int n = group.size();
    std::vector<bool> slow(n);
    std::vector<std::vector<int>> sets;
    for (const auto &lanes : slipping_sets(group)) {
        bool rests = true;
        for (int lane : lanes)
            rests &= group.resting || alone[group.layout.member[lane]].fades ||
                     bits(state.rests(lane / LANES, model.rest_speed, model.springs.fastest)) >> lane % LANES & 1;
        if (!rests) continue;
        sets.emplace_back();
        for (int lane : lanes) {
            sets.back().push_back(group.layout.member[lane]);
            slow[lane] = true;
        }
    }
    std::vector<int> remaining;
    for (int k = 0; k < n; k++) {
        if (slow[k]) continue;
        remaining.push_back(group.layout.member[k]);
        alone[remaining.back()].fades = false;
    }
    if (sets.empty()) return &group;
    retire(group);
    for (auto &members : sets) {
        std::sort(members.begin(), members.end());
        Group &resting = build(members, now);
        const double time = fade(resting);
        if (time == NEVER) begin_creep(resting);
        retire(resting);
        for (int i : members) {
            begins[i] = {NEVER, 0.0};
            version[i]++;
            if (time < NEVER && alone[i].u == 0.0) queue.push({now.after(time), i, false, version[i]});
            if (alone[i].slip == 0.0) remaining.push_back(i);
        }
    }
    return remaining.empty() ? nullptr : &collect(remaining);
}

// Solve Σ_j K_ij y_j = right_i for some blocks by conjugate gradients, with the diagonal as preconditioner: springs of
// very different strengths need many times fewer steps with it. In exact arithmetic there are as many steps as blocks.
std::vector<double> Run::solve(const std::vector<int> &members, const std::vector<double> &right) {
    constexpr int STEPS_A_BLOCK = 100;
    const Springs &springs = model.springs;
    const int n = int(members.size());
    for (int m = 0; m < n; m++) row_of[members[m]] = m;
    // From both ends, so that a mirrored chain has a mirrored solution to the bit.
    auto dot = [n](const std::vector<double> &a, const std::vector<double> &b) {
        double total = 0.0;
        for (int m = 0, end = n - 1; m <= end; m++, end--) total += a[m] * b[m] + (m < end ? a[end] * b[end] : 0.0);
        return total;
    };
    std::vector<double> solution(n), residual = right, scaled(n), product(n);
    auto scale = [&] {
        for (int m = 0; m < n; m++) scaled[m] = residual[m] / springs.diagonal[members[m]];
    };
    scale();
    std::vector<double> direction = scaled;
    double square = dot(residual, scaled);
    const double least = 1e-33 * square;
    for (int step = 0; step < STEPS_A_BLOCK * n && square > least; step++) {
        watch.worked(n);
        for (int m = 0; m < n; m++) {
            const int i = members[m];
            double pull = 0.0;
            for (int64_t p = springs.start[i]; p < springs.start[i + 1]; p++)
                if (const int row = row_of[springs.neighbour[p]]; row >= 0)
                    pull += springs.strength[p] * direction[row];
            product[m] = springs.diagonal[i] * direction[m] - pull;
        }
        const double length = square / dot(direction, product);
        for (int m = 0; m < n; m++) {
            solution[m] += length * direction[m];
            residual[m] -= length * product[m];
        }
        scale();
        const double before = square;
        square = dot(residual, scaled);
        for (int m = 0; m < n; m++) direction[m] = scaled[m] + square / before * direction[m];
    }
    for (int i : members) row_of[i] = -1;
    return solution;
}

// The rate at which the force on a stuck block grows, relative to the displacement of the driver.
double Run::creep_rate(int i) const {
    const Springs &springs = model.springs;
    double rate = 0.0;
    for (int64_t p = springs.start[i]; p < springs.start[i + 1]; p++)
        rate += springs.strength[p] * alone[springs.neighbour[p]].creep;
    return springs.driving[i] + rate;
}

// Add the work of the springs on a block that creeps to its slip event.
void Run::add_creep(int i, double distance) {
    if (Catalogue::Event *event = catalogue ? catalogue->of(i) : nullptr)
        event->energy += model.springs.threshold[i] * model.law.at_rest * distance;
}

// A block that may have crept up to now sticks or slips from now on.
void Run::end_creep(int i) {
    Block &block = alone[i];
    if (block.creeps) add_creep(i, loading * block.loaded.until(load) * block.creep);
    block.loaded = load;
    block.creeps = false;
    block.creep = 0.0;
}

}  // namespace bk
