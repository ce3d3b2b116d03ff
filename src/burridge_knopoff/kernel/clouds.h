// Clouds of states, and a test whether a state is within the radius of one of them.
//
// The points of a cloud are sorted along the coordinate in which it is widest and divided into groups of neighbours,
// each in a box. A box that is too far away contains no close point, to the last bit, since rounding preserves the
// order of differences.
#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

namespace bk {

class Clouds {
  public:
    const int width;

    explicit Clouds(int width) : width(width) {}
    int count() const { return int(clouds.size()); }

    // Add a cloud of n points with a radius in the largest difference of a coordinate.
    void add(const double *points, int n, double radius) {
        Cloud cloud;
        cloud.radius = radius;
        double widest = -1.0;
        for (int k = 0; k < width; k++) {
            double low = 0.0, high = 0.0;
            for (int i = 0; i < n; i++) {
                const double x = points[size_t(i) * width + k];
                low = i ? std::min(low, x) : x;
                high = i ? std::max(high, x) : x;
            }
            if (high - low > widest) {
                widest = high - low;
                cloud.axis = k;
            }
        }
        std::vector<int> order(n);
        std::iota(order.begin(), order.end(), 0);
        std::stable_sort(order.begin(), order.end(), [&](int i, int j) {
            return points[size_t(i) * width + cloud.axis] < points[size_t(j) * width + cloud.axis];
        });
        for (int i = 0; i < n; i++) {
            const double *from = points + size_t(order[i]) * width;
            cloud.point.insert(cloud.point.end(), from, from + width);
            if (i % GROUP == 0) {
                cloud.low.insert(cloud.low.end(), from, from + width);
                cloud.high.insert(cloud.high.end(), from, from + width);
            }
            double *low = &cloud.low[size_t(i / GROUP) * width], *high = &cloud.high[size_t(i / GROUP) * width];
            for (int k = 0; k < width; k++) {
                low[k] = std::min(low[k], from[k]);
                high[k] = std::max(high[k], from[k]);
            }
        }
        clouds.push_back(std::move(cloud));
    }

    // Whether a state is within the radius of a point of a cloud.
    bool is_near(int number, const double *state) const {
        const Cloud &cloud = clouds[number];
        const int last = int(cloud.low.size()) / width, points = int(cloud.point.size()) / width;
        // Rounding must not hide a group; `close` decides whether a point is close.
        const double wide = WIDER * cloud.radius, own = state[cloud.axis];
        int group = 0, high = last;
        while (group < high) {
            const int middle = (group + high) / 2;
            if (own - cloud.high[size_t(middle) * width + cloud.axis] > wide)
                group = middle + 1;
            else
                high = middle;
        }
        for (; group < last && cloud.low[size_t(group) * width + cloud.axis] - own <= wide; group++) {
            if (!close(&cloud.low[size_t(group) * width], &cloud.high[size_t(group) * width], state, cloud.radius))
                continue;
            for (int k = GROUP * group; k < std::min(GROUP * (group + 1), points); k++) {
                const double *point = &cloud.point[size_t(k) * width];
                if (close(point, point, state, cloud.radius)) return true;
            }
        }
        return false;
    }

  private:
    static constexpr int GROUP = 16;
    static constexpr double WIDER = 1.000001;
    struct Cloud {
        std::vector<double> point, low, high;
        int axis = 0;
        double radius = 0.0;
    };
    std::vector<Cloud> clouds;

    // Whether a state is within the radius of a box.
    bool close(const double *low, const double *high, const double *state, double radius) const {
        for (int k = 0; k < width; k++)
            if (low[k] - state[k] > radius || state[k] - high[k] > radius) return false;
        return true;
    }
};

}  // namespace bk
