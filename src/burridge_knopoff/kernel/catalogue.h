// A catalogue of slip events: slips that are connected in space and time.
//
// A slip of a block lasts from its start to its stop. Slips of neighbours that overlap in time are connected. An event
// is a maximal connected set of slips, from the first start to the last stop. At a finite velocity of the driver there
// may be no time at which all blocks are at rest; events are therefore defined by connection, not by times of rest.
//
// The energy released by an event is the work of all springs on its blocks, ∫ Σ s_i U_i' dτ, which friction and
// dashpots dissipate, since the blocks are at rest before and after. Over a piece in which the same blocks slip the
// work is exactly, with y = U − U(0),
//
//     Σ ½ (s_i(0) + s_i(T) − D_i v T) y_i(T) + D_i v (T y_i(T) − ∫ y_i dτ).
//
// The dashpots at the slipping blocks dissipate ∫ Σ c_ij (U_j' − U_i')² + Σ c_i (v − U_i')² dτ.
#pragma once

#include <algorithm>

#include "layout.h"
#include "polynomial.h"
#include "record.h"

namespace bk {

class Catalogue {
  public:
    // A slip of a block in an event, from the slip clock at its start.
    struct Slip {
        int block;
        double distance;
        Clock begun;

        template <class A>
        void archive(A &values) {
            values(block, distance, begun);
        }
        bool operator<(const Slip &other) const {
            return std::pair(block, distance) < std::pair(other.block, other.distance);
        }
    };

    struct Event {
        Clock start, load;  // slip clock and loading clock at the first start; the same clock under steady loading
        int epicentre = 0, slipping = 0;
        double interval = 0.0, peak_velocity = 0.0, energy = 0.0, damped = 0.0;
        std::vector<Slip> slips;
        // The event into which this one was merged, −1 for none; the events that were merged into this one.
        int merged = -1;
        std::vector<int> absorbed;
        // The speed of a block over a piece in which it may exceed the peak velocity, the length of the piece, and a
        // bound on the speed. The maximum is found only if no later piece has a higher bound.
        double bound = 0.0, length = 0.0, speed[Blocks::ORDER + 1] = {};

        template <class A>
        void archive(A &values) {
            values(start, load, epicentre, slipping, interval, peak_velocity, energy, damped, slips, merged, absorbed,
                   bound, length, speed);
        }
    };

    // Columns, with an entry for each event, in the order in which events end. Blocks are numbered from 1.
    struct Table {
        std::vector<double> time, slip_time, duration, moment, largest_slip, peak_velocity, stress_drop,
            energy_released, energy_damped, interval;
        std::vector<int> epicentre, first_block, last_block, blocks;
        // With profiles, blocks of successive events, their slips, and the slip time from the start of the event to
        // their first starts; those of event k end before slip_end[k].
        std::vector<int64_t> slip_end;
        std::vector<int> slip_block;
        std::vector<double> slip, slip_onset;
    };

    const double from;
    const bool profiles;
    const size_t most;
    Table table;
    bool full = false;

    // from : earlier events are omitted; profiles : whether the slip of every block is stored; most : number of events
    // and of slips in profiles at which the table is full
    Catalogue(int blocks, double from, bool profiles, double most)
        : from(from), profiles(profiles), most(size_t(most)), of_block(blocks), slip(blocks) {}

    // Start again without events. Blocks that slip now belong to no event until they stop.
    void restart() {
        table = {};
        full = false;
        events.clear();
        spare.clear();
        std::fill(of_block.begin(), of_block.end(), Block{});
    }

    // The history of a block.
    struct Block {
        // The event in which the block slips, and its last event if this has not ended; −1 for none.
        int event = -1, last_event = -1;
        // Both clocks and the position at the start of the slip, and start time of the last event that has ended.
        Clock begun, loaded;
        double position = 0.0, last_start = NAN;

        template <class A>
        void archive(A &values) {
            values(event, last_event, begun, loaded, position, last_start);
        }
    };

