// A catalogue of slip events: slips that are connected in space and time.
//
// A slip of a block lasts from its start to its stop. Slips of neighbours that overlap in time are connected, and so is
// all that is connected in turn: that is one event, from the first start to the last stop. Under a finite velocity of
// the driver there may be no moment at which all blocks rest, so connection decides, not rest.
//
// The energy that an event releases is the work of all springs on its blocks, ∫ Σ s_i U_i' dτ, which friction
// dissipates: the blocks rest before and after. Over a piece in which the same blocks slip this is exactly, with
// y = U − U(0),
//
//     Σ ½ (s_i(0) + s_i(T) − D_i v T) y_i(T) + D_i v (T y_i(T) − ∫ y_i dτ).
#pragma once

#include <algorithm>
#include <memory>

#include "record.h"
#include "springs.h"

namespace bk {

class Catalogue {
  public:
    struct Event {
        Clock start, load;  // slip clock and loading clock of the first start: one clock under steady loading
        int epicentre = 0, slipping = 0;
        double peak_velocity = 0.0, energy = 0.0;
        std::vector<std::pair<int, double>> slips;  // block, and how far it slipped
        std::shared_ptr<Event> merged;              // the event that goes on with this one
    };

    // Columns, with an entry for each event, in the order in which events end. Blocks count from 1.
    struct Table {
        std::vector<double> time, slip_time, duration, moment, largest_slip, peak_velocity, stress_drop,
            energy_released, interval;
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
        : from(from), profiles(profiles), most(size_t(most)), event_of(blocks), begun(blocks), position(blocks),
          last_start(blocks, NAN), slip(blocks) {}

    // Begin again without events; all blocks that slip now have slipped since before.
    void restart() {
        table = {};
        full = false;
        std::fill(event_of.begin(), event_of.end(), nullptr);
        std::fill(last_start.begin(), last_start.end(), NAN);
    }

    // Events that have not ended, for a run that goes on.
    struct Open {
        std::vector<Event> events;
        std::vector<int> event_of;  // −1 for none
        std::vector<Clock> begun;
        std::vector<double> position, last_start;
    };

    Open open() const {
        Open made{{}, std::vector<int>(event_of.size(), -1), begun, position, last_start};
        std::vector<std::shared_ptr<Event>> known;
        for (size_t i = 0; i < event_of.size(); i++) {
            if (!event_of[i]) continue;
            const std::shared_ptr<Event> event = find(event_of[i]);
            const size_t k = std::find(known.begin(), known.end(), event) - known.begin();
            if (k == known.size()) {
                known.push_back(event);
                made.events.push_back(*event);
            }
            made.event_of[i] = int(k);
        }
        return made;
    }

    void resume(const Open &open) {
        std::vector<std::shared_ptr<Event>> known;
        for (const Event &event : open.events) known.push_back(std::make_shared<Event>(event));
        for (size_t i = 0; i < event_of.size(); i++)
            event_of[i] = open.event_of[i] < 0 ? nullptr : known[open.event_of[i]];
        begun = open.begun;
        position = open.position;
        last_start = open.last_start;
    }

    // The event of a slipping block; nullptr if it sticks, or slips since before the catalogue began.
    Event *of(int i) { return event_of[i] ? find(event_of[i]).get() : nullptr; }

    // Block i starts at position x.
    void start(const Springs &springs, int i, const Clock &at, const Clock &load, double x) {
        std::shared_ptr<Event> event;
        for (int64_t p = springs.start[i]; p < springs.start[i + 1]; p++) {
            const std::shared_ptr<Event> &beside = event_of[springs.neighbour[p]];
            if (beside) event = event ? joined(event, find(beside)) : find(beside);
        }
        if (!event) {
            event = std::make_shared<Event>();
            event->start = at;
            event->load = load;
            event->epicentre = i;
        }
        event->slipping++;
        event_of[i] = event;
        begun[i] = at;
        position[i] = x;
    }

    // Block i stops at position x.
    void stop(const Springs &springs, double v, int i, const Clock &at, double x) {
        if (!event_of[i]) return;
        const std::shared_ptr<Event> event = find(event_of[i]);
        event_of[i] = nullptr;
        event->slips.emplace_back(i, (x - position[i]) + v * begun[i].until(at));
        if (--event->slipping == 0) finish(springs, *event, at);
    }

  private:
    std::vector<std::shared_ptr<Event>> event_of;
    std::vector<Clock> begun;
    std::vector<double> position, last_start, slip;

    static std::shared_ptr<Event> find(std::shared_ptr<Event> event) {
        while (event->merged) event = event->merged;
        return event;
    }

    // One event of two, with the earlier start.
    static std::shared_ptr<Event> joined(std::shared_ptr<Event> event, std::shared_ptr<Event> other) {
        if (event == other) return event;
        if (other->slips.size() > event->slips.size()) std::swap(event, other);
        if (event->start.until(other->start) < 0.0) {
            event->start = other->start;
            event->load = other->load;
            event->epicentre = other->epicentre;
        }
        event->slipping += other->slipping;
        event->energy += other->energy;
        event->peak_velocity = std::max(event->peak_velocity, other->peak_velocity);
        event->slips.insert(event->slips.end(), other->slips.begin(), other->slips.end());
        other->slips = {};
        other->merged = event;
        return event;
    }

    void finish(const Springs &springs, Event &event, const Clock &at) {
        std::sort(event.slips.begin(), event.slips.end());
        std::vector<int> blocks;
        for (auto [i, far] : event.slips) {
            if (blocks.empty() || blocks.back() != i) blocks.push_back(i);
            slip[i] += far;
        }
        const double interval = event.load.time - last_start[event.epicentre];
        double moment = 0.0, largest = 0.0, drop = 0.0;
        for (int i : blocks) {
            last_start[i] = event.load.time;
            moment += slip[i];
            largest = std::max(largest, slip[i]);
            // The spring force falls by (K slip)_i.
            drop -= springs.pull(slip.data(), i);
        }
        full = std::max(table.time.size(), table.slip.size()) >= most;
        if (event.load.time >= from && !full) {
            table.time.push_back(event.load.time);
            table.slip_time.push_back(event.start.time);
            table.duration.push_back(event.start.until(at));
            table.epicentre.push_back(event.epicentre + 1);
            table.first_block.push_back(blocks.front() + 1);
            table.last_block.push_back(blocks.back() + 1);
            table.blocks.push_back(int(blocks.size()));
            table.moment.push_back(moment);
            table.largest_slip.push_back(largest);
            table.peak_velocity.push_back(event.peak_velocity);
            table.stress_drop.push_back(drop / double(blocks.size()));
            table.energy_released.push_back(event.energy);
            table.interval.push_back(interval);
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
