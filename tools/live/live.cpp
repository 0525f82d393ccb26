// The core for a web page: one function from the numbers of a scene and times to samples, events
// and the facts that sentences about the motion need. tools/live/build.sh compiles it.
#include "outcome/outcome.hpp"
#include "simulate.hpp"

namespace rolling_ellipse {
namespace {

// The settings of `simulate`, with the limits of the table of `explore`.
const Settings settings{Model::automatic,          Method::automatic, 1e-10,  1e-12, {}, {},
                        Stabilization::projection, {10.0, 10.0},      20'000, 200,   {}};
constexpr double absent = std::numeric_limits<double>::quiet_NaN();

std::vector<double> numbers;  // the answer to a call, which stays until the next one

template <class... Numbers>
void add(Numbers... values) {
    (numbers.push_back(static_cast<double>(values)), ...);
}

// The next numbers asked for; without a jx there is no blow.
Scene asked_scene(const double*& asked) {
    SceneNumbers known;
    for (auto& number : known) {
        const double value = *asked++;
        if (!std::isnan(value)) number = value;
    }
    Impulse blow;
    for (const auto& field : impulse_fields) blow.*field.number = *asked++;
    return scene_of(known, std::isnan(blow.jx) ? std::nullopt : std::optional(blow));
}

void add_start(const Scene& scene) {
    const InitialState start = initial_state(scene);
    const Continuation next = first_continuation(scene, start.state);
    add(start.touching, start.state.mode, next.mode, next.paradox, next.may_fly, start.slip_removed,
        start.energy_lost, start.reaction_x, start.reaction_z, start.free_omega);
}

// The scene from which the motion goes on after an event on the ground.
Scene scene_after(Scene scene, const State& state) {
    scene.impulse.reset();
    for (auto* number : {&scene.z, &scene.x_dot, &scene.z_dot}) number->reset();
    if (state.mode == Mode::sliding) scene.x_dot = state.x_dot;
    scene.theta = state.theta;
    scene.omega = state.omega;
    scene.x = state.x;
    return scene;
}

// The start, the time from which a body in the air stays on the ground, or NaN, and the start,
// the outcome and the proof on the ground.
void add_facts(Scene scene, const Motion& motion) {
    add_start(scene);
    double landed = 0.0;
    if (!initial_state(scene).touching) {
        const auto lands = [](const Event& each) { return each.after.mode != Mode::flight; };
        const auto at = std::find_if(motion.events.begin(), motion.events.end(), lands);
        landed = at == motion.events.end() ? absent : at->t;
        if (landed >= 0) scene = scene_after(scene, at->after);
    }
    const Certificate c = certify(scene);
    add(landed);
    add_start(scene);
    add(outcome(scene, [] {}), c.end.validity, c.smallest_normal_force.value_or(absent),
        c.smallest_normal_force_angle.value_or(absent), c.largest_friction_needed.value_or(absent),
        c.end.angle.value_or(absent));
}

// Times after the end of the motion have its last state.
void add_samples(const Scene& scene, const Solution& solution, const double* asked, int n) {
    std::vector<double> times(asked, asked + n);
    for (double& t : times) t = std::min(t, solution.followed_until);
    std::vector<ContactSample> samples(n);
    Sampler(solution.motion, n)(times.data(), n, samples.data());
    const auto [into, along] = scene.ground_gravity();
    for (const auto& [s, force] : samples) {
        const double moved = scene.mass * (s.x_dot * s.x_dot + s.z_dot * s.z_dot);
        add(s.x, s.z, s.theta, s.x_dot, s.z_dot, s.omega, force.normal, force.friction, s.mode,
            (moved + scene.inertia * s.omega * s.omega) / 2,
            scene.mass * (into * s.z - along * s.x));
    }
}

// Asked are a scene, its blow, the end of the motion, whether facts are wanted, and n times.
void answer(const double* asked, int n) {
    const Scene scene = asked_scene(asked);
    validate(scene);
    const Solution solution = simulate(scene, settings, asked[0], [] {});
    add(solution.ending, solution.followed_until, solution.motion.events.size());
    for (const Event& each : solution.motion.events) {
        const double lead = geometry(scene.axes(), each.after.theta).dh;
        add(each.t, each.kind, each.after.x + lead);
    }
    if (asked[1] == 1) add_facts(scene, solution.motion);
    add_samples(scene, solution, asked + 2, n);
}

}  // namespace

// The answer begins with its length. One that begins with NaN then is a refusal, in letters.
extern "C" const double* live(const double* asked, int n) {
    numbers = {0.0};
    try {
        answer(asked, n);
    } catch (const std::exception& error) {
        const std::string letters = error.what();
        numbers = {0.0, absent};
        numbers.insert(numbers.end(), letters.begin(), letters.end());
    }
    numbers[0] = static_cast<double>(numbers.size());
    return numbers.data();
}

}  // namespace rolling_ellipse
