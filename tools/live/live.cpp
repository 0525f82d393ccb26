// The core for a web page: simulates a scene, describes its motion in sentences, then samples it at
// any times; or tells only the first outcome. tools/live/build.sh compiles it.
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

// The last scene that was simulated, its motion, and the last answers, which stay valid until the
// next call.
Scene scene;
Solution solution;
std::string answer;
std::vector<double> numbers;

// The scene with these numbers, in the order of `columns`; an absent number is NaN, as is jx in a
// scene without a blow.
Scene scene_from(const double* asked) {
    SceneNumbers known;
    for (auto& number : known) {
        const double value = *asked++;
        if (!std::isnan(value)) number = value;
    }
    Impulse blow;
    for (const auto& field : impulse_fields) blow.*field.number = *asked++;
    const Scene found = scene_of(known, std::isnan(blow.jx) ? std::nullopt : std::optional(blow));
    validate(found);
    return found;
}

// The motion of the scene with these numbers up to an end time, which follows them.
Solution motion_of(const Scene& of, const double* asked) {
    const double end = asked[std::size(scene_fields) + std::size(impulse_fields)];
    return simulate(of, settings_of_page(), end, [] {});
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
    const double place = event.after.state.x + geometry(scene.axes(), event.after.state.theta).dh;
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

std::string json_of_description() {
    const Description found = describe(scene, solution, [] {});
    return ",\"first\":" + json(key(found.first)) + ",\"headline\":" + json(found.headline) +
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

// Simulates a scene up to an end time, the last of the numbers. The answer is JSON, with sentences
// if `in_words` is set, or the text of a refusal.
extern "C" const char* ask(const double* asked, int in_words) {
    try {
        scene = scene_from(asked);
        solution = motion_of(scene, asked);
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

// The first outcome that `ask` would tell, or the text of a refusal. Only a body that starts in the
// air is simulated; the last motion stays.
extern "C" const char* first(const double* asked) {
    try {
        const Scene of = scene_from(asked);
        answer = key(initial_state(of).touching
                         ? outcome(of, [] {})
                         : outcome_after_landing(of, motion_of(of, asked), [] {}));
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
