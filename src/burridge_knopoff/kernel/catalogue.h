// A catalogue of slip events: slips that are connected in space and time.
//
// A slip of a block lasts from its start to its stop. Slips of neighbours that overlap in time are connected, and so is
// all that is connected in turn: that is one event, from the first start to the last stop. Under a finite velocity of
// the driver there may be no moment at which all blocks rest, so connection decides, not rest.
//
// The energy that an event releases is the work of all springs on its blocks, ∫ Σ s_i U_i' dτ, which friction and
// dashpots dissipate: the blocks rest before and after. Over a piece in which the same blocks slip this is exactly,
// with y = U − U(0),
//
//     Σ ½ (s_i(0) + s_i(T) − D_i v T) y_i(T) + D_i v (T y_i(T) − ∫ y_i dτ).
//
// Dashpots dissipate ∫ Σ c_ij (U_j' − U_i')² + Σ c_i (v − U_i')² dτ, over those at the slipping blocks.
#pragma once

#include <algorithm>

#include "layout.h"
#include "polynomial.h"
#include "record.h"

namespace bk {

class Catalogue {
  public:
    struct Event {
        Clock start, load;  // slip clock and loading clock of the first start: one clock under steady loading
        int epicentre = 0, slipping = 0;
        double interval = 0.0, peak_velocity = 0.0, energy = 0.0, damped = 0.0;
        std::vector<std::pair<int, double>> slips;  // block, and how far it slipped
        // The event that goes on with this one, −1 for none; the events that this one goes on with.
        int merged = -1;
        std::vector<int> absorbed;
        // The speed of a block over a piece of its motion, of some length, in which it may exceed the peak velocity,
        // and its bound: as a rule a later speed is higher, and the maximum need not be found.
        double bound = 0.0, length = 0.0, speed[Blocks::ORDER + 1] = {};

        template <class A>
        void archive(A &values) {
            values(start, load, epicentre, slipping, interval, peak_velocity, energy, damped, slips, merged, absorbed,
                   bound, length, speed);
        }
    };

    // Columns, with an entry for each event, in the order in which events end. Blocks count from 1.
    struct Table {
        std::vector<double> time, slip_time, duration, moment, largest_slip, peak_velocity, stress_drop,
            energy_released, energy_damped, interval;
        std::vector<int> epicentre, first_block, last_block, blocks;
        // With profiles, blocks and slips of the events one after the other: event k has those before slip_end[k].
        std::vector<int64_t> slip_end;
        std::vector<int> slip_block;
        std::vector<double> slip;
    };

    const double from;
    const bool profiles;
    const size_t most;
    Table table;
    bool full = false;

    // from : events that begin earlier are left out; profiles : whether the slip of every block is kept; most : number
    // of events and of slips in profiles at which the table is full
    Catalogue(int blocks, double from, bool profiles, double most)
        : from(from), profiles(profiles), most(size_t(most)), of_block(blocks), slip(blocks) {}

    // Begin again without events; all blocks that slip now have slipped since before.
    void restart() {
        table = {};
        full = false;
        events.clear();
        spare.clear();
        std::fill(of_block.begin(), of_block.end(), Block{});
    }

    // What is known of a block.
    struct Block {
        // The event in which it slips, and the one in which it slipped last, unless that has ended; −1 for none.
        int event = -1, last_event = -1;
        // Time and position at its start, and time at the start of the last event that has ended.
        Clock begun;
        double position = 0.0, last_start = NAN;

        template <class A>
        void archive(A &values) {
            values(event, last_event, begun, position, last_start);
        }
    };

    // Events that have not ended, for a run that goes on.
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

    // The event of a slipping block; nullptr if it sticks, or slips since before the catalogue began.
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
            // The last event of this block may go on elsewhere.
            event.interval =
                load.time - (block.last_event < 0 ? block.last_start : events[find(block.last_event)].load.time);
            event.peak_velocity = event.energy = event.damped = event.bound = 0.0;
        }
        events[number].slipping++;
        block.event = number;
        block.begun = at;
        block.position = x;
    }

    // Block i stops at position x.
    void stop(const Springs &springs, double v, int i, const Clock &at, double x) {
        Block &block = of_block[i];
        if (block.event < 0) return;
        const int number = find(block.event);
        Event &event = events[number];
        block.event = -1;
        block.last_event = number;
        event.slips.emplace_back(i, (x - block.position) + v * block.begun.until(at));
        if (--event.slipping > 0) return;
        finish(springs, number, at);
        for (int k : event.absorbed) release(k);
        release(number);
    }

    // A block of the event has a speed with these coefficients over a piece, at most `bound`.
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
    std::vector<int> spare, blocks;  // numbers to be used again; blocks of the event that ends
    std::vector<double> slip;        // of its blocks, 0 for others
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

    // One event of two, with the earlier start.
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

    // Ends of the event that ends, along the chain; over the joint of a ring the first is above the last.
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
        for (auto [i, far] : event.slips) {
            if (blocks.empty() || blocks.back() != i) blocks.push_back(i);
            slip[i] += far;
        }
        double moment = 0.0, largest = 0.0, drop = 0.0;
        for (int i : blocks) {
            // Else it has slipped in a later event.
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
        full = std::max(table.time.size(), table.slip.size()) >= most;
        if (event.load.time >= from && !full) {
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
            for (int i : blocks) {
                if (!profiles) break;
                table.slip_block.push_back(i + 1);
                table.slip.push_back(slip[i]);
            }
            if (profiles) table.slip_end.push_back(int64_t(table.slip.size()));
        }
        for (int i : blocks) slip[i] = 0.0;
    }
};

}  // namespace bk
