// Prints the exact values of motions of every model and of the results of every proof.
// tests/core/test_core.py and tools/same_bits.py compare the output of several builds.
//
//     golden > tests/core/golden.txt
//
// Each line is a record: its kind, further words, and numbers as hexadecimal floats. The arguments
// of a motion precede its results.

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <initializer_list>
#include <optional>
#include <string>
#include <utility>
#include <vector>
#if defined(__GLIBC__)
#include <gnu/libc-version.h>
#endif

#include "motions.hpp"
#include "outcome/outcome.hpp"
#include "rolling/level/kernel.hpp"
#include "simulate.hpp"

using namespace rolling_ellipse;

namespace {

void print(const std::string& words, const std::vector<double>& numbers) {
    std::printf("%s", words.c_str());
    for (const double number : numbers) std::printf(" %a", number);
    std::printf("\n");
}

// Pseudo-random multiples of 2^-32 in [0, 1), from a generator without rounding.
class Draw {
  public:
    double operator()() {
        state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
        return static_cast<double>(state_ >> 32) * 0x1p-32;
    }

  private:
    std::uint64_t state_ = 1;
};

// ------------------------------------------------------------------------- the C library

// FNV-1a hash of the values of the library functions that the core calls.
std::uint64_t fingerprint() {
    Draw draw;
    std::uint64_t sum = 14695981039346656037ULL;
    for (int i = 0; i < 20'000; ++i) {
        const double x = (draw() - 0.5) * 20;
        const double y = draw() * 4 + 1e-3;
        for (const double value :
             {std::sin(x), std::cos(x), std::tan(x), std::atan(x), std::atan2(x, y), std::exp(x),
              std::log(y), std::pow(y, x), std::sinh(x), std::tanh(x), std::asinh(x),
              std::atanh(x / 10.5), std::fma(x, y, -x * y)}) {
            std::uint64_t bits;
            std::memcpy(&bits, &value, sizeof bits);
            sum = (sum ^ bits) * 1099511628211ULL;
        }
    }
    return sum;
}

void print_library() {
#if defined(__GLIBC__)
    const std::string library = std::string("glibc ") + gnu_get_libc_version();
#else
    const std::string library = "other 0";
#endif
    std::printf("library %s %016llx\n", library.c_str(),
                static_cast<unsigned long long>(fingerprint()));
}

// -------------------------------------------------------------------------------- motions

struct Asked {
    const char* name;
    Scene scene;
    double t_end = 3.0;
    Model model = Model::automatic;
    Method method = Method::automatic;
    Stabilization stabilization = Stabilization::projection;
    std::optional<double> step = {};
    std::optional<int> stages = {};
    int samples = 13;
    int printed = 13;  // number of printed samples
};

Scene thin() {
    Scene scene = ellipse(0.3, 0.0);
    scene.b = 0.02;
    scene.inertia = scene.mass * uniform_disc_gyration2(scene.a, scene.b);
    return scene;
}

Scene standing(double omega) {
    Scene scene = ellipse(1.0, omega);
    std::swap(scene.a, scene.b);
    return scene;
}

Scene circle() {
    Scene scene = ellipse(0.2, 2.0, 0.5);
    scene.b = scene.a;
    return scene;
}

Scene separatrix(double beside) {
    Scene scene = ellipse(0.0, 0.0);
    scene.omega = roll_over_speed(scene.body()) * (1 + beside);
    return scene;
}

Scene falling(double friction, double restitution) {
    Scene scene = ellipse(0.5, 0.75, friction);
    scene.z = 2.5;
    scene.x_dot = 0.25;
    scene.restitution = restitution;
    return scene;
}

Scene flat_fall() {
    Scene scene = bouncing(0.0, 0.0, 0.5);
    scene.z = 1.5;
    return scene;
}

Scene struck(const Impulse& impulse, double friction) {
    Scene scene = ellipse(0.0, 0.0, friction);
    scene.impulse = impulse;
    return scene;
}

std::vector<Asked> motions() {
    using S = Stabilization;
    const Scene turning = ellipse(0.0, 3.2), rocking = ellipse(0.5, 0.0);
    const Scene report = struck({0.0, -48.0, 1.5, 0.0}, infinity);
    constexpr Model rolling = Model::rolling, multipliers = Model::multipliers;
    const auto table = [&](const char* name, const Scene& scene, double t_end) {
        return Asked{name, scene, t_end, rolling, Method::exact, S::projection, {}, {}, 2001, 41};
    };
    const auto stepped = [&](const char* name, Method method, std::optional<double> step,
                             std::optional<int> stages = {}) {
        return Asked{name, turning, 20.0, rolling, method, S::projection, step, stages};
    };
    const auto constrained = [&](const char* name, Method method, S stabilization,
                                 std::optional<double> step = {}) {
        return Asked{name, rocking, 5.0, multipliers, method, stabilization, step};
    };
    return {
        {"rotation", turning, 40.0, rolling, Method::exact},
        {"libration", rocking, 40.0, rolling, Method::exact},
        {"for-long", turning, 1e9, rolling, Method::exact},
        {"thin", thin(), 30.0, rolling, Method::exact},
        {"standing", standing(-1.5), 30.0, rolling, Method::exact},
        {"over-separatrix", separatrix(1e-6), 20.0, rolling, Method::exact},
        {"under-separatrix", separatrix(-1e-9), 20.0, rolling, Method::exact},
        {"circle", circle()},
        table("table-of-rotation", turning, 40.0),
        table("table-of-libration", rocking, 4e5),
        table("table-of-thin", thin(), 30.0),
        {"down-the-slope", on_slope(ellipse(0.0, 3.0), 0.1), 20.0, rolling, Method::exact},
        {"up-the-slope", on_slope(ellipse(0.0, -6.0), 0.1), 8.0, rolling, Method::exact},
        {"rocking-on-slope", on_slope(ellipse(0.3, 0.0), 0.1), 8.0, rolling, Method::exact},
        {"circle-on-slope", on_slope(circle(), 0.1), 8.0, rolling, Method::exact},
        {"slope-with-friction", on_slope(ellipse(0.0, 3.0, 0.8), 0.1), 4.0},
        stepped("rk4", Method::rk4, 0.01),
        stepped("dop853", Method::dop853, {}),
        stepped("dopri5", Method::dopri5, {}),
        stepped("gauss-2", Method::gauss, 0.05, 2),
        stepped("gauss-3", Method::gauss, 0.05, 3),
        stepped("gauss-4", Method::gauss, 0.05, 4),
        {"dop853-on-slope", on_slope(ellipse(0.0, 3.0), 0.1), 10.0, rolling, Method::dop853},
        constrained("free-constraints", Method::dop853, S::none),
        constrained("baumgarte", Method::dopri5, S::baumgarte),
        constrained("projection", Method::dop853, S::projection),
        constrained("projection-energy", Method::dop853, S::projection_energy),
        constrained("rk4-baumgarte", Method::rk4, S::baumgarte, 0.01),
        constrained("rk4-projection", Method::rk4, S::projection, 0.01),
        constrained("ggl", Method::radau, S::ggl, 0.02),
        {"slip", skidding(0.0, 0.0, 3.0, 0.2)},
        {"slip-backwards", skidding(0.7, 2.0, -1.0, 0.3)},
        {"reversed", skidding(-0.7, 2.4, 0.5, 0.1)},
        {"no-friction", skidding(0.4, 1.0, 0.5, 0.0)},
        {"jam", skidding(0.9, -0.5, 5.0, 1.6), 1.0},
        {"jump", ellipse(0.0, 5.2, 1.0)},
        {"bounces", bouncing(0.0, 5.5, 0.3)},
        {"drop", falling(1.0, 0.0)},
        {"bounce", falling(0.0, 1.0)},
        {"settles", falling(0.4, 0.5), 6.0},
        {"rests", ellipse(0.0, 0.0, 0.5)},
        {"comes-to-rest", flat_fall(), 6.0},
        {"report", report},
        {"report-with-friction", struck({0.0, -48.0, 1.5, 0.0}, 0.3)},
        {"kicked", struck({-5.0, 60.0, 0.5, -0.5}, 0.4)},
    };
}

const char* word(Validity validity) {
    constexpr const char* words[] = {"valid", "invalid", "edge", "no_proof"};
    return words[static_cast<int>(validity)];
}

const char* word(EventKind kind) {
    constexpr const char* words[] = {"slip",   "stick", "reverse", "lift_off",
                                     "impact", "rest",  "jam",     "blow"};
    static_assert(std::size(words) == std::size(names<EventKind>));
    return words[static_cast<int>(kind)];
}

double or_nan(std::optional<double> value) { return value.value_or(std::nan("")); }

std::vector<double> numbers(const State& at) {
    return {at.theta, at.omega, at.x, at.z, at.x_dot, at.z_dot};
}

template <class Sample, class Numbers>
void print_samples(const Asked& asked, const Solution& solution, Numbers numbers_of) {
    std::vector<double> times;
    for (int i = 0; i < asked.samples; ++i) {
        const double t = asked.t_end * i / (asked.samples - 1);
        if (t <= solution.followed_until) times.push_back(t);
    }
    std::vector<Sample> samples(times.size());
    const Sampler sampler(solution.motion, times.size());
    sampler(times.data(), times.size(), samples.data());
    const std::size_t every = (asked.samples - 1) / (asked.printed - 1);
    for (std::size_t i = 0; i < times.size(); i += every) {
        std::vector<double> line = numbers_of(samples[i]);
        line.insert(line.begin(), times[i]);
        print("sample", line);
    }
}

void print_motion(const Asked& asked) {
    const Scene& scene = asked.scene;
    Settings settings = settings_of(asked.model, asked.method, asked.step, asked.stabilization);
    settings.stages = asked.stages;
    settings.baumgarte = {10.0, 10.0};
    print(std::string("motion ") + asked.name + " " + name(asked.model) + " " + name(asked.method) +
              " " + name(asked.stabilization),
          {asked.t_end, static_cast<double>(asked.samples), or_nan(asked.step),
           static_cast<double>(asked.stages.value_or(0))});
    const Impulse blow = scene.impulse.value_or(Impulse{});
    print("scene",
          {scene.a, scene.b, scene.mass, scene.gravity, scene.inertia, scene.slope, scene.friction,
           scene.restitution, scene.theta, scene.omega, scene.x, or_nan(scene.z),
           or_nan(scene.x_dot), or_nan(scene.z_dot), blow.jx, blow.jz, blow.dx, blow.dz});
    const Solution solution = simulate(scene, settings, asked.t_end, [] {});
    print(std::string("solution ") + name(solution.model) + " " + name(solution.method),
          {static_cast<double>(solution.ending), solution.followed_until,
           valid_until(scene, solution)});
    for (const Event& event : solution.motion.events) {
        std::vector<double> line = numbers(event.after.state);
        line.insert(line.begin(), event.t);
        print(std::string("event ") + word(event.kind), line);
    }
    if (solution.model == Model::rolling) {
        print_samples<FlowSample>(asked, solution, [](const FlowSample& at) {
            return std::vector<double>{at.theta, at.omega, at.x};
        });
    } else if (solution.model == Model::multipliers) {
        print_samples<CoordinateState>(asked, solution, [](const CoordinateState& at) {
            std::vector<double> line(at.q.begin(), at.q.end());
            line.insert(line.end(), at.q_dot.begin(), at.q_dot.end());
            return line;
        });
    } else {
        print_samples<ContactSample>(asked, solution, [](const ContactSample& at) {
            std::vector<double> line = numbers(at.state);
            line.insert(line.end(), {at.force.normal, at.force.friction});
            return line;
        });
    }
}

void print_certificate(const Asked& asked) {
    const Certificate found = certify(asked.scene);
    print(std::string("certificate ") + word(found.end.validity),
          {or_nan(found.end.angle), or_nan(found.smallest_normal_force),
           or_nan(found.smallest_normal_force_angle), or_nan(found.largest_friction_needed),
           or_nan(found.largest_friction_needed_angle), required_friction(asked.scene)});
    const Outcome becomes = outcome(asked.scene, [] {});
    std::printf("outcome %d\n", static_cast<int>(becomes));
}

// ---------------------------------------------------------------------------- many bodies

// Prints bodies of many aspect ratios, in libration and rotation, at positive and negative times.
void print_bodies() {
    constexpr int count = 96;
    Draw draw;
    std::vector<RollingStart> starts;
    std::vector<double> times;
    for (int i = 0; i < count; ++i) {
        const double b = i % 3 == 0 ? 0.001 + draw() : 0.3 + draw();
        const Body body{1.0, b, (1 + b * b) / 4, 9.81};
        const double theta = 6 * draw() - 3;  // drawn before omega with every compiler
        const double omega = 8 * draw() - 4;
        starts.push_back(rolling_start(body, theta, omega));
        times.push_back((draw() - 0.5) * (i % 5 == 0 ? 1e4 : 20.0));
    }
    std::vector<FlowSample> side_by_side(count);
    sample(kernel(), starts.data(), times.data(), count, side_by_side.data());
    for (int i = 0; i < count; ++i) {
        const auto& [body, theta, omega, view, height, rests] = starts[i];
        print("body", {times[i], body.a, body.b, theta, omega, body.gravity, body.gyration2});
        print("rolled", {side_by_side[i].theta, side_by_side[i].omega, side_by_side[i].x});
    }
}

void print_outcomes() {
    for (const double b : {0.01, 0.5, 1.0, 1.5, 20.0}) {
        const Body body{1.0, b, uniform_disc_gyration2(1.0, b), 9.81};
        for (const double friction : {0.1, 0.4, 0.6, 1.5, infinity}) {
            const Thresholds at = thresholds(body, friction);
            const bool has_two = at.slip_windows.size() > 1;
            print("thresholds",
                  {body.a, body.b, body.gravity, body.gyration2, friction, at.roll_over_speed,
                   at.contact_loss_speed, or_nan(at.contact_loss_angle), at.slip_speed(),
                   or_nan(at.slip_angle), has_two ? at.slip_windows[0].upper : infinity,
                   has_two ? at.slip_windows[1].lower : infinity, at.friction_to_roll_over,
                   at.painleve_friction, or_nan(at.painleve_angle), at.rocking_rate, at.tip_rate});
            std::string codes = "classify ";
            for (int i = 0; i < 16; ++i) {
                for (int j = 0; j < 16; ++j) {
                    codes += static_cast<char>(
                        '0' + static_cast<int>(classify(body, friction, 0.2 * i, 0.5 * j)));
                }
            }
            print(codes, {body.a, body.b, body.gravity, body.gyration2, friction});
        }
    }
}

}  // namespace

int main() {
    print_library();
    for (const Asked& asked : motions()) {
        print_motion(asked);
        print_certificate(asked);
    }
    print_bodies();
    print_outcomes();
}
