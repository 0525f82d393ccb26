// Rolling without slip as one degree of freedom: its equation, and everything that follows from
// theta and omega.
#pragma once

#include "constraints.hpp"
#include "integrator/common.hpp"
#include "scene.hpp"

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

  private:
    Axes axes_;
    double a2_;
    double b2_;
    double c2_;  // a^2 - b^2
    double gyration2_;
    double weight_;  // g cos(alpha)
    double pull_;    // g sin(alpha)
};

struct ContactForce {
    double normal;    // [N]
    double friction;  // [N], on the body, along x
};

ContactForce rolling_force(const Scene& scene, double theta, double omega);

struct RollingDetail {
    KinematicState state;  // its x is the integral of h from 0
    Coordinates q_ddot;
    ContactForce force;
    Eigen::Vector4d multipliers;
};

RollingDetail rolling_detail(const Scene& scene, double theta, double omega);

}  // namespace rolling_ellipse
