#include "contact/sliding.hpp"

#include <algorithm>
#include <cmath>

namespace rolling_ellipse {

SlidingEquation::SlidingEquation(const Scene& scene, double side)
    : axes_(scene.axes()),
      side_(side),
      mass_(scene.mass),
      gyration2_(scene.body().gyration2),
      gravity_(scene.ground_gravity()),
      normal_share_(std::isinf(scene.friction) ? 0.0 : 1.0),
      friction_share_(std::isinf(scene.friction) ? -side : -scene.friction * side) {}

ContactForce SlidingEquation::force(const Geometry& at, double omega) const {
    const auto [c, b] = contact(at, omega);
    const double force = mass_ * (c / b);
    return {normal_share_ * force, friction_share_ * force};
}

// The impulse of N changes omega and slip in a fixed ratio, physics (54).
SlidingEquation::LastMoment SlidingEquation::last_moment(const Vector<5>& y) const {
    const Geometry at = geometry(axes_, y[0]);
    const double b_derivative =
        (2 * normal_share_ * at.dh * at.ddh + friction_share_ * (at.dh * at.dh + at.h * at.ddh)) /
        gyration2_;
    const auto [c, b] = contact(at, y[1]);
    const double spin = -(at.h * friction_share_ + at.dh * normal_share_) / gyration2_;
    const double slip_by_turning = friction_share_ / spin - at.h;
    const double without_slip = y[1] - y[3] / slip_by_turning;
    const double without_c = std::copysign(std::sqrt(-gravity_.into / at.ddh), y[1]);
    const double impulse_to_stop = (without_slip - y[1]) / spin;
    const double impulse_to_jam =
        at.ddh < 0 && (without_c - y[1]) / spin >= 0 ? (without_c - y[1]) / spin : infinity;
    const bool stops = impulse_to_stop >= 0 && impulse_to_stop <= impulse_to_jam;
    const double omega = stops ? without_slip : without_c;
    const double slip = stops ? 0.0 : y[3] + slip_by_turning * (omega - y[1]);
    // Until B = 0, or until N = c/B has made the impulse: a slide that starts with so small a B
    // need not turn towards B = 0, nor turn at all.
    const double b_rate = b_derivative * y[1];
    const double until_no_b = b_rate < 0 ? -b / b_rate : infinity;
    const double until_made = (stops ? impulse_to_stop : impulse_to_jam) * b / c;
    const double least = std::min(until_no_b, until_made >= 0 ? until_made : infinity);
    const double after = least < infinity ? least : 0.0;
    const double turn = y[1] * after;
    return {stops ? slip_vanishes : jams,
            {y[0] + turn, omega, y[2] + (y[3] + at.h * y[1]) * after, slip, y[4] + after}};
}

}  // namespace rolling_ellipse
