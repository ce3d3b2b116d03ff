// The kernel's classes as Python sees them.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include "archive.h"
#include "ensemble.h"
#include "lockstep.h"
#include "run.h"
#include "threads.h"
#include "time_stepping.h"

namespace nb = nanobind;
using namespace nb::literals;
using namespace bk;

namespace {

template <class T>
using Array1 = nb::ndarray<const T, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
template <class T>
using Array2 = nb::ndarray<const T, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
using Numbers = Array1<double>;
using Table = Array2<double>;

template <class T>
std::vector<T> copied(const Array1<T> &array) {
    return {array.data(), array.data() + array.size()};
}

// A NumPy array of its own, of these values.
template <class T, class From = T>
nb::ndarray<nb::numpy, T> array(const std::vector<From> &values, std::vector<size_t> shape) {
    T *made = new T[values.size() ? values.size() : 1];
    std::copy(values.begin(), values.end(), made);
    nb::capsule owner(made, [](void *p) noexcept { delete[] static_cast<T *>(p); });
    return nb::ndarray<nb::numpy, T>(made, shape.size(), shape.data(), owner);
}
auto numbers(const std::vector<double> &values, std::vector<size_t> shape) {
    return array<double>(values, std::move(shape));
}
auto numbers(const std::vector<double> &values) {
    return array<double>(values, {values.size()});
}

// A NumPy array that takes these values over.
template <class T>
nb::ndarray<nb::numpy, T> taken(std::vector<T> &values) {
    auto *own = new std::vector<T>(std::move(values));
    values.clear();
    nb::capsule owner(own, [](void *p) noexcept { delete static_cast<std::vector<T> *>(p); });
    const size_t shape[] = {own->size()};
    return nb::ndarray<nb::numpy, T>(own->data(), 1, shape, owner);
}

Model *new_model(Numbers diagonal, Numbers driving, Numbers threshold, Numbers weakening, Numbers sliding_force,
                 Numbers mass, Array1<int64_t> start, Array1<int64_t> neighbour, Numbers strength, Numbers damping,
                 Numbers damping_diagonal, Numbers damping_load, Array2<int64_t> operations, Table constants, int value,
                 int slope, bool linear, double rate, bool steepest_at_rest, double v, bool symmetric,
                 double creep_speed, double rest_speed) {
    auto model = std::make_unique<Model>();
    Springs &springs = model->springs;
    springs.blocks = int(diagonal.size());
    springs.diagonal = copied(diagonal);
    springs.driving = copied(driving);
    springs.threshold = copied(threshold);
    springs.weakening = copied(weakening);
    springs.sliding_force = copied(sliding_force);
    springs.mass = copied(mass);
    springs.start = copied(start);
    springs.neighbour.assign(neighbour.data(), neighbour.data() + neighbour.size());
    springs.strength = copied(strength);
    springs.damping = copied(damping);
    springs.damping_diagonal = copied(damping_diagonal);
    springs.damping_load = copied(damping_load);
    springs.complete();
    for (size_t k = 0; k < operations.shape(0); k++)
        model->law.tape.push_back({int(operations(k, 0)), int(operations(k, 1)), int(operations(k, 2)), constants(k, 0),
                                   constants(k, 1), constants(k, 2)});
    model->law.value = value;
    model->law.slope = slope;
    model->law.linear = linear;
    model->law.rate = rate;
    model->law.steepest_at_rest = steepest_at_rest;
    model->law.complete();
    model->v = v;
    model->symmetric = symmetric;
    model->creep_speed = creep_speed;
    model->rest_speed = rest_speed;
    return model.release();
}

template <class Solver>
nb::tuple values(Solver &solver, int blocks) {
    std::vector<double> x(blocks), u(blocks), slip(blocks);
    if constexpr (std::is_same_v<Solver, Run>)
        solver.state(x.data(), u.data(), slip.data());
    else
        solver.values(x.data(), u.data(), slip.data());
    return nb::make_tuple(numbers(x), numbers(u), array<int32_t>(slip, {size_t(blocks)}));
}

template <class T>
nb::bytes packed(const T &value) {
    T copy = value;
    Archive archive;
    archive(copy);
    return nb::bytes(archive.bytes.data(), archive.bytes.size());
}

template <class T>
void unpacked(T &at, nb::bytes bytes) {
    T made;
    Archive archive({bytes.c_str(), bytes.size()});
    archive(made);
    if (!archive.complete())
        throw nb::value_error("state: got a state pickled by another version of the kernel, expected this version");
    new (&at) T(std::move(made));
}

nb::dict outcome(const Outcome &out) {
    const size_t n = out.count, blocks = out.blocks, times = out.times, kept = out.kept;
    nb::dict made;
    made["position"] = numbers(out.position, {n, times, blocks});
    made["velocity"] = numbers(out.velocity, {n, times, blocks});
    made["slip"] = array<int8_t>(out.slip, {n, times, blocks});
    made["status"] = array<int32_t>(out.status, {n});
    made["end"] = numbers(out.end, {n});
    made["event_count"] = array<int64_t>(out.event_count, {n});
    made["event_time"] = numbers(out.event_time, {n, kept});
    made["event_block"] = array<int32_t>(out.event_block, {n, kept});
    made["event_kind"] = array<int32_t>(out.event_kind, {n, kept});
    return made;
}

void check_shape(const Ensemble &ensemble, const Table &position, const Table &velocity, const Array2<bool> &stuck) {
    auto fits = [&](auto &table) {
        return table.shape(0) == position.shape(0) && int(table.shape(1)) == ensemble.model.springs.blocks;
    };
    if (fits(position) && fits(velocity) && fits(stuck)) return;
    auto shape = [](auto &table) {
        return "(" + std::to_string(table.shape(0)) + ", " + std::to_string(table.shape(1)) + ")";
    };
    throw nb::value_error(("position, velocity, stuck: got shapes " + shape(position) + ", " + shape(velocity) + ", " +
                           shape(stuck) + ", expected (n, " + std::to_string(ensemble.model.springs.blocks) +
                           ") for each")
                              .c_str());
}

}  // namespace

