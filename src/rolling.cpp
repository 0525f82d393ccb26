#include "rolling.hpp"

#include <cmath>

namespace rolling_ellipse {
namespace {

// The multipliers of the gradients of f1 ... f4: lambda1 = F, lambda2 = N, and from the rows of psi
// and r, which carry no mass: 0 = r sin lambda2 - R' lambda3 + lambda4, 0 = -cos lambda2 + lambda3.
// At the contact r cos(psi - theta) is stationary in psi, so that lambda4 = 0.
Eigen::Vector4d multipliers(const Coordinates& q, double friction, double normal) {
    const double offset = q[coordinate::psi] - q[coordinate::theta];
    return {friction, normal, normal * std::cos(offset), 0.0};
}

}  // namespace

double rolling_acceleration(const Body& body, double slope, const Geometry& at, double omega) {
    const double inertia = body.gyration2 + at.h * at.h + at.dh * at.dh;
    const double weight = body.gravity * std::cos(slope);
    const double pull = body.gravity * std::sin(slope);
    return (at.h * pull - at.dh * (weight + at.rho * omega * omega)) / inertia;
}

RollingDetail rolling_detail(const Scene& scene, double theta, double omega) {
    const Axes axes{scene.a, scene.b};
    const Geometry at = geometry(axes, theta);
    const double omega2 = omega * omega;
    const double omega_dot = rolling_acceleration(scene.body(), scene.slope, at, omega);
    const double x_ddot = at.h * omega_dot + at.dh * omega2;
    const double z_ddot = at.dh * omega_dot + at.ddh * omega2;

    RollingDetail detail;
    detail.state = kinematics(axes, theta, omega);
    const double psi = detail.state.q[coordinate::psi];
    const double psi_dot = detail.state.q_dot[coordinate::psi];
    const double psi_ddot =
        contact_angle_rate(axes, at) * omega_dot + contact_angle_second(axes, at) * omega2;
    const double r_ddot = polar_radius_slope(axes, psi) * psi_ddot +
                          polar_radius_second(axes, psi) * psi_dot * psi_dot;
    detail.q_ddot << x_ddot, z_ddot, omega_dot, psi_ddot, r_ddot;
    detail.normal_force = scene.mass * (scene.gravity * std::cos(scene.slope) + z_ddot);
    detail.friction_force = scene.mass * (x_ddot - scene.gravity * std::sin(scene.slope));
    detail.multipliers = multipliers(detail.state.q, detail.friction_force, detail.normal_force);
    return detail;
}

}  // namespace rolling_ellipse
