// Forces of a dense network by increments from the blocks that slip.
//
// Stuck blocks recede from the driver together, so that the spring force on block i is
//
//     s_i(τ) = s_i(r) + D_i d − Σ_j K_ij (x_j − r_j),
//
// where r_j are reference positions, which recede with the stuck blocks, d is the displacement of the driver since they
// were taken, and only the blocks j that slip contribute to the sum. A block that stops takes a new reference position.
// Each column of vectors has a list of the slipping blocks whose springs reach it, so that others cost nothing there.
// The list is in the order of lanes, so that the sum does not depend on the order in which blocks have started.
#pragma once

#include <algorithm>
#include <vector>

#include "springs.h"
#include "vector.h"

namespace bk {

template <int COUNT>
class Increments {
  public:
    using Rows = Vectors<COUNT>;
    using vec = typename Lanes<COUNT>::vec;

    bool used = false;
    Rows reference;  // r_j

    // Begin without slipping blocks.
    void begin(int columns) {
        used = true;
        reference.reserve(columns);
        for (std::vector<Pulls> *pulls : {&of_springs, &of_dashpots}) {
            pulls->resize(columns);
            for (Pulls &column : *pulls) column.clear();
        }
    }

    // A block in a lane starts; member : the blocks of the group, ascending
    void start(const Springs &springs, const std::vector<int> &member, int lane) {
        add(of_springs, springs, springs.strength, springs.diagonal, member, lane);
        if (springs.damped) add(of_dashpots, springs, springs.damping, springs.damping_diagonal, member, lane);
    }

    // The block in a lane stops at a position: add what it has contributed to the forces on all blocks.
    void stop(Rows &force, int lane, double position) {
        const double far = position - reference.lane(lane);
        for (size_t c = 0; c < of_springs.size(); c++) {
            force[c] += remove(of_springs[c], lane) * far;
            remove(of_dashpots[c], lane);
        }
        reference.lane(lane) = position;
    }

    // −(K y)_i of a column and −(C y)_i, with y_j = value(j) for slipping blocks and 0 for others
    template <class Value>
    BK_INLINE vec springs(int c, Value &&value) const {
        return sum(of_springs[c], value);
    }
    template <class Value>
    BK_INLINE vec dashpots(int c, Value &&value) const {
        return sum(of_dashpots[c], value);
    }

  private:
    // A slipping block and its part of a column of −K or −C.
    struct Pull {
        int lane;
        double strength[COUNT] = {};
        BK_INLINE vec of() const {
            vec made;
            std::memcpy(&made, strength, sizeof made);
            return made;
        }
    };
    using Pulls = std::vector<Pull>;             // in ascending order of lanes
    std::vector<Pulls> of_springs, of_dashpots;  // on each column of the group

    template <class Value>
    static BK_INLINE vec sum(const Pulls &pulls, Value &&value) {
        vec total{};
        for (const Pull &pull : pulls) total += pull.of() * value(pull.lane);
        return total;
    }

    static typename Pulls::iterator find(Pulls &pulls, int lane) {
        return std::lower_bound(pulls.begin(), pulls.end(), lane,
                                [](const Pull &pull, int wanted) { return pull.lane < wanted; });
    }
    // Remove a block and return its part of the column, 0 if there is none.
    static vec remove(Pulls &pulls, int lane) {
        const auto at = find(pulls, lane);
        if (at == pulls.end() || at->lane != lane) return vec{};
        const vec strength = at->of();
        pulls.erase(at);
        return strength;
    }

    // Add the elements of −K or −C between the block in a lane and itself, and its neighbours in the group.
    void add(std::vector<Pulls> &pulls, const Springs &springs, const std::vector<double> &joined,
             const std::vector<double> &own, const std::vector<int> &member, int lane) {
        int c = -1;
        double *part = nullptr;
        auto set = [&](int other, double strength) {
            if (other / COUNT != c) {
                c = other / COUNT;
                auto at = find(pulls[c], lane);
                if (at == pulls[c].end() || at->lane != lane) at = pulls[c].insert(at, Pull{lane});
                part = at->strength;
            }
            part[other % COUNT] = strength;
        };
        const int i = member[lane];
        set(lane, -own[i]);
        auto at = member.begin();
        for (int64_t p = springs.start[i]; p < springs.start[i + 1] && at != member.end(); p++) {
            const int other = springs.neighbour[p];
            // The blocks of a whole network follow each other.
            if (*at < other) at = std::lower_bound(at, member.end(), other);
            if (at != member.end() && *at == other) set(int(at++ - member.begin()), joined[p]);
        }
    }
};

}  // namespace bk