    // Events that have not ended, for a continued run.
    struct Open {
        std::vector<Event> events;
        std::vector<Block> of_block;

        template <class A>
        void archive(A &values) {
            values(events, of_block);
        }
    };

    Open open() const {
        Open made{{}, of_block};
        std::vector<int> known;
        for (Block &block : made.of_block) {
            if (block.event < 0) continue;
            const int event = find(block.event), k = int(std::find(known.begin(), known.end(), event) - known.begin());
            if (k == int(known.size())) {
                known.push_back(event);
                made.events.push_back(events[event]);
                made.events.back().absorbed.clear();
            }
            block.event = k;
        }
        for (Block &block : made.of_block) {
            if (block.last_event < 0) continue;
            block.last_event = int(std::find(known.begin(), known.end(), find(block.last_event)) - known.begin());
        }
        return made;
    }

    void resume(const Open &open) {
        spare.clear();
        events = open.events;
        of_block = open.of_block;
    }

    // The event of a slipping block; nullptr if it sticks, or has slipped since before the catalogue began.
    Event *of(int i) {
        int &event = of_block[i].event;
        if (event < 0) return nullptr;
        event = find(event);
        return &events[event];
    }

    // Block i starts at position x.
    void start(const Springs &springs, int i, const Clock &at, const Clock &load, double x) {
        Block &block = of_block[i];
        int number = -1;
        for (int64_t p = springs.start[i]; p < springs.start[i + 1]; p++) {
            const int beside = of_block[springs.neighbour[p]].event;
            if (beside >= 0) number = number < 0 ? find(beside) : joined(number, find(beside));
        }
        if (number < 0) {
            if (spare.empty()) {
                spare.push_back(int(events.size()));
                events.emplace_back();
            }
            number = spare.back();
            spare.pop_back();
            Event &event = events[number];
            event.start = at;
            event.load = load;
            event.epicentre = i;
            // The last event of this block may continue elsewhere.
            event.interval =
                load.time - (block.last_event < 0 ? block.last_start : events[find(block.last_event)].load.time);
            event.peak_velocity = event.energy = event.damped = event.bound = 0.0;
        }
        events[number].slipping++;
        block.event = number;
        block.begun = at;
        block.loaded = load;
        block.position = x;
    }

    // Block i stops at position x. v, loading : velocities of the driver on the slip clock and on the loading clock
    void stop(const Springs &springs, double v, double loading, int i, const Clock &at, const Clock &load, double x) {
        Block &block = of_block[i];
        if (block.event < 0) return;
        const int number = find(block.event);
        Event &event = events[number];
        block.event = -1;
        block.last_event = number;
        event.slips.push_back(
            {i, ((x - block.position) + v * block.begun.until(at)) + loading * block.loaded.until(load), block.begun});
        if (--event.slipping > 0) return;
        finish(springs, number, at);
        for (int k : event.absorbed) release(k);
        release(number);
    }

    // Consider the speed of a block of the event over a piece, with these coefficients and this bound.
    void consider(Event &event, const Polynomial &speed, double length, double bound) {
        find_peak(event);
        if (bound <= event.peak_velocity) return;
        event.bound = bound;
        event.length = length;
        std::copy(speed.coefficient, speed.coefficient + Blocks::ORDER + 1, event.speed);
    }

  private:
    std::vector<Event> events;
    std::vector<Block> of_block;
    std::vector<int> spare, blocks;  // free numbers of events; blocks of the event that ends
    std::vector<double> slip;        // slips of the blocks of the event that ends, 0 for other blocks
    std::vector<Clock> begun;        // first starts of the blocks of the event that ends
    Polynomial polynomial;

    int find(int number) const {
        while (events[number].merged >= 0) number = events[number].merged;
        return number;
    }

    void release(int number) {
        Event &event = events[number];
        event.slips.clear();
        event.absorbed.clear();
        event.merged = -1;
        event.slipping = 0;
        spare.push_back(number);
    }

