// The first event in a piece of a series, searched for in all blocks at once and proved to be the first.
//
// Each block has a polynomial g that is positive until its event: the speed of a slipping block, or the distance of the
// force on a stuck block from its threshold. A root t* is estimated and refined by Halley's method. Then it is proved
// that no g has an earlier root: over [0, t*] each g, or the quotient q in g(t) = g(t*) + (1 − t/t*) q(t), is bounded
// from below. The bounds are the Bernstein coefficients of the first terms; the sum of the moduli of all other terms is
// subtracted from the last coefficient, because these terms are at most Σ|c_k| t*^k u^LOW at u = t/t*, which has no
// other coefficient. If the proof fails, the exhaustive search of a Polynomial decides. An event can thus be missed or
// late only within rounding.
//
// Sign changes of the section function W are found in the same search, in a lane after those of the blocks. They do not
// change any event, and cost very little.
#pragma once

#include "polynomial.h"
#include "series.h"

namespace bk {

constexpr double UNKNOWN = 1e300;
// Degree of the bounds.
constexpr int LOW = 8;
// W at the end of one piece and at the start of the next differ by rounding, less than this.
constexpr double SEAM = 1e-14;

// Bounds of polynomials over [0, 1] from their scaled terms.
template <class L>
struct Bounds {
    using vec = typename L::vec;
    using mask = typename L::mask;
    vec low, high, corner[LOW + 1];

    BK_INLINE void take(const vec *term) {
        constexpr int ORDER = L::ORDER;
        static constexpr double inverse[LOW + 1] = {1.0,        1.0 / 8.0,  1.0 / 28.0, 1.0 / 56.0, 1.0 / 70.0,
                                                    1.0 / 56.0, 1.0 / 28.0, 1.0 / 8.0,  1.0};
        vec rest{}, other{}, b[LOW + 1];
        for (int k = 0; k <= LOW; k++) b[k] = term[k] * inverse[k];
        for (int k = LOW + 1; k < ORDER; k += 2) {
            rest += magnitude(term[k]);
            other += magnitude(term[k + 1]);
        }
        for (int j = 1; j <= LOW; j++)
            for (int k = LOW; k >= j; k--) b[k] += b[k - 1];
        rest += other;
        low = b[LOW] - rest;
        high = b[LOW] + rest;
        for (int k = 0; k < LOW; k++) {
            low = least(low, b[k]);
            high = largest(high, b[k]);
        }
        for (int k = 0; k <= LOW; k++) corner[k] = b[k];
    }

    // Where the control polygon first falls through 0, as a fraction of the interval; UNKNOWN if it does not.
    BK_INLINE vec fall() const {
        vec share = L::splat(UNKNOWN);
        for (int k = LOW - 1; k >= 0; k--) {
            const mask falls = (corner[k] > 0.0) & (corner[k + 1] <= 0.0);
            share = select(falls, (1.0 / LOW) * (double(k) + corner[k] / (corner[k] - corner[k + 1])), share);
        }
        return share;
    }
};

// Working memory of a search, which several searches can share.
template <class L>
struct EventScratch {
    typename L::vec power[L::ORDER + 1], scaled[L::ORDER + 1], quotient[L::ORDER + 1], candidate[L::ORDER + 1];
    Polynomial polynomial;
};

template <class L>
class EventSearch {
  public:
    static constexpr int ORDER = L::ORDER, LANES = L::LANES;
    using vec = typename L::vec;
    using mask = typename L::mask;
    using Number = typename L::Number;
    // Number of times that a trajectory was searched block by block.
    long long searches = 0;
    vec time;    // of the event, or the reach if there is none
    mask found;  // whether there is an event

    explicit EventSearch(EventScratch<L> &scratch)
        : power(scratch.power), scaled(scratch.scaled), quotient(scratch.quotient), candidate(scratch.candidate),
          polynomial(scratch.polynomial) {}

