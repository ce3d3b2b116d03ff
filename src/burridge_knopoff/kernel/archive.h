// Values as bytes, and back: the state that continues a run can be sent to another process.
#pragma once

#include <cstring>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace bk {

// Called with variables, it writes them, or reads them in the same order. A class lists its variables in `archive`.
class Archive {
  public:
    std::string bytes;

    Archive() : reading(false) {}
    explicit Archive(std::string bytes) : bytes(std::move(bytes)), reading(true) {}

    template <class... T>
    void operator()(T &...values) {
        (one(values), ...);
    }

    // Whether exactly all bytes were read.
    bool complete() const { return place == bytes.size(); }

  private:
    const bool reading;
    size_t place = 0;

    template <class T>
    void one(T &value) {
        if constexpr (!std::is_arithmetic_v<T>) {
            value.archive(*this);
        } else if (!reading) {
            bytes.append(reinterpret_cast<const char *>(&value), sizeof value);
        } else if (sizeof value <= left()) {
            std::memcpy(&value, bytes.data() + place, sizeof value);
            place += sizeof value;
        } else {
            place = std::string::npos;
        }
    }
    size_t left() const { return place <= bytes.size() ? bytes.size() - place : 0; }

    template <class T>
    void one(std::vector<T> &values) {
        size_t count = values.size();
        one(count);
        if (reading) values.resize(count <= left() ? count : 0);
        for (T &value : values) one(value);
    }
    template <class T>
    void one(std::optional<T> &value) {
        bool there = value.has_value();
        one(there);
        if (reading && there) value.emplace();
        if (there) one(*value);
    }
    template <class A, class B>
    void one(std::pair<A, B> &value) {
        (*this)(value.first, value.second);
    }
    template <class T, size_t N>
    void one(T (&values)[N]) {
        for (T &value : values) one(value);
    }
};

}  // namespace bk
