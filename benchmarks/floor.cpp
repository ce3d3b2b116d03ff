// The floor: how fast can a program be that is written for one model alone?
//
// It runs the paper's three blocks (a = 0.08, v = 0.1, one-sided contact) and records what the package records of a
// run: all events, <J> over the window, and the crossings of the section W = x1 + x2 + x3 = 0. Springs, laws and a are
// constants. It computes no exponents, extremes or samples, and it does not prove that no event is missed: it samples
// the motion at intervals H. benchmarks/floor.py compares its results with those of the package.
//
// Coordinates are those of docs/model.md: x_i = U_i - v tau - e_i and w_i = U_i'. The gap of a block to its next event
// is its speed w_i if it slips, and 1 - s_i = 1 - Phi(v) + (K x)_i if it sticks.

#include <algorithm>
#include <cmath>
#include <immintrin.h>

struct Row { double time, what, kind; };  // block, 1 start or 0 stop; or W', direction of W

namespace {

// Lanes are the three blocks and W, or four times.
typedef double vec __attribute__((vector_size(32)));
typedef long long bits __attribute__((vector_size(32)));

constexpr double A = 0.08, V = 0.1;
constexpr double H = 0.1;           // interval of samples
constexpr double LOW = 2e-3;        // gaps that stay above this in all samples have no event
constexpr double DIP = 1e-3;        // a gap whose parabola through three samples falls below this may have two
constexpr double NEAR = 1e-3;       // distance from a guess up to which a reverted series gives the root to rounding
constexpr int CELLS = 90;           // intervals after which the closed form is restarted
constexpr double PANEL = 5 * H;     // longest interval over which 8 Gauss nodes integrate J
constexpr double SLOW = 1e-9;       // last coefficient of a nonlinear series up to which a step may be 6 H, else 2 H
constexpr double TOGETHER = 1e-13;  // blocks with gaps below this at an event change state with it
constexpr vec DRIVER = {V, V, V, 0.0};

inline vec all(double a) { return vec{a, a, a, a}; }
inline double sum(vec a) { return (a[0] + a[1]) + (a[2] + a[3]); }
inline int negative(vec a) { return _mm256_movemask_pd(a); }
template <int I> inline vec lane(vec a) { return __builtin_shuffle(a, bits{I, I, I, I}); }

// K x in the lanes of the blocks, W in the last.
inline vec springs(vec x) {
    return vec{2, -1, 0, 1} * lane<0>(x) + vec{-1, 4, -1, 1} * lane<1>(x) + vec{0, -1, 2, 1} * lane<2>(x);
}

// Eight Gauss-Legendre nodes on [0, 1].
constexpr vec NODE[2] = {{0.019855071751231884, 0.10166676129318663, 0.2372337950418355, 0.40828267875217510},
                         {0.59171732124782490, 0.7627662049581645, 0.89833323870681337, 0.98014492824876812}};
constexpr vec WEIGHT[2] = {{0.050614268145188130, 0.11119051722668724, 0.15685332293894364, 0.18134189168918099},
                           {0.18134189168918099, 0.15685332293894364, 0.11119051722668724, 0.050614268145188130}};

struct State { vec x, w; int slip; };  // slip: one bit a block

inline bits lanes_of(int slip) { return bits{-(slip & 1), -(slip >> 1 & 1), -(slip >> 2 & 1), 0}; }

enum Law { LINEARIZED, NONLINEAR };
template <Law LAW> constexpr double SLIDING = LAW == LINEARIZED ? 1.0 - A * V : 1.0 / (1.0 + A * V);  // Phi(v)
template <Law LAW> constexpr vec AT_REST = {1 - SLIDING<LAW>, 1 - SLIDING<LAW>, 1 - SLIDING<LAW>, 0.0};

// Taylor series of a motion: positions x, speeds w, and r = K x with W.
template <Law LAW, int N> struct Series {
    vec x[N + 1], w[N + 1], r[N + 1];
    int slip;

    explicit Series(const State &s) : x{s.x, s.w - DRIVER}, w{s.w}, r{springs(x[0]), springs(x[1])}, slip(s.slip) {
        const vec on = (vec)((bits)all(1.0) & lanes_of(slip));
        vec f[N + 1], g[N + 1];  // Phi, and -a Phi(0) times the speeds
        f[0] = LAW == LINEARIZED ? 1.0 - A * w[0] : 1.0 / (1.0 + A * w[0]);
        w[1] = (SLIDING<LAW> - r[0] - f[0]) * on;
        const vec slope = -A * f[0], back = slope * f[0];
        f[1] = back * w[1], g[1] = slope * w[1];
#pragma GCC unroll 32
        for (int n = 1; n < N; ++n) {
            const vec per = on * (1.0 / (n + 1)), next = r[n] * per;
            if constexpr (LAW == LINEARIZED) {
                w[n + 1] = w[n] * (A * per) - next;
            } else {
                // Phi (1 + a w) = 1. What is known early is summed first: f[n] waits for one product with f[n - 1].
                vec late = all(0.0), early = all(0.0);
#pragma GCC unroll 32
                for (int k = (n + 1) / 2; k < n - 1; ++k) late += f[k] * g[n - k];
#pragma GCC unroll 32
                for (int k = std::min((n - 1) / 2, n - 2); k > 0; --k) early += f[k] * g[n - k];
                const vec before = on * (1.0 / n);
                if (n > 1) f[n] = (late + (early - back * (r[n - 1] * before))) + f[n - 1] * (g[1] - back * before);
                w[n + 1] = -f[n] * per - next;
                g[n + 1] = slope * w[n + 1];
            }
            x[n + 1] = w[n] * (1.0 / (n + 1));
            r[n + 1] = springs(w[n]) * (1.0 / (n + 1));
        }
    }

    vec gap(int n) const { return lanes_of(slip) ? w[n] : n == 0 ? r[0] + AT_REST<LAW> : r[n]; }
    State at(double t) const {
        State even{x[N], w[N], slip}, odd{x[N - 1], w[N - 1], slip};
        const double square = t * t;
#pragma GCC unroll 32
        for (int n = N - 2; n > 0; n -= 2) {
            even.x = even.x * square + x[n], even.w = even.w * square + w[n];
            odd.x = odd.x * square + x[n - 1], odd.w = odd.w * square + w[n - 1];
        }
        return State{(even.x * square + x[0]) + odd.x * t, (even.w * square + w[0]) + odd.w * t, slip};
    }

    // Return where a gap (lane 3: sign W) falls through 0 near t: a series about the guess is reverted. HUGE_VAL if it
    // turns above 0.
    double zero(int i, double t, int sign) const {
        const vec *g = slip >> i & 1 ? w : r;
        for (int turn = 0; turn < 9; ++turn) {
            double d[5] = {sign * g[N][i]};
#pragma GCC unroll 32
            for (int n = N - 1; n >= 0; --n) {
                for (int k = 4; k > 0; --k) d[k] = d[k] * t + d[k - 1];
                d[0] = d[0] * t + sign * g[n][i];
            }
            if (g == r) d[0] += AT_REST<LAW>[i];
            const double over = 1.0 / d[1], u = -d[0] * over, b = d[2] * over, c = d[3] * over;
            if (std::abs(u) * (1.0 + std::abs(b)) < NEAR)
                return t + u + u * u * (-b + u * ((2.0 * b * b - c) + u * (5.0 * b * (c - b * b) - d[4] * over)));
            const double square = d[1] * d[1] - 4.0 * d[0] * d[2];
            const double step = square > 0.0 ? 2.0 * d[0] / (std::sqrt(square) - d[1]) : -0.5 * d[1] / d[2];
            if (square <= 0.0 && std::abs(step) < NEAR) break;
            t += step;
        }
        return HUGE_VAL;
    }

    // Integral of J.
    double distance(double start, double end) const {
        vec total = {};
        for (int l = 0; l < 2; ++l) {
            const vec t = start + (end - start) * NODE[l];
            vec dx = all(x[N][2] - x[N][0]), dw = all(w[N][2] - w[N][0]);
#pragma GCC unroll 32
            for (int n = N - 1; n >= 0; --n) dx = dx * t + (x[n][2] - x[n][0]), dw = dw * t + (w[n][2] - w[n][0]);
            total += WEIGHT[l] * (vec)_mm256_sqrt_pd(dx * dx + dw * dw);
        }
        return sum(total) * (end - start);
    }
};

// The linearized law: the motion of a set of slipping blocks is linear in (1, x, w), and its closed form is tabulated.
struct Flow {
    vec gap[CELLS + 2][7];                          // at the samples, from -H on
    vec x[CELLS + 1][7], w[CELLS + 1][7];           // in the middle of the cells between them
    vec dx[CELLS / 5 + 1][2][7], dw[CELLS / 5 + 1][2][7];  // x3 - x1 and w3 - w1 at the Gauss nodes of each panel
    explicit Flow(int slip) {
        for (int n = 0; n < 7; ++n) {
            auto part = [&](vec *row, vec value) { row[n] = n ? value - row[0] : value; };
            State s{vec{}, vec{}, slip};
            if (n) (n < 4 ? s.x : s.w)[(n - 1) % 3] = 1.0;
            part(gap[0], Series<LINEARIZED, 20>(Series<LINEARIZED, 20>(s).at(-H)).gap(0));
            for (int j = 0; j <= CELLS; ++j) {
                const Series<LINEARIZED, 20> series(s);
                part(gap[j + 1], series.gap(0));
                part(x[j], series.at(0.5 * H).x), part(w[j], series.at(0.5 * H).w);
                s = series.at(H);
                for (int l = 0; l < 2 && j % 5 == 0; ++l) {
                    vec position, speed;
                    for (int k = 0; k < 4; ++k) {
                        const State node = series.at(PANEL * NODE[l][k]);
                        position[k] = node.x[2] - node.x[0], speed[k] = node.w[2] - node.w[0];
                    }
                    part(dx[j / 5][l], position), part(dw[j / 5][l], speed);
                }
            }
        }
    }
};

// A piece of the motion under the linearized law.
struct Closed {
    static constexpr Law law = LINEARIZED;
    static constexpr int cells = CELLS;
    const Flow &flow;
    const int slip;
    const vec a, b, c, d, e, f;
    Closed(const Flow &flow, const State &s)
        : flow(flow), slip(s.slip), a(lane<0>(s.x)), b(lane<1>(s.x)), c(lane<2>(s.x)), d(lane<0>(s.w)), e(lane<1>(s.w)),
          f(lane<2>(s.w)) {}
    vec image(const vec *row) const {
        return (row[0] + row[1] * a + row[2] * b + row[3] * c) + (row[4] * d + row[5] * e + row[6] * f);
    }
    void sample(int j, vec *out) const {
        for (int l = 0; l < 4; ++l) out[l] = image(flow.gap[j + l + 1]);
    }

