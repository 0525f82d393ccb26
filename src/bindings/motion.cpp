#include <algorithm>

#include "bindings/bindings.hpp"
#include "scene/refuse.hpp"
#include "simulate.hpp"

namespace rolling_ellipse::bindings {
namespace {

std::size_t segment_count(const Solution& solution) {
    const auto* motion = std::get_if<ContactMotion>(&solution.motion);
    return motion ? motion->arcs.size() : 1;
}

// A solution says nothing of other times than those that it went through, and nothing at all where
// it ended before it began.
void validate_times(const Solution& solution, const double* times, py::ssize_t begin,
                    py::ssize_t end) {
    if (begin < end && segment_count(solution) == 0) {
        throw std::invalid_argument("t must be empty, for the motion ended before its first arc: " +
                                    solution.message);
    }
    for (py::ssize_t i = begin; i < end; ++i) {
        if (times[i] >= 0 && times[i] <= solution.followed_until) continue;
        refuse("t", "within [0, " + text(solution.followed_until) + "] [s]", times[i]);
    }
}

// theta, omega, x at each time.
py::tuple sample_solution(const Solution& solution, const Array& t) {
    const py::ssize_t n = t.size();
    require_length("t", t, n);
    std::vector<Array> out = empty_arrays(3, n);
    double* const columns[] = {out[0].mutable_data(), out[1].mutable_data(), out[2].mutable_data()};
    const double* const times = t.data();
    const RollingSampler sampler(solution, n);
    run_interruptible(n, 1, [&](py::ssize_t begin, py::ssize_t end) {
        validate_times(solution, times, begin, end);
        store_samples(sampler, times, begin, end, columns);
    });
    return py::make_tuple(out[0], out[1], out[2]);
}

Solution simulate_interruptible(const Scene& scene, const Settings& settings, double t_end) {
    const py::gil_scoped_release release;
    return simulate(scene, settings, t_end, SignalWatch());
}

Solution simulate_coordinates(const Scene& scene, const Array& q, const Array& q_dot,
                              const Settings& settings, double t_end) {
    const CoordinateState start = single_state(q, q_dot);
    const py::gil_scoped_release release;
    return simulate(scene, start, settings, t_end, SignalWatch());
}

// q and q_dot, (n, 5), of the multiplier model at each time.
py::tuple sample_coordinates(const Solution& solution, const Array& t) {
    const py::ssize_t n = t.size();
    require_length("t", t, n);
    Array q = matrix(n, 5);
    Array q_dot = matrix(n, 5);
    const double* const times = t.data();
    std::vector<CoordinateState> samples(std::min<std::size_t>(n, chunk));
    run_interruptible(n, 1, [&](py::ssize_t begin, py::ssize_t end) {
        validate_times(solution, times, begin, end);
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
    require_length("t", t, n);
    std::vector<Array> out = empty_arrays(8, n);
    std::array<double*, 8> columns{};
    std::transform(out.begin(), out.end(), columns.begin(),
                   [](Array& array) { return array.mutable_data(); });
    py::array_t<std::int8_t> mode(n);
    std::int8_t* const modes = mode.mutable_data();
    const double* const times = t.data();
    std::vector<ContactSample> samples(std::min<std::size_t>(n, chunk));
    run_interruptible(n, 1, [&](py::ssize_t begin, py::ssize_t end) {
        validate_times(solution, times, begin, end);
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

}  // namespace

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
    py::native_enum<Method>(m, "Method", "enum.Enum", "How the model is solved.")
        .value("AUTO", Method::automatic)
        .value("EXACT", Method::exact)
        .value("DOP853", Method::dop853)
        .value("DOPRI5", Method::dopri5)
        .value("RK4", Method::rk4)
        .value("GAUSS", Method::gauss)
        .value("RADAU", Method::radau)
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
    py::native_enum<Status>(m, "Status", "enum.Enum", "How a simulation ended.")
        .value("COMPLETED", Status::completed)
        .value("JAMMED", Status::jammed)
        .value("VALIDITY_LOST", Status::validity_lost)
        .value("MAX_EVENTS", Status::max_events)
        .value("MAX_STEPS", Status::max_steps)
        .value("STEP_TOO_SMALL", Status::step_too_small)
        .value("STEP_TOO_LARGE", Status::step_too_large)
        .finalize();
    bind_class<Settings>(m, "Settings")
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
    bind_class<Solution>(m, "Solution")
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
}

}  // namespace rolling_ellipse::bindings
