#include "sliding.hpp"

#include <algorithm>
#include <cmath>

namespace rolling_ellipse {

double slip_velocity(const State& state, const Geometry& at) {
    return state.x_dot - at.h * state.omega;
}

double noticeable_slip(const State& state, const Geometry& at) {
    const double slip = slip_velocity(state, at);
    return std::abs(slip) <= 8 * epsilon * std::abs(state.x_dot) ? 0.0 : slip;
}

State in_contact(const Geometry& at, double theta, double omega, double x, double slip, Mode mode) {
    return {theta, omega, x, at.h, slip + at.h * omega, at.dh * omega, mode};
}

FreeContact free_contact(const Scene& scene, const Geometry& at, double omega) {
    const double k2 = scene.body().gyration2;
    return {1 + at.h * at.h / k2, at.h * at.dh / k2, 1 + at.dh * at.dh / k2,
            scene.gravity * std::cos(scene.slope) + at.ddh * omega * omega};
}

SlidingEquation::SlidingEquation(const Scene& scene, double side)
    : axes_{scene.a, scene.b},
      side_(side),
      mass_(scene.mass),
      gyration2_(scene.body().gyration2),
      weight_(scene.gravity * std::cos(scene.slope)),
      pull_(scene.gravity * std::sin(scene.slope)),
      normal_share_(std::isinf(scene.friction) ? 0.0 : 1.0),
      friction_share_(std::isinf(scene.friction) ? -side : -scene.friction * side) {}

// The force along its direction closes the gap: N = c/B, B = Gnn - mu s Gnt.
SlidingEquation::Contact SlidingEquation::contact(const Geometry& at, double omega) const {
    const double c = weight_ + at.ddh * omega * omega;
    const double gnn = 1 + at.dh * at.dh / gyration2_;
    const double gtn = at.h * at.dh / gyration2_;
    const double b = normal_share_ * gnn + friction_share_ * gtn;
    return {c, b};
}

ContactForce SlidingEquation::force(double theta, double omega) const {
    const auto [c, b] = contact(geometry(axes_, theta), omega);
    return {mass_ * normal_share_ * c / b, mass_ * friction_share_ * c / b};
}

Vector<4> SlidingEquation::operator()(double t, const Vector<4>& y) const {
    const Vector<5> rates = slowed({y[0], y[1], y[2], y[3], t});
    return rates.head<4>() / rates[4];
}

Vector<5> SlidingEquation::slowed(const Vector<5>& y) const {
    const double omega = y[1];
    const Geometry at = geometry(axes_, y[0]);
    const auto [c, b] = contact(at, omega);
    const double normal = normal_share_ * c;  // B times the forces
    const double friction = friction_share_ * c;
    const double omega_dot = -(at.h * friction + at.dh * normal) / gyration2_;
    const double slip_dot = friction - at.h * omega_dot + b * (pull_ - at.dh * omega * omega);
    return {b * omega, omega_dot, b * (y[3] + at.h * omega), slip_dot, b};
}

std::array<double, 3> SlidingEquation::margins(const Vector<4>& y) const {
    const auto [c, b] = contact(geometry(axes_, y[0]), y[1]);
    const double slip = side_ == 0 ? 1.0 : side_ * y[3];  // without friction it goes on for ever
    return {slip, c, b};
}

// B = 0 gives theta, c = 0 gives omega; the impulse of N that does it changes the slip as well.
Vector<5> SlidingEquation::jam(const Vector<5>& y) const {
    const Geometry at = geometry(axes_, y[0]);
    const double b_slope =
        (2 * normal_share_ * at.dh * at.ddh + friction_share_ * (at.dh * at.dh + at.h * at.ddh)) /
        gyration2_;
    const double turn = -contact(at, y[1]).b / b_slope;
    const double after = turn / y[1];
    const double omega = std::copysign(std::sqrt(std::max(-weight_ / at.ddh, 0.0)), y[1]);
    const double spin = -(at.h * friction_share_ + at.dh * normal_share_) / gyration2_;
    const double slip = y[3] + (friction_share_ / spin - at.h) * (omega - y[1]);
    return {y[0] + turn, omega, y[2] + (y[3] + at.h * y[1]) * after, slip, y[4] + after};
}

}  // namespace rolling_ellipse
