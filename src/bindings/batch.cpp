// Many scenes at once: takes a table of scenes and returns tables of their motions.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "bindings/bindings.hpp"
#include "outcome/outcome.hpp"
#include "simulate.hpp"

namespace rolling_ellipse::bindings {
namespace {

constexpr std::size_t scene_numbers = std::size(scene_fields) + std::size(impulse_fields);
constexpr int refused = -1;  // code of a rejected scene; the codes of Ending are >= 0

// The scene in a row; NaN marks an absent value.
Scene scene_in(const double* row) {
    const auto given = [](double value) {
        return std::isnan(value) ? std::nullopt : std::optional(value);
    };
    SceneNumbers numbers;
    const double* const blow = row + numbers.size();
    std::transform(row, blow, numbers.begin(), given);
    std::optional<Impulse> impulse;
    if (given(*blow)) read(impulse.emplace(), impulse_fields, blow);
    return scene_of(numbers, impulse);
}

Scene scene_in(const double* row, Origin origin) {
    const Scene scene = scene_in(row);
    validate(scene, origin);
    return scene;
}

// Index and message of the first rejected scene; None if all are accepted.
py::object first_refused(const Array& scenes, bool reached) {
    const Origin origin = reached ? Origin::reached : Origin::typed;
    const py::ssize_t n = require_matrix("scenes", scenes, scene_numbers);
    py::ssize_t at = 0;
    try {
        run_interruptible(n, 1, [&](py::ssize_t begin, py::ssize_t end) {
            for (at = begin; at < end; ++at) scene_in(scenes.data(at, 0), origin);
        });
    } catch (const std::invalid_argument& error) {
        return py::make_tuple(at, error.what());
    }
    return py::none();
}

// The motion of a scene as samples and events. Only one of the sample vectors is filled.
struct Answer {
    int ending = refused;
    Solution solution = {};  // the solution without its segments
    py::ssize_t segments = 0;
    py::ssize_t samples = 0;
    std::vector<FlowSample> rolling = {};
    std::vector<ContactSample> contact = {};
    std::vector<CoordinateState> coordinates = {};
};

template <class Sample>
std::vector<Sample> sampled(const Solution& solution, const double* times, py::ssize_t n,
                            const Checkpoint& checkpoint) {
    const Sampler sampler(solution.motion, n);
    std::vector<Sample> samples(n);
    for (py::ssize_t begin = 0; begin < n; begin += chunk) {
        checkpoint();
        sampler(times + begin, std::min(chunk, n - begin), samples.data() + begin);
    }
    return samples;
}

Answer answer(const double* row, const Settings& settings, const double* times, py::ssize_t n,
              const Checkpoint& checkpoint) {
    Answer answer;
    Solution& solution = answer.solution;
    try {
        const Scene scene = scene_in(row, Origin::reached);
        solution = simulate(scene, settings, times[n - 1], checkpoint);
        solution.valid_until = valid_until(scene, solution);
    } catch (const std::invalid_argument& error) {
        solution.message = error.what();
        return answer;
    }
    answer.ending = static_cast<int>(solution.ending);
    answer.segments = solution.motion.segments.size();
    answer.samples = reached(solution, times, n);
    if (solution.model == Model::contact) {
        answer.contact = sampled<ContactSample>(solution, times, answer.samples, checkpoint);
    } else if (solution.model == Model::multipliers) {
        answer.coordinates = sampled<CoordinateState>(solution, times, answer.samples, checkpoint);
    } else {
        answer.rolling = sampled<FlowSample>(solution, times, answer.samples, checkpoint);
    }
    solution.motion.segments = {};
    return answer;
}

// The ending, model and method of an answer as codes, its counts, and the lengths of its lists.
std::vector<Figure> codes_of(const Answer& answer) {
    const Solution& solution = answer.solution;
    std::vector<Figure> codes{{"ending", answer.ending},
                              {"model", static_cast<int>(solution.model)},
                              {"method", static_cast<int>(solution.method)},
                              {"samples", answer.samples},
                              {"events", std::int64_t(solution.motion.events.size())}};
    for (const Figure& each : stats_of(answer.segments, solution.counts)) codes.push_back(each);
    codes.push_back({"letters", std::int64_t(solution.message.size())});
    return codes;
}

// The lists of all answers, concatenated; `part` is a member of Answer or a getter.
template <class Part>
auto joined(std::vector<Answer>& answers, const Part& part) {
    std::vector<typename std::decay_t<decltype(std::invoke(part, answers[0]))>::value_type> all;
    for (Answer& each : answers) {
        const auto list = std::move(std::invoke(part, each));
        all.insert(all.end(), list.begin(), list.end());
    }
    return all;
}

// Codes and times of all answers, one row per scene.
py::dict facts(const std::vector<Answer>& answers) {
    const py::ssize_t n = answers.size();
    py::array_t<std::int64_t> codes({n, static_cast<py::ssize_t>(codes_of({}).size())});
    Array numbers = matrix(n, 2);
    std::int64_t* code = codes.mutable_data();
    for (py::ssize_t i = 0; i < n; ++i) {
        for (const auto& [name, value] : codes_of(answers[i])) *code++ = value;
        const Solution& solution = answers[i].solution;
        const double times[] = {solution.followed_until, solution.valid_until};
        store(numbers, i, times);
    }
    return py::dict("codes"_a = codes, "numbers"_a = numbers);
}

// The names of the columns of each table; for the tables of samples, the names of the rows.
py::dict columns() {
    return py::dict(
        "scenes"_a = names_of(scene_fields, impulse_fields), "codes"_a = names_of(codes_of({})),
        "numbers"_a = py::make_tuple("t_end", "valid_until"), "events"_a = event_columns(),
        "rolling"_a = py::make_tuple("theta", "omega", "x"),
        "contact"_a = names_of(state_fields, force_fields));
}

// The samples of all scenes, concatenated, for each type of sample. Each quantity is a row, except
// that coordinates have one row per sample.
py::dict samples(std::vector<Answer>& answers) {
    const auto rolling = joined(answers, &Answer::rolling);
    const auto contact = joined(answers, &Answer::contact);
    const auto coordinates = joined(answers, &Answer::coordinates);
    Array flow = matrix(3, rolling.size());
    const FlowColumns flow_columns{flow.mutable_data(0), flow.mutable_data(1),
                                   flow.mutable_data(2)};
    for (std::size_t i = 0; i < rolling.size(); ++i) store(rolling[i], flow_columns, i);
    Array touch = matrix(std::size(state_fields) + std::size(force_fields), contact.size());
    py::array_t<std::int8_t> mode(contact.size());
    ContactColumns contact_columns{{}, mode.mutable_data()};
    for (py::ssize_t row = 0; row < touch.shape(0); ++row) {
        contact_columns.numbers.push_back(touch.mutable_data(row));
    }
    contact_columns.store(contact.data(), 0, contact.size());
    const py::tuple q = computed(coordinates.size(), [&](py::ssize_t i) {
        return std::tuple(coordinates[i].q, coordinates[i].q_dot);
    });
    return py::dict("rolling"_a = flow, "contact"_a = touch, "mode"_a = mode, "q"_a = q[0],
                    "q_dot"_a = q[1]);
}

py::dict simulate_table(const Array& scenes, const Settings& settings, const Array& times,
                        int workers) {
    const py::ssize_t n = require_matrix("scenes", scenes, scene_numbers);
    require_length("times", times, std::max<py::ssize_t>(times.size(), 1));
    std::vector<Answer> answers(n);
    run_each(n, workers, [&](py::ssize_t i, const std::function<void()>& checkpoint) {
        answers[i] = answer(scenes.data(i, 0), settings, times.data(), times.size(), checkpoint);
    });
    py::dict tables = facts(answers);
    const std::vector<char> text =
        joined(answers, [](Answer& each) -> auto& { return each.solution.message; });
    tables["text"] = array_of(std::vector<std::int8_t>(text.begin(), text.end()));
    tables["events"] = event_rows(
        joined(answers, [](Answer& each) -> auto& { return each.solution.motion.events; }));
    tables.attr("update")(samples(answers));
    return tables;
}

// The state at the end of a motion, and its time. A motion with too many events ends just after the
// last one. There is no state if the motion ended early for a reason other than a requested stop.
std::pair<std::optional<State>, double> reached_by(const Solution& solution, double t_end) {
    const auto& [events, ending] = std::tie(solution.motion.events, solution.ending);
    if (ending == Ending::max_events) return {events.back().after.state, events.back().t};
    const double t = std::min(t_end, solution.followed_until);
    const bool stopped = ending == Ending::completed || ending == Ending::never;
    if (t < t_end && !stopped) return {std::nullopt, t};
    ContactSample last;
    Sampler(solution.motion, 1)(&t, 1, &last);
    return {last.state, t};
}

// The end of each motion. `states` contains the state, its time and the largest normal impulse of
// the impacts; `codes` contains the mode, the number of events, the kind of the first event, the
// ending and the number of impacts. Missing values are NaN or -1.
py::dict ends_table(const Array& scenes, const Settings& settings, const Array& times,
                    int workers) {
    const py::ssize_t n = require_matrix("scenes", scenes, scene_numbers);
    const py::ssize_t each = times.size() == 1 ? 0 : 1;
    if (each) require_length("times", times, n);
    Array states = matrix(std::size(state_fields) + 2, n);
    py::array_t<std::int32_t> codes({py::ssize_t{5}, n});
    std::fill_n(states.mutable_data(), states.size(), std::numeric_limits<double>::quiet_NaN());
    std::fill_n(codes.mutable_data(), codes.size(), -1);
    const auto end = [&](py::ssize_t i, const Checkpoint& checkpoint) {
        const double t = times.data()[i * each];
        Solution solution;
        try {
            const Scene scene = scene_in(scenes.data(i, 0), Origin::reached);
            solution = simulate(scene, settings, t, checkpoint);
        } catch (const std::invalid_argument&) {
            return;
        }
        const std::vector<Event>& events = solution.motion.events;
        std::int32_t impacts = 0;
        double largest = 0.0;
        for (const Event& event : events) {
            if (event.kind != EventKind::impact) continue;
            ++impacts;
            largest = std::max(largest, event.after.reaction_z);
        }
        codes.mutable_at(1, i) = static_cast<std::int32_t>(events.size());
        if (!events.empty()) codes.mutable_at(2, i) = static_cast<int>(events.front().kind);
        codes.mutable_at(3, i) = static_cast<int>(solution.ending);
        codes.mutable_at(4, i) = impacts;
        if (solution.motion.segments.empty()) return;
        const auto [state, time] = reached_by(solution, t);
        double* to = states.mutable_data() + i;
        for (const auto& field : state_fields) {
            if (state) *to = (*state).*field.number;
            to += n;
        }
        *to = time;
        to[n] = largest;
        if (state) codes.mutable_at(0, i) = static_cast<int>(state->mode);
    };
    run_each(n, workers, end);
    return py::dict("states"_a = states, "codes"_a = codes);
}

// The values of `body_of` for each scene, one row per scene.
Array bodies(const Array& scenes) {
    const py::ssize_t n = require_matrix("scenes", scenes, scene_numbers);
    Array found = matrix(n, body_of({}).size());
    for (py::ssize_t i = 0; i < n; ++i) {
        store(found, i, body_of(scene_in(scenes.data(i, 0))).data());
    }
    return found;
}

// The friction that each body needs to roll forever, or to lie still.
Array friction_table(const Array& scenes, bool to_rest, int workers) {
    const py::ssize_t n = require_matrix("scenes", scenes, scene_numbers);
    Array needed = vector(n);
    double* const to = needed.mutable_data();
    run_each(n, workers, [&](py::ssize_t i, const auto&) {
        const Scene scene = scene_in(scenes.data(i, 0), Origin::typed);
        to[i] = to_rest ? friction_to_rest(scene) : required_friction(scene);
    });
    return needed;
}

}  // namespace

void bind_batch(py::module_& m) {
    m.def("first_refused", first_refused, "scenes"_a, "reached"_a);
    m.def("validate_settings", py::overload_cast<const Settings&, double>(validate), "settings"_a,
          "t_end"_a);
    m.attr("COLUMNS") = columns();
    m.def("ends_table", ends_table, "scenes"_a, "settings"_a, "times"_a, "workers"_a);
    m.def("friction_table", friction_table, "scenes"_a, "to_rest"_a, "workers"_a);
    m.def("bodies", bodies, "scenes"_a);
    m.def("simulate_table", simulate_table, "scenes"_a, "settings"_a, "times"_a, "workers"_a);
}

}  // namespace rolling_ellipse::bindings
