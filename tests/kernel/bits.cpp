// The kernel without Python: reads cases, and writes what it finds in them, bit by bit.
//
// Rows go in and out as their length and as many doubles. tests/kernel/test_compilers.py gives the cases and has the
// same found by the kernel that is installed. All is one file here, since compilers then take half the time.

#include <array>
#include <cstdio>
#include <memory>

#include "creep.cpp"
#include "ensemble.cpp"
#include "groups.cpp"
#include "local_exponents.cpp"
#include "lockstep.cpp"
#include "run.cpp"
#include "time_stepping.h"

using namespace bk;

namespace {

constexpr double MOST_NUMBERS = 1e6;

bool read(std::vector<double> &row) {
    double length;
    if (std::fread(&length, 8, 1, stdin) != 1) return false;
    row.resize(size_t(length));
    return std::fread(row.data(), 8, row.size(), stdin) == row.size();
}

template <class T = double>
std::vector<T> next() {
    std::vector<double> row;
    if (!read(row)) std::exit(1);
    return {row.begin(), row.end()};
}

template <class T>
void write(const std::vector<T> &values) {
    const std::vector<double> row(values.begin(), values.end());
    const double length = double(row.size());
    std::fwrite(&length, 8, 1, stdout);
    std::fwrite(row.data(), 8, row.size(), stdout);
}

// As `new_model` of module.cpp has them from Python.
void read_model(Model &model) {
    Springs &springs = model.springs;
    springs.diagonal = next();
    springs.driving = next();
    springs.threshold = next();
    springs.weakening = next();
    springs.sliding_force = next();
    springs.mass = next();
    springs.start = next<int64_t>();
    springs.neighbour = next<int>();
    springs.strength = next();
    springs.damping = next();
    springs.damping_diagonal = next();
    springs.damping_load = next();
    springs.blocks = int(springs.diagonal.size());
    springs.complete();
    const std::vector<int> code = next<int>();
    const std::vector<double> constant = next(), number = next();
    for (size_t k = 0; k < code.size(); k += 3)
        model.law.tape.push_back({code[k], code[k + 1], code[k + 2], constant[k], constant[k + 1], constant[k + 2]});
    model.law.value = int(number[0]);
    model.law.slope = int(number[1]);
    model.law.linear = number[2] != 0.0;
    model.law.rate = number[3];
    model.law.steepest_at_rest = number[4] != 0.0;
    model.law.complete();
    model.v = number[5];
    model.symmetric = number[6] != 0.0;
    model.creep_speed = number[7];
}

template <class Solver>
void finish(Solver &solver, int status, const EventLog &log, const Observer &observer, const Catalogue &catalogue) {
    const int n = observer.blocks;
    std::vector<double> x(n), u(n), slip(n);
    if constexpr (std::is_same_v<Solver, Run>)
        solver.state(x.data(), u.data(), slip.data());
    else
        solver.values(x.data(), u.data(), slip.data());
    std::vector<double> integral(observer.batch_integral);
    for (size_t k = 0; k < integral.size(); k++) integral[k] += observer.batch_rest[k];
    std::vector<double> settled(observer.last_at);
    for (double &time : settled)
        if (std::isinf(time)) time = time > 0.0 ? NAN : observer.begin;
    write<double>({double(status)});
    write(x);
    write(u);
    write(log.events.time);
    write(log.events.value);
    write(observer.distance_sample);
    write(observer.trajectory_position);
    write(observer.trajectory_velocity);
    write(integral);
    write(observer.crossings.time);
    write(observer.crossings.value);
    write(settled);
    write<double>({observer.highest_speed[0], observer.highest_speed[1]});
    write<double>({observer.lowest_force[0], observer.lowest_force[1]});
    write(catalogue.table.time);
    write(catalogue.table.moment);
    write(catalogue.table.energy_released);
    write(catalogue.table.energy_damped);
}

}  // namespace

int main() {
    for (std::vector<double> setting; read(setting);) {
        Model model;
        read_model(model);
        const int n = model.springs.blocks, vectors = int(setting[0]), count = int(setting[1]);
        const double step = setting[2];
        const long long rate_limit = 1000LL * n;
        const std::vector<double> edge = next(), times = next(), x = next(), u = next();
        const std::vector<char> stuck = next<char>();
        const bool *sticks = reinterpret_cast<const bool *>(stuck.data());

        auto observed = [&] { return Observer(n, 0.0, edge, times, times, {1e-1, 1e-3}, false, 0, MOST_NUMBERS); };
        auto logged = [&] { return EventLog(n, 0.0, true, rate_limit, false, MOST_NUMBERS); };
        {
            EventLog log = logged();
            Observer observer = observed();
            Catalogue catalogue(n, 0.0, false, MOST_NUMBERS);
            Exponents exponents(n, vectors, 0.0, edge, false);
            Run run(model, log, observer, exponents, true, -1, 1LL << 40, 0.0);
            run.catalogue = &catalogue;
            run.begin(x.data(), u.data(), sticks, 0.0);
            finish(run, run.run(), log, observer, catalogue);
            write(exponents.growth);
        }
        {
            // As many as move in lanes for certain.
            struct Alone {
                EventLog log;
                Observer observer;
                Exponents exponents;
                std::unique_ptr<Run> run;
            };
            std::vector<std::unique_ptr<Alone>> alone;
            std::vector<Run *> runs;
            for (int k = 0; k < 4; k++) {
                alone.emplace_back(new Alone{logged(), observed(), Exponents(n, vectors, 0.0, edge, false), nullptr});
                Alone &own = *alone.back();
                own.run = std::make_unique<Run>(model, own.log, own.observer, own.exponents, true, -1, 1LL << 40, 0.0);
                own.run->begin(x.data(), u.data(), sticks, 0.0);
                runs.push_back(own.run.get());
            }
            const std::vector<int> status = run_in_lockstep(runs);
            for (int k = 0; k < 4; k++) {
                Catalogue none(n, 0.0, false, MOST_NUMBERS);
                finish(*runs[k], status[k], alone[k]->log, alone[k]->observer, none);
                write(alone[k]->exponents.growth);
            }
        }
        {
            EventLog log = logged();
            Observer observer = observed();
            Catalogue catalogue(n, 0.0, false, MOST_NUMBERS);
            TimeStepping run(model, log, observer, step, false);
            run.catalogue = &catalogue;
            run.begin(x.data(), u.data(), sticks, 0.0);
            finish(run, run.run(), log, observer, catalogue);
        }
        const std::vector<double> position = next(), velocity = next();
        const std::unique_ptr<bool[]> none(new bool[size_t(count) * n]());
        Ensemble ensemble(model, rate_limit);
        Outcome out(count, n, int(times.size()), 0);
        ensemble.run(position.data(), velocity.data(), none.get(), times, out, nullptr, {}, {});
        write(out.position);
        write(out.velocity);
        write(out.end);
    }
}
