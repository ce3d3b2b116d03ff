// One run from event to event: smooth motion as Taylor series, each event at its exact time.
//
// A chain of few blocks is one group with one clock. In a long chain, where few blocks slip at a time, each connected
// set of slipping blocks and their stuck neighbours is a group with its own series, clock and next event. A stuck block
// whose neighbours are stuck starts at a time known in closed form. Groups merge when a block at their border starts,
// and split when a block stops. The events are the same either way.
#pragma once

#include <memory>
#include <optional>
#include <queue>

#include "exponents.h"
#include "group.h"
#include "modes.h"

namespace bk {

// The state of a single block, see State.
struct Block {
    double x, u, acceleration, age, slip, touching;
    Clock since, loaded;  // the time of this state, and the loading clock then
    // Whether the block creeps, and its displacement relative to that of the driver, otherwise 0.
    bool creeps = false;
    double creep = 0.0;
    // Whether the block slips slowly and waits for a stop; then `acceleration` is more accurate than the forces.
    bool fades = false;

    template <class A>
    void archive(A &values) {
        values(x, u, acceleration, age, slip, touching, since, loaded, creeps, creep);
    }
};

// State that lets a continued run repeat the last pieces of the previous run, so that it equals an uninterrupted run.
struct Mark {
    std::vector<Block> block;
    std::vector<int> group;  // of each block, −1 for none
    // Start times of blocks without a group.
    std::vector<Clock> begins;
    // Forces on the blocks of a group from outside it; in a dense network, forces at the reference positions.
    std::vector<double> sliding_force, drift, reference;
    int stops = 0;
    // The slip clock and, under quasi-static loading, the loading clock.
    Clock now, load;
    // Positions and velocities at the last event, for the closed form.
    std::vector<double> origin, origin_velocity;
    // Slip events that had not ended.
    std::optional<Catalogue::Open> catalogue;
    double since_event = 0.0;
    // The sign of W at the start of the piece, 0 if it was not known, and the time since which it was tracked.
    int side = 0;
    double section_from = 0.0;
    // Whether the chain moved in groups.
    bool local = false;

    template <class A>
    void archive(A &values) {
        values(block, group, begins, sliding_force, drift, now, load, origin, origin_velocity, catalogue, since_event,
               side, section_from, local, reference, stops);
    }
};

class Run {
  public:
    // Velocities of a set of slow slips that are below 0 by less than this share of the largest are rounding.
    static constexpr double NOISE = 1e-7;
    // Longest time between orthonormalisations, which are also needed without events, in units of the shortest.
    static constexpr double LONGEST_FOLLOW = 4.0;
    // Factor exp(−DECAY) by which dashpots may shorten a perturbation in the shortest time.
    static constexpr double DECAY = 4.0;
    static constexpr int LANES = Blocks::LANES;
    // Number of unused groups whose memory is kept, in addition to the number in use.
    static constexpr size_t SPARE = 64;
    // In a run in groups, perturbations are orthonormalised after one change for every so many blocks, and after so
    // many parts of a piece, in each of which a vector may shrink by exp(−2.4); see Tangent.
    static constexpr int BLOCKS_A_CHANGE = 128, PARTS = 4;
    using vec = Blocks::vec;
    using mask = Blocks::mask;

    const Model &model;
    EventLog &log;
    Observer &observer;
    Exponents &exponents;
    const bool observing, local;
    const long long step_limit;
    // Velocity of the driver while all blocks stick or creep, under quasi-static loading, where v = 0; 0 under steady
    // loading.
    const double loading;
    int halting_block = -1;
    double end;
    Clock now;
    // Under quasi-static loading, the loading clock: it runs while all blocks stick or creep, `now` while some slip.
    Clock load;
    long long steps = 0;
    // The closed form between events, if it is used.
    std::unique_ptr<Modes> modes;
    // Slip events are recorded here, if a catalogue is given.
    Catalogue *catalogue = nullptr;

