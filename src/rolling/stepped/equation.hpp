// Rolling without slip as one degree of freedom: the equation of motion, and the accelerations and
// forces that follow from theta and omega.
#pragma once

#include <algorithm>
#include <cmath>

#include "geometry/ellipse.hpp"
#include "integrator/system.hpp"
#include "numerics/numbers.hpp"
#include "scene/centre_of_rolling.hpp"
#include "scene/scene.hpp"

namespace rolling_ellipse {

// Energy per mass [J/kg].
struct SpecificEnergy {
    double kinetic;
    double potential;

    double total() const { return kinetic + potential; }
};

// The energy of a state, with x = 0 at the start of the motion, and the largest constraint residual
// (geometry/constraints.hpp): |f2| or |f3| divided by the long semi-axis, or |f4|.
struct Invariants {
    SpecificEnergy energy;
    double residual;
};

// The equation of rolling D theta'' + h' (g cos(alpha) + rho omega^2) - h g sin(alpha) = 0, physics
// (18), for y = (theta, omega), with the slope alpha and D = k^2 + h^2 + h'^2.
class RollingEquation {
  public:
    static constexpr int size = 2;

    RollingEquation(const Body& body, double slope)
        : RollingEquation(body, ground_gravity(body.gravity, slope)) {}
    RollingEquation(const Body& body, const GroundGravity& gravity)
        : axes_(body.axes()),
          turned_{{square(body.a), square(body.b), (body.a - body.b) * (body.a + body.b)},
                  {square(body.b), square(body.a), (body.b - body.a) * (body.b + body.a)}},
          gyration2_(body.gyration2),
          gravity_(gravity),
          long_axis_(std::max(body.a, body.b)) {}

    double acceleration(double sin_theta, double cos_theta, double omega) const {
        return acceleration(turned_[0], sin_theta, cos_theta, omega);
    }

    // The rate of y. Each quarter turn exchanges the axes of the body.
    [[gnu::always_inline]] Vector<2> operator()(double, const Vector<2>& y) const {
        if (!(std::abs(y[0]) <= largest_in_quarters)) {
            return {y[1], acceleration(std::sin(y[0]), std::cos(y[0]), y[1])};
        }
        const auto [rest, odd] = nearest_quarter(y[0]);
        const auto [sine, cosine] = sine_cosine_of_rest(rest);
        return {y[1], acceleration(turned_[odd], sine, cosine, y[1])};
    }

    // Derivatives of the rate of y: physics (19), with D' = 2 h' rho and rho' = -3 rho h'/h.
    Matrix<2> jacobian(double, const Vector<2>& y) const {
        const Geometry at = geometry(axes_, y[0]);
        const double omega = y[1];
        const double inertia = inertia_about_contact(gyration2_, at);
        const double load = gravity_.into + at.rho * omega * omega;
        const double rho_derivative = -3 * at.rho * at.dh / at.h;
        const double by_theta = at.dh * gravity_.along - at.ddh * load -
                                at.dh * rho_derivative * omega * omega -
                                2 * at.dh * at.rho * acceleration(at.sin, at.cos, omega);
        const double by_omega = -2 * at.dh * at.rho * omega;
        Matrix<2> jacobian;
        jacobian << 0.0, 1.0, by_theta / inertia, by_omega / inertia;
        return jacobian;
    }

    // Energy per mass, physics (17).
    SpecificEnergy energy(const Geometry& at, double omega, double x) const {
        return {0.5 * inertia_about_contact(gyration2_, at) * omega * omega,
                gravity_.into * at.h - gravity_.along * x};
    }

    // Accelerations of theta and of the centre, physics (18, 20).
    struct Accelerations {
        double theta;
        double x;
        double z;
    };

    Accelerations accelerations(const Geometry& at, double omega) const {
        const auto [up, along] = centre(at, omega).acceleration;
        return {acceleration(at.sin, at.cos, omega), along, up};
    }

    ContactForce force(double mass, const Geometry& at, double omega) const {
        const auto [normal, friction] = centre(at, omega).force_per_mass;
        return {mass * normal, mass * friction};
    }

    // The acceleration with a normal force that acts `lever` ahead of the contact. Its couple
    // changes the angular acceleration by -s, s = lever N/(m M), where N is the normal force
    // without the couple and M = D + lever h': physics (64).
    double acceleration(const Geometry& at, double omega, double lever) const {
        const double slowing = lever * force(1.0, at, omega).normal / inertia(at, lever);
        return acceleration(at.sin, at.cos, omega) - slowing;
    }
    ContactForce force(double mass, const Geometry& at, double omega, double lever) const {
        const auto [normal, friction] = centre(at, omega).force_per_mass;
        const double slowing = lever * normal / inertia(at, lever);
        return {mass * (normal - at.dh * slowing), mass * (friction - at.h * slowing)};
    }

    bool is_level() const { return gravity_.along == 0; }
    Vector<2> mass() const { return Vector<2>::Ones(); }
    Vector<2> typical() const {
        return {1.0, std::sqrt(root_of_squares(gravity_.into, gravity_.along) / long_axis_)};
    }

  private:
    double inertia(const Geometry& at, double lever) const {
        return inertia_about_contact(gyration2_, at) + lever * at.dh;
    }

    CentreOfRolling<double> centre(const Geometry& at, double omega) const {
        return centre_of_rolling(gyration2_, gravity_.into, gravity_.along, at.h, at.dh, at.ddh,
                                 bend_of_height(axes_, at), omega * omega);
    }

    struct Squares {
        double a2;
        double b2;
        double c2;  // a^2 - b^2
    };

    // Physics (18), multiplied by h^4, takes one square root and one division, neither of which
    // waits for the other. With u = h^2, p = h h',
    //     theta'' (u^2 (k^2 + u) + u p^2)
    //         = u h (u g sin(alpha) - p g cos(alpha)) - p a^2 b^2 omega^2
    [[gnu::always_inline]] double acceleration(const Squares& axes, double s, double c,
                                               double omega) const {
        const double u = axes.a2 * (s * s) + axes.b2 * (c * c);
        const double p = axes.c2 * (s * c);
        const double inverse = 1 / (u * u * (gyration2_ + u) + u * (p * p));
        const double drive = u * (u * gravity_.along - p * gravity_.into) * std::sqrt(u);
        const double turning = p * (axes.a2 * axes.b2 * (omega * omega));
        return (drive - turning) * inverse;
    }

    Axes axes_;
    Squares turned_[2];  // squares of the axes after even and after odd quarter turns
    double gyration2_;
    GroundGravity gravity_;
    double long_axis_;
};

// The lever of the normal force while the body rolls. A body at rest starts to turn in the
// direction in which it falls.
inline double rolling_lever(const Scene& scene, const Geometry& at, double omega) {
    return lever_against(scene, omega == 0 ? at.h * std::tan(scene.slope) - at.dh : omega);
}

// The contact force of a rolling body, or of a body at rest.
inline ContactForce rolling_force(const Scene& scene, const Geometry& at, double omega) {
    const RollingEquation rolling(scene.body(), scene.slope);
    if (scene.rolling_resistance == 0) return rolling.force(scene.mass, at, omega);
    const auto [into, along] = scene.ground_gravity();
    if (omega == 0 && is_held(scene, at)) return {scene.mass * into, -scene.mass * along};
    return rolling.force(scene.mass, at, omega, rolling_lever(scene, at, omega));
}

}  // namespace rolling_ellipse
