// Standard methods for comparison: a fixed step with events at step ends.
#pragma once

#include <optional>

#include "group.h"

namespace bk {

// State that continues a run: slip directions, and the slip events that had not ended.
struct StepMark {
    std::vector<double> slip;
    std::optional<Catalogue::Open> catalogue;

    template <class A>
    void archive(A &values) {
        values(slip, catalogue);
    }
};

// One run with step h by the paper's Runge-Kutta method of fourth order, or by Euler's explicit method. Between step
// ends the motion is the cubic through both states and their slopes.
class TimeStepping {
  public:
    static constexpr int LANES = Blocks::LANES;
    const Model &model;
    EventLog &log;
    Observer &observer;
    const double step;
    const bool euler;
    double clock = 0.0;
    long long steps = 0;
    // Slip events are recorded here, if a catalogue is given.
    Catalogue *catalogue = nullptr;

    TimeStepping(const Model &model, EventLog &log, Observer &observer, double step, bool euler)
        : model(model), log(log), observer(observer), step(step), euler(euler), n(model.springs.blocks), layout(model),
          state(layout), old_x(n), old_u(n) {
        log.unit = model.springs.unit;
        for (auto *table : {&speed, &acceleration}) table->assign(4, std::vector<double>(n));
        for (auto *table : {&x, &u}) table->assign(4, std::vector<double>(n));
        for (int i = 0; i < n; i++) layout.member.push_back(i);
        layout.lay([](int i) { return i; });
        state.widen();
        for (int k = n; k < layout.columns * LANES; k++) state.place(k, 0.0, 0.0, true);
    }

    // Start at a time from x_i, U_i' and stuck blocks; steps end at multiples of h.
    void begin(const double *position, const double *velocity, const bool *stuck, double time) {
        for (int i = 0; i < n; i++) state.place(i, position[i], velocity[i], stuck[i]);
        clock = time;
        earlier_steps = (long long)std::floor(time / step);
        while ((earlier_steps + 1) * step <= time) earlier_steps++;
        steps = 0;
        settled = false;
        observer.begin = time;
        log.restart(time);
        if (catalogue) catalogue->restart();
    }

    StepMark mark() const {
        StepMark made{std::vector<double>(n), {}};
        for (int i = 0; i < n; i++) made.slip[i] = state.slip.lane(i);
        if (catalogue) made.catalogue = catalogue->open();
        return made;
    }

    // Continue as if the run that led to this state had not ended.
    void resume(const StepMark &mark) {
        for (int i = 0; i < n; i++) state.slip.lane(i) = mark.slip[i];
        if (catalogue && mark.catalogue) catalogue->resume(*mark.catalogue);
        settled = true;
    }

    void values(double *position, double *velocity, double *direction) const {
        for (int i = 0; i < n; i++) {
            position[i] = state.position.lane(i);
            velocity[i] = state.velocity.lane(i);
            direction[i] = state.slip.lane(i);
        }
    }

    int run() {
        if (!settled) {
            settled = true;
            settle();
        }
        double *position = &state.position.lane(0), *velocity = &state.velocity.lane(0);
        while (clock < observer.end()) {
            watch.worked(n);
            const double after = std::min((earlier_steps + steps + 1) * step, observer.end()), h = after - clock;
            std::copy(position, position + n, old_x.begin());
            std::copy(velocity, velocity + n, old_u.begin());
            slope(0);
            if (euler)
                stage(0, h);
            else
                runge_kutta(h);
            for (int i = 0; i < n; i++) {
                state.touching.lane(i) = 0.0;
                if (!(std::fabs(velocity[i]) < ABSURD_SPEED)) return DIVERGED;
            }
            slope(3);
            // A step so long that a block passes its stop meets friction where the law does not describe any.
            for (int i = 0; i < n; i++)
                if (!(std::fabs(acceleration[3][i]) * h < ABSURD_SPEED)) return DIVERGED;
            interpolate(h);
            observe(h);
            if (catalogue) record(h);
            clock = after;
            steps++;
            settle();
            if (log.accumulating) return ACCUMULATING_EVENTS;
            if (log.full() || observer.crossings.full || (catalogue && catalogue->full)) return FULL;
        }
        return COMPLETED;
    }

