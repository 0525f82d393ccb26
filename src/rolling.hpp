// Rolling without slip as one degree of freedom: everything that follows from theta and omega.
#pragma once

#include "constraints.hpp"
#include "scene.hpp"

namespace rolling_ellipse {

// theta'' of  D theta'' + h' (g cos(alpha) + rho omega^2) - h g sin(alpha) = 0.
double rolling_acceleration(const Body& body, double slope, const Geometry& at, double omega);

struct RollingDetail {
    KinematicState state;  // its x is the integral of h from 0
    Coordinates q_ddot;
    double normal_force;    // [N]
    double friction_force;  // [N], on the body, along x
    Eigen::Vector4d multipliers;
};

RollingDetail rolling_detail(const Scene& scene, double theta, double omega);

}  // namespace rolling_ellipse