    void find_peak(Event &event) {
        if (event.bound > event.peak_velocity) {
            polynomial.load(event.speed, 1, Blocks::ORDER);
            event.peak_velocity = polynomial.maximum(event.length, event.peak_velocity);
        }
        event.bound = 0.0;
    }

    // Merge two events; the result has the earlier start.
    int joined(int number, int other_number) {
        if (number == other_number) return number;
        if (events[other_number].slips.size() > events[number].slips.size()) std::swap(number, other_number);
        Event &event = events[number], &other = events[other_number];
        if (event.start.until(other.start) < 0.0) {
            event.start = other.start;
            event.load = other.load;
            event.epicentre = other.epicentre;
            event.interval = other.interval;
        }
        event.slipping += other.slipping;
        event.energy += other.energy;
        event.damped += other.damped;
        find_peak(event);
        find_peak(other);
        event.peak_velocity = std::max(event.peak_velocity, other.peak_velocity);
        event.slips.insert(event.slips.end(), other.slips.begin(), other.slips.end());
        event.absorbed.push_back(other_number);
        event.absorbed.insert(event.absorbed.end(), other.absorbed.begin(), other.absorbed.end());
        other.absorbed.clear();
        other.merged = number;
        return number;
    }

    // First and last block of the event that ends; in a ring, the first exceeds the last if the event spans the seam.
    std::pair<int, int> ends(const Springs &springs) const {
        const int count = int(blocks.size());
        if (springs.ring && blocks.front() == 0 && blocks.back() == springs.blocks - 1)
            for (int k = 1; k < count; k++)
                if (blocks[k] > blocks[k - 1] + 1) return {blocks[k], blocks[k - 1]};
        return {blocks.front(), blocks.back()};
    }

    void finish(const Springs &springs, int number, const Clock &at) {
        Event &event = events[number];
        find_peak(event);
        std::sort(event.slips.begin(), event.slips.end());
        blocks.clear();
        begun.clear();
        for (const Slip &part : event.slips) {
            if (blocks.empty() || blocks.back() != part.block) {
                blocks.push_back(part.block);
                begun.push_back(part.begun);
            } else if (begun.back().until(part.begun) < 0.0) {
                begun.back() = part.begun;
            }
            slip[part.block] += part.distance;
        }
        double moment = 0.0, largest = 0.0, drop = 0.0;
        for (int i : blocks) {
            // Otherwise the block has slipped in a later event.
            Block &block = of_block[i];
            if (block.last_event >= 0 && find(block.last_event) == number) {
                block.last_event = -1;
                block.last_start = event.load.time;
            }
            moment += slip[i];
            largest = std::max(largest, std::fabs(slip[i]));
            // The spring force falls by (K slip)_i.
            drop -= springs.pull(slip.data(), i);
        }
        const bool wanted = event.load.time >= from;
        full |= wanted && std::max(table.time.size(), table.slip.size()) >= most;
        if (wanted && !full) {
            table.time.push_back(event.load.time);
            table.slip_time.push_back(event.start.time);
            table.duration.push_back(event.start.until(at));
            table.epicentre.push_back(event.epicentre + 1);
            const auto [first, last] = ends(springs);
            table.first_block.push_back(first + 1);
            table.last_block.push_back(last + 1);
            table.blocks.push_back(int(blocks.size()));
            table.moment.push_back(moment);
            table.largest_slip.push_back(largest);
            table.peak_velocity.push_back(event.peak_velocity);
            table.stress_drop.push_back(drop / double(blocks.size()));
            table.energy_released.push_back(event.energy);
            table.energy_damped.push_back(event.damped);
            table.interval.push_back(event.interval);
            if (profiles) {
                for (int i : blocks) {
                    table.slip_block.push_back(i + 1);
                    table.slip.push_back(slip[i]);
                }
                for (const Clock &start : begun) table.slip_onset.push_back(event.start.until(start));
                table.slip_end.push_back(int64_t(table.slip.size()));
            }
        }
        for (int i : blocks) slip[i] = 0.0;
    }
};

}  // namespace bk
