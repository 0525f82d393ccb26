// The core for a web page, compiled by tools/live/build.sh. It simulates a scene, describes the
// motion in sentences and samples it at any times, or reports only the first outcome.
#include "describe.hpp"

namespace rolling_ellipse {
namespace {

// The settings of `simulate`, with limits for a page.
Settings settings_of_page() {
    Settings settings{};
    settings.rtol = 1e-10;
    settings.atol = 1e-12;
    settings.stabilization = Stabilization::projection;
    settings.baumgarte = {10.0, 10.0};
    settings.max_steps = 20'000;
    settings.max_events = 200;
    return settings;
}

// The scene of a motion, its end time, and its settings with the blows during the motion.
struct Question {
    Scene scene;
    double end;
    Settings settings;
};

// The last question, its motion, and the last answers, which stay valid until the next call.
Question question;
Solution solution;
std::string answer;
std::vector<double> numbers;

Impulse impulse_from(const double*& asked) {
    Impulse found;
    for (const auto& field : impulse_fields) found.*field.number = *asked++;
    return found;
}

// Reads a question from an array of numbers: those of the scene in the order of `columns`, the end
// time, the number of later blows, and the time and impulse of each. An absent number is NaN, as is
// jx if the scene has no blow.
Question question_from(const double* asked) {
    SceneNumbers known;
    for (auto& number : known) {
        const double value = *asked++;
        if (!std::isnan(value)) number = value;
    }
    const Impulse blow = impulse_from(asked);
    const auto first = std::isnan(blow.jx) ? std::nullopt : std::optional(blow);
    Question found{scene_of(known, first), *asked++, settings_of_page()};
    validate(found.scene);
    for (double left = *asked++; left > 0; --left) {
        const double t = *asked++;
        found.settings.blows.push_back({t, impulse_from(asked)});
    }
    return found;
}

Solution motion_of(const Question& of) {
    return simulate(of.scene, of.settings, of.end, [] {});
}

// The number of events of the last motion up to and including its last blow; 0 without a blow.
std::size_t events_until_blow() {
    const auto& events = solution.motion.events;
    std::size_t count = events.size();
    while (count > 0 && events[count - 1].kind != EventKind::blow) --count;
    return count;
}

// The part of a question from the last blow of the last motion on: a scene in the state just before
// that blow, with its impulse from the question. Without a blow during the motion, the whole
// question.
Question from_blow(const Question& of) {
    const std::size_t count = events_until_blow();
    if (count == 0) return of;
    const Event& last = solution.motion.events[count - 1];
    Question found{reached(of.scene, last.before), of.end - last.t, settings_of_page()};
    for (const auto& [t, impulse] : of.settings.blows) {
        if (t <= last.t) found.scene.impulse = impulse;
    }
    return found;
}

std::string key(const std::optional<Outcome>& first) { return first ? name(*first) : "IN_THE_AIR"; }

// ------------------------------------------------------------------------------------------- JSON

std::string json(const std::string& name) { return '"' + name + '"'; }

std::string json(double value) { return value == infinity ? "1e999" : text(value); }

// The values in brackets, each formatted by `write`.
template <class Values, class Write>
std::string json(const char* brackets, const Values& values, const Write& write) {
    std::string found(1, brackets[0]);
    for (const auto& each : values) found += (found.size() > 1 ? "," : "") + write(each);
    return found + brackets[1];
}

std::string json(const Event& event) {
    const State& state = event.after.state;
    const double place = state.x + geometry(question.scene.axes(), state.theta).dh;
    return '[' + json(event.t) + ',' + json(name(event.kind)) + ',' + json(place) + ']';
}

std::string json(const Sentence& sentence) {
    const auto number = [](const auto& each) {
        return json(std::string(each.first)) + ':' + json(each.second);
    };
    return '[' + json(sentence.first) + ',' + json("{}", sentence.second, number) + ']';
}

template <class Values>
std::string json(const Values& values) {
    return json("[]", values, [](const auto& each) { return json(each); });
}

// The time of the last blow and the description of the motion after it, as members of an object.
std::string json_of_description() {
    const Scene struck = from_blow(question).scene;
    const std::size_t count = events_until_blow();
    std::vector<Event>& events = solution.motion.events;
    std::vector<Event> later(events.begin() + count, events.end());
    std::swap(events, later);
    const Description found = describe(struck, solution, [] {});
    std::swap(events, later);
    return ",\"blow\":" + json(count > 0 ? events[count - 1].t : 0.0) +
           ",\"first\":" + json(key(found.first)) + ",\"headline\":" + json(found.headline) +
           ",\"reasons\":" + json(found.reasons);
}

}  // namespace

// The names of the numbers of a scene and of a sample, in order.
extern "C" const char* columns() {
    std::vector<std::string> of_scene, of_sample;
    for (const auto& field : scene_fields) of_scene.push_back(field.name);
    for (const auto& field : impulse_fields) of_scene.push_back(field.name);
    for (const auto& field : state_fields) of_sample.push_back(field.name);
    for (const auto& field : force_fields) of_sample.push_back(field.name);
    of_sample.insert(of_sample.end(), {"mode", "kinetic", "potential"});
    answer = "{\"scene\":" + json(of_scene) + ",\"sample\":" + json(of_sample) + '}';
    return answer.c_str();
}

// Simulates the motion of a question. The answer is JSON, with sentences if `in_words` is set, or
// an error message.
extern "C" const char* ask(const double* asked, int in_words) {
    try {
        question = question_from(asked);
        solution = motion_of(question);
        answer = "{\"ending\":" + json(name(solution.ending)) +
                 ",\"until\":" + json(solution.followed_until) +
                 ",\"events\":" + json(solution.motion.events);
        if (in_words) answer += json_of_description();
        answer += '}';
    } catch (const std::exception& error) {
        answer = error.what();
    }
    return answer.c_str();
}

// The first outcome that `ask` would report, or an error message, for a question that differs from
// the last one only in its last blow. A motion is simulated only if the body is struck in the air,
// and `samples` still samples the last motion of `ask`.
extern "C" const char* first(const double* asked) {
    try {
        const Question struck = from_blow(question_from(asked));
        answer = key(initial_state(struck.scene).touching
                         ? outcome(struck.scene, [] {})
                         : outcome_after_landing(struck.scene, motion_of(struck), [] {}));
    } catch (const std::exception& error) {
        answer = error.what();
    }
    return answer.c_str();
}

// Samples of the last motion; beyond its end they repeat its last state.
extern "C" const double* samples(const double* asked, int n) {
    std::vector<double> times(asked, asked + n);
    for (double& t : times) t = std::min(t, solution.followed_until);
    std::vector<ContactSample> found(n);
    Sampler(solution.motion, n)(times.data(), n, found.data());
    const Scene& scene = question.scene;
    const auto [into, along] = scene.ground_gravity();
    numbers.clear();
    for (const auto& [state, force] : found) {
        for (const auto& field : state_fields) numbers.push_back(state.*field.number);
        for (const auto& field : force_fields) numbers.push_back(force.*field.number);
        const double speed2 = square(state.x_dot) + square(state.z_dot);
        numbers.push_back(static_cast<double>(state.mode));
        numbers.push_back((scene.mass * speed2 + scene.inertia * square(state.omega)) / 2);
        numbers.push_back(scene.mass * (into * state.z - along * state.x));
    }
    return numbers.data();
}

}  // namespace rolling_ellipse
