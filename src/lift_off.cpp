#include "lift_off.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "certificate.hpp"
#include "continuation.hpp"
#include "integrator/runge_kutta.hpp"
#include "sliding_steps.hpp"

namespace rolling_ellipse {
namespace {

Scene level_scene(const Body& body, double friction) {
    Scene scene{};
    scene.a = body.a;
    scene.b = body.b;
    scene.mass = 1.0;
    scene.gravity = body.gravity;
    scene.inertia = body.gyration2;
    scene.friction = friction;
    return scene;
}

// With infinite friction the slide has N = 0: its centre is in free fall, h'^2 omega^2 + 2 g h
// stays what it is, physics (52). Below 2 g L it turns back under the tip with c > 0: from the flat
// to the tip h'' falls, so that c h'^2 = g h'^2 + h'' h'^2 omega^2 falls as well, but to g h'^2
// where omega vanishes.
bool reaches_the_tip(const Scene& scene, const State& start) {
    const FlatView at = flat_view({scene.a, scene.b}, start.theta);
    const double h = geometry({scene.a, scene.b}, start.theta).h;
    const double to_tip = at.c2 * square(at.cos) / (at.long_axis + h);
    return square(start.z_dot) >= 2 * scene.gravity * to_tip;
}

// The state in which rolling ends; nothing if it does not.
std::optional<State> end_of_rolling(const Scene& scene, const State& from) {
    const EndOfRolling end = end_of_rolling(scene.body(), scene.friction, from.theta, from.omega);
    if (end.validity != Validity::invalid) return std::nullopt;
    const RollingFlow flow = rolling_flow(scene.body(), from.theta, from.omega);
    const FlowSample last = sample(flow, time_of_end(flow, end));
    const Geometry at = geometry({scene.a, scene.b}, last.theta);
    return in_contact(at, last.theta, last.omega, last.x, 0.0, Mode::rolling);
}

// The state in which a slide ends, and what ended it; nothing if it gets over the tip or turns
// back.
struct EndOfSlide {
    State state;
    int which;
};

std::optional<EndOfSlide> end_of_slide(const Scene& scene, const State& from, double side,
                                       double tip) {
    if (std::isinf(scene.friction) && !reaches_the_tip(scene, from)) return std::nullopt;
    constexpr long most_steps = 2000;  // of half a turn; more only where N = F = 0 at the tip
    SteppedSliding motion = sliding_from(scene, from, side);
    const SlidingEquation& f = motion.equation;
    const auto margins = [&f, tip](const Vector<4>& y) -> std::array<double, 5> {
        const auto [slip, c, b] = f.margins(y);
        return {slip, c, b, tip + 0.5 - y[0], y[1]};
    };
    ExplicitMethod<DormandPrince853, SlidingEquation> integrator(f);
    const Until until =
        integrate_until(integrator, motion.steps, finest, most_steps, infinity, margins, [] {});
    if (until.ending != Ending::stopped || until.which > jams) return std::nullopt;
    ContactSample last{};
    sample(motion, &until.time, 1, &last);
    return EndOfSlide{last.state, until.which};
}

// Follows a body that rolls over the flat position up to the tip. Only on the way up can c vanish:
// where it does, its rate is h''' omega^3, physics (53), and h'' falls from the flat to the tip.
bool leaves_the_ground(const Scene& scene, double flat, double omega) {
    const double tip = flat + half_pi;
    const Geometry at = geometry({scene.a, scene.b}, flat);
    State state = in_contact(at, flat, omega, 0.0, 0.0, Mode::rolling);
    Continuation next = continuation(scene, state);
    // Where N and c vanish together, right at the tip, there are only slides of no length before.
    constexpr int most_arcs = 64;
    for (int i = 0; state.theta < tip && !next.jams && next.mode != Mode::flight; ++i) {
        if (i == most_arcs) return true;
        if (next.mode == Mode::rolling) {
            const std::optional<State> end = end_of_rolling(scene, state);
            if (!end) return false;
            state = *end;
            next = continuation(scene, state, false);
        } else {
            const std::optional<EndOfSlide> end = end_of_slide(scene, state, next.side, tip);
            if (!end) return false;
            if (end->which != slip_vanishes) return end->which == pressure_vanishes;
            state = end->state;
            const Geometry here = geometry({scene.a, scene.b}, state.theta);
            state = in_contact(here, state.theta, state.omega, state.x, 0.0, Mode::sliding);
            next = continuation(scene, state);
        }
    }
    return next.mode == Mode::flight;
}

// At lift-off omega^2 >= g/|h''| >= g L/c^2, physics (53), with no more energy than at the start.
double too_slow(const Body& body, const FlatView& at) {
    const double flat_inertia = body.gyration2 + square(at.short_axis);
    return std::sqrt(body.gravity * at.long_axis / at.c2 * body.gyration2 / flat_inertia);
}

}  // namespace

double lift_off_speed(const Body& body, double friction, double slip_speed) {
    const FlatView at = flat_view({body.a, body.b}, 0.0);
    if (at.c2 == 0) return infinity;
    const double flat = body.a >= body.b ? 0.0 : half_pi;
    const Scene scene = level_scene(body, friction);
    const auto leaves = [&](double omega) { return leaves_the_ground(scene, flat, omega); };
    constexpr double growth = 1.05;
    constexpr int most_growths = 200;
    double low = std::max(slip_speed, too_slow(body, at));
    if (leaves(low)) return low;
    double high = growth * low;
    for (int i = 0; !leaves(high); ++i) {
        if (i == most_growths) return infinity;
        low = high;
        high *= growth;
    }
    for (;;) {
        const double middle = 0.5 * (low + high);
        if (!(low < middle && middle < high)) return high;
        (leaves(middle) ? high : low) = middle;
    }
}

}  // namespace rolling_ellipse
