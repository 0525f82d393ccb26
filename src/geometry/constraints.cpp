#include "geometry/constraints.hpp"

#include <cmath>

namespace rolling_ellipse {
namespace {

// Depth of the lowest point of an ellipse under its centre [m], by the implicit equation d^T M d =
// 1 in ground axes, physics (11): without the support function, so that each method checks the
// other.
double lowest_depth(const Axes& axes, double theta) {
    const double along_a = std::sin(theta) / axes.b;
    const double along_b = std::cos(theta) / axes.a;
    // M = R^T diag(1/a^2, 1/b^2) R has det M = 1/(a b)^2; on the line at depth y the form is least
    // at y^2 det M/M_xx, which is 1 where the line is tangent.
    const double m_xx = along_a * along_a + along_b * along_b;
    return axes.a * axes.b * std::sqrt(m_xx);
}

}  // namespace

ConstraintMatrix constraint_matrix(const Axes& axes, const Coordinates& q) {
    const double psi = q[coordinate::psi];
    const double theta = q[coordinate::theta];
    const double r = q[coordinate::r];
    const double s = std::sin(psi - theta);
    const double c = std::cos(psi - theta);
    ConstraintMatrix matrix;
    // clang-format off
    // physics (14); columns: x, z, theta, psi, r
    matrix <<
        1, 0, -r * c, 0, 0,
        0, 1, -r * s, r * s, -c,
        0, 0, 0, -polar_radius_derivative(axes, psi), 1,
        0, 0, -contact_angle_rate(axes, geometry(axes, theta)), 1, 0;
    // clang-format on
    return matrix;
}

Eigen::Vector4d constraint_drift(const Axes& axes, const Coordinates& q, const Coordinates& q_dot) {
    const double theta = q[coordinate::theta];
    const double psi = q[coordinate::psi];
    const double r = q[coordinate::r];
    const double s = std::sin(psi - theta);
    const double c = std::cos(psi - theta);
    const double omega = q_dot[coordinate::theta];
    const double psi_dot = q_dot[coordinate::psi];
    const double r_dot = q_dot[coordinate::r];
    const double turn = psi_dot - omega;
    // physics (15)
    return {(r * s * turn - r_dot * c) * omega, 2 * r_dot * s * turn + r * c * turn * turn,
            -polar_radius_second(axes, psi) * psi_dot * psi_dot,
            -contact_angle_second(axes, geometry(axes, theta)) * omega * omega};
}

Eigen::Vector3d position_residuals(const Axes& axes, const Coordinates& q) {
    const double theta = q[coordinate::theta];
    const double psi = q[coordinate::psi];
    const double r = q[coordinate::r];
    // physics (13)
    return {q[coordinate::z] - r * std::cos(psi - theta), r - polar_radius(axes, psi),
            (psi - theta) - contact_angle_offset(geometry(axes, theta))};
}

ConstraintResiduals constraints(const Axes& axes, const Coordinates& q, const Coordinates& q_dot) {
    ConstraintResiduals result;
    result.position = position_residuals(axes, q);
    result.velocity = constraint_matrix(axes, q) * q_dot;
    const double depth = lowest_depth(axes, q[coordinate::theta]);
    result.gap = q[coordinate::z] - depth;
    // v + omega x d for the clockwise omega, x_dot + omega d_z: physics (12).
    result.slip = q_dot[coordinate::x] - q_dot[coordinate::theta] * depth;
    return result;
}

CoordinateState kinematics(const Axes& axes, double theta, double omega) {
    const Geometry at = geometry(axes, theta);
    const double psi = contact_angle(axes, theta);
    const double psi_dot = contact_angle_rate(axes, at) * omega;
    // r from psi as it is rounded: then f3 is zero to rounding, and f2 is flat in psi.
    CoordinateState state;
    state.q << centre_path(axes, theta), at.h, theta, psi, polar_radius(axes, psi);
    // physics (12)
    state.q_dot << at.h * omega, at.dh * omega, omega, psi_dot,
        polar_radius_derivative(axes, psi) * psi_dot;
    return state;
}

}  // namespace rolling_ellipse