    // Find the first events within the reach. section : the lane of W in g, or its column if each lane has a clock; −1
    // if sign changes of W are not searched for
    void find(Series<L> &series, const State<L> &state, vec reach, mask where, int section = -1) {
        columns = series.columns;
        width = series.width;
        for (auto *row : {&root_at, &lowest, &highest, &zeros}) row->reserve(width);
        deflate(series, state);
        time = reach_of_bounds = reach;
        found = mask{};
        crossing = Number{} + UNCERTAIN;
        mask wanted = bound(series, reach, where, section), doubtful{};
        const mask backward = state.layout.symmetric ? turns_back(state, where) : mask{};
        if (section >= 0) rule_out(lowest[column_of(section)], section);
        const bool crosses = section >= 0 && some(of_section(root_at[column_of(section)], section) < UNKNOWN);
        if (L::ONE_CLOCK && (any(wanted) || crosses))
            refine_columns(series, reach, where);
        else if (crosses)
            refine_column(series, section, reach, where);
        if (any(wanted)) {
            if (!L::ONE_CLOCK) refine_candidate(series, reach, where);
            doubtful = wanted & where & ~backward & ~proved(series, where & ~backward, section);
            // The first event may be that of another block than was estimated.
            if (!L::ONE_CLOCK && any(contested & ~doubtful)) doubtful |= earlier(series, reach, contested & ~doubtful);
            if (!L::ONE_CLOCK && any(doubtful)) {
                const vec before_time = time;
                const mask before_found = found;
                bound(series, reach, doubtful, -1);
                refine_columns(series, reach, doubtful);
                time = select(doubtful, time, before_time);
                found = (doubtful & found) | (~doubtful & before_found);
                doubtful &= ~proved(series, doubtful, -1);
            }
        }
        doubtful |= backward;
        if (any(doubtful)) search(series, state, reach, doubtful);
    }

    // Copy g of the block that was found for each clock, for `due`.
    void aim(const Series<L> &series) {
        if (aimed || L::ONE_CLOCK) return;
        aimed = true;
        for (int k = 0; k <= ORDER; k++) candidate[k] = series.gap[size_t(k) * width];
        for (int c = 1; c < columns; c++) {
            const mask own = is_block(c);
            if (!any(own)) continue;
            for (int k = 0; k <= ORDER; k++)
                candidate[k] = select(own, series.gap[size_t(k) * width + c], candidate[k]);
        }
    }

    // Where blocks have the event that was found: their g is the same to the bit, as for mirror images. Their events
    // are then simultaneous, regardless of rounding errors at that time.
    mask due(const Series<L> &series, int c) const {
        // The block itself need not be compared.
        const mask itself = found & is_block(c);
        mask others = found & series.layout.present[c] & ~itself;
        for (int k = 0; k <= ORDER && any(others); k++) {
            const size_t row = size_t(k) * width;
            const vec of_block = L::ONE_CLOCK ? L::splat(series.gap.lane(row * LANES + block[0])) : candidate[k];
            others &= series.gap[row + c] == of_block;
        }
        return itself | others;
    }

    // The time at which W changes its sign in the first `length` of the reach; NONE if it does not, UNCERTAIN if a
    // search is necessary.
    static constexpr double NONE = -1.0, UNCERTAIN = -2.0;
    Number crossing_within(const Series<L> &series, Number length, int section) const {
        const int c = column_of(section);
        const Number at = of_section(root_at[c], section), start = of_section(series.gap[c], section);
        const Number apart = length < at ? at - length : length - at;
        const auto certain = (start > 0.0) & (at < UNKNOWN) & (fall * apart > SEAM);
        const auto within = at < length;
        const Number none = Number{} + NONE, uncertain = Number{} + UNCERTAIN;
        return crossing == none ? none : certain ? (within ? at : none) : uncertain;
    }

    // Bounds on g in the piece, for the blocks of a column.
    vec bound_in_piece(int c) const {
        vec bound = largest(highest[c], vec{});
        for (vec left = zeros[c]; any(left > vec{}); left -= 1.0)
            bound = select(left > vec{}, bound * reach_of_bounds, bound);
        return bound;
    }

  private:
    // Number of Halley steps with the first terms, and with all terms before the exhaustive search.
    static constexpr int GUESSES = 1, ITERATIONS = 6;
    // A root has converged when the next step would be smaller than this fraction of the piece.
    static constexpr double CONVERGED = 1e-17;
    // At the event, values down to minus this fraction of the highest value count as 0: they are rounding.
    static constexpr double COMMON = 1e-14;
    // Value at the event below which another block is bounded by its quotient.
    static constexpr double NEAR = 1e-3;

    int columns, width;
    typename L::Rows root_at, lowest, highest, zeros;
    vec *const power, *const scaled, *const quotient, *const candidate;
    // The block that was found for each clock, −1 for none; for a single clock the same in all lanes.
    mask block;
    bool aimed = false;  // whether the candidate is the block that was found
    Number crossing, fall;
    vec reach_of_bounds;
    mask contested;
    Polynomial &polynomial;

    // The lanes of a column that have the event.
    mask is_block(int c) const { return block == numbers(c); }
    // The numbers of the blocks in a column.
    static BK_INLINE mask numbers(int c) {
        mask number = mask{} + (L::ONE_CLOCK ? c * LANES : c);
        for (int lane = 0; lane < LANES && L::ONE_CLOCK; lane++) number[lane] += lane;
        return number;
    }

