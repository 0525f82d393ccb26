#include "outcome/blow.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "contact/continuation.hpp"
#include "integrator/events.hpp"
#include "contact/units.hpp"
#include "integrator/events.hpp"
#include "integrator/runge_kutta.hpp"
#include "proof/law.hpp"
#include "rolling/steps.hpp"
#include "scene/impact.hpp"
#include "scene/refuse.hpp"

namespace rolling_ellipse {
namespace {

// How rolling ends that the ground cannot hold any longer.
Outcome broken(double friction) {
    return std::isinf(friction) ? Outcome::loses_contact : Outcome::slips;
}

// From the angle, as the motion goes, to the next position in which the long axis stands upright.
double turn_to_the_tip(const Axes& axes, double theta, double direction) {
    const FlatView at = flat_view(axes, theta);
    if (at.c2 == 0) return pi;
    const double left = half_pi - direction * std::atan2(at.sin, at.cos);
    return left > equal_ulps * epsilon ? left : pi;
}

// Of a body that rolls on a slope: its motion, in units of its own.
Outcome followed(const Scene& in_si, const State& from, const Checkpoint& checkpoint) {
    constexpr long most_steps = 100'000;
    constexpr double most_falls = 64;  // times in which a body from rest gains its length downhill
    const Units units = natural_units(in_si);
    const Scene scene = body_in_units(in_si, units);
    const State start = in_units(from, units);
    const Axes axes = scene.axes();
    const RollingDynamics dynamics(scene);
    const double rate = dynamics.accelerations(geometry(axes, start.theta), start.omega).theta;
    const double direction = std::copysign(1.0, start.omega != 0 ? start.omega : rate);

    Settings settings{};
    settings.method = Method::dop853;
    SteppedRolling motion = rolling_from(scene, start, settings);
    const double theta = motion.steps.knots.front().y[0];
    const double to_tip = turn_to_the_tip(axes, theta, direction);
    enum End { rolling_ends, turns_back, passes_the_tip };
    const auto margins = [&](const Vector<2>& y) -> std::array<double, 3> {
        return {law_margin(dynamics.force(geometry(axes, y[0]), y[1]), scene.friction),
                direction * y[1], to_tip - direction * (y[0] - theta)};
    };
    const double length = std::max(scene.a, scene.b);
    const double fall = std::sqrt((length + scene.body().gyration2 / length) /
                                  std::abs(scene.ground_gravity().along));
    const double longest = std::min(most_falls * fall, std::numeric_limits<double>::max());
    ExplicitMethod<DormandPrince853, RollingEquation> integrator(motion.equation);
    const Until until =
        integrate_until(integrator, motion.steps, finest, most_steps, longest, margins, checkpoint);
    if (until.ending != Ending::event) return Outcome::edge;
    if (until.which == rolling_ends) return broken(scene.friction);
    return until.which == turns_back ? Outcome::rocks : Outcome::rolls_over;
}

Outcome outcome_on_slope(const Scene& scene, const State& start, Mode mode,
                         const Checkpoint& checkpoint) {
    switch (mode) {
        case Mode::rest:
            return Outcome::rests;
        case Mode::rolling:
            return followed(scene, start, checkpoint);
        default:
            return broken(scene.friction);
    }
}

}  // namespace

Outcome outcome(const Scene& scene, const Checkpoint& checkpoint) {
    const State start = initial_state(scene).state;
    validate_motion(scene.body(), start.theta, start.omega);
    validate_velocity(scene.body(), start.x_dot, start.z_dot);
    const Continuation next = first_continuation(scene, start);
    if (next.mode == Mode::flight) return Outcome::loses_contact;
    if (next.paradox != Painleve::determined) return Outcome::jams;
    if (!rolls(start) && next.mode == Mode::sliding) return Outcome::slips;
    if (scene.slope != 0) return outcome_on_slope(scene, start, next.mode, checkpoint);
    return classify(scene.body(), scene.friction, start.theta, start.omega);
}

double press_to(const Scene& scene, double distance, double omega) {
    require_finite("distance", " [m]", distance);
    validate_motion(scene.body(), scene.theta, omega);
    const State state = state_before_impulse(scene);
    const Geometry at = geometry(scene.axes(), state.theta);
    const double k2 = scene.body().gyration2;
    const double wanted = inertia_about_contact(k2, at) * omega;
    const double there = k2 * state.omega + at.h * state.x_dot + at.dh * state.z_dot;
    return scene.mass * (wanted - there) / (distance - at.dh);
}

double speed_to_the_tip(const Scene& scene) {
    const Body body = scene.body();
    const RollingStart at_rest = rolling_start(body, scene.theta, 0.0);
    const Geometry at = geometry(body.axes(), scene.theta);
    const double inertia = inertia_about_contact(body.gyration2, at);
    return std::sqrt(std::max(-at_rest.height.over_tip, 0.0) * 2 * body.gravity / inertia);
}

}  // namespace rolling_ellipse