  private:
    const int n;
    Blocks layout;
    State<Blocks> state;
    Polynomial polynomial;
    long long earlier_steps = 0;
    bool settled = false;
    Watch watch;
    std::vector<double> old_x, old_u;
    // Slopes of the four stages, and the coefficients of the cubics, lowest power first.
    std::vector<std::vector<double>> speed, acceleration, x, u;

    // Write x' and U'' at the present state into row `stage`.
    void slope(int stage) {
        const double *position = &state.position.lane(0), *velocities = &state.velocity.lane(0);
        for (int i = 0; i < n; i++) {
            const double direction = state.slip.lane(i), velocity = velocities[i];
            speed[stage][i] = velocity - model.v;
            acceleration[stage][i] = 0.0;
            if (direction == 0.0) continue;
            double force = model.springs.sliding_force[i] + model.springs.pull(position, i);
            if (model.springs.damped) force += model.springs.damping_load[i] + model.springs.drag(velocities, i);
            acceleration[stage][i] =
                (force - direction * (model.springs.threshold[i] *
                                      model.law.at((direction * model.springs.weakening[i]) * velocity))) /
                model.springs.mass[i];
        }
    }

    // Set the state to that at the start of the step, advanced by h with the slope in row `stage`.
    void stage(int row, double h) {
        for (int i = 0; i < n; i++) {
            state.position.lane(i) = old_x[i] + h * speed[row][i];
            state.velocity.lane(i) = old_u[i] + h * acceleration[row][i];
        }
    }

    // The state at the end of the step, whose first slope is in row 0.
    void runge_kutta(double h) {
        stage(0, 0.5 * h);
        slope(1);
        stage(1, 0.5 * h);
        slope(2);
        stage(2, h);
        slope(3);
        for (int i = 0; i < n; i++) {
            state.position.lane(i) =
                old_x[i] + h * (speed[0][i] + 2.0 * speed[1][i] + 2.0 * speed[2][i] + speed[3][i]) / 6.0;
            state.velocity.lane(i) =
                old_u[i] +
                h * (acceleration[0][i] + 2.0 * acceleration[1][i] + 2.0 * acceleration[2][i] + acceleration[3][i]) /
                    6.0;
        }
    }

    // Add the step to the slip events: its work by the trapezoidal rule, and the speeds at its end.
    void record(double h) {
        const double *position = &state.position.lane(0);
        for (int i = 0; i < n; i++) {
            const double direction = state.slip.lane(i);
            Catalogue::Event *event = direction != 0.0 ? catalogue->of(i) : nullptr;
            if (!event) continue;
            const double force = model.springs.sliding_force[i] +
                                 0.5 * (model.springs.pull(old_x.data(), i) + model.springs.pull(position, i));
            event->energy += force * ((position[i] - old_x[i]) + model.v * h);
            event->peak_velocity = std::max(event->peak_velocity, direction * state.velocity.lane(i));
            auto damped = [&](const double *u) {
                return model.springs.damping_load[i] * (model.v - 2.0 * u[i]) - u[i] * model.springs.drag(u, i);
            };
            if (model.springs.damped)
                event->damped += 0.5 * h * (damped(old_u.data()) + damped(&state.velocity.lane(0)));
        }
    }

    // The cubics through both ends of the step; rows 0 and 3 hold the slopes there.
    void interpolate(double h) {
        auto cubic = [&](std::vector<std::vector<double>> &c, int i, double begins, double ends, double before,
                         double after) {
            const double change = (ends - begins) / h;
            c[0][i] = begins;
            c[1][i] = before;
            c[2][i] = (3.0 * change - 2.0 * before - after) / h;
            c[3][i] = (before + after - 2.0 * change) / (h * h);
        };
        for (int i = 0; i < n; i++) {
            cubic(x, i, old_x[i], state.position.lane(i), speed[0][i], speed[3][i]);
            cubic(u, i, old_u[i], state.velocity.lane(i), acceleration[0][i], acceleration[3][i]);
        }
    }

