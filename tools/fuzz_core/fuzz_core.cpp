// The core with arbitrary numbers, for libFuzzer: tools/fuzz_core.sh builds and runs it.
//
// Every input must satisfy: wrong numbers are refused by a std::invalid_argument that names the
// argument, and nothing else is thrown; every answer is finite, and has a status that fits. Whether
// it is right is for tests/properties and tools/fuzz/promises.py to say.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <vector>

#include "bytes.hpp"
#include "contact/sliding.hpp"
#include "outcome/outcome.hpp"
#include "outcome/passages.hpp"
#include "proof/law.hpp"
#include "rolling/level/kernel.hpp"
#include "rolling/stepped/equation.hpp"
#include "scene/impact.hpp"
#include "simulate.hpp"

using namespace rolling_ellipse;
using fuzz_core::Bytes;

namespace {

Scene scene;  // the scene drawn from the input

// Prints the scene as a call of Python.
void print_scene() {
    std::fprintf(stderr, "Scene(");
    for (const SceneField& field : scene_fields) {
        if (const auto value = field.of(scene)) {
            std::fprintf(stderr, "%s=%.17g, ", field.name, *value);
        }
    }
    if (const auto& blow = scene.impulse) {
        std::fprintf(stderr, "impulse=Impulse(%.17g, %.17g, dx=%.17g, dz=%.17g)", blow->jx,
                     blow->jz, blow->dx, blow->dz);
    }
    std::fprintf(stderr, ")\n");
}

// Aborts if a condition fails; libFuzzer keeps the input.
void check(bool holds, const char* what, int line) {
    if (holds) return;
    std::fprintf(stderr, "line %d: %s\n", line, what);
    print_scene();
    std::abort();
}
#define CHECK(...) check((__VA_ARGS__), #__VA_ARGS__, __LINE__)

struct Interrupted {};  // thrown by a checkpoint, as by Ctrl-C

// A checkpoint that interrupts long work as Ctrl-C does.
Checkpoint patience(int looks) {
    return [looks]() mutable {
        if (--looks < 0) throw Interrupted{};
    };
}

// Makes the body weightless, or gives it exactly the friction that rolling needs, up to rounding.
void put_at_its_limit(Scene& scene, Bytes& bytes) {
    const Geometry at = geometry(scene.axes(), scene.theta);
    const double beside = 1 + 0.5 * epsilon * (bytes.choice(7) - 3);
    if (at.ddh < 0 && bytes.chance(128)) {
        scene.omega = bytes.sign() * beside * std::sqrt(scene.ground_gravity().into / -at.ddh);
    } else {
        scene.friction = beside * friction_needed(rolling_force(scene, at, scene.omega));
    }
}

Scene scene_from(Bytes& bytes) {
    Scene scene{};
    scene.a = bytes.power(-2, 2);
    const double thin = bytes.chance(64) ? 3.0 : 0.7;
    scene.b = bytes.chance(32) ? scene.a : scene.a * bytes.power(-thin, thin);
    if (bytes.chance(24)) scene.b = scene.a * (1 + bytes.sign() * bytes.power(-15, -1));
    scene.mass = bytes.power(-2, 2);
    scene.gravity = bytes.power(-1, 2);
    const double longer = std::max(scene.a, scene.b);
    scene.inertia = bytes.chance(128) ? scene.mass * uniform_disc_gyration2(scene.a, scene.b)
                                      : scene.mass * longer * longer * bytes.power(-6, 0);
    if (bytes.chance(128)) {
        const bool gentle = bytes.chance(96);  // a choice for long climbs and slow changes
        scene.slope = gentle ? bytes.sign() * bytes.power(-9, 0) : bytes.between(-1.5, 1.5);
    }
    scene.friction = bytes.chance(64) ? infinity : bytes.power(-3, 2);
    scene.restitution = bytes.chance(64) ? 0.0 : bytes.between(0, 1);
    const double rate = std::sqrt(scene.gravity / longer);
    scene.theta = bytes.chance(64) ? half_pi * bytes.choice(8) : bytes.between(-7, 7);
    scene.omega = bytes.sign() * (bytes.chance(32) ? 0.0 : rate * bytes.power(-4, 1.5));
    if (bytes.chance(24)) put_at_its_limit(scene, bytes);
    scene.x = bytes.chance(200) ? 0.0 : bytes.between(-1e3, 1e3);
    const double speed = rate * longer;
    if (bytes.chance(64)) scene.z = longer * bytes.power(-1, 1.5);
    if (bytes.chance(64)) scene.x_dot = speed * bytes.between(-5, 5);
    if (bytes.chance(32)) scene.z_dot = speed * bytes.between(-5, 5);
    if (bytes.chance(64)) {
        const double size = scene.mass * speed;
        const double least = std::min(scene.a, scene.b);
        scene.impulse = Impulse{size * bytes.between(-3, 3), size * bytes.between(-3, 3),
                                least * bytes.between(-1, 1), least * bytes.between(-1, 1)};
    }
    return scene;
}

double unit_of_time(const Scene& scene) {
    return std::sqrt(std::max(scene.a, scene.b) / scene.gravity);
}

Settings settings_from(Bytes& bytes, double t_end) {
    Settings settings{};
    settings.model = static_cast<Model>(bytes.choice(4));
    settings.method = bytes.chance(128) ? Method::automatic : static_cast<Method>(bytes.choice(7));
    settings.stabilization =
        bytes.chance(128) ? Stabilization::projection : static_cast<Stabilization>(bytes.choice(5));
    settings.rtol = bytes.power(-13, -3);
    settings.atol = bytes.power(-14, -3);
    if (bytes.chance(96)) settings.step = t_end * bytes.power(-2, 0);
    if (bytes.chance(32)) settings.stages = bytes.choice(6);
    for (double& gain : settings.baumgarte) gain = bytes.power(0, 2);
    settings.max_steps = bytes.chance(16) ? bytes.choice(3) : 40;
    settings.max_events = bytes.chance(16) ? bytes.choice(3) : 10;
    if (bytes.chance(32)) settings.rest_speed = bytes.power(-9, 0);
    return settings;
}

void check_start(const Scene& scene) {
    const State before = state_before_impulse(scene, geometry(scene.axes(), scene.theta));
    const InitialState start = initial_state(scene);
    CHECK(is_finite(before) && is_finite(start.state));
    CHECK(std::isfinite(start.reaction_x) && start.reaction_z >= 0);
    CHECK(sticking_friction(scene) >= 0);
    CHECK(std::abs(first_continuation(scene, start.state).side) <= 1);
}

// Checks collisions of a body with the ground at any speed and slip.
void check_collision(const Scene& scene, Bytes& bytes) {
    const Geometry at = geometry(scene.axes(), scene.theta);
    const double speed = std::max(scene.a, scene.b) / unit_of_time(scene);
    State before{scene.theta, scene.omega, scene.x, at.h, 0.0, 0.0, Mode::flight};
    before.x_dot = speed * bytes.between(-5, 5);
    before.z_dot = at.dh * before.omega - speed * bytes.power(-6, 1);
    if (!(before.z_dot < at.dh * before.omega)) return;
    const double largest = std::max(std::abs(before.x_dot), std::abs(before.z_dot));
    if (!(largest <= largest_number)) return;  // no motion comes to such speeds
    CHECK(is_finite(collision(scene, at, before, gap_rate(before, at)).after));
}

void check_certificate(const Scene& scene) {
    const auto [found, reason] = certify(scene);
    CHECK(!reason.empty());
    const Validity validity = found.end.validity;
    CHECK(found.end.angle.has_value() || validity == Validity::valid ||
          validity == Validity::no_proof);
    if (found.smallest_normal_force) CHECK(!std::isnan(*found.smallest_normal_force));
    if (found.largest_friction_needed) CHECK(*found.largest_friction_needed >= 0);
}

void check_samples(const Solution& solution, double t_end) {
    if (solution.motion.segments.empty()) return;
    constexpr int count = 8;
    const double last = std::min(t_end, solution.followed_until);
    std::vector<double> times(count);
    for (int i = 0; i < count; ++i) times[i] = last * i / (count - 1);
    const Sampler look(solution.motion, count);
    std::vector<ContactSample> samples(count);
    look(times.data(), count, samples.data());
    for (const ContactSample& each : samples) {
        CHECK(is_finite(each.state));
        CHECK(std::isfinite(each.force.normal) && std::isfinite(each.force.friction));
    }
    std::vector<CoordinateState> coordinates(count);
    look(times.data(), count, coordinates.data());
    for (const CoordinateState& each : coordinates) {
        CHECK(each.q.allFinite() && each.q_dot.allFinite());
    }
}

void check_solution(const Solution& solution, double t_end) {
    CHECK(solution.followed_until >= 0 && solution.followed_until <= t_end);
    const bool ran_through =
        solution.ending == Ending::completed || solution.ending == Ending::validity_lost;
    if (ran_through) CHECK(solution.followed_until == t_end);
    CHECK(!(solution.valid_until < 0));
    if (solution.ending == Ending::validity_lost) CHECK(solution.valid_until < t_end);
    if (solution.ending != Ending::completed) CHECK(!solution.message.empty());
    double last = 0.0;
    for (const Event& event : solution.motion.events) {
        CHECK(event.t >= last && event.t <= t_end);
        CHECK(is_finite(event.before) && is_finite(event.after));
        last = event.t;
    }
    check_samples(solution, t_end);
    if (solution.motion.segments.empty()) return;
    for (const Quantity quantity :
         {Quantity::theta, Quantity::x, Quantity::z, Quantity::omega, Quantity::contact_x}) {
        const Checkpoint checkpoint = patience(1000);
        const Observable of = observable(solution.motion, quantity, checkpoint);
        const double until = solution.followed_until;
        passages(solution.motion, until, of, {0.0, 1.0}, 0, checkpoint);
    }
}

void check_simulation(const Scene& scene, Bytes& bytes) {
    const double unit = unit_of_time(scene);
    const double span = bytes.chance(48) ? bytes.power(0, 8) : bytes.power(-3, 1.3);
    const double t_end = bytes.chance(16) ? bytes.any() : unit * span;
    const Settings settings = settings_from(bytes, t_end);
    if (!(t_end >= 0 && std::isfinite(t_end))) return;  // Python refuses it
    const Solution solution = simulate(scene, settings, t_end, patience(20));
    check_solution(solution, t_end);
    if (bytes.chance(16)) CHECK(!reason(scene, solution).empty());
}

// Checks the report's coordinates, on the constraints or off them.
void check_coordinates(const Scene& scene, Bytes& bytes) {
    CoordinateState start = kinematics(scene.axes(), scene.theta, scene.omega);
    for (int i = 0; i < 5; ++i) {
        if (bytes.chance(48)) start.q[i] += bytes.sign() * bytes.power(-9, 0);
        if (bytes.chance(48)) start.q_dot[i] += bytes.sign() * bytes.power(-9, 0);
    }
    if (!start.q.allFinite() || !start.q_dot.allFinite()) return;
    const double largest =
        std::max(start.q.cwiseAbs().maxCoeff(), start.q_dot.cwiseAbs().maxCoeff());
    if (largest > largest_number) return;  // Python refuses it
    const double t_end = unit_of_time(scene) * bytes.power(-3, 1);
    Settings settings = settings_from(bytes, t_end);
    settings.model = Model::multipliers;
    if (!(t_end > 0 && std::isfinite(t_end))) return;
    const Solution solution = simulate(scene, start, settings, t_end, patience(20));
    CHECK(solution.followed_until >= 0 && solution.followed_until <= t_end);
    check_samples(solution, t_end);
}

// Checks rolling at any time: one state, the same state in lanes, and a table of many times.
void check_flow(const Scene& scene, Bytes& bytes) {
    const Body body = scene.body();
    const double t = bytes.sign() * unit_of_time(scene) * bytes.power(-6, 9);
    validate_motion(body, scene.theta, scene.omega);
    const RollingStart start = rolling_start(body, scene.theta, scene.omega);
    const RollingFlow flow = rolling_flow(start, scene.x);
    validate_time(t, longest_time(flow));
    const auto check_state = [](const FlowSample& found) {
        CHECK(std::isfinite(found.theta) && std::isfinite(found.omega) && std::isfinite(found.x));
    };
    check_state(sample(flow, t));
    constexpr int count = 8;
    double times[count];
    for (int i = 0; i < count; ++i) times[i] = t * (i + 1) / count;
    FlowSample samples[count];
    FlowSampler(flow, 1000)(times, count, samples);
    std::for_each(samples, samples + count, check_state);
    const std::vector<RollingStart> starts(count, start);
    sample(kernel(), starts.data(), times, count, samples);
    std::for_each(samples, samples + count, check_state);
    CHECK(period(flow) > 0);
}

void check_answers(const Scene& scene, Bytes& bytes) {
    const int what = bytes.choice(8);
    if (what == 0) CHECK(required_friction(scene) >= 0);
    if (what <= 2) CHECK(!std::isnan(period(scene)));
    const int code = static_cast<int>(outcome(scene, patience(20)));
    CHECK(code >= 0 && code <= static_cast<int>(Outcome::edge));
    press_to(scene, scene.a * bytes.between(-1, 1), scene.omega);
}

void check_body(const Scene& scene, bool thresholds_too) {
    const int code =
        static_cast<int>(classify(scene.body(), scene.friction, scene.theta, scene.omega));
    CHECK(code >= 0 && code <= static_cast<int>(Outcome::edge));
    if (!thresholds_too) return;
    const Thresholds found = thresholds(scene.body(), scene.friction);
    CHECK(found.roll_over_speed >= 0 && found.contact_loss_speed >= 0 && found.slip_speed >= 0);
    CHECK(found.friction_to_roll_over >= 0 && found.painleve_friction >= 0);
}

void run(Bytes& bytes) {
    const int what = bytes.choice(8);
    scene = scene_from(bytes);
    validate(scene);
    switch (what) {
        case 0:
            return check_start(scene);
        case 1:
            return check_collision(scene, bytes);
        case 2:
            return check_certificate(scene);
        case 3:
            return check_coordinates(scene, bytes);
        case 4:
            return check_flow(scene, bytes);
        case 5:
            return check_answers(scene, bytes);
        case 6:
            return check_body(scene, bytes.chance(32));
        default:
            return check_simulation(scene, bytes);
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Bytes bytes(data, size);
    try {
        run(bytes);
    } catch (const std::invalid_argument& refused) {
        CHECK(std::string(refused.what()).find(" must ") != std::string::npos);
    } catch (const Interrupted&) {
    }
    return 0;
}
