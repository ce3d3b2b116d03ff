// What moves trajectories in the lanes of vectors, each with its own clock and its own model.
#pragma once

#include "events.h"
#include "interrupt.h"
#include "record.h"
#include "status.h"

namespace bk {

class TrajectoryLanes {
  public:
    static constexpr int LANES = Trajectories::LANES;
    using vec = Trajectories::vec;
    using mask = Trajectories::mask;

    long long searches() const { return search.searches; }

  protected:
    const int blocks;
    Trajectories layout;
    FrictionSeries<Trajectories> law;
    State<Trajectories> state;
    Series<Trajectories> series;
    EventScratch<Trajectories> scratch;
    Polynomial &polynomial = scratch.polynomial;
    EventSearch<Trajectories> search;
    vec clock{}, clock_rest{};
    mask active{};

    // model : one that is like those of all lanes
    explicit TrajectoryLanes(const Model &model)
        : blocks(model.springs.blocks), layout(model), law(model.law, blocks), state(layout), series(layout, law),
          search(scratch) {}
    TrajectoryLanes(const TrajectoryLanes &) = delete;

    // Expand the motion of all lanes, with columns of g beyond those of the blocks; return for which time the series
    // are valid, and in `resting` where a lane has no motion: towards a pole of the law pieces shrink until the clock
    // stands still.
    vec expand(int extra, mask &resting) {
        vec fastest{};
        for (int i = 0; i < blocks; i++) fastest = largest(fastest, magnitude(state.velocity[i]));
        const vec reach = series.expand(state, extra);
        resting = ~((clock < clock + reach) & (fastest < ABSURD_SPEED));
        return reach;
    }

    // Move lanes and their clocks on along their pieces.
    void advance(vec length, mask where) {
        series.move(state, length, where);
        const vec total = clock + (clock_rest + length), rest = (clock - total) + (clock_rest + length);
        clock_rest = select(where, rest, clock_rest);
        clock = select(where, total, clock);
    }

    // The time from the clocks until others.
    vec until(vec other) const { return (other - clock) - clock_rest; }
    Clock clock_of(int lane) const { return {clock[lane], clock_rest[lane]}; }

    // Let the blocks that have the events that were found stop or start, in their order. change(i, where) : lets one
    template <class Change>
    void change_due(mask where, Change &&change) {
        search.aim(series);
        for (int i = 0; i < blocks; i++) {
            const mask due = where & search.due(series, i);
            if (any(due)) change(i, due);
        }
    }

    // Carry out every change that is due at this instant, to the last one, before time moves on.
    // is_open() : lanes in which events do not accumulate
    template <class Change, class Open>
    void settle(mask where, Change &&change, Open &&is_open) {
        std::vector<int> due(blocks);
        for (where &= is_open(); any(where); where &= is_open()) {
            mask changing{};
            state.measure();
            // Who changes is decided before anyone does: then no order of the blocks is preferred.
            for (int i = 0; i < blocks; i++) {
                const mask own = where & state.pending(i);
                due[i] = bits(own);
                changing |= own;
            }
            for (int i = 0; i < blocks; i++)
                if (due[i]) change(i, Trajectories::from_bits(due[i]));
            where = changing;
        }
    }
};

}  // namespace bk