    double at(const std::vector<std::vector<double>> &c, int i, double t) const {
        return ((c[3][i] * t + c[2][i]) * t + c[1][i]) * t + c[0][i];
    }

    void observe(double h) {
        const Clock start{clock, 0.0};
        if (observer.wants_distance(start, h)) {
            for (int k = 0; k < 4; k++) {
                observer.distance.position[k] = x[k][n - 1] - x[k][0];
                observer.distance.velocity[k] = u[k][n - 1] - u[k][0];
            }
            observer.distance.position[0] += observer.apart;
            observer.distance.begin(3);
            observer.average(start, 0.0, h);
            observer.compare(start, 0.0, h);
        }
        if (h > start.until(observer.transient())) {
            polynomial.degree = 3;
            for (int k = 0; k < 4; k++) {
                polynomial.coefficient[k] = 0.0;
                for (int i = 0; i < n; i++) polynomial.coefficient[k] += observer.in_section(i) ? x[k][i] : 0.0;
            }
            observer.cross(polynomial, EventSearch<Blocks>::UNCERTAIN, start, 0.0, h, h, [&](double t) {
                double total = 0.0;
                for (int i = 0; i < n; i++) total += observer.in_section(i) ? at(u, i, t) - model.v : 0.0;
                return total;
            });
        }
        for (int i = 0; i < n && !observer.section_only; i++) {
            const double direction = state.slip.lane(i), threshold = model.springs.threshold[i];
            observer.extreme(direction != 0.0, threshold, UNKNOWN, start, 0.0, h, [&]() -> Polynomial & {
                const Springs &springs = model.springs;
                polynomial.degree = 3;
                for (int k = 0; k < 4; k++) {
                    polynomial.coefficient[k] = direction != 0.0 ? direction * u[k][i] : -springs.pull(x[k].data(), i);
                    if (direction == 0.0 && springs.damped) polynomial.coefficient[k] -= springs.drag(u[k].data(), i);
                }
                if (direction == 0.0)
                    polynomial.coefficient[0] += threshold - springs.sliding_force[i] - springs.damping_load[i];
                return polynomial;
            });
        }
        while (observer.next_trajectory < observer.trajectory_time.size()) {
            const double t = start.until(observer.trajectory_time[observer.next_trajectory]);
            if (t > h) break;
            observer.sample([&](int i, double &position, double &velocity) {
                position = at(x, i, t);
                velocity = at(u, i, t);
            });
        }
    }

    void settle() {
        for (bool changing = true; changing && !log.accumulating;) {
            std::vector<int> due(layout.columns);
            changing = false;
            watch.worked(n);
            state.measure();
            for (int c = 0; c < layout.columns; c++) changing |= (due[c] = bits(state.pending(c))) != 0;
            for (int c = 0; changing && c < layout.columns; c++)
                for (int lane = 0; due[c] >> lane; lane++) {
                    if (!(due[c] >> lane & 1)) continue;
                    const int i = c * LANES + lane, kind = state.slip.lane(i) == 0.0;
                    state.transition(c, Blocks::from_bits(1 << lane));
                    const double x = state.position.lane(i);
                    if (catalogue && kind) catalogue->start(model.springs, i, {clock, 0.0}, {clock, 0.0}, x);
                    if (catalogue && !kind)
                        catalogue->stop(model.springs, model.v, 0.0, i, {clock, 0.0}, {clock, 0.0}, x);
                    log.add(i, kind, clock, [&](double *row) {
                        watch.worked(n);
                        std::copy(&state.position.lane(0), &state.position.lane(0) + n, row);
                        std::copy(&state.velocity.lane(0), &state.velocity.lane(0) + n, row + n);
                    });
                }
        }
    }
};

}  // namespace bk
