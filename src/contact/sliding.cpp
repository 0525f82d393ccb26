#include "contact/sliding.hpp"

#include <algorithm>
#include <cmath>

namespace rolling_ellipse {
namespace {

// Angular acceleration by a unit of the contact force, physics (51).
double spin(const SlidingBody& body, const Geometry& at) {
    return -(at.h * body.friction_share + at.dh * body.normal_share) / body.gyration2;
}

// dB/dtheta, B of physics (50).
double response_derivative(const SlidingBody& body, const Geometry& at) {
    return (2 * body.normal_share * at.dh * at.ddh +
            body.friction_share * (at.dh * at.dh + at.h * at.ddh)) /
           body.gyration2;
}

}  // namespace

SlidingBody sliding_body(const Scene& scene, double side) {
    const bool endless = std::isinf(scene.friction);
    return {scene.axes(),
            scene.mass,
            scene.body().gyration2,
            scene.ground_gravity(),
            side,
            endless ? 0.0 : 1.0,
            endless ? -side : -scene.friction * side};
}

// Per mass N = c/B with B = Gnn - mu s Gtn, physics (50); with infinite friction F = c/Gtn and N =
// 0, physics (52).
Response response(const SlidingBody& body, const Geometry& at, double omega) {
    const double c = free_acceleration(at, body.gravity.into, omega);
    const double gnn = 1 + at.dh * at.dh / body.gyration2;
    const double gtn = at.h * at.dh / body.gyration2;
    return {c, body.normal_share * gnn + body.friction_share * gtn};
}

ContactForce sliding_force(const SlidingBody& body, const Geometry& at, double omega) {
    const auto [c, b] = response(body, at, omega);
    const double force = body.mass * (std::max(c, 0.0) / b);  // c = 0 at lift-off, but for rounding
    return {body.normal_share * force, body.friction_share * force};
}

double slip_rate(const SlidingBody& body, const Geometry& at, double omega) {
    const auto [c, b] = response(body, at, omega);
    const double by_force = (body.friction_share - at.h * spin(body, at)) * (c / b);
    return by_force + body.gravity.along - at.dh * omega * omega;
}

double slowed_response_rate(const SlidingBody& body, const Geometry& at, double c) {
    return std::sqrt(std::abs(response_derivative(body, at) * c * spin(body, at)));
}

// The impulse of N changes omega and slip in a fixed ratio, physics (54).
LastMoment last_moment(const SlidingBody& body, double angle, double omega, double slip) {
    const Geometry at = geometry(body.axes, angle);
    const double b_derivative = response_derivative(body, at);
    const auto [c, b] = response(body, at, omega);
    const double turn_by_force = spin(body, at);
    const double slip_by_turning = body.friction_share / turn_by_force - at.h;
    const double without_slip = omega - slip / slip_by_turning;
    const double without_c = std::copysign(std::sqrt(-body.gravity.into / at.ddh), omega);
    const double impulse_to_stop = (without_slip - omega) / turn_by_force;
    const double to_no_c = (without_c - omega) / turn_by_force;
    const double impulse_to_jam = at.ddh < 0 && to_no_c >= 0 ? to_no_c : infinity;
    const bool stops = impulse_to_stop >= 0 && impulse_to_stop <= impulse_to_jam;
    const double omega_after = stops ? without_slip : without_c;
    const double slip_after = stops ? 0.0 : slip + slip_by_turning * (omega_after - omega);
    // The moment ends with B = 0, or when N = c/B has made the impulse: a slide that starts with so
    // small a B need not turn towards B = 0, nor turn at all.
    const double b_rate = b_derivative * omega;
    const double until_no_b = b_rate < 0 ? -b / b_rate : infinity;
    const double until_made = (stops ? impulse_to_stop : impulse_to_jam) * b / c;
    const double least = std::min(until_no_b, until_made >= 0 ? until_made : infinity);
    return {stops, omega_after, slip_after, slip_after + at.h * omega_after,
            least < infinity ? least : 0.0};
}

}  // namespace rolling_ellipse
