#include "contact/continuation.hpp"

#include <cmath>
#include <utility>

#include "contact/sliding.hpp"
#include "proof/law.hpp"
#include "rolling/stepped/equation.hpp"

namespace rolling_ellipse {
namespace {

double side_of(double v) { return std::copysign(1.0, v); }

// Whether the body stays where it is.
bool rests(const Scene& scene, const State& state, const Geometry& at) {
    const double incline = std::tan(scene.slope);
    return state.omega == 0 && is_equilibrium(at, incline) && std::abs(incline) <= scene.friction;
}

// The body leaves the ground if c <= 0, physics (53), and jams if B <= 0, physics (50, 52). Only if
// it slips already can a slide with N = c/B > 0, c < 0, be a second motion beside flight: without
// slip, the N and F of rolling rule out that slip starts to the side of this slide. A body may be
// put there, but no motion leads there: a slide ends before, where c or B vanishes, and an impact
// with B < 0 goes on until the slip stops.
Continuation slide_or_leave(const Scene& scene, const Geometry& at, double omega, double side,
                            bool slips = false) {
    const auto [c, b] = response(sliding_body(scene, side), at, omega);
    if (slips && c < 0 && b < 0) return {Mode::sliding, side, Painleve::two_motions};
    if (c <= 0) return {Mode::flight};
    return {Mode::sliding, side, b <= 0 ? Painleve::no_motion : Painleve::determined};
}

// The start of a slip, where rolling is not possible, to the side to which the contact accelerates.
Continuation starting_to_slide(const Scene& scene, const Geometry& at, const State& state,
                               const ContactForce& rolling) {
    const auto to_side = [&](double side) { return slide_or_leave(scene, at, state.omega, side); };
    if (std::isinf(scene.friction)) return to_side(-side_of(at.dh));
    if (rolling.normal > 0) return to_side(-side_of(rolling.friction));
    for (const double side : {1.0, -1.0}) {
        const Continuation next = to_side(side);
        if (next.mode == Mode::flight) return next;
        const double rate = slip_rate(sliding_body(scene, side), at, state.omega);
        if (next.paradox == Painleve::determined && side * rate > 0) return next;
    }
    return {Mode::sliding, 0.0, Painleve::no_motion};
}

// The continuation by the given geometry and slip, which may be those a moment later.
Continuation continuation_at(const Scene& scene, const State& state, const Geometry& at,
                             double slip, bool may_roll) {
    if (scene.friction == 0) {
        const bool stays = slip == 0 && scene.slope == 0 && rests(scene, state, at);
        return stays ? Continuation{Mode::rest} : slide_or_leave(scene, at, state.omega, 0.0);
    }
    if (slip != 0) return slide_or_leave(scene, at, state.omega, side_of(slip), true);
    if (rests(scene, state, at)) return {Mode::rest};
    const ContactForce force = rolling_force(scene, state.theta, state.omega);
    const bool held = law_margin(force, scene.friction) >= 0 || at_the_limit(force, scene.friction);
    if (may_roll && force.normal > 0 && held) {
        Continuation next{Mode::rolling};
        next.may_fly = free_acceleration(at, scene.ground_gravity().into, state.omega) < 0;
        return next;
    }
    return starting_to_slide(scene, at, state, force);
}

}  // namespace

Continuation continuation(const Scene& scene, const State& state, bool may_roll) {
    const Geometry at = geometry(scene.axes(), state.theta);
    const double slip = slip_velocity(state, at);
    const bool weightless = is_weightless(at, scene.ground_gravity().into, state.omega);
    if (!weightless) return continuation_at(scene, state, at, slip, may_roll);
    // h'' is least on the tip, so that c falls on the way up to it and grows behind it.
    if (at.dh * state.omega > 0 && !is_equilibrium(at)) return {Mode::flight};
    State later = state;
    later.theta += std::copysign(turn_of_grazing, state.omega);
    Continuation next =
        continuation_at(scene, later, geometry(scene.axes(), later.theta), slip, may_roll);
    const bool needs_force = next.mode == Mode::rolling && scene.slope != 0;
    next.grazes = std::isinf(scene.friction) && !needs_force;
    return next;
}

State with_angle(const Axes& axes, State state, const Axes& new_axes, double theta) {
    const Geometry before = geometry(axes, state.theta);
    const Geometry after = geometry(new_axes, theta);
    const double omega = state.omega;
    state.theta = theta;
    if (state.z == before.h) state.z = after.h;
    if (state.x_dot == before.h * omega) state.x_dot = after.h * omega;
    if (state.z_dot == before.dh * omega) state.z_dot = after.dh * omega;
    return state;
}

Continuation first_continuation(const Scene& scene, const State& start, bool may_roll) {
    if (start.mode == Mode::flight) return {Mode::flight};
    const Units units = natural_units(scene.body(), scene.mass);
    const Scene body = in_units(scene, units);
    const State state = in_units(start, units);
    const QuarterView angle = quarter_view({resolved(state.theta), 0.0});
    Scene seen = body;
    if (is_odd(angle.quarters)) std::swap(seen.a, seen.b);
    return continuation(seen, with_angle(body.axes(), state, seen.axes(), angle.rest.high),
                        may_roll);
}

}  // namespace rolling_ellipse
