// A growing table with one time and a few values per row, for events and section crossings.
#pragma once

#include <vector>

namespace bk {

// A table with `most` rows is full: no more rows are added.
struct Record {
    int width;
    size_t most;
    std::vector<double> time, value;
    bool full = false;

    Record(int width, double most_numbers) : width(width), most(size_t(most_numbers) / (width + 1)) {}

    // The values of a new row, nullptr if the table is full.
    double *append(double at) {
        if (time.size() >= most) {
            full = true;
            return nullptr;
        }
        time.push_back(at);
        value.resize(value.size() + width);
        return value.data() + value.size() - width;
    }
    void clear() {
        time.clear();
        value.clear();
        full = false;
    }
};

// A time as the sum of two numbers, so that steps add up without rounding.
struct Clock {
    double time = 0.0, rest = 0.0;

    template <class A>
    void archive(A &values) {
        values(time, rest);
    }
    double until(double other) const { return (other - time) - rest; }
    double until(const Clock &other) const { return (other.time - time) + (other.rest - rest); }
    Clock after(double step) const {
        const double total = time + (rest + step);
        return {total, (time - total) + (rest + step)};
    }
};

}  // namespace bk
