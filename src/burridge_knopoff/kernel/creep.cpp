// Creep under quasi-static loading.
//
// Behind a driver that does not move, the speed of an overdamped slip tends to 0 and never changes sign: the block does
// not stop. The force on it stays equal to the kinetic friction at zero speed, s_i = θ_i Φ(0), and it moves as the
// driver advances. With C the blocks that creep, the others stuck, a displacement of the driver moves them in
// proportion to
//
//     w_C = K_CC⁻¹ D_C,    0 ≤ w_i ≤ 1,
//
// until the force on a stuck block reaches its threshold. This is the limit of a slow driver, behind which these blocks
// slip at the velocity w_i v. K_CC is positive definite, and only non-negative solutions occur, so that no block that
// creeps stops before another one starts.
#include "run.h"

namespace bk {

// End a piece without an event where its last slip begins to creep. This time does not depend on how the motion is
// divided into pieces.
void Run::end_at_rest(Group &group) {
    const double fastest = model.springs.fastest;
    group.resting = !group.event && group.rests_at(group.length, fastest);
    if (!group.resting) return;
    double before = 0.0;
    for (double middle; (middle = 0.5 * (before + group.length)) > before && middle < group.length;)
        (group.rests_at(middle, fastest) ? group.length : before) = middle;
}

// Whether all blocks of a group stick or creep.
bool Run::rests(const Group &group) const {
    if (loading == 0.0 || group.resting) return loading > 0.0;
    for (int c = 0; c < group.layout.columns; c++)
        if (any(group.layout.present[c] & ~group.state.rests(c, model.springs.fastest))) return false;
    return true;
}

// Let the slipping blocks of a group that rests creep from now on.
void Run::begin_creep(Group &group) {
    const Springs &springs = model.springs;
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
        if (state.slip.lane(k) == 0.0 || alone[i].creeps) continue;
        members.push_back(i);
        right.push_back(springs.driving[i]);
        state.velocity.lane(k) = state.acceleration.lane(k) = state.touching.lane(k) = 0.0;
        state.age.lane(k) = LONG;
    }
    if (members.empty()) return;
    const std::vector<double> creep = solve(members, right);
    // The distance at which the forces balance kinetic friction exactly.
    for (size_t m = 0; m < members.size(); m++) {
        const int lane = lane_of[members[m]];
        right[m] = state.force(lane / LANES)[lane % LANES] - springs.threshold[members[m]] * model.law.at_rest;
    }
    const std::vector<double> rest = solve(members, right);
    for (size_t m = 0; m < members.size(); m++) {
        const int i = members[m];
        state.position.lane(lane_of[i]) += rest[m];
        add_creep(i, rest[m]);
        alone[i].creeps = true;
        alone[i].creep = creep[m];
    }
    // Perturbations of blocks that creep follow from those of the others.
    for (int v = 0; v < exponents.tangent.vectors; v++) {
        for (int i : members) exponents.x(v)[i] = exponents.u(v)[i] = 0.0;
        for (size_t m = 0; m < members.size(); m++) right[m] = springs.pull(exponents.x(v), members[m]);
        const std::vector<double> follows = solve(members, right);
        for (size_t m = 0; m < members.size(); m++) exponents.x(v)[members[m]] = follows[m];
    }
}

// Take the connected sets of slipping blocks that creep out of a group; return the group of the remaining blocks,
// nullptr if there are none.
Group *Run::release(Group &group) {
    if (loading == 0.0 || model.creep_speed == 0.0) return &group;
    const Springs &springs = model.springs;
    const State<Blocks> &state = group.state;
    const int n = group.size();
    std::vector<bool> reached(n), creeps(n);
    std::vector<std::vector<int>> sets;
    for (int k = 0; k < n; k++) {
        if (reached[k] || state.slip.lane(k) == 0.0) continue;
        std::vector<int> lanes{k};
        reached[k] = true;
        bool rests = true;
        for (size_t m = 0; m < lanes.size(); m++) {
            const int i = group.layout.member[lanes[m]];
            const int column = lanes[m] / LANES;
            rests &= group.resting || bits(state.rests(column, springs.fastest)) >> lanes[m] % LANES & 1;
            for (int64_t p = springs.start[i]; p < springs.start[i + 1]; p++) {
                const int j = springs.neighbour[p];
                if (group_of[j] != group.number || reached[lane_of[j]] || state.slip.lane(lane_of[j]) == 0.0) continue;
                reached[lane_of[j]] = true;
                lanes.push_back(lane_of[j]);
            }
        }
        if (!rests) continue;
        sets.emplace_back();
        for (int lane : lanes) {
            sets.back().push_back(group.layout.member[lane]);
            creeps[lane] = true;
        }
    }
    if (sets.empty()) return &group;
    std::vector<int> remaining;
    for (int k = 0; k < n; k++)
        if (!creeps[k]) remaining.push_back(group.layout.member[k]);
    retire(group);
    for (auto &members : sets) {
        std::sort(members.begin(), members.end());
        Group &creeping = build(members, now);
        begin_creep(creeping);
        retire(creeping);
        for (int i : members) {
            begins[i] = {NEVER, 0.0};
            version[i]++;
            if (!alone[i].creeps) remaining.push_back(i);
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