    // The series about the middle of cell j, and when that is.
    template <int N = 8> Series<law, N> series(int j) const {
        return Series<law, N>(State{image(flow.x[j]), image(flow.w[j]), slip});
    }
    static double origin(int j) { return (j + 0.5) * H; }
    double distance(double end) const {
        const int panels = std::min(int(end / PANEL), CELLS / 5);
        vec total = {};
        for (int j = 0; j < panels; ++j)
            for (int l = 0; l < 2; ++l) {
                const vec dx = image(flow.dx[j][l]), dw = image(flow.dw[j][l]);
                total += WEIGHT[l] * (vec)_mm256_sqrt_pd(dx * dx + dw * dw);
            }
        const int j = std::min(int((panels * PANEL + end) * (0.5 / H)), cells - 1);
        return sum(total) * PANEL + series<10>(j).distance(panels * PANEL - origin(j), end - origin(j));
    }
};

// A piece under the nonlinear law: one Taylor series.
struct Expanded {
    static constexpr Law law = NONLINEAR;
    static constexpr int N = 20;
    const Series<law, N> whole;
    const int cells;
    explicit Expanded(const State &s)
        : whole(s), cells(negative(SLOW - whole.w[N]) | negative(SLOW + whole.w[N]) ? 2 : 6) {}
    void sample(int j, vec *out) const {
        vec even[4], odd[4];
        for (int l = 0; l < 4; ++l) even[l] = whole.gap(N), odd[l] = whole.gap(N - 1);
#pragma GCC unroll 32
        for (int n = N - 2; n >= 0; n -= 2)
            for (int l = 0; l < 4; ++l) {
                const double square = (j + l) * (j + l) * (H * H);
                even[l] = even[l] * square + whole.gap(n);
                if (n) odd[l] = odd[l] * square + whole.gap(n - 1);
            }
        for (int l = 0; l < 4; ++l) out[l] = even[l] + odd[l] * ((j + l) * H);
    }
    const Series<law, N> &series(int) const { return whole; }
    static double origin(int) { return 0.0; }
    double distance(double end) const {
        return end < PANEL ? whole.distance(0.0, end) : whole.distance(0.0, 0.5 * end) + whole.distance(0.5 * end, end);
    }
};

struct Run {
    State state;
    Row *event, *crossing;
    double clock = 0.0, clock_rest = 0.0, integral = 0.0;
    long events = 0, crossings = 0;
    int side = 0;       // of W, 1 or -1; 0 before the window
    bool fresh = true;  // whether a block has just changed state: its gap has a double root at 0, which is no dip

