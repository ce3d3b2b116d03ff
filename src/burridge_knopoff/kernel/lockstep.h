// Several runs at once, each in a lane of vectors.
//
// A run in a lane gives the same results as alone, to the bit. It enters at the beginning of a piece and leaves at the
// beginning of its last piece, which it computes alone. Lanes therefore contain no code for the start and the end of a
// run. Each run has its own law, springs, driver, clock and observables, and does not depend on other lanes.
#pragma once

#include <deque>
#include <map>

#include "run.h"
#include "trajectory_lanes.h"

namespace bk {

// A copy of a model, since the models of the runs need not outlive it.
struct Example {
    const Model model;
};

class Lockstep : private Example, public TrajectoryLanes {
  public:
    // like : one of the runs
    explicit Lockstep(const Run &like)
        : Example{like.model}, TrajectoryLanes(Example::model), vectors(like.exponents.tangent.vectors),
          tangent(blocks, vectors), in_section(blocks), apart(ORDER + 2), apart_rate(ORDER + 2), growth(vectors) {}

    // Whether a run can use a lane: it must move as a whole under steady loading, without a catalogue.
    static bool takes(const Run &run) {
        return !run.local && !run.model.springs.dense && run.loading == 0.0 && !run.modes && !run.catalogue &&
               !run.exponents.at_rest;
    }
    // Whether a run can share vectors with the others.
    bool is_like(const Run &run) const { return run.exponents.tangent.vectors == vectors && run.model.is_like(model); }

    // Add a run that can share vectors with the others.
    void add(Run &run) { waiting.push_back(&run); }

    // Carry out all runs, and report how each ended.
    void run(std::map<Run *, int> &status);

  private:
    static constexpr int ORDER = Trajectories::ORDER;
    // This many remaining runs, or fewer, are as fast alone.
    static constexpr int FEW = std::max(1, LANES / 4);

    const int vectors;
    Tangent<Trajectories> tangent;
    Run *own[LANES] = {};
    std::deque<Run *> waiting;
    std::map<Run *, int> *status = nullptr;
    Watch watch;

    // The next times of the observers, whether J is averaged, and the extremes so far.
    vec end{}, transient{}, batch_begin{}, batch_end{}, distance_time{}, trajectory_time{}, since_event{}, side{},
        ends_apart{}, lower{}, higher{};
    vec highest_speed[2]{}, lowest_force[2]{};  // by Stage
    vec longest_follow{}, batch_edge{}, steps{}, most_steps{}, speed_weight{};
    mask observed{}, averaged{}, compared{}, running{}, halts{}, accumulating{}, changed{};
    std::vector<mask> in_section;
    Trajectories::Rows apart, apart_rate;  // coefficients of d and d'
    Trajectories::Rows growth;             // lengths of the perturbations

    void enter(Run &run, int lane);
    void leave(int lane);
    void finish(mask where);
    void aim(int lane);
    void round();
    void load_section();
    void observe(vec length);
    void average(vec length, mask where);
    void compare(vec length, mask where);
    void load_distance(int lane);
    vec section_rate(vec t) const;
    void cross(double crossing, double rate, double length, int lane);
    void extremes(vec length);
    void sample(double length, int lane);
    void follow(vec length);
    void follow(vec from, vec to, mask where);
    void orthonormalise(vec clock, mask where);
    void exchange(int lane, bool out);
    void change(int i, mask where);
    const double *slip_of(int lane);
    std::vector<double> slip;
};

// Carry out runs, in lockstep where they are of the same kind, and return how each ended.
std::vector<int> run_in_lockstep(const std::vector<Run *> &runs);

}  // namespace bk
