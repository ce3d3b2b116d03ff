// Integration of trajectories in the lanes of vectors, each with its own clock and its own model.
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
    std::vector<int> due;  // lanes in which a block changes, see `settle`

    // model : a model of the same kind as those of all lanes
    explicit TrajectoryLanes(const Model &model)
        : blocks(model.springs.blocks), layout(model), law(model.law, blocks), state(layout), series(layout, law),
          search(scratch), due(blocks) {}
    TrajectoryLanes(const TrajectoryLanes &) = delete;

    // Expand the motion of all lanes, with additional columns of g; return the times for which the series are valid.
    // `resting` becomes true for lanes that cannot continue: near a pole of the law pieces become so short that the
    // clock does not advance.
    vec expand(int extra, mask &resting) {
        vec fastest{};
        for (int i = 0; i < blocks; i++) fastest = largest(fastest, magnitude(state.velocity[i]));
        const vec reach = series.expand(state, extra);
        resting = ~((clock < clock + reach) & (fastest < ABSURD_SPEED));
        return reach;
    }

    // Advance lanes and their clocks along their pieces.
    void advance(vec length, mask where) {
        series.move(state, length, where);
        const vec total = clock + (clock_rest + length), rest = (clock - total) + (clock_rest + length);
        clock_rest = select(where, rest, clock_rest);
        clock = select(where, total, clock);
    }

    // The times from the clocks to others.
    vec until(vec other) const { return (other - clock) - clock_rest; }
    Clock clock_of(int lane) const { return {clock[lane], clock_rest[lane]}; }

    // Stop or start the blocks whose events were found, in order. change(i, where) changes one block
    template <class Change>
    void change_due(mask where, Change &&change) {
        search.aim(series);
        for (int i = 0; i < blocks; i++) {
            const mask due = where & search.due(series, i);
            if (any(due)) change(i, due);
        }
    }

    // Carry out every change that is due at this instant, before time advances.
    // is_open() : lanes in which events do not accumulate
    template <class Change, class Open>
    void settle(mask where, Change &&change, Open &&is_open) {
        for (where &= is_open(); any(where); where &= is_open()) {
            mask changing{};
            state.measure();
            // All changes are decided before any block changes, so that the result does not depend on their order.
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
