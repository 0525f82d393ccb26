// The only file that knows Python: numbers in, NumPy arrays out, no arithmetic.
#include <pybind11/native_enum.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <exception>
#include <functional>
#include <thread>
#include <vector>

#include "classify.hpp"
#include "constraints.hpp"
#include "integrator/collocation.hpp"
#include "integrator/explicit_tableaus.hpp"
#include "rolling.hpp"
#include "simulate.hpp"
#include "thresholds.hpp"

namespace py = pybind11;
using namespace pybind11::literals;
using namespace rolling_ellipse;

namespace {

using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Range = std::function<void(py::ssize_t, py::ssize_t)>;

void check_signals() {
    const py::gil_scoped_acquire gil;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

// Run body(begin, end) over 0 .. n in chunks, without the GIL; Ctrl-C stops it between chunks.
// What a chunk computes does not depend on which thread takes it.
constexpr py::ssize_t chunk = 1024;

void run_interruptible(py::ssize_t n, int workers, const Range& body) {
    if (n <= chunk) return body(0, n);
    constexpr py::ssize_t most_threads = 256;
    workers = static_cast<int>(std::min({py::ssize_t{workers}, most_threads, n / chunk + 1}));
    const py::gil_scoped_release release;
    std::atomic<py::ssize_t> next{0};
    std::vector<std::exception_ptr> failures(workers);
    const auto work = [&](int worker, bool interruptible) {
        try {
            for (py::ssize_t begin; (begin = next.fetch_add(chunk)) < n;) {
                body(begin, std::min(begin + chunk, n));
                if (interruptible) check_signals();
            }
        } catch (...) {
            failures[worker] = std::current_exception();
            next = n;
        }
    };
    std::vector<std::thread> threads;
    for (int worker = 1; worker < workers; ++worker) threads.emplace_back(work, worker, false);
    work(0, true);
    for (std::thread& thread : threads) thread.join();
    for (const std::exception_ptr& failure : failures) {
        if (failure) std::rethrow_exception(failure);
    }
}

std::vector<Array> empty_arrays(int count, py::ssize_t n) {
    std::vector<Array> arrays;
    for (int i = 0; i < count; ++i) arrays.emplace_back(n);
    return arrays;
}

// One argument of `flow`: an array of n numbers, or one number for all.
struct Argument {
    const double* data;
    py::ssize_t stride;

    double operator[](py::ssize_t i) const { return data[i * stride]; }
};

Argument argument(const Array& array) { return {array.data(), array.size() == 1 ? 0 : 1}; }

void validate_time(double t, double longest) {
    if (!std::isfinite(t)) refuse("t", "finite [s]", t);
    if (std::abs(t) > longest) {
        refuse("t", "at most 1e15 half turns or swings, " + text(longest) + " [s]", t);
    }
}

// theta, omega, x at the times begin .. end.
template <class Sampler>
void store_samples(const Sampler& sampler, const double* times, py::ssize_t begin, py::ssize_t end,
                   double* const columns[3]) {
    std::array<FlowSample, chunk> samples;
    sampler(times + begin, end - begin, samples.data());
    for (py::ssize_t i = begin; i < end; ++i) {
        columns[0][i] = samples[i - begin].theta;
        columns[1][i] = samples[i - begin].omega;
        columns[2][i] = samples[i - begin].x;
    }
}

RollingFlow validated_flow(const Body& body, double theta, double omega) {
    validate(body);
    validate_motion(body, theta, omega);
    return rolling_flow(body, theta, omega);
}

py::tuple flow_scalar(double t, double a, double b, double theta, double omega, double gravity,
                      std::optional<double> gyration2) {
    const Body body{a, b, gyration2.value_or(uniform_disc_gyration2(a, b)), gravity};
    const RollingFlow flow = validated_flow(body, theta, omega);
    validate_time(t, longest_time(flow));
    const FlowSample now = sample(flow, t);
    return py::make_tuple(now.theta, now.omega, now.x);
}

// The same at many times.
py::tuple flow_times(const Array& t, double a, double b, double theta, double omega, double gravity,
                     std::optional<double> gyration2, int workers) {
    const py::ssize_t n = t.size();
    const Body body{a, b, gyration2.value_or(uniform_disc_gyration2(a, b)), gravity};
    const RollingFlow flow = validated_flow(body, theta, omega);
    const FlowSampler sampler(flow, infinity, n);
    const double longest = longest_time(flow);
    std::vector<Array> out = empty_arrays(3, n);
    double* const columns[] = {out[0].mutable_data(), out[1].mutable_data(), out[2].mutable_data()};
    const double* const times = t.data();
    run_interruptible(n, workers, [&](py::ssize_t begin, py::ssize_t end) {
        for (py::ssize_t i = begin; i < end; ++i) validate_time(times[i], longest);
        store_samples(sampler, times, begin, end, columns);
    });
    return py::make_tuple(out[0], out[1], out[2]);
}

// t, a, b, theta, omega, gravity, gyration2, each with n elements, or one.
py::tuple flow_array(py::ssize_t n, const std::array<Array, 7>& arguments, int workers) {
    std::vector<Array> out = empty_arrays(3, n);
    double* const columns[] = {out[0].mutable_data(), out[1].mutable_data(), out[2].mutable_data()};
    const Argument times = argument(arguments[0]);
    std::array<Argument, 6> parameters{};
    std::transform(arguments.begin() + 1, arguments.end(), parameters.begin(), argument);
    run_interruptible(n, workers, [&](py::ssize_t begin, py::ssize_t end) {
        std::array<double, 6> last{};
        RollingFlow flow{};
        for (py::ssize_t i = begin; i < end; ++i) {
            std::array<double, 6> now{};
            for (std::size_t p = 0; p < now.size(); ++p) now[p] = parameters[p][i];
            if (i == begin || now != last) {
                flow = validated_flow({now[0], now[1], now[5], now[4]}, now[2], now[3]);
                last = now;
            }
            validate_time(times[i], longest_time(flow));
            const FlowSample at = sample(flow, times[i]);
            columns[0][i] = at.theta;
            columns[1][i] = at.omega;
            columns[2][i] = at.x;
        }
    });
    return py::make_tuple(out[0], out[1], out[2]);
}

// a, b, omega, theta, friction, gravity, gyration2, each with n elements, or one.
py::array_t<std::int8_t> classify_array(py::ssize_t n, const std::array<Array, 7>& arguments,
                                        int workers) {
    py::array_t<std::int8_t> out(n);
    std::int8_t* const outcomes = out.mutable_data();
    std::array<Argument, 7> of{};
    std::transform(arguments.begin(), arguments.end(), of.begin(), argument);
    run_interruptible(n, workers, [&](py::ssize_t begin, py::ssize_t end) {
        for (py::ssize_t i = begin; i < end; ++i) {
            const Body body{of[0][i], of[1][i], of[6][i], of[5][i]};
            const double omega = of[2][i], theta = of[3][i], friction = of[4][i];
            validate(body);
            validate_motion(body, theta, omega);
            validate_friction(friction);
            outcomes[i] = static_cast<std::int8_t>(classify(body, friction, theta, omega));
        }
    });
    return out;
}

// theta, x_dot, z_dot, omega, a, b, gyration2, friction, restitution, each with n elements, or one:
// x_dot, z_dot, omega just after the collision of a touching body, by the law of impact.hpp.
py::tuple collide_arrays(py::ssize_t n, const std::array<Array, 9>& arguments) {
    std::vector<Array> out = empty_arrays(3, n);
    double* const columns[] = {out[0].mutable_data(), out[1].mutable_data(), out[2].mutable_data()};
    std::array<Argument, 9> of{};
    std::transform(arguments.begin(), arguments.end(), of.begin(), argument);
    run_interruptible(n, 1, [&](py::ssize_t begin, py::ssize_t end) {
        for (py::ssize_t i = begin; i < end; ++i) {
            // Neither mass nor gravity nor height matters; a scene may move down only in the air.
            const double mass = 1.0, gravity = 1.0, slope = 0.0, x = 0.0, z = of[4][i] + of[5][i];
            const Scene scene{of[4][i], of[5][i], mass,     gravity,  of[6][i],
                              slope,    of[7][i], of[8][i], of[0][i], of[3][i],
                              x,        z,        of[1][i], of[2][i], std::nullopt};
            validate(scene.body());  // by its own names: k^2 is no inertia
            validate(scene);
            const State after = after_collision(scene, state_before_impulse(scene));
            columns[0][i] = after.x_dot;
            columns[1][i] = after.z_dot;
            columns[2][i] = after.omega;
        }
    });
    return py::make_tuple(out[0], out[1], out[2]);
}

// theta, omega, x at each time.
py::tuple sample_solution(const Solution& solution, const Array& t) {
    const py::ssize_t n = t.size();
    std::vector<Array> out = empty_arrays(3, n);
    double* const columns[] = {out[0].mutable_data(), out[1].mutable_data(), out[2].mutable_data()};
    const double* const times = t.data();
    const RollingSampler sampler(solution, n);
    run_interruptible(n, 1, [&](py::ssize_t begin, py::ssize_t end) {
        store_samples(sampler, times, begin, end, columns);
    });
    return py::make_tuple(out[0], out[1], out[2]);
}

void store(Array& array, py::ssize_t row, const double* values) {
    std::copy_n(values, array.shape(1), array.mutable_data(row, 0));
}

Array matrix(py::ssize_t rows, py::ssize_t columns) {
    return Array(std::vector<py::ssize_t>{rows, columns});
}

CoordinateState state_at(const Array& q, const Array& q_dot, py::ssize_t row) {
    return {Eigen::Map<const Coordinates>(q.data(row, 0)),
            Eigen::Map<const Coordinates>(q_dot.data(row, 0))};
}

Solution simulate_interruptible(const Scene& scene, const Settings& settings, double t_end) {
    const py::gil_scoped_release release;
    return simulate(scene, settings, t_end, check_signals);
}

Solution simulate_coordinates(const Scene& scene, const Array& q, const Array& q_dot,
                              const Settings& settings, double t_end) {
    const CoordinateState start = state_at(q, q_dot, 0);
    const py::gil_scoped_release release;
    return simulate(scene, start, settings, t_end, check_signals);
}

// q and q_dot, (n, 5), of the multiplier model at each time.
py::tuple sample_coordinates(const Solution& solution, const Array& t) {
    const py::ssize_t n = t.size();
    Array q = matrix(n, 5);
    Array q_dot = matrix(n, 5);
    const double* const times = t.data();
    std::vector<CoordinateState> samples(std::min<std::size_t>(n, chunk));
    run_interruptible(n, 1, [&](py::ssize_t begin, py::ssize_t end) {
        sample(solution, times + begin, end - begin, samples.data());
        for (py::ssize_t i = begin; i < end; ++i) {
            store(q, i, samples[i - begin].q.data());
            store(q_dot, i, samples[i - begin].q_dot.data());
        }
    });
    return py::make_tuple(q, q_dot);
}

// theta, omega, x, z, x_dot, z_dot, normal and friction force, mode of the contact model.
py::tuple sample_contact(const Solution& solution, const Array& t) {
    const py::ssize_t n = t.size();
    std::vector<Array> out = empty_arrays(8, n);
    std::array<double*, 8> columns{};
    std::transform(out.begin(), out.end(), columns.begin(),
                   [](Array& array) { return array.mutable_data(); });
    py::array_t<std::int8_t> mode(n);
    std::int8_t* const modes = mode.mutable_data();
    const double* const times = t.data();
    std::vector<ContactSample> samples(std::min<std::size_t>(n, chunk));
    run_interruptible(n, 1, [&](py::ssize_t begin, py::ssize_t end) {
        sample(solution, times + begin, end - begin, samples.data());
        for (py::ssize_t i = begin; i < end; ++i) {
            const auto& [s, force] = samples[i - begin];
            const double row[] = {s.theta, s.omega, s.x,          s.z,
                                  s.x_dot, s.z_dot, force.normal, force.friction};
            for (std::size_t column = 0; column < columns.size(); ++column) {
                columns[column][i] = row[column];
            }
            modes[i] = static_cast<std::int8_t>(s.mode);
        }
    });
    return py::make_tuple(out[0], out[1], out[2], out[3], out[4], out[5], out[6], out[7], mode);
}

// q, q_dot, q_ddot and multipliers that follow from the first eight of those.
py::tuple contact_arrays(const Scene& scene, const std::array<Array, 8>& columns) {
    const py::ssize_t n = columns[0].size();
    Array q = matrix(n, 5);
    Array q_dot = matrix(n, 5);
    Array q_ddot = matrix(n, 5);
    Array multipliers = matrix(n, 4);
    run_interruptible(n, 1, [&](py::ssize_t begin, py::ssize_t end) {
        for (py::ssize_t i = begin; i < end; ++i) {
            const auto of = [&](std::size_t column) { return columns[column].data()[i]; };
            const State state{of(0), of(1), of(2), of(3), of(4), of(5), Mode::flight};
            const CoordinateState at = coordinate_state({scene.a, scene.b}, state);
            const MultiplierSolution found = accelerations(scene, at, ContactForce{of(6), of(7)});
            store(q, i, at.q.data());
            store(q_dot, i, at.q_dot.data());
            store(q_ddot, i, found.q_ddot.data());
            store(multipliers, i, found.multipliers.data());
        }
    });
    return py::make_tuple(q, q_dot, q_ddot, multipliers);
}

py::tuple state_tuple(const State& s) {
    return py::make_tuple(s.theta, s.omega, s.x, s.z, s.x_dot, s.z_dot, s.mode);
}

py::list event_list(const Solution& solution) {
    py::list events;
    if (const auto* motion = std::get_if<ContactMotion>(&solution.motion)) {
        for (const Event& event : motion->events) {
            events.append(py::make_tuple(event.t, event.kind, state_tuple(event.before),
                                         state_tuple(event.after)));
        }
    }
    return events;
}

std::size_t segment_count(const Solution& solution) {
    const auto* motion = std::get_if<ContactMotion>(&solution.motion);
    return motion ? motion->arcs.size() : 1;
}

// q_ddot and multipliers of the multiplier model.
py::tuple multiplier_arrays(const Scene& scene, const Settings& settings, const Array& q,
                            const Array& q_dot) {
    const py::ssize_t n = q.shape(0);
    const ConstrainedBody body(scene);
    Array q_ddot = matrix(n, 5);
    Array multipliers = matrix(n, 4);
    run_interruptible(n, 1, [&](py::ssize_t begin, py::ssize_t end) {
        for (py::ssize_t i = begin; i < end; ++i) {
            const MultiplierSolution solution =
                accelerations(body, settings, state_at(q, q_dot, i));
            store(q_ddot, i, solution.q_ddot.data());
            store(multipliers, i, solution.multipliers.data());
        }
    });
    return py::make_tuple(q_ddot, multipliers);
}

// The nearest state that meets the constraints.
py::tuple projected(const Scene& scene, const Array& q, const Array& q_dot) {
    CoordinateState state = state_at(q, q_dot, 0);
    ConstrainedBody(scene).project(state.q, state.q_dot);
    return py::make_tuple(Array(5, state.q.data()), Array(5, state.q_dot.data()));
}

// The constraint matrix, row after row, and the drift term.
py::tuple constraint_system(const Array& q, const Array& q_dot, double a, double b) {
    validate_axes(a, b);
    const py::ssize_t n = q.shape(0);
    Array rows = matrix(n, 20);
    Array drift = matrix(n, 4);
    for (py::ssize_t i = 0; i < n; ++i) {
        const CoordinateState state = state_at(q, q_dot, i);
        const Eigen::Matrix<double, 5, 4> columns = constraint_matrix({a, b}, state.q).transpose();
        store(rows, i, columns.data());
        store(drift, i, constraint_drift({a, b}, state.q, state.q_dot).data());
    }
    return py::make_tuple(rows, drift);
}

// q and q_dot as (n, 5); the caller has checked the shapes.
py::tuple constraint_arrays(const Array& q, const Array& q_dot, double a, double b) {
    validate_axes(a, b);
    const py::ssize_t n = q.shape(0);
    Array position = matrix(n, 3);
    Array velocity = matrix(n, 4);
    Array gap(n);
    Array slip(n);
    double* const gaps = gap.mutable_data();
    double* const slips = slip.mutable_data();
    run_interruptible(n, 1, [&](py::ssize_t begin, py::ssize_t end) {
        for (py::ssize_t i = begin; i < end; ++i) {
            const ConstraintResiduals residuals =
                constraints({a, b}, Eigen::Map<const Coordinates>(q.data(i, 0)),
                            Eigen::Map<const Coordinates>(q_dot.data(i, 0)));
            store(position, i, residuals.position.data());
            store(velocity, i, residuals.velocity.data());
            gaps[i] = residuals.gap;
            slips[i] = residuals.slip;
        }
    });
    return py::make_tuple(position, velocity, gap, slip);
}

py::tuple kinematics_arrays(py::ssize_t n, const Array& theta, const Array& omega, double a,
                            double b) {
    validate_axes(a, b);
    const Argument thetas = argument(theta);
    const Argument omegas = argument(omega);
    Array q = matrix(n, 5);
    Array q_dot = matrix(n, 5);
    run_interruptible(n, 1, [&](py::ssize_t begin, py::ssize_t end) {
        for (py::ssize_t i = begin; i < end; ++i) {
            const KinematicState state = kinematics({a, b}, thetas[i], omegas[i]);
            store(q, i, state.q.data());
            store(q_dot, i, state.q_dot.data());
        }
    });
    return py::make_tuple(q, q_dot);
}

// q (its x replaced by the one given), q_dot, q_ddot, normal and friction force, multipliers.
py::tuple rolling_arrays(const Scene& scene, const Array& theta, const Array& omega,
                         const Array& x) {
    const py::ssize_t n = theta.size();
    Array q = matrix(n, 5);
    Array q_dot = matrix(n, 5);
    Array q_ddot = matrix(n, 5);
    Array multipliers = matrix(n, 4);
    Array normal(n);
    Array friction(n);
    double* const normals = normal.mutable_data();
    double* const frictions = friction.mutable_data();
    run_interruptible(n, 1, [&](py::ssize_t begin, py::ssize_t end) {
        for (py::ssize_t i = begin; i < end; ++i) {
            RollingDetail detail = rolling_detail(scene, theta.data()[i], omega.data()[i]);
            detail.state.q[coordinate::x] = x.data()[i];
            store(q, i, detail.state.q.data());
            store(q_dot, i, detail.state.q_dot.data());
            store(q_ddot, i, detail.q_ddot.data());
            store(multipliers, i, detail.multipliers.data());
            normals[i] = detail.force.normal;
            frictions[i] = detail.force.friction;
        }
    });
    return py::make_tuple(q, q_dot, q_ddot, normal, friction, multipliers);
}

// theta'' of rolling at each angle and angular velocity, and its derivatives by both.
py::tuple rolling_equation_arrays(const Scene& scene, const Array& theta, const Array& omega) {
    const RollingEquation equation(scene.body(), scene.slope);
    const py::ssize_t n = theta.size();
    Array acceleration(n);
    Array jacobian = matrix(n, 2);
    double* const accelerations = acceleration.mutable_data();
    run_interruptible(n, 1, [&](py::ssize_t begin, py::ssize_t end) {
        for (py::ssize_t i = begin; i < end; ++i) {
            const Vector<2> y{theta.data()[i], omega.data()[i]};
            accelerations[i] = equation(0.0, y)[1];
            const Vector<2> row = equation.jacobian(0.0, y).row(1);
            store(jacobian, i, row.data());
        }
    });
    return py::make_tuple(acceleration, jacobian);
}

// A function of theta, a, b, each with n elements, or one.
template <class Function>
void define_geometry(py::module_& module, const char* name, Function function) {
    module.def(
        name,
        [function](py::ssize_t n, const std::array<Array, 3>& arguments) {
            const Argument theta = argument(arguments[0]);
            const Argument a = argument(arguments[1]);
            const Argument b = argument(arguments[2]);
            Array out(n);
            double* const values = out.mutable_data();
            run_interruptible(n, 1, [&](py::ssize_t begin, py::ssize_t end) {
                for (py::ssize_t i = begin; i < end; ++i) {
                    validate_axes(a[i], b[i]);
                    values[i] = function(Axes{a[i], b[i]}, theta[i]);
                }
            });
            return out;
        },
        "n"_a, "arguments"_a);
}

void bind_geometry(py::module_& m) {
    define_geometry(m, "support", [](const Axes& e, double t) { return geometry(e, t).h; });
    define_geometry(m, "support_slope", [](const Axes& e, double t) { return geometry(e, t).dh; });
    define_geometry(m, "support_curvature",
                    [](const Axes& e, double t) { return geometry(e, t).ddh; });
    define_geometry(m, "curvature_radius",
                    [](const Axes& e, double t) { return geometry(e, t).rho; });
    define_geometry(m, "contact_distance",
                    [](const Axes& e, double t) { return contact_distance(e, geometry(e, t)); });
    define_geometry(m, "contact_angle", contact_angle);
    define_geometry(m, "centre_path", centre_path);
    define_geometry(m, "arc_length", arc_length);
}

void bind_scene(py::module_& m) {
    py::native_enum<Mode>(m, "Mode", "enum.IntEnum", "What the body does, one code a sample.")
        .value("ROLLING", Mode::rolling)
        .value("SLIDING", Mode::sliding)
        .value("FLIGHT", Mode::flight)
        .value("REST", Mode::rest)
        .finalize();
    py::class_<Impulse>(m, "Impulse")
        .def(py::init([](double jx, double jz, double dx, double dz) {
                 const Impulse impulse{jx, jz, dx, dz};
                 validate(impulse);
                 return impulse;
             }),
             "jx"_a, "jz"_a, "dx"_a, "dz"_a);
    py::class_<Scene>(m, "Scene")
        .def(py::init([](double a, double b, double mass, double gravity,
                         std::optional<double> inertia, double slope, double friction,
                         double restitution, double theta, double omega, double x,
                         std::optional<double> z, std::optional<double> x_dot,
                         std::optional<double> z_dot, std::optional<Impulse> impulse) {
                 const Scene scene{a,
                                   b,
                                   mass,
                                   gravity,
                                   inertia.value_or(mass * uniform_disc_gyration2(a, b)),
                                   slope,
                                   friction,
                                   restitution,
                                   theta,
                                   omega,
                                   x,
                                   z,
                                   x_dot,
                                   z_dot,
                                   impulse};
                 validate(scene);
                 return scene;
             }),
             py::kw_only(), "a"_a, "b"_a, "mass"_a, "gravity"_a, "inertia"_a, "slope"_a,
             "friction"_a, "restitution"_a, "theta"_a, "omega"_a, "x"_a, "z"_a, "x_dot"_a,
             "z_dot"_a, "impulse"_a)
        .def_property_readonly("gyration2", [](const Scene& s) { return s.body().gyration2; });
    m.def("initial_state", [](const Scene& scene) {
        const InitialState initial = initial_state(scene);
        const State& s = initial.state;
        return py::make_tuple(s.theta, s.omega, s.x, s.z, s.x_dot, s.z_dot, s.mode,
                              initial.reaction_x, initial.reaction_z, initial.free_omega);
    });
}

void bind_certificate(py::module_& m) {
    py::native_enum<Validity>(m, "Validity", "enum.Enum", "Is rolling valid for the whole motion?")
        .value("VALID", Validity::valid)
        .value("INVALID", Validity::invalid)
        .value("EDGE", Validity::edge)
        .value("NO_PROOF", Validity::no_proof)
        .finalize();
    py::native_enum<Outcome>(m, "Outcome", "enum.IntEnum", "What a rolling body comes to first.")
        .value("RESTS", Outcome::rests)
        .value("ROCKS", Outcome::rocks)
        .value("ROLLS_OVER", Outcome::rolls_over)
        .value("SLIPS", Outcome::slips)
        .value("LOSES_CONTACT", Outcome::loses_contact)
        .value("JAMS", Outcome::jams)
        .value("EDGE", Outcome::edge)
        .finalize();
    m.def("classify_array", classify_array, "n"_a, "arguments"_a, "workers"_a);
    m.def("certify", [](const Scene& scene) {
        const CertifiedScene certified = certify(scene);
        const Certificate& c = certified.certificate;
        return py::make_tuple(c.end.validity, c.smallest_normal_force,
                              c.smallest_normal_force_angle, c.largest_friction_needed,
                              c.largest_friction_needed_angle, c.end.angle, certified.reason);
    });
    m.def(
        "thresholds",
        [](double a, double b, double gravity, std::optional<double> gyration2, double friction) {
            const Body body{a, b, gyration2.value_or(uniform_disc_gyration2(a, b)), gravity};
            validate(body);
            validate_friction(friction);
            const Thresholds t = thresholds(body, friction);
            return py::make_tuple(t.roll_over_speed, t.contact_loss_speed, t.contact_loss_angle,
                                  t.slip_speed, t.slip_angle, t.lift_off_speed,
                                  t.friction_to_roll_over, t.painleve_friction, t.painleve_angle,
                                  t.rocking_rate, t.tip_rate);
        },
        "a"_a, "b"_a, "gravity"_a, "gyration2"_a, "friction"_a);
}

// Numbers of the methods, for those who want to check them.
template <std::size_t N>
Array array(const double (&values)[N]) {
    return Array(N, values);
}

template <std::size_t Rows, std::size_t Columns>
Array array(const double (&values)[Rows][Columns]) {
    return Array(std::vector<py::ssize_t>{Rows, Columns}, values[0]);
}

template <class T>
py::dict explicit_tableau() {
    return py::dict("order"_a = T::order, "stages"_a = T::stages, "c"_a = array(T::c),
                    "a"_a = array(T::a), "error_estimates"_a = T::error_estimates,
                    "error"_a = array(T::error), "dense_terms"_a = T::dense_terms,
                    "dense"_a = array(T::dense));
}

template <class T>
py::dict gauss_tableau() {
    return py::dict("c"_a = array(T::c), "b"_a = array(T::b), "mu"_a = array(T::mu),
                    "nu"_a = array(T::nu));
}

template <class T>
py::dict radau_tableau() {
    return py::dict("c"_a = array(T::c), "a"_a = array(T::a), "gamma"_a = T::gamma,
                    "alpha"_a = T::alpha, "beta"_a = T::beta, "transform"_a = array(T::transform),
                    "inverse_transform"_a = array(T::inverse_transform));
}

void bind_tableaus(py::module_& m) {
    m.def("tableaus", [] {
        return py::dict("rk4"_a = explicit_tableau<RungeKutta4>(),
                        "dopri5"_a = explicit_tableau<DormandPrince5>(),
                        "dop853"_a = explicit_tableau<DormandPrince853>(),
                        "gauss2"_a = gauss_tableau<GaussCoefficients<2>>(),
                        "gauss3"_a = gauss_tableau<GaussCoefficients<3>>(),
                        "gauss4"_a = gauss_tableau<GaussCoefficients<4>>(),
                        "radau"_a = radau_tableau<RadauCoefficients>());
    });
}

void bind_motion(py::module_& m) {
    py::native_enum<Model>(m, "Model", "enum.Enum", "How the motion is described.")
        .value("AUTO", Model::automatic)
        .value("ROLLING", Model::rolling)
        .value("MULTIPLIERS", Model::multipliers)
        .value("CONTACT", Model::contact)
        .finalize();
    py::native_enum<Stabilization>(m, "Stabilization", "enum.Enum", "How constraints are kept.")
        .value("NONE", Stabilization::none)
        .value("BAUMGARTE", Stabilization::baumgarte)
        .value("PROJECTION", Stabilization::projection)
        .value("PROJECTION_ENERGY", Stabilization::projection_energy)
        .value("GGL", Stabilization::ggl)
        .finalize();
    py::native_enum<EventKind>(m, "EventKind", "enum.Enum", "What changes at an event.")
        .value("SLIP", EventKind::slip)
        .value("STICK", EventKind::stick)
        .value("REVERSE", EventKind::reverse)
        .value("LIFT_OFF", EventKind::lift_off)
        .value("IMPACT", EventKind::impact)
        .value("REST", EventKind::rest)
        .value("JAM", EventKind::jam)
        .finalize();
    py::native_enum<Method>(m, "Method", "enum.Enum", "How the model is solved.")
        .value("AUTO", Method::automatic)
        .value("EXACT", Method::exact)
        .value("DOP853", Method::dop853)
        .value("DOPRI5", Method::dopri5)
        .value("RK4", Method::rk4)
        .value("GAUSS", Method::gauss)
        .value("RADAU", Method::radau)
        .finalize();
    py::native_enum<Status>(m, "Status", "enum.Enum", "How a simulation ended.")
        .value("COMPLETED", Status::completed)
        .value("JAMMED", Status::jammed)
        .value("VALIDITY_LOST", Status::validity_lost)
        .value("MAX_EVENTS", Status::max_events)
        .value("MAX_STEPS", Status::max_steps)
        .value("STEP_TOO_SMALL", Status::step_too_small)
        .value("STEP_TOO_LARGE", Status::step_too_large)
        .finalize();
    py::class_<Settings>(m, "Settings")
        .def(py::init([](Model model, Method method, double rtol, double atol,
                         std::optional<double> step, std::optional<int> stages,
                         Stabilization stabilization, std::array<double, 2> baumgarte,
                         long max_steps, long max_events, std::optional<double> rest_speed) {
                 return Settings{model,        method,    rtol,          atol,
                                 step,         stages,    stabilization, baumgarte[0],
                                 baumgarte[1], max_steps, max_events,    rest_speed};
             }),
             py::kw_only(), "model"_a, "method"_a, "rtol"_a, "atol"_a, "step"_a, "stages"_a,
             "stabilization"_a, "baumgarte"_a, "max_steps"_a, "max_events"_a, "rest_speed"_a);
    py::class_<Solution>(m, "Solution")
        .def_readonly("status", &Solution::status)
        .def_readonly("followed_until", &Solution::followed_until)
        .def_readonly("valid_until", &Solution::valid_until)
        .def_readonly("reason", &Solution::reason)
        .def_readonly("message", &Solution::message)
        .def_readonly("model", &Solution::model)
        .def_readonly("method", &Solution::method)
        .def_property_readonly("stats",
                               [](const Solution& s) {
                                   return py::dict("segments"_a = segment_count(s),
                                                   "steps"_a = s.counts.steps,
                                                   "rejected_steps"_a = s.counts.rejected,
                                                   "evaluations"_a = s.counts.evaluations);
                               })
        .def("sample", sample_solution, "t"_a)
        .def("sample_coordinates", sample_coordinates, "t"_a)
        .def("sample_contact", sample_contact, "t"_a)
        .def_property_readonly("events", event_list);
    m.def("simulate", simulate_interruptible, "scene"_a, "settings"_a, "t_end"_a);
    m.def("simulate_coordinates", simulate_coordinates, "scene"_a, "q"_a, "q_dot"_a, "settings"_a,
          "t_end"_a);
    m.def("multiplier_detail", multiplier_arrays, "scene"_a, "settings"_a, "q"_a, "q_dot"_a);
    m.def("contact_detail", contact_arrays, "scene"_a, "columns"_a);
    m.def("project", projected, "scene"_a, "q"_a, "q_dot"_a);
    m.def("constraint_system", constraint_system, "q"_a, "q_dot"_a, "a"_a, "b"_a);
    m.def("period", py::overload_cast<const Scene&>(period), "scene"_a);
    m.def("flow_scalar", flow_scalar, "t"_a, "a"_a, "b"_a, "theta"_a, "omega"_a, "gravity"_a,
          "gyration2"_a);
    m.def("flow_times", flow_times, "t"_a, "a"_a, "b"_a, "theta"_a, "omega"_a, "gravity"_a,
          "gyration2"_a, "workers"_a);
    m.def("flow_array", flow_array, "n"_a, "arguments"_a, "workers"_a);
    m.def("collide_arrays", collide_arrays, "n"_a, "arguments"_a);
    m.def("constraints", constraint_arrays, "q"_a, "q_dot"_a, "a"_a, "b"_a);
    m.def("kinematics", kinematics_arrays, "n"_a, "theta"_a, "omega"_a, "a"_a, "b"_a);
    m.def("rolling_equation", rolling_equation_arrays, "scene"_a, "theta"_a, "omega"_a);
    m.def("rolling_detail", rolling_arrays, "scene"_a, "theta"_a, "omega"_a, "x"_a);
}

}  // namespace

PYBIND11_MODULE(_core, m) {
    m.doc() = "C++ core of rolling_ellipse; see the Python package for the documented interface.";
    bind_geometry(m);
    bind_scene(m);
    bind_certificate(m);
    bind_tableaus(m);
    bind_motion(m);
}