    // The column of W in g, and the value of a row there for each clock.
    static int column_of(int section) { return L::ONE_CLOCK ? section / LANES : section; }
    static BK_INLINE Number of_section(vec row, int section) {
        if constexpr (L::ONE_CLOCK)
            return row[section % LANES];
        else
            return row;
    }
    static BK_INLINE bool some(bool where) { return where; }
    static BK_INLINE bool some(mask where) { return any(where); }

    // Record that W does not change its sign if its lower bound is positive.
    BK_INLINE void rule_out(vec low, int section) {
        crossing = of_section(low, section) > SEAM ? Number{} + NONE : crossing;
    }

    // Divide the known zeros at the start out of g: a block that has just started has U' = 0.
    void deflate(Series<L> &series, const State<L> &state) {
        const vec zero{};
        for (int c = 0; c < columns; c++) {
            vec *g = series.gap.at(c);
            // The force is at its threshold by construction: rounding must not start the block a second time.
            const mask at = (state.touching[c] > zero) & (state.slip[c] == zero) &
                            (magnitude(g[0]) < 0.5 * series.layout.threshold[c]);
            if (any(at)) g[0] = select(at, zero, g[0]);
            zeros[c] = zero;
            for (int times = 0; times < ORDER; times++) {
                const mask where = (g[0] == zero) & series.layout.present[c];
                if (!any(where)) break;
                for (int k = 0; k < ORDER; k++)
                    g[size_t(k) * width] = select(where, g[size_t(k + 1) * width], g[size_t(k) * width]);
                g[size_t(ORDER) * width] = select(where, zero, g[size_t(ORDER) * width]);
                zeros[c] += select(where, L::splat(1.0), zero);
            }
        }
    }

    // Four independent chains of products, which can be computed in parallel.
    BK_INLINE void raise(vec t) {
        const vec square = t * t, fourth = square * square;
        vec now[4] = {L::splat(1.0), t, square, square * t};
        for (int k = 0; k <= ORDER; k += 4)
            for (int j = 0; j < 4 && k + j <= ORDER; j++) {
                power[k + j] = now[j];
                now[j] = now[j] * fourth;
            }
    }

    // Bound g over the reach; return where there may be an event, with estimates of its time in `root_at`.
    mask bound(Series<L> &series, vec reach, mask where, int section) {
        mask wanted{};
        raise(reach);
        for (int c = 0; c < (section >= 0 ? width : columns); c++) {
            const vec *g = series.gap.at(c);
            for (int k = 0; k <= ORDER; k++) scaled[k] = g[size_t(k) * width] * power[k];
            Bounds<L> bounds;
            bounds.take(scaled);
            lowest[c] = select(where, bounds.low, lowest[c]);
            highest[c] = select(where, bounds.high, highest[c]);
            const mask own = where & (bounds.low <= 0.0);
            root_at[c] = select(where, L::splat(UNKNOWN), root_at[c]);
            if (any(own)) {
                const vec share = bounds.fall();
                root_at[c] = select(own & (share < UNKNOWN), share * reach, root_at[c]);
                if (section >= 0 && c == column_of(section)) steepness(bounds, reach, section);
            }
            // In lanes without a block g is 0 or W.
            if (c < columns) wanted |= own & series.layout.present[c];
        }
        return L::any_of_clock(wanted);
    }

    // Set `fall`: a lower bound on the rate at which W falls everywhere in the reach, if it is positive.
    void steepness(const Bounds<L> &bounds, vec reach, int section) {
        vec steepest = bounds.corner[1] - bounds.corner[0], rest{};
        for (int k = 1; k < LOW; k++) steepest = largest(steepest, bounds.corner[k + 1] - bounds.corner[k]);
        for (int k = LOW + 1; k <= ORDER; k++) rest += double(k) * magnitude(scaled[k]);
        fall = of_section(-(double(LOW) * steepest + rest) / reach, section);
    }

    // Where a stuck block may start backward, which g does not show.
    mask turns_back(const State<L> &state, mask where) {
        mask doubtful{};
        for (int c = 0; c < columns; c++)
            doubtful |= (state.slip[c] == vec{}) & state.layout.present[c] &
                        ((zeros[c] > 0.0) | (highest[c] >= 2.0 * state.layout.threshold[c]));
        return L::any_of_clock(doubtful) & where;
    }