    // local : 1 in groups, 0 as a single group, −1 whichever is faster
    Run(const Model &model, EventLog &log, Observer &observer, Exponents &exponents, bool observing, int local,
        long long step_limit, double loading)
        : model(model), log(log), observer(observer), exponents(exponents), observing(observing),
          local(!exponents.is_carried() &&
                (local < 0 ? model.springs.blocks >= Springs::MANY && !model.springs.single : local > 0)),
          step_limit(step_limit), loading(loading), end(observer.end()), blocks(model.springs.blocks),
          first(observer.section ? observer.section - 1 : 0),
          last(observer.section ? observer.section : model.springs.blocks), law(model.law, 1), alone(blocks),
          group_of(blocks, -1), lane_of(blocks, -1), version(blocks), row_of(blocks, -1), begins(blocks) {
        log.unit = model.springs.unit;
        exponents.interval = loading > 0.0 ? 0.0 : follow_unit();
        exponents.unit = model.springs.unit;
        exponents.rounding = rounding_of_starts(model.v);
    }

    Run(const Run &) = delete;

    // Start at a time from positions x_i, velocities U_i' and stuck blocks.
    void begin(const double *position, const double *speed, const bool *stuck, double time) {
        for (int i = 0; i < blocks; i++) {
            const double slip = stuck[i] ? 0.0 : speed[i] < 0.0 ? -1.0 : 1.0;
            alone[i] = {position[i], stuck[i] ? 0.0 : speed[i], 0.0, LONG, slip, 0.0, {time, 0.0}, {time, 0.0}};
        }
        restart({time, 0.0}, {time, 0.0});
        settled = false;
    }

    // Continue at a time from the mark of a run that ended then, in groups or as a whole.
    void resume(const Mark &mark, double time);

    const Mark &mark() const { return marked; }

    int run() {
        if (!settled) settle_first();
        return local ? run_groups() : run_whole();
    }

    // Shortest time between orthonormalisations: the unit of the chain, or less if dashpots are strong.
    double follow_unit() const {
        const Springs &springs = model.springs;
        return springs.damping_rate * springs.unit > DECAY ? DECAY / springs.damping_rate : springs.unit;
    }

    // Time in which a driver of a given speed changes the forces on blocks by their rounding.
    double rounding_of_starts(double speed) const {
        const auto largest = [](const std::vector<double> &of) { return *std::max_element(of.begin(), of.end()); };
        const double rate = speed * largest(model.springs.driving);
        return AT_THRESHOLD * (model.springs.unit + (rate > 0.0 ? largest(model.springs.threshold) / rate : 0.0));
    }

    // The loading clock at a time of the slip clock. Under steady loading the two are the same.
    const Clock &loading_clock(const Clock &at) const { return loading > 0.0 ? load : at; }

    // Positions, velocities and slip directions now, or at the end of a completed run.
    void state(double *position, double *speed, double *direction) {
        for (int i = 0; i < blocks; i++) state_of(i, position[i], speed[i], direction[i]);
    }

    // The group of all blocks, settled.
    Group &whole() {
        if (!settled) settle_first();
        return *groups[group_of[0]];
    }

  private:
    friend class Lockstep;
    const int blocks, first, last;  // W is the sum over the blocks first … last − 1
    bool settled = false;
    Watch watch;
    double since_event = 0.0;
    int stops = 0;  // since the forces of a dense network were last added up
    Mark marked;
    EventScratch<Blocks> scratch;
    Polynomial &polynomial = scratch.polynomial;
    FrictionSeries<Blocks> law;  // of the group whose piece was expanded last
    std::vector<Block> alone;    // states of blocks; for those in a group, at its start
    std::vector<int> group_of, lane_of;
    std::vector<uint64_t> version;
    uint64_t versions = 0;                       // of groups, no two alike
    std::vector<std::unique_ptr<Group>> groups;  // nullptr if the memory was freed
    std::vector<int> spare, due;
    std::vector<int> row_of;  // rows of blocks in a system of equations, −1 for other blocks
    // The next events at one instant: groups whose pieces end, and blocks without a group that start.
    std::vector<int> ending, starting;