NB_MODULE(_core, m) {
    m.attr("LANES") = WIDEST;
    nb::dict status;
    for (auto [name, value] : {std::pair("HALTED", HALTED),
                               {"FULL", FULL},
                               {"COMPLETED", COMPLETED},
                               {"STEP_LIMIT", STEP_LIMIT},
                               {"ACCUMULATING_EVENTS", ACCUMULATING_EVENTS},
                               {"DIVERGED", DIVERGED}})
        status[name] = int(value);
    m.attr("STATUS") = status;

    check_interrupt = check_python;
    nb::module_::import_("atexit").attr("register")(nb::cpp_function(end_calls));

    nb::class_<StopFlag>(m, "StopFlag", "Ends calls of the kernel in the threads that check it, by KeyboardInterrupt.")
        .def(nb::init<>())
        .def("heed", &StopFlag::heed, "Let the calls of this thread end once the flag is set.")
        .def("set", &StopFlag::set);

    m.def(
        "first_root",
        [](Numbers coefficients, double length) {
            Polynomial polynomial;
            polynomial.load(coefficients.data(), 1, int(coefficients.size()) - 1);
            return polynomial.first_root(length);
        },
        "coefficients"_a, "length"_a,
        "The first t in [0, length] at which a polynomial, of degree 24 at most, becomes negative; -1 if it never "
        "does.");
    m.def(
        "maximum",
        [](Numbers coefficients, double length, double floor) {
            Polynomial polynomial;
            polynomial.load(coefficients.data(), 1, int(coefficients.size()) - 1);
            return polynomial.maximum(length, floor);
        },
        "coefficients"_a, "length"_a, "floor"_a,
        "The maximum of a polynomial over [0, length], or floor if that is larger.");
    m.def(
        "quadrature",
        [] {
            const std::vector<double> node(GAUSS.node, GAUSS.node + NODES), weight(GAUSS.weight, GAUSS.weight + NODES);
            return nb::make_tuple(numbers(node), numbers(weight));
        },
        "Nodes and weights, of sum 1, of the quadrature rule for J on [-1, 1].");

    nb::class_<Model>(m, "KernelModel",
                      "A chain or network of blocks with its friction law and driver, as the kernel reads it.")
        .def(nb::new_(&new_model), "diagonal"_a, "driving"_a, "threshold"_a, "weakening"_a, "sliding_force"_a, "mass"_a,
             "start"_a, "neighbour"_a, "strength"_a, "damping"_a, "damping_diagonal"_a, "damping_load"_a,
             "operations"_a, "constants"_a, "value"_a, "slope"_a, "linear"_a, "rate"_a, "steepest_at_rest"_a, "v"_a,
             "symmetric"_a, "creep_speed"_a = 0.0, "rest_speed"_a = 0.0)
        .def_prop_ro(
            "fastest", [](const Model &model) { return model.springs.fastest; },
            "Bound on the angular frequencies of slipping blocks.")
        .def(
            "friction_series",
            [](const Model &model, Numbers speed) {
                if (model.law.linear) throw nb::value_error("law: got a linear one, expected one with a series");
                FrictionSeries<Blocks> series(model.law, 1, int(speed.size()));
                std::vector<double> value(speed.size()), slope(speed.size());
                for (int n = 0; n < int(speed.size()); n++) {
                    series.row(0, 0)[n] = Blocks::splat(speed(n));
                    series.fill(0, n, 0, int(model.law.tape.size()));
                    value[n] = series.row(model.law.value, 0)[n][0];
                    slope[n] = series.row(model.law.slope, 0)[n][0];
                }
                return nb::make_tuple(numbers(value), numbers(slope));
            },
            "speed"_a,
            "Taylor coefficients of the friction and of its slope along a motion with these coefficients of the "
            "speed.");

    nb::class_<Record>(m, "Record", "A growing table with one time and a few values per row.")
        .def_prop_ro("count", [](const Record &table) { return table.time.size(); })
        .def_ro("full", &Record::full)
        .def(
            "times", [](const Record &table) { return numbers(table.time); }, "The times, shape (count,).")
        .def(
            "values",
            [](const Record &table) { return numbers(table.value, {table.time.size(), size_t(table.width)}); },
            "The values, shape (count, width).");

    nb::class_<EventLog>(
        m, "EventLog",
        "The event sequence of a run: `earlier_events` before `states_from`, with rows (block from 1, kind 0 stop | 1 "
        "start); `events` from then on, with rows (block, kind, x_1 ... x_N, U_1' ... U_N').")
        .def(nb::init<int, double, bool, long long, bool, double>(), "blocks"_a, "states_from"_a, "keep"_a,
             "rate_limit"_a, "stops_only"_a, "most_numbers"_a)
        .def_ro("count", &EventLog::count)
        .def_ro("states_from", &EventLog::states_from)
        .def_ro("earlier_events", &EventLog::earlier)
        .def_ro("events", &EventLog::events);

    nb::class_<Observer>(
        m, "Observer",
        "The measurements of one run: J averaged over batches, J and states at given times, when J was last at levels, "
        "section crossings.")
        .def(
            "__init__",
            [](Observer *at, int blocks, double apart, Numbers edge, Numbers distance_time, Numbers trajectory_time,
               Numbers level, bool section_only, int section, double most_numbers) {
                new (at) Observer(blocks, apart, copied(edge), copied(distance_time), copied(trajectory_time),
                                  copied(level), section_only, section, most_numbers);
            },
            "blocks"_a, "apart"_a, "edge"_a, "distance_time"_a, "trajectory_time"_a, "level"_a, "section_only"_a,
            "section"_a, "most_numbers"_a)
        .def_ro("crossings", &Observer::crossings)
        .def_ro("section_only", &Observer::section_only)
        .def_prop_ro("end", &Observer::end)
        .def_prop_ro(
            "distance_time", [](const Observer &o) { return numbers(o.distance_time); }, nb::rv_policy::move)
        .def_prop_ro(
            "trajectory_time", [](const Observer &o) { return numbers(o.trajectory_time); }, nb::rv_policy::move)
        .def(
            "results",
            [](const Observer &o) {
                std::vector<double> integral(o.batch_integral);
                for (size_t k = 0; k < integral.size(); k++) integral[k] += o.batch_rest[k];
                const size_t blocks = o.blocks, count = o.trajectory_time.size();
                nb::dict made;
                made["batch_integral"] = numbers(integral);
                made["distance"] = numbers(o.distance_sample);
                std::vector<double> settled(o.last_at);
                for (double &time : settled)
                    if (std::isinf(time)) time = time > 0.0 ? NAN : o.begin;
                made["settling_time"] = numbers(settled);
                made["position"] = numbers(o.trajectory_position, {count, blocks});
                made["velocity"] = numbers(o.trajectory_velocity, {count, blocks});
                made["crossing_time"] = numbers(o.crossings.time);
                made["crossing"] = numbers(o.crossings.value, {o.crossings.time.size(), 2});
                auto seen = [](std::vector<double> extremes) {
                    for (double &one : extremes)
                        if (std::fabs(one) >= NEVER) one = NAN;
                    return extremes;
                };
                made["highest_speed"] = numbers(seen({o.highest_speed[0], o.highest_speed[1]}));
                made["lowest_force"] = numbers(seen({o.lowest_force[0], o.lowest_force[1]}));
                return made;
            },
            "All that was measured, as NumPy arrays.");

    nb::class_<Exponents>(m, "Exponents", "Growth of the perturbations of a run: Lyapunov exponents, batch by batch.")
        .def(
            "__init__",
            [](Exponents *at, int blocks, int vectors, double start_time, Numbers edge, bool at_rest) {
                new (at) Exponents(blocks, vectors, start_time, copied(edge), at_rest);
            },
            "blocks"_a, "vectors"_a, "start_time"_a, "edge"_a, "at_rest"_a = false)
        .def(
            "carry",
            [](Exponents &exponents, Table matrix) {
                for (int v = 0; v < exponents.tangent.vectors; v++)
                    for (int i = 0; i < exponents.blocks; i++) {
                        exponents.x(v)[i] = matrix(i, v);
                        exponents.u(v)[i] = matrix(exponents.blocks + i, v);
                    }
                exponents.carry();
            },
            "matrix"_a,
            "Propagate the columns of a matrix (2 blocks, vectors) from now on, without orthonormalisation.")
        .def(
            "matrix",
            [](Exponents &exponents) {
                const size_t n = exponents.blocks, vectors = exponents.tangent.vectors;
                std::vector<double> made(2 * n * vectors);
                for (size_t v = 0; v < vectors; v++)
                    for (size_t i = 0; i < n; i++) {
                        made[i * vectors + v] = exponents.x(int(v))[i];
                        made[(n + i) * vectors + v] = exponents.u(int(v))[i];
                    }
                return numbers(made, {2 * n, vectors});
            },
            "The perturbations as columns, shape (2 blocks, vectors).")
        .def(
            "results",
            [](const Exponents &exponents) {
                const size_t vectors = exponents.tangent.vectors, batches = exponents.duration.size();
                std::vector<double> growth(exponents.growth);
                for (size_t k = 0; k < growth.size(); k++)
                    if (int(k % vectors) >= exponents.alive) growth[k] = -HUGE_VAL;
                nb::dict made;
                made["growth"] = numbers(growth, {batches, vectors});
                made["duration"] = numbers(exponents.duration);
                made["lost"] = exponents.lost();
                return made;
            },
            "growth (batches, vectors), -inf for dropped vectors, duration (batches,), and the number of exponents "
            "-inf.")
        .def_prop_ro(
            "steps", [](const Exponents &exponents) { return exponents.tangent.steps + exponents.in_group.steps; },
            "Number of parts of the motion along which perturbations were propagated.")
        .def_ro("unordered", &Exponents::unordered,
                "The first two blocks, from 0, whose changes at one instant have an order that matters; -1 for none.")
        .def_ro("unordered_mirrors", &Exponents::unordered_mirrors, "The same, for mirror blocks.")
        .def_ro("tied", &Exponents::tied, "The first two blocks that start together under quasi-static loading.");

    nb::class_<Catalogue>(m, "Catalogue", "Slip events of a run: slips that are connected in space and time.")
        .def(nb::init<int, double, bool, double>(), "blocks"_a, "begin"_a, "profiles"_a, "most"_a)
        .def_ro("full", &Catalogue::full)
        .def(
            "take",
            [](Catalogue &catalogue) {
                Catalogue::Table &table = catalogue.table;
                nb::dict made;
                made["time"] = taken(table.time);
                made["slip_time"] = taken(table.slip_time);
                made["duration"] = taken(table.duration);
                made["epicentre"] = taken(table.epicentre);
                made["first_block"] = taken(table.first_block);
                made["last_block"] = taken(table.last_block);
                made["blocks"] = taken(table.blocks);
                made["moment"] = taken(table.moment);
                made["largest_slip"] = taken(table.largest_slip);
                made["peak_velocity"] = taken(table.peak_velocity);
                made["stress_drop"] = taken(table.stress_drop);
                made["energy_released"] = taken(table.energy_released);
                made["energy_damped"] = taken(table.energy_damped);
                made["interval"] = taken(table.interval);
                made["slip_end"] = taken(table.slip_end);
                made["slip_block"] = taken(table.slip_block);
                made["slip"] = taken(table.slip);
                made["slip_onset"] = taken(table.slip_onset);
                return made;
            },
            "The columns, with an entry for each event in the order in which events end, and the profiles; the "
            "catalogue is empty afterwards.");

    nb::class_<Mark>(m, "Mark", "State that continues a run exactly.")
        .def("__getstate__", &packed<Mark>)
        .def("__setstate__", &unpacked<Mark>);

    nb::class_<Run>(m, "Run", "One run from event to event.")
        .def(
            "__init__",
            [](Run *at, const Model &model, EventLog &log, Observer &observer, Exponents &exponents, bool observing,
               int local, long long step_limit, double loading) {
                new (at) Run(model, log, observer, exponents, observing, local, step_limit, loading);
            },
            "model"_a, "log"_a, "observer"_a, "exponents"_a, "observing"_a, "local"_a, "step_limit"_a, "loading"_a,
            nb::keep_alive<1, 2>(), nb::keep_alive<1, 3>(), nb::keep_alive<1, 4>(), nb::keep_alive<1, 5>())
        .def(
            "begin",
            [](Run &run, Numbers position, Numbers velocity, Array1<bool> stuck, double time) {
                run.begin(position.data(), velocity.data(), stuck.data(), time);
            },
            "position"_a, "velocity"_a, "stuck"_a, "time"_a = 0.0)
        .def("mark", [](const Run &run) { return run.mark(); })
        .def("resume", &Run::resume, "mark"_a, "time"_a)
        .def("run", &Run::run, nb::call_guard<Unlocked>())
        .def("values", [](Run &run) { return values(run, run.model.springs.blocks); })
        .def(
            "use_modes",
            [](Run &run, nb::callable solve) {
                run.modes = std::make_unique<Modes>(run.model, [solve](int first, int last) {
                    nb::gil_scoped_acquire held;
                    const auto [eigenvalue, vector] = nb::cast<std::pair<Numbers, Table>>(solve(first, last));
                    return Modes::Matrix{copied(eigenvalue), {vector.data(), vector.data() + vector.size()}};
                });
            },
            "solve"_a,
            "Use the closed form between events; solve(first, last) returns eigenvalues and modes, one per row, of K "
            "for these blocks.")
        .def(
            "record", [](Run &run, Catalogue &catalogue) { run.catalogue = &catalogue; }, "catalogue"_a,
            nb::keep_alive<1, 2>(), "Record slip events in a catalogue from the next start on.")
        .def_rw("halting_block", &Run::halting_block)
        .def_rw("end", &Run::end)
        .def_ro("steps", &Run::steps)
        .def_ro("local", &Run::local)
        .def_prop_ro("clock", [](const Run &run) { return run.loading_clock(run.now).time; })
        .def_prop_ro("slip_clock", [](const Run &run) { return run.now.time; });

    m.def("run_in_lockstep", &run_in_lockstep, "runs"_a, nb::call_guard<Unlocked>(),
          "Carry out several runs, with the same bits as alone, and return their statuses. Runs of models that differ "
          "only in parameters share vectors.");

    nb::class_<StepMark>(m, "StepMark", "State that continues a run with a fixed step exactly.")
        .def("__getstate__", &packed<StepMark>)
        .def("__setstate__", &unpacked<StepMark>);

    nb::class_<TimeStepping>(m, "TimeStepping",
                             "One run with a fixed step, by Runge-Kutta of fourth order or by Euler's method.")
        .def(
            "__init__",
            [](TimeStepping *at, const Model &model, EventLog &log, Observer &observer, double step, bool euler) {
                new (at) TimeStepping(model, log, observer, step, euler);
            },
            "model"_a, "log"_a, "observer"_a, "step"_a, "euler"_a = false, nb::keep_alive<1, 2>(),
            nb::keep_alive<1, 3>(), nb::keep_alive<1, 4>())
        .def(
            "begin",
            [](TimeStepping &run, Numbers position, Numbers velocity, Array1<bool> stuck, double time) {
                run.begin(position.data(), velocity.data(), stuck.data(), time);
            },
            "position"_a, "velocity"_a, "stuck"_a, "time"_a = 0.0)
        .def("mark", &TimeStepping::mark)
        .def(
            "resume", [](TimeStepping &run, const StepMark &mark, double) { run.resume(mark); }, "mark"_a, "time"_a)
        .def("run", &TimeStepping::run, nb::call_guard<Unlocked>())
        .def("values", [](TimeStepping &run) { return values(run, run.model.springs.blocks); })
        .def(
            "record", [](TimeStepping &run, Catalogue &catalogue) { run.catalogue = &catalogue; }, "catalogue"_a,
            nb::keep_alive<1, 2>(), "Record slip events in a catalogue from the next start on.")
        .def_ro("steps", &TimeStepping::steps)
        .def_ro("clock", &TimeStepping::clock);

    nb::class_<Clouds>(m, "Clouds",
                       "Several clouds of points, each with a radius in the largest difference of a coordinate.")
        .def(
            "__init__",
            [](Clouds *at, std::vector<Table> clouds, int width, std::vector<double> radius) {
                new (at) Clouds(width);
                for (size_t k = 0; k < clouds.size(); k++)
                    at->add(clouds[k].data(), int(clouds[k].shape(0)), radius[k]);
            },
            "clouds"_a, "width"_a, "radius"_a)
        .def_prop_ro("count", &Clouds::count)
        .def(
            "is_near",
            [](const Clouds &clouds, int cloud, Numbers state) { return clouds.is_near(cloud, state.data()); },
            "cloud"_a, "state"_a, "Whether a state, shape (width,), is within the radius of a point of a cloud.");

    nb::class_<Ensemble>(m, "Ensemble", "Many trajectories of one model at once, each in a lane of vectors.")
        .def(
            "__init__",
            [](Ensemble *at, const Model &model, long long rate_limit) { new (at) Ensemble(model, rate_limit); },
            "model"_a, "rate_limit"_a, nb::keep_alive<1, 2>())
        .def_ro("rounds", &Ensemble::rounds)
        .def_prop_ro("searches", &Ensemble::searches)
        .def(
            "run",
            [](Ensemble &ensemble, Table position, Table velocity, Array2<bool> stuck, std::vector<double> times,
               int events) {
                check_shape(ensemble, position, velocity, stuck);
                Outcome out(int(position.shape(0)), ensemble.model.springs.blocks, int(times.size()), events);
                {
                    const Unlocked call;
                    ensemble.run(position.data(), velocity.data(), stuck.data(), times, out);
                }
                return outcome(out);
            },
            "position"_a, "velocity"_a, "stuck"_a, "times"_a, "events"_a = 0,
            "The states of all trajectories at some times, and their first events.")
        .def(
            "label",
            [](Ensemble &ensemble, Table position, Table velocity, Array2<bool> stuck, const Clouds &clouds,
               std::vector<int> returns, std::vector<int> block, std::vector<int> section, double end) {
                check_shape(ensemble, position, velocity, stuck);
                std::vector<Target> targets;
                for (size_t k = 0; k < block.size(); k++)
                    targets.push_back({block[k], Section(section[k]), returns[k]});
                const size_t n = position.shape(0), blocks = ensemble.model.springs.blocks;
                Outcome out(int(n), int(blocks), 1, 0);
                {
                    const Unlocked call;
                    ensemble.run(position.data(), velocity.data(), stuck.data(), {end}, out, &clouds, targets);
                }
                std::vector<double> last(n * 2 * blocks);
                for (size_t k = 0; k < n; k++) {
                    std::copy_n(&out.position[k * blocks], blocks, &last[k * 2 * blocks]);
                    std::copy_n(&out.velocity[k * blocks], blocks, &last[k * 2 * blocks + blocks]);
                }
                return nb::make_tuple(array<int32_t>(out.label, {n}), numbers(out.end, {n}),
                                      numbers(last, {n, 2 * blocks}));
            },
            "position"_a, "velocity"_a, "stuck"_a, "clouds"_a, "returns"_a, "block"_a, "section"_a, "end"_a,
            "The cloud that each state reaches, -1 for none, the end times, and the states at the end.\n\n"
            "block : of the section of each cloud, from 0; section : its stops 0, maxima of its velocity 1, everywhere "
            "2")
        .def(
            "maxima",
            [](Ensemble &ensemble, Table position, Table velocity, Array2<bool> stuck, double begin, double end) {
                check_shape(ensemble, position, velocity, stuck);
                if (position.shape(0) != 1) throw std::invalid_argument("position: expected one state");
                const int blocks = ensemble.model.springs.blocks;
                Outcome out(1, blocks, 1, 0);
                Maxima maxima{begin, {}};
                {
                    const Unlocked call;
                    ensemble.run(position.data(), velocity.data(), stuck.data(), {end}, out, nullptr, {}, &maxima);
                }
                const size_t width = 2 + 2 * blocks;
                return numbers(maxima.rows, {maxima.rows.size() / width, width});
            },
            "position"_a, "velocity"_a, "stuck"_a, "begin"_a, "end"_a,
            "The maxima of the velocity of every block of one trajectory between two times, rows of time, block "
            "(from 1), positions and velocities.");
}