    // Refine the estimates of all columns, and take the earliest.
    void refine_columns(Series<L> &series, vec reach, mask where) {
        vec first = L::splat(UNKNOWN);
        for (int c = 0; c < (L::ONE_CLOCK ? width : columns); c++) {
            refine_column(series, c, reach, where);
            if (c < columns) first = least(first, select(series.layout.present[c], root_at[c], L::splat(UNKNOWN)));
        }
        aimed = false;
        first = L::least_of_clock(first);
        found = (first <= reach) & where;
        time = select(found, first, reach);
        block = select(where, mask{} - 1, block);
        for (int c = columns - 1; c >= 0; c--) {
            const mask own = found & (root_at[c] == time) & series.layout.present[c];
            if (!L::ONE_CLOCK)
                block = select(own, mask{} + c, block);
            else if (any(own))
                block = mask{} + (c * LANES + __builtin_ctz(bits(own)));
        }
    }

    void refine_column(Series<L> &series, int c, vec reach, mask where) {
        const mask wanted = where & (root_at[c] < UNKNOWN);
        if (any(wanted)) root_at[c] = refine(series.gap.at(c), width, root_at[c], reach, wanted);
    }

    // Refine the earliest guess of each lane.
    void refine_candidate(Series<L> &series, vec reach, mask where) {
        vec first = L::splat(UNKNOWN);
        block = mask{} - 1;
        for (int c = 0; c < columns; c++) {
            const mask earlier = root_at[c] < first;
            first = select(earlier, root_at[c], first);
            block = select(earlier, mask{} + c, block);
        }
        aimed = false;
        aim(series);
        const mask wanted = where & (first < UNKNOWN);
        first = refine(candidate, 1, first, reach, wanted);
        found = wanted & (first <= reach);
        time = select(found, first, reach);
        block = select(found, block, mask{} - 1);
    }

    // The roots near guesses, by Halley's method; UNKNOWN where it does not converge within the reach.
    static vec refine(const vec *g, int stride, vec t, vec end, mask wanted) {
        const vec zero{};
        mask open = wanted & (t <= end), done{};
        for (int i = 0; i < GUESSES + ITERATIONS && any(open); i++) {
            // Even and odd powers apart, in z = t², since each sum waits for the last: g = e + t o. The first terms
            // show the way at a third of the cost.
            const vec z = t * t;
            const int top = i < GUESSES ? LOW : ORDER;
            vec even = g[size_t(top) * stride], odd = g[size_t(top - 1) * stride];
            vec even_slope{}, odd_slope{}, even_curvature{}, odd_curvature{};
            for (int k = top - 2; k > 0; k -= 2) {
                even_curvature = even_curvature * z + even_slope;
                even_slope = even_slope * z + even;
                even = even * z + g[size_t(k) * stride];
                odd_curvature = odd_curvature * z + odd_slope;
                odd_slope = odd_slope * z + odd;
                odd = odd * z + g[size_t(k - 1) * stride];
            }
            even_curvature = even_curvature * z + even_slope;
            even_slope = even_slope * z + even;
            even = even * z + g[0];
            const vec value = even + t * odd;
            const vec slope = odd + 2.0 * (t * even_slope + z * odd_slope);
            const vec curvature =
                (even_slope + 3.0 * (t * odd_slope)) + 4.0 * (z * (even_curvature + t * odd_curvature));
            // Twice the product, since curvature is half the second derivative.
            const vec step = -(value * slope) / (slope * slope - value * curvature), size = magnitude(step);
            mask good = open & (slope < zero);
            t = select(good, t + step, t);
            good &= (t >= zero) & (t <= end);
            const vec bend = curvature * step;
            const mask now = good & (size < (top == ORDER ? 1e-5 : 0.0) * end) &
                             (size * (bend * bend) <= (CONVERGED * end) * (slope * slope));
            done |= now;
            open = good & ~now;
        }
        return select(done, t, L::splat(UNKNOWN));
    }

    // Where no block has an event before `time`, by bounds over [0, time].
    // section : the lane of W, −1 if its sign changes are not searched for
    mask proved(Series<L> &series, mask where, int section) {
        const vec zero{};
        mask failed = where & ~found;
        contested = mask{};
        raise(time);
        for (int c = 0; c < columns; c++) {
            const mask own = where & series.layout.present[c];
            const vec *g = series.gap.at(c);
            // Coefficients of q: minus the sums of the higher terms of g.
            vec total{};
            for (int k = ORDER; k >= 0; k--) {
                const vec term = g[size_t(k) * width] * power[k];
                scaled[k] = term;
                quotient[k] = -total;
                total += term;
            }
            // A block close to its own event is bounded by its q, other blocks by their g.
            const mask near = (total <= NEAR) & (total < scaled[0]);
            failed |= own & near & (total < -COMMON * highest[c]);
            if (!L::ONE_CLOCK) contest(g, c, own & near);
            if (any(near & own))
                for (int k = 0; k <= ORDER; k++) scaled[k] = select(near, quotient[k], scaled[k]);
            Bounds<L> bounds;
            bounds.take(scaled);
            failed |= own & ~(bounds.low > zero);
            if (section >= 0 && c == column_of(section)) rule_out(select(near, vec{}, bounds.low), section);
            highest[c] = select(near | ~own, highest[c], least(highest[c], bounds.high));
        }
        return ~L::any_of_clock(failed);
    }

