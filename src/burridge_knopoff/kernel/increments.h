// Forces of a dense network by increments from the blocks that slip.
//
// Stuck blocks recede from the driver together, so that the spring force on block i is
//
//     s_i(τ) = s_i(r) + D_i d − Σ_j K_ij (x_j − r_j),
//
// where r_j are reference positions, which recede with the stuck blocks, d is the displacement of the driver since they
// were taken, and only the blocks j that slip contribute to the sum. A block that stops takes a new reference position.
// Blocks are in the order of their lanes, so that the sum does not depend on the order in which they have started.
#pragma once

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
        this->columns = columns;
        reference.reserve(columns);
        for (const Slipping &block : slipping) spare.push_back(block.number);
        slipping.clear();
    }

    // A block in a lane starts; member : the blocks of the group, ascending
    void start(const Springs &springs, const std::vector<int> &member, int lane) {
        size_t number = of_springs.size();
        if (spare.empty()) {
            of_springs.emplace_back(1);
            of_dashpots.emplace_back(1);
        } else {
            number = spare.back();
            spare.pop_back();
        }
        fill(of_springs[number], springs, springs.strength, springs.diagonal, member, lane);
        if (springs.damped) fill(of_dashpots[number], springs, springs.damping, springs.damping_diagonal, member, lane);
        slipping.insert(slipping.begin() + before(lane),
                        {lane, number, of_springs[number].at(), of_dashpots[number].at()});
    }

    // The block in a lane stops at a position: add what it has contributed to the forces on all blocks.
    void stop(Rows &force, int lane, double position) {
        const int k = before(lane);
        const double far = position - reference.lane(lane);
        for (int c = 0; c < columns; c++) force[c] += slipping[k].springs[c] * far;
        reference.lane(lane) = position;
        spare.push_back(slipping[k].number);
        slipping.erase(slipping.begin() + k);
    }

    // −(K y)_i of a column and −(C y)_i, with y_j = value(j) for slipping blocks and 0 for others
    template <class Value>
    BK_INLINE vec springs(int c, Value &&value) const {
        vec total{};
        for (const Slipping &block : slipping) total += block.springs[c] * value(block.lane);
        return total;
    }
    template <class Value>
    BK_INLINE vec dashpots(int c, Value &&value) const {
        vec total{};
        for (const Slipping &block : slipping) total += block.dashpots[c] * value(block.lane);
        return total;
    }

  private:
    // A slipping block with its columns of −K and −C.
    struct Slipping {
        int lane;
        size_t number;  // of the columns
        const vec *springs, *dashpots;
    };
    int columns = 0;
    std::vector<Slipping> slipping;  // in ascending order
    std::vector<size_t> spare;
    // Columns of −K and −C in the lanes of the group.
    std::vector<Rows> of_springs, of_dashpots;

    // Number of slipping blocks in lower lanes.
    int before(int lane) const {
        int k = 0;
        while (k < int(slipping.size()) && slipping[k].lane < lane) k++;
        return k;
    }

    void fill(Rows &row, const Springs &springs, const std::vector<double> &joined, const std::vector<double> &own,
              const std::vector<int> &member, int lane) {
        const int i = member[lane];
        row.reserve(columns);
        for (int c = 0; c < columns; c++) row[c] = vec{};
        int k = 0;
        for (int64_t p = springs.start[i]; p < springs.start[i + 1]; p++) {
            while (k < int(member.size()) && member[k] < springs.neighbour[p]) k++;
            if (k < int(member.size()) && member[k] == springs.neighbour[p]) row.lane(k) = joined[p];
        }
        row.lane(lane) = -own[i];
    }
};

}  // namespace bk
