// Rolling without slip as one degree of freedom: its equation, and everything that follows from
// theta and omega.
#pragma once

#include <cmath>

#include "geometry/constraints.hpp"
#include "integrator/system.hpp"
#include "scene/scene.hpp"

namespace rolling_ellipse {

// D theta'' + h' (g cos(alpha) + rho omega^2) - h g sin(alpha) = 0, physics (18), for
// y = (theta, omega), alpha the slope, D = k^2 + h^2 + h'^2.
class RollingEquation {
  public:
    static constexpr int size = 2;

    RollingEquation(const Body& body, double slope);

    double acceleration(double sin_theta, double cos_theta, double omega) const;

    Vector<2> operator()(double t, const Vector<2>& y) const;
    Matrix<2> jacobian(double t, const Vector<2>& y) const;
    Vector<2> mass() const { return Vector<2>::Ones(); }
    Vector<2> typical() const {
        return {1.0, std::sqrt(std::hypot(gravity_.into, gravity_.along) / long_axis_)};
    }

  private:
    Axes axes_;
    double a2_;
    double b2_;
    double c2_;  // a^2 - b^2
    double gyration2_;
    GroundGravity gravity_;
    double long_axis_;
};

// physics (18) times h^4, so that one root and one division are enough: with u = h^2, p = h h',
//     theta'' u (u (k^2 + u) + p^2) = u h (u g sin(alpha) - p g cos(alpha)) - p a^2 b^2 omega^2
inline double RollingEquation::acceleration(double s, double c, double omega) const {
    const double u = a2_ * s * s + b2_ * c * c;
    const double p = c2_ * s * c;
    const double drive = u * std::sqrt(u) * (u * gravity_.along - p * gravity_.into);
    const double turning = p * a2_ * b2_ * omega * omega;
    return (drive - turning) / (u * (u * (gyration2_ + u) + p * p));
}

inline Vector<2> RollingEquation::operator()(double, const Vector<2>& y) const {
    return {y[1], acceleration(std::sin(y[0]), std::cos(y[0]), y[1])};
}

// Everything that rolling does at a place: physics (20), Newton's law for the centre.
class RollingDynamics {
  public:
    explicit RollingDynamics(const Scene& scene);

    struct Accelerations {
        double theta;
        double x;
        double z;
    };
    Accelerations accelerations(const Geometry& at, double omega) const;
    ContactForce force(const Accelerations& of_centre) const;
    ContactForce force(const Geometry& at, double omega) const {
        return force(accelerations(at, omega));
    }

  private:
    RollingEquation equation_;
    double mass_;
    GroundGravity gravity_;
};

ContactForce rolling_force(const Scene& scene, double theta, double omega);

// The second derivatives of psi and r of the contact point, and the multipliers that a contact
// force makes.
struct SecondRates {
    double psi;
    double r;
};
SecondRates contact_point_second_rates(const Axes& axes, const Geometry& at, double psi,
                                       double omega, double omega_dot);
Eigen::Vector4d contact_multipliers(const Coordinates& q, const ContactForce& force);

struct RollingDetail {
    CoordinateState state;  // its x is the integral of h from 0
    Coordinates q_ddot;
    ContactForce force;
    Eigen::Vector4d multipliers;
};

RollingDetail rolling_detail(const Scene& scene, double theta, double omega);

}  // namespace rolling_ellipse
