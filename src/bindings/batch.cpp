// Many scenes at once: a table of scenes in, tables of what became of them out.
#include <algorithm>
#include <cmath>

#include "bindings/bindings.hpp"
#include "bindings/samples.hpp"
#include "simulate.hpp"

namespace rolling_ellipse::bindings {
namespace {

using Codes = py::array_t<std::int64_t>;
using Bytes = py::array_t<std::int8_t>;

constexpr py::ssize_t scene_numbers = 18;
constexpr int refused = -1;  // in the place of an Ending

// A row of the table; NaN is what was not given.
Scene scene_of(const double* row, double most) {
    const auto given = [&](int i) {
        return std::isnan(row[i]) ? std::nullopt : std::optional<double>(row[i]);
    };
    Scene scene{};
    scene.a = row[0];
    scene.b = row[1];
    scene.mass = row[2];
    scene.gravity = row[3];
    scene.slope = row[4];
    scene.friction = row[5];
    scene.restitution = row[6];
    scene.theta = row[7];
    scene.omega = row[8];
    scene.x = row[9];
    scene.inertia = given(10).value_or(scene.mass * uniform_disc_gyration2(scene.a, scene.b));
    scene.z = given(11);
    scene.x_dot = given(12);
    scene.z_dot = given(13);
    if (given(14)) scene.impulse = Impulse{row[14], row[15], row[16], row[17]};
    validate(scene, most);
    return scene;
}

// The first scene that is refused, by its place and with the reason; None where none is.
py::object first_refused(const Array& scenes, bool reached) {
    const double most = reached ? most_energy_reached : most_energy;
    const py::ssize_t n = require_matrix("scenes", scenes, scene_numbers);
    py::ssize_t at = 0;
    try {
        run_interruptible(n, 1, [&](py::ssize_t begin, py::ssize_t end) {
            for (at = begin; at < end; ++at) scene_of(scenes.data(at, 0), most);
        });
    } catch (const std::invalid_argument& error) {
        return py::make_tuple(at, error.what());
    }
    return py::none();
}

// What became of a scene, without the means to look at other times. Samples are of one kind.
struct Answer {
    int ending = refused;
    Solution solution = {};  // its motion keeps the events only
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
    Answer found;
    Solution& solution = found.solution;
    try {
        solution = simulate(scene_of(row, most_energy_reached), settings, times[n - 1], checkpoint);
    } catch (const std::invalid_argument& error) {
        solution.message = error.what();
        return found;
    }
    found.ending = static_cast<int>(solution.ending);
    found.segments = solution.motion.segments.size();
    if (found.segments) {
        found.samples = std::upper_bound(times, times + n, solution.followed_until) - times;
    }
    if (solution.model == Model::contact) {
        found.contact = sampled<ContactSample>(solution, times, found.samples, checkpoint);
    } else if (solution.model == Model::multipliers) {
        found.coordinates = sampled<CoordinateState>(solution, times, found.samples, checkpoint);
    } else {
        found.rolling = sampled<FlowSample>(solution, times, found.samples, checkpoint);
    }
    solution.motion.segments = {};
    return found;
}

py::ssize_t total(const std::vector<Answer>& answers, py::ssize_t (*count)(const Answer&)) {
    py::ssize_t sum = 0;
    for (const Answer& each : answers) sum += count(each);
    return sum;
}

// How each ended, one row a scene.
py::dict facts(const std::vector<Answer>& answers) {
    const py::ssize_t n = answers.size();
    Codes codes({n, py::ssize_t{10}});
    Array numbers = matrix(n, 2);
    Bytes text(total(
        answers, [](const Answer& each) -> py::ssize_t { return each.solution.message.size(); }));
    std::int8_t* letters = text.mutable_data();
    for (py::ssize_t i = 0; i < n; ++i) {
        const auto& [ending, solution, segments, samples, r, c, q] = answers[i];
        const auto& [steps, rejected, evaluations] = solution.counts;
        const std::int64_t row[] = {
            ending,
            static_cast<int>(solution.model),
            static_cast<int>(solution.method),
            samples,
            static_cast<std::int64_t>(solution.motion.events.size()),
            segments,
            steps,
            rejected,
            evaluations,
            static_cast<std::int64_t>(solution.message.size()),
        };
        std::copy(std::begin(row), std::end(row), codes.mutable_data(i, 0));
        const double times[] = {solution.followed_until, solution.valid_until};
        store(numbers, i, times);
        letters = std::copy(solution.message.begin(), solution.message.end(), letters);
    }
    return py::dict("codes"_a = codes, "numbers"_a = numbers, "text"_a = text);
}

Array event_table(const std::vector<Answer>& answers) {
    Array table = matrix(
        total(answers,
              [](const Answer& each) -> py::ssize_t { return each.solution.motion.events.size(); }),
        event_numbers);
    double* to = table.mutable_data();
    for (const Answer& each : answers) {
        for (const Event& event : each.solution.motion.events) to = store_event(event, to);
    }
    return table;
}

// The samples of all scenes of a kind one after the other: quantity by quantity, but for
// coordinates, which are sample by sample.
py::dict samples(const std::vector<Answer>& answers) {
    const auto count = [&](auto of) { return total(answers, of); };
    const py::ssize_t rolled =
        count([](const Answer& each) -> py::ssize_t { return each.rolling.size(); });
    const py::ssize_t touched =
        count([](const Answer& each) -> py::ssize_t { return each.contact.size(); });
    const py::ssize_t constrained =
        count([](const Answer& each) -> py::ssize_t { return each.coordinates.size(); });
    Array rolling = matrix(3, rolled), contact = matrix(8, touched);
    Array q = matrix(constrained, 5), q_dot = matrix(constrained, 5);
    Bytes mode(touched);
    double* to_rolling = rolling.mutable_data();
    double* to_contact = contact.mutable_data();
    std::int8_t* to_mode = mode.mutable_data();
    py::ssize_t row = 0;
    for (const Answer& each : answers) {
        for (const FlowSample& sample : each.rolling) {
            const double values[] = {sample.theta, sample.omega, sample.x};
            for (int c = 0; c < 3; ++c) to_rolling[c * rolled] = values[c];
            ++to_rolling;
        }
        for (const auto& [state, force] : each.contact) {
            double values[8];
            double* const forces = store_state(state, values);
            forces[0] = force.normal;
            forces[1] = force.friction;
            for (int c = 0; c < 8; ++c) to_contact[c * touched] = values[c];
            ++to_contact;
            *to_mode++ = static_cast<std::int8_t>(state.mode);
        }
        for (const CoordinateState& state : each.coordinates) {
            store(q, row, state.q.data());
            store(q_dot, row++, state.q_dot.data());
        }
    }
    return py::dict("rolling"_a = rolling, "contact"_a = contact, "mode"_a = mode, "q"_a = q,
                    "q_dot"_a = q_dot);
}

py::dict simulate_table(const Array& scenes, const Settings& settings, const Array& times,
                        int workers) {
    const py::ssize_t n = require_matrix("scenes", scenes, scene_numbers);
    require_length("times", times, std::max<py::ssize_t>(times.size(), 1));
    std::vector<Answer> answers(n);
    run_each(n, workers, [&](py::ssize_t i, const std::function<void()>& checkpoint) {
        answers[i] = answer(scenes.data(i, 0), settings, times.data(), times.size(), checkpoint);
    });
    py::dict found = facts(answers);
    found["events"] = event_table(answers);
    found.attr("update")(samples(answers));
    return found;
}

}  // namespace

void bind_batch(py::module_& m) {
    m.def("first_refused", first_refused, "scenes"_a, "reached"_a);
    m.def(
        "validate_settings",
        [](const Settings& settings, double t_end) { validate(settings, t_end); }, "settings"_a,
        "t_end"_a);
    m.def("simulate_table", simulate_table, "scenes"_a, "settings"_a, "times"_a, "workers"_a);
}

}  // namespace rolling_ellipse::bindings