    // Record where another block that is also close to its event, and not a mirror image, may be first.
    void contest(const vec *g, int c, mask near) {
        near &= (root_at[c] < UNKNOWN) & ~is_block(c);
        mask same = near;
        for (int k = 0; k <= ORDER && any(same); k++) same &= g[size_t(k) * width] == candidate[k];
        contested |= near & ~same;
    }

    // Take the event of the block that is first, however small the difference; return where the proof then fails.
    mask earlier(Series<L> &series, vec reach, mask where) {
        const mask before = block;
        mask changed{}, last = mask{} - 1;
        for (;;) {
            // The next block of each lane that may be first.
            mask next = mask{} + columns;
            for (int c = columns - 1; c >= 0; c--)
                next = select(where & (root_at[c] < UNKNOWN) & (before != c) & (last < c), mask{} + c, next);
            const mask wanted = next < columns;
            if (!any(wanted)) break;
            vec guess = time;
            for (int c = 0; c < columns; c++) {
                const mask own = next == c;
                if (!any(own)) continue;
                guess = select(own, root_at[c], guess);
                for (int k = 0; k <= ORDER; k++)
                    quotient[k] = select(own, series.gap[size_t(k) * width + c], quotient[k]);
            }
            const vec root = refine(quotient, 1, guess, reach, wanted);
            const mask first = wanted & ((root < time) | ((root == time) & (next < block)));
            time = select(first, root, time);
            block = select(first, next, block);
            changed |= first;
            last = next;
        }
        if (!any(changed)) return changed;
        aimed = false;
        aim(series);
        return changed & ~proved(series, changed, -1);
    }

    // Search all blocks of some clocks, by halving.
    void search(Series<L> &series, const State<L> &state, vec reach, mask where) {
        aimed = false;
        const int which = bits(where), clocks = L::ONE_CLOCK ? 1 : LANES;
        for (int lane = 0; lane < clocks; lane++) {
            if (!(which >> lane & 1)) continue;
            searches++;
            double first = reach[lane];
            int own = -1;
            const int blocks = L::ONE_CLOCK ? columns * LANES : columns;
            for (int i = 0; i < blocks; i++) {
                const size_t place = L::ONE_CLOCK ? i : size_t(i) * LANES + lane;
                if (L::ONE_CLOCK && !series.layout.present[i / LANES][i % LANES]) break;
                const bool slips = state.slip.lane(place) != 0.0;
                for (int side = 1; side >= (state.layout.symmetric && !slips ? -1 : 1); side -= 2) {
                    load(series, state, place, side);
                    // In the whole reach, so that no block changes a bit of the event of another block.
                    const double t = polynomial.first_root(reach[lane]);
                    if (t >= 0.0 && (t < first || own < 0)) {
                        first = t;
                        own = i;
                    }
                }
            }
            if (L::ONE_CLOCK) {
                block = mask{} + own;
                time = L::splat(first);
                found = L::all_lanes(own >= 0);
            } else {
                block[lane] = own;
                time[lane] = first;
                found[lane] = -int64_t(own >= 0);
            }
        }
    }

    // Load the g of one block, for a stuck one to the threshold ahead (side 1) or behind (−1).
    void load(const Series<L> &series, const State<L> &state, size_t place, int side) {
        polynomial.load(&series.gap.lane(place), width * LANES, ORDER, 1.0);
        if (side > 0) return;
        // The zeros that were divided out of the gap ahead must be restored first.
        const int times = int(zeros.lane(place));
        for (int k = ORDER; k >= 0; k--)
            polynomial.coefficient[k] = k >= times ? -polynomial.coefficient[k - times] : 0.0;
        const double threshold = state.layout.threshold.lane(place);
        polynomial.coefficient[0] += 2.0 * threshold;
        if (state.touching.lane(place) != 0.0 && std::fabs(polynomial.coefficient[0]) < 0.5 * threshold)
            polynomial.coefficient[0] = 0.0;
        polynomial.deflate();
    }
};

}  // namespace bk
