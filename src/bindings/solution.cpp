#include <algorithm>

#include "bindings/bindings.hpp"
#include "multipliers/steps.hpp"
#include "outcome/passages.hpp"
#include "simulate.hpp"

namespace rolling_ellipse::bindings {
namespace {

// Rejects times at which the solution is unknown: all times if the motion has no segments.
void validate_times(const Solution& solution, const double* times, py::ssize_t begin,
                    py::ssize_t end) {
    if (begin < end && solution.motion.segments.empty()) {
        throw std::invalid_argument("t must be empty, for the motion ended before it began: " +
                                    solution.message);
    }
    for (py::ssize_t i = begin; i < end; ++i) {
        if (times[i] >= 0 && times[i] <= solution.followed_until) continue;
        refuse("t", "within [0, " + text(solution.followed_until) + "] [s]", times[i]);
    }
}

// Whether t contains valid sample times: at least one, finite, not negative, strictly ascending.
bool are_sample_times(const Array& t) {
    if (t.ndim() != 1 || t.size() == 0) return false;
    const double* const times = t.data();
    for (py::ssize_t i = 1; i < t.size(); ++i) {
        if (!(times[i] > times[i - 1])) return false;
    }
    return times[0] >= 0 && times[t.size() - 1] < infinity;
}

// Sample times as an array, if they are valid and given as an array of doubles or a list of plain
// floats; None for other arguments, which may still be convertible.
py::object sample_times(const py::object& t) {
    Array times;
    if (Py_TYPE(t.ptr()) == py::detail::npy_api::get().PyArray_Type_) {
        const auto array = py::reinterpret_borrow<py::array>(t);
        if (!array.dtype().is(py::dtype::of<double>())) return py::none();
        times = Array(array);  // the array itself, if contiguous and aligned
    } else if (PyList_CheckExact(t.ptr())) {
        const py::tuple given(t);  // another thread may change the list
        times = vector(given.size());
        double* to = times.mutable_data();
        for (const py::handle each : given) {
            if (!PyFloat_CheckExact(each.ptr())) return py::none();
            *to++ = PyFloat_AS_DOUBLE(each.ptr());
        }
    }
    return are_sample_times(times) ? times : py::object(py::none());
}

// Calls take(samples, begin, end) with the samples at all times, one batch after another.
template <class Sample, class Take>
void take_samples(const Solution& solution, const Array& t, const Take& take) {
    const py::ssize_t n = t.size();
    const double* const times = t.data();
    const Sampler sampler(solution.motion, n);
    std::vector<Sample> samples(std::min<std::size_t>(n, chunk));
    run_interruptible(n, 1, [&](py::ssize_t begin, py::ssize_t end) {
        validate_times(solution, times, begin, end);
        sampler(times + begin, end - begin, samples.data());
        take(samples.data(), begin, end);
    });
}

// Returns the times, and theta, omega and x at each.
py::tuple rolling_samples(const Solution& solution, const Array& t) {
    FlowArrays out(t.size());
    const double* const times = t.data();
    const Sampler sampler(solution.motion, t.size());
    run_interruptible(t.size(), 1, [&](py::ssize_t begin, py::ssize_t end) {
        validate_times(solution, times, begin, end);
        sampler(times + begin, end - begin, out.columns.from(begin));
    });
    return py::make_tuple(read_only(t), read_only(out.theta), read_only(out.omega),
                          read_only(out.x));
}

// Returns the times, and q and q_dot, (n, 5), at each.
py::tuple coordinate_samples(const Solution& solution, const Array& t) {
    Array q = matrix(t.size(), 5);
    Array q_dot = matrix(t.size(), 5);
    const auto take = [&](const CoordinateState* samples, py::ssize_t begin, py::ssize_t end) {
        for (py::ssize_t i = begin; i < end; ++i) {
            store(q, i, samples[i - begin].q.data());
            store(q_dot, i, samples[i - begin].q_dot.data());
        }
    };
    take_samples<CoordinateState>(solution, t, take);
    return py::make_tuple(read_only(t), read_only(q), read_only(q_dot));
}

// Returns the times, and the values of state and force and the mode at each.
py::tuple contact_samples(const Solution& solution, const Array& t) {
    constexpr std::size_t numbers = std::size(state_fields) + std::size(force_fields);
    py::tuple arrays(numbers + 2);
    py::array_t<std::int8_t> mode(t.size());
    ContactColumns columns{std::vector<double*>(numbers), mode.mutable_data()};
    arrays[0] = read_only(t);
    for (std::size_t i = 0; i < numbers; ++i) {
        Array column = vector(t.size());
        columns.numbers[i] = column.mutable_data();
        arrays[i + 1] = read_only(column);
    }
    take_samples<ContactSample>(
        solution, t, [&](const ContactSample* samples, py::ssize_t begin, py::ssize_t end) {
            columns.store(samples, begin, end);
        });
    arrays[numbers + 1] = read_only(mode);
    return arrays;
}

// Read-only arrays of the times and of the samples at these times: theta, omega, x for rolling; q,
// q_dot for the multiplier model; the values of states and forces, and the modes, for contact.
py::tuple samples(const Solution& solution, const double* times, py::ssize_t n) {
    Array t = vector(n);
    std::copy_n(times, n, t.mutable_data());
    if (solution.model == Model::contact) return contact_samples(solution, t);
    if (solution.model == Model::multipliers) return coordinate_samples(solution, t);
    return rolling_samples(solution, t);
}

// A solution up to the last time, and its samples at all times that it reaches. If q and q_dot are
// given, the motion starts from them rather than from the scene's start.
py::tuple solved(const Scene& scene, const Settings& settings, const Array& t,
                 const std::optional<std::pair<Array, Array>>& start) {
    require_length("t", t, std::max<py::ssize_t>(t.size(), 1));
    const double* const times = t.data();
    const double t_end = times[t.size() - 1];
    std::optional<CoordinateState> from;
    if (start) from = single_state(start->first, start->second);
    Solution solution = [&] {
        const GilRelease release;
        return from ? simulate(scene, *from, settings, t_end, SignalWatch())
                    : simulate(scene, settings, t_end, SignalWatch());
    }();
    const py::tuple found = samples(solution, times, reached(solution, times, t.size()));
    return py::make_tuple(std::move(solution), found);
}

// A sample at one time: its values, named like the arrays of a motion, and its mode.
py::dict sample_at(const Solution& solution, const Scene& scene, const Settings& settings,
                   double t) {
    validate_times(solution, &t, 0, 1);
    const Sampler sampler(solution.motion, 1);
    ContactSample sample;
    sampler(&t, 1, &sample);
    const State& state = sample.state;
    CoordinateState at = coordinate_state(scene.axes(), state);
    if (solution.model == Model::multipliers) {
        sampler(&t, 1, &at);
        const Eigen::Vector4d forces =
            accelerations(ConstrainedBody(scene), settings, at).multipliers;
        sample.force = {forces[1], forces[0]};
    }
    py::dict found;
    for (const auto& field : state_fields) found[field.name] = state.*field.number;
    for (const auto& field : force_fields) found[field.name] = sample.force.*field.number;
    found["contact_x"] = state.x + geometry(scene.axes(), state.theta).dh;
    found["psi"] = at.q[coordinate::psi];
    found["r"] = at.q[coordinate::r];
    found["mode"] = static_cast<int>(state.mode);
    return found;
}

// An array of times for each value, and phrases that say where times may be missing.
py::tuple lists(const Passages& passages) {
    py::list times;
    for (const std::vector<double>& each : passages.times) times.append(array_of(each));
    return py::make_tuple(times, passages.unproved);
}

py::tuple passages_of(const Solution& solution, Quantity quantity,
                      const std::vector<double>& values, int direction) {
    const Motion& motion = solution.motion;
    const Checkpoint checkpoint = SignalWatch();
    const Observable of = observable(motion, quantity, checkpoint);
    Passages found;
    {
        const GilRelease release;
        found = passages(motion, solution.followed_until, of, values, direction, checkpoint);
    }
    return lists(found);
}

// Times of the zeros of a function that maps an array of times to an array of values.
py::tuple zeros_of(const Solution& solution, const py::function& function, int direction) {
    const Measure measure = [&](const std::vector<double>& times) {
        const Array values = function(array_of(times));
        return std::vector<double>(values.data(), values.data() + values.size());
    };
    const Observable of{std::nullopt, measure, 0.0};
    return lists(passages(solution.motion, solution.followed_until, of, {0.0}, direction, [] {}));
}

py::dict stats(const Solution& solution) {
    py::dict found;
    for (const auto& [name, value] : stats_of(solution.motion.segments.size(), solution.counts)) {
        found[name] = value;
    }
    return found;
}

// The losses of an integrated motion (energy, constraints, projected); None for other solutions.
py::object losses_in(const Solution& solution) {
    const std::optional<Losses> found = losses(solution);
    if (!found) return py::none();
    return py::make_tuple(found->energy, found->constraints, found->projected);
}

// The state just before or just after an event, and the code of its mode.
py::dict event_state(const EventRow& row, bool after) {
    const auto& [t, kind, before, start] = event_of(row);
    const InitialState& state = after ? start : InitialState{before, 0.0, 0.0, before.omega};
    py::dict found = numbers_of(state);
    found["mode"] = static_cast<int>(state.state.mode);
    return found;
}

}  // namespace

py::tuple event_columns() {
    py::list names;
    names.append("t");
    names.append("kind");
    for (const char* when : {"_before", "_after"}) {
        for (const auto& field : state_fields) names.append(std::string(field.name) + when);
        names.append(std::string("mode") + when);
    }
    for (const auto& field : start_fields) names.append(field.name);
    return names;
}

Array event_rows(const std::vector<Event>& events) {
    Array table = matrix(events.size(), event_numbers);
    double* to = table.mutable_data();
    for (const Event& event : events) {
        *to++ = event.t;
        *to++ = static_cast<int>(event.kind);
        for (const State* state : {&event.before, &event.after.state}) {
            for (const auto& field : state_fields) *to++ = state->*field.number;
            *to++ = static_cast<int>(state->mode);
        }
        for (const auto& field : start_fields) *to++ = event.after.*field.number;
    }
    return table;
}

py::ssize_t reached(const Solution& solution, const double* times, py::ssize_t n) {
    if (solution.motion.segments.empty()) return 0;
    return std::upper_bound(times, times + n, solution.followed_until) - times;
}

Event event_of(const EventRow& row) {
    Event event{row[0], static_cast<EventKind>(row[1]), {}, {}};
    const double* from = row.data() + 2;
    for (State* state : {&event.before, &event.after.state}) {
        from = read(*state, state_fields, from);
        state->mode = static_cast<Mode>(*from++);
    }
    read(event.after, start_fields, from);
    return event;
}

void ContactColumns::store(const ContactSample* samples, py::ssize_t begin, py::ssize_t end) const {
    auto column = numbers.begin();
    const auto fill = [&](const auto& table, const auto& part) {
        for (const auto& field : table) {
            double* const values = *column++;
            for (py::ssize_t i = begin; i < end; ++i) {
                values[i] = samples[i - begin].*part.*field.number;
            }
        }
    };
    fill(state_fields, &ContactSample::state);
    fill(force_fields, &ContactSample::force);
    for (py::ssize_t i = begin; i < end; ++i) {
        modes[i] = static_cast<std::int8_t>(samples[i - begin].state.mode);
    }
}

void bind_solution(py::module_& m) {
    bind_enum<EventKind>(m, "EventKind", "enum.IntEnum", "Kind of an event.");
    bind_enum<Ending>(m, "Ending", "enum.Enum", "How a motion ended.");
    bind_enum<Quantity>(m, "Quantity", "enum.Enum", "A quantity of a motion.");
    bind_class<Solution>(m, "Solution")
        .def_property_readonly("ending",
                               [](const Solution& s) { return static_cast<int>(s.ending); })
        .def_readonly("followed_until", &Solution::followed_until)
        .def(
            "valid_until",
            [](const Solution& s, const Scene& scene) { return valid_until(scene, s); }, "scene"_a)
        .def_readonly("message", &Solution::message)
        .def_property_readonly("model", [](const Solution& s) { return name(s.model); })
        .def_property_readonly("method", [](const Solution& s) { return name(s.method); })
        .def_property_readonly("stats", stats)
        .def_property_readonly("events",
                               [](const Solution& s) { return event_rows(s.motion.events); })
        .def("losses", losses_in)
        .def_property_readonly("turns", [](const Solution& s) { return array_of(s.motion.turns); })
        .def("knots", [](const Solution& s) { return array_of(knot_times(s.motion)); })
        .def("passages", passages_of, "quantity"_a, "values"_a, "direction"_a)
        .def("zeros", zeros_of, "function"_a, "direction"_a)
        .def("sample_at", sample_at, "scene"_a, "settings"_a, "t"_a)
        .def(
            "samples",
            [](const Solution& s, const Array& t) {
                require_length("t", t, t.size());
                return samples(s, t.data(), t.size());
            },
            "t"_a);
    m.attr("STATS") = names_of(stats_of(0, {}));
    m.def("event_state", event_state, "row"_a, "after"_a);
    m.def("sample_times", sample_times, "t"_a);
    m.def("simulate", solved, "scene"_a, "settings"_a, "t"_a, "start"_a);
}

}  // namespace rolling_ellipse::bindings
