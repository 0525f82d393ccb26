#include "continuation.hpp"

#include <cmath>

#include "contact_arcs.hpp"

namespace rolling_ellipse {
namespace {

double side_of(double v) { return std::copysign(1.0, v); }

// Does it stay where it is?
bool rests(const Scene& scene, const State& state, const Geometry& at) {
    constexpr double ulps = 8;
    const double incline = std::tan(scene.slope);
    return state.omega == 0 && std::abs(at.dh - incline * at.h) <= ulps * epsilon * at.h &&
           std::abs(incline) <= scene.friction;
}

// It leaves the ground where c <= 0, physics (53), and jams where B <= 0, physics (50, 52).
Continuation sliding(const Scene& scene, const Geometry& at, double omega, double side) {
    const auto [c, b] = SlidingEquation(scene, side).contact(at, omega);
    if (c <= 0) return {Mode::flight};
    return {Mode::sliding, side, b <= 0};
}

// Without slip, where rolling is not possible: to the side to which the contact accelerates.
Continuation starting_to_slide(const Scene& scene, const Geometry& at, const State& state,
                               const ContactForce& rolling) {
    if (std::isinf(scene.friction)) return sliding(scene, at, state.omega, -side_of(at.dh));
    if (rolling.normal > 0) return sliding(scene, at, state.omega, -side_of(rolling.friction));
    for (const double side : {1.0, -1.0}) {
        const Continuation next = sliding(scene, at, state.omega, side);
        if (next.mode == Mode::flight) return next;
        const Vector<4> rate =
            SlidingEquation(scene, side)(0.0, {state.theta, state.omega, 0.0, 0.0});
        if (!next.jams && side * rate[3] > 0) return next;
    }
    return {Mode::sliding, 0.0, true};
}

}  // namespace

Continuation continuation(const Scene& scene, const State& state, bool may_roll) {
    const Geometry at = geometry({scene.a, scene.b}, state.theta);
    const double slip = slip_velocity(state, at);
    if (scene.friction == 0) {
        const bool stays = slip == 0 && scene.slope == 0 && rests(scene, state, at);
        return stays ? Continuation{Mode::rest} : sliding(scene, at, state.omega, 0.0);
    }
    if (slip != 0) return sliding(scene, at, state.omega, side_of(slip));
    if (rests(scene, state, at)) return {Mode::rest};
    const ContactForce force = rolling_force(scene, state.theta, state.omega);
    const bool grips =
        std::isinf(scene.friction) || std::abs(force.friction) <= scene.friction * force.normal;
    if (may_roll && force.normal > 0 && grips) return {Mode::rolling};
    return starting_to_slide(scene, at, state, force);
}

}  // namespace rolling_ellipse
