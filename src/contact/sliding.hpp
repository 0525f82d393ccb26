// Sliding with Coulomb friction in one direction: contact force, equation, and what ends it.
#pragma once

#include <array>

#include "integrator/system.hpp"
#include "rolling/equation.hpp"
#include "scene/scene.hpp"

namespace rolling_ellipse {

enum SlideEnd { slip_vanishes, pressure_vanishes, jams };

// y = (theta, omega, x, slip velocity), physics (51); side is the sign of the slip. With infinite
// friction the limit holds, physics (52): no normal force, and friction alone keeps the gap closed.
class SlidingEquation {
  public:
    static constexpr int size = 4;

    SlidingEquation(const Scene& scene, double side);

    Vector<4> operator()(double t, const Vector<4>& y) const;

    // What stays positive while it slides on, in the order of SlideEnd: the slip, the free
    // acceleration c into the ground, physics (53), and B, the normal acceleration that a unit of
    // normal force makes (Painleve), physics (49, 50).
    std::array<double, 3> margins(const Vector<4>& y) const;

    // With infinite friction B is small near the tip, and nothing grows there.
    bool may_jam() const { return normal_share_ != 0; }

    // The rates of (y, t) by a clock tau that slows down near B = 0, dt = B dtau, where N =
    // c/B grows without bound: physics (54).
    Vector<5> slowed(const Vector<5>& y) const;

    // Where a slide ends that has come to B = 0 with c > 0: in a moment, N makes either the slip or
    // c vanish.
    struct LastMoment {
        SlideEnd end;
        Vector<5> y;
    };
    LastMoment last_moment(const Vector<5>& y) const;

    ContactForce force(const Geometry& at, double omega) const;

    struct Contact {
        double c;
        double b;
    };
    Contact contact(const Geometry& at, double omega) const;

  private:
    Axes axes_;
    double side_;
    double mass_;
    double gyration2_;
    GroundGravity gravity_;
    double normal_share_;    // of the contact force: 1, and 0 with infinite friction
    double friction_share_;  // -mu s; -s with infinite friction
};

// The force along its direction cancels the acceleration -c of the gap: per mass N = c/B with B =
// Gnn - mu s Gtn, physics (50); with infinite friction F = c/Gtn and N = 0, physics (52).
inline SlidingEquation::Contact SlidingEquation::contact(const Geometry& at, double omega) const {
    const double c = free_acceleration(at, gravity_.into, omega);
    const double gnn = 1 + at.dh * at.dh / gyration2_;
    const double gtn = at.h * at.dh / gyration2_;
    const double b = normal_share_ * gnn + friction_share_ * gtn;
    return {c, b};
}

inline Vector<5> SlidingEquation::slowed(const Vector<5>& y) const {
    const double omega = y[1];
    const Geometry at = geometry(axes_, y[0]);
    const auto [c, b] = contact(at, omega);
    const double normal = normal_share_ * c;  // B times the forces, physics (51, 54)
    const double friction = friction_share_ * c;
    const double omega_dot = -(at.h * friction + at.dh * normal) / gyration2_;
    const double slip_dot =
        friction - at.h * omega_dot + b * (gravity_.along - at.dh * omega * omega);
    return {b * omega, omega_dot, b * (y[3] + at.h * omega), slip_dot, b};
}

inline Vector<4> SlidingEquation::operator()(double t, const Vector<4>& y) const {
    const Vector<5> rates = slowed({y[0], y[1], y[2], y[3], t});
    return rates.head<4>() / rates[4];
}

inline std::array<double, 3> SlidingEquation::margins(const Vector<4>& y) const {
    const auto [c, b] = contact(geometry(axes_, y[0]), y[1]);
    const double slip = side_ == 0 ? 1.0 : side_ * y[3];  // without friction it goes on for ever
    return {slip, c, b};
}

}  // namespace rolling_ellipse