    void move(double t) {  // The clock is a compensated sum.
        const double total = clock + (clock_rest + t);
        clock_rest = (clock - total) + (clock_rest + t), clock = total;
    }
    void change(int i) {
        state.slip ^= 1 << i, state.w[i] = 0.0;
        event[events++] = {clock, i + 1.0, double(state.slip >> i & 1)};
    }
    void cross(double t, vec w) {
        side = -side;
        crossing[crossings++] = {clock + (clock_rest + t), sum(w) - 3.0 * V, double(side)};
    }
};

// Follow a piece to its first event, to the time `until`, or as far as it reaches.
template <class Piece> void follow(Run &run, const Piece &piece, double until) {
    const double remaining = (until - run.clock) - run.clock_rest;
    const int slip = run.state.slip, last = std::min(piece.cells, 1 + int(remaining * (1 / H)));
    vec buffer[CELLS + 6], *sample = buffer + 3, watch = {1, 1, 1, double(run.side)};
    const vec idle = {0, 0, 0, double(!run.side)};
    State other;
    double t = HUGE_VAL;  // of the first event
    int due = 0, low = 0;
    // A parabola through three samples gives the guess; of two roots the first, or the second if W has crossed.
    auto zero = [&](int i, int j, bool dips, int sign, State &at) {
        const double before = sample[j - 2][i], y = sample[j - 1][i], after = sample[j][i];
        const double b = 0.5 * (after - before), c = 0.5 * (after + before) - y;
        const double square = b * b - 4.0 * c * y;
        const double guess = (j - 1 + (square > 0.0 ? 2.0 * y / (std::sqrt(square) - b) : -0.5 * b / c)) * H;
        const int cell = dips ? std::clamp(int(guess * (1 / H)), 0, piece.cells - 1) : j - 1;
        const auto &series = piece.series(cell);
        const double u = series.zero(i, guess - piece.origin(cell), sign);
        at = series.at(u);
        return piece.origin(cell) + u;
    };
    for (int j = -1; j <= last && t == HUGE_VAL; j += 4) {
        vec *now = sample + j, small[4];
        piece.sample(j, now);
        for (int l = 0; l < 4; ++l) now[l] = now[l] * watch + idle, small[l] = now[l] - LOW;
        const int before = low;
        low = negative((vec)((bits)small[0] | (bits)small[1] | (bits)small[2] | (bits)small[3]));
        if (!(low | before)) continue;
        for (int l = j < 0 ? 2 : 0; l < 4 && t == HUGE_VAL; ++l) {
            const int below = due = negative(now[l]);
            if (j + l > int(run.fresh)) {
                const vec a = now[l - 2], b = now[l - 1], bend = a - 2.0 * b + now[l], rise = now[l] - a;
                const bits inside = (rise < 1.2 * bend) & (rise > -1.2 * bend) & (a >= 0.0) & (b >= 0.0);
                due |= negative((vec)((8.0 * (b - DIP) * bend < rise * rise) & inside));
            }
            for (int left = due & 7; left; left &= left - 1) {
                const double one = zero(__builtin_ctz(left), j + l, !(below & left & -left), 1, other);
                if (one < t) t = one, run.state = other;
            }
            for (int turn = due & 8 ? (below & 8 ? 1 : 2) : 0; turn > 0; --turn) {
                const double one = zero(3, j + l, !(below & 8), run.side, other);
                if (!(one <= std::min(t, remaining))) break;
                run.cross(one, other.w);
                watch *= vec{1, 1, 1, -1};
                for (int n = -2; n < 4; ++n) now[n] *= vec{1, 1, 1, -1};
            }
        }
    }
    const bool event = t <= remaining;
    if (!event) {
        t = std::min(remaining, piece.cells * H);
        const int cell = std::min(int(t * (1 / H)), piece.cells - 1);
        run.state = piece.series(cell).at(t - piece.origin(cell));
    }
    if (run.side) run.integral += slip & 5 ? piece.distance(t) : t * std::abs(run.state.x[2] - run.state.x[0]);
    run.move(t), run.fresh = event;
    const vec gap = lanes_of(slip) ? run.state.w : springs(run.state.x) + AT_REST<Piece::law>;
    for (int left = event ? due & 7 : 0; left; left &= left - 1)
        if (gap[__builtin_ctz(left)] < TOGETHER) run.change(__builtin_ctz(left));
}

// All blocks stick: forces grow at the rates D_i v, and J stays.
template <Law LAW> void wait(Run &run, double until) {
    const vec due = (springs(run.state.x) + AT_REST<LAW>) * vec{1 / V, 0.5 / V, 1 / V, 1 / (3 * V)};
    const double remaining = (until - run.clock) - run.clock_rest, t = std::min({due[0], due[1], due[2], remaining});
    if (run.side) run.integral += t * std::abs(run.state.x[2] - run.state.x[0]);
    if (run.side > 0 && due[3] <= t) run.cross(std::max(0.0, due[3]), vec{});
    run.state.x -= DRIVER * t;
    run.move(t), run.fresh = true;
    for (int i = 0; i < 3; ++i)
        if (t < remaining && due[i] - t < TOGETHER) run.change(i);
}

template <Law LAW> void advance(Run &run, double until) {
    static const Flow flow[7] = {Flow(1), Flow(2), Flow(3), Flow(4), Flow(5), Flow(6), Flow(7)};
    while (run.clock < until) {
        if (run.state.slip == 0) wait<LAW>(run, until);
        else if constexpr (LAW == LINEARIZED) follow(run, Closed(flow[run.state.slip - 1], run.state), until);
        else follow(run, Expanded(run.state), until);
    }
}

}  // namespace

// Run from x and w, all blocks slipping; return <J> from `transient` to `end`, and the number of rows written.
extern "C" double run_floor(int nonlinear, const double *x, const double *w, double transient, double end,
                            Row *event, Row *crossing, long *count) {
    Run run{{vec{x[0], x[1], x[2], 0}, vec{w[0], w[1], w[2], 0}, 7}, event, crossing};
    const auto advance_to = nonlinear ? advance<NONLINEAR> : advance<LINEARIZED>;
    advance_to(run, transient);
    run.side = springs(run.state.x)[3] < 0.0 ? -1 : 1;
    advance_to(run, end);
    count[0] = run.events, count[1] = run.crossings;
    return run.integral / (end - transient);
}