    // A future event: the start of a block without a group, or the end of a group's piece.
    struct Next {
        Clock at;
        int number;
        bool is_group;
        uint64_t version;
        bool operator>(const Next &other) const { return other.at.until(at) > 0.0; }
    };
    // Future events on the slip clock, and on the loading clock.
    using Queue = std::priority_queue<Next, std::vector<Next>, std::greater<Next>>;
    Queue queue, waiting;
    Queue &starts() { return loading > 0.0 ? waiting : queue; }

    // Both ways, in run.cpp.
    void restart(const Clock &at, const Clock &loaded);
    void settle_first();
    void state_of(int i, double &position, double &speed, double &direction);
    double position_at_rest(int i, const Clock &at) const;
    // Displacement of the driver relative to a block that sticks or creeps, on the loading clock.
    double lag(int i) const { return loading * alone[i].loaded.until(load) * (1.0 - alone[i].creep); }
    Group &build(std::vector<int> members, const Clock &at);
    void hold(Group &group);
    double spring_pull(int i, const Clock &at) const;
    Block block_in(Group &group, int lane, const Clock &loaded) const;
    void retire(Group &group);
    bool plan(Group &group);
    void change(Group &group, int lane, const Clock &at);
    bool settle(Group &group, const Clock &at);
    void find_due(Group &group);
    void change_due(Group &group, const Clock &at);
    void remember();
    void start_modes(Group &group, const Mark &mark);
    int blocked() const;

    // Creep, in creep.cpp.
    void end_at_rest(Group &group);
    bool rests(const Group &group) const;
    std::vector<std::vector<int>> slipping_sets(const Group &group) const;
    double fade(Group &group);
    bool stop_slow(Group &group);
    void balance(Group &group, const std::vector<int> &members);
    void begin_creep(Group &group);
    Group *release(Group &group);
    std::vector<double> solve(const std::vector<int> &members, const std::vector<double> &right);
    double creep_rate(int i) const;
    void add_creep(int i, double distance);
    void end_creep(int i);

    // One group.
    int run_whole();
    bool load_next(Group &group);
    void advance(Group &group, double length);
    void observe(Group &group, double to);
    void follow(Group &group, double length);
    void follow(Group &group, double from, double to);

    // Many groups, in groups.cpp.
    int run_groups();
    void drop_void(Queue &queue);
    void take_next(Queue &queue);
    bool process();
    void wait(int i);
    bool schedule(Group &group);
    void regroup();
    void gather(int i, std::vector<int> &members);
    Group &collect(std::vector<int> &members);
    Group *complete(Group *group);
    bool part(Group &group);
    void end_piece(Group &group, double to);
    void observe_all(const Clock &at, const Clock &reach);
    void observe_distance(const Clock &at);
    void observe_section(const Clock &at, const Clock &reach);
    double waiting_force(int i, const Clock &at) const;
    double section_value(const Clock &at);
    Polynomial motion_of(int i, bool speed, const Clock &at);
    bool section_lanes(const Group &group, int &begin, int &stop) const;
    double section_range(const Group &group);
    bool holds_end(const Group &group) const;

    // Lyapunov exponents of a run in groups, in local_exponents.cpp.
    void count_stuck();
    void begin_exponents(double length);
    void load_exponents();
    void follow_groups();
    void pass_edges(const Clock &next, bool completed);
    void propagate(Group &group, double to);
    void exchange(const Group &group, bool out);
    // The directions in which all blocks slip, and how many stick.
    std::vector<double> directions;
    int sticking = 0;
    // Instants at which the motion has changed since the last orthonormalisation.
    int changes = 0;
    const Group *expanded = nullptr;  // the group whose piece was expanded last
    double direction_of(int i) const {
        return group_of[i] < 0 ? alone[i].slip : groups[group_of[i]]->state.slip.lane(lane_of[i]);
    }

    std::vector<Clock> begins;  // start times of waiting blocks
    Clock observed, distance_from, section_from;
    double section_at = 0.0, section_change = 0.0;
    bool waiting_seen[2] = {false, false}, blind = false;
};

}  // namespace bk
