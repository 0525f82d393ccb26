#include "geometry/constraints.hpp"

#include <cmath>

namespace rolling_ellipse {
namespace {

// Depth of the lowest point of an ellipse below its centre [m], from the implicit equation d^T M d
// = 1 in ground axes, physics (11). The support function is deliberately not used, so that the gap
// and the slip are an independent check of it.
double lowest_depth(const Axes& axes, double theta) {
    const double along_a = std::sin(theta) / axes.b;
    const double along_b = std::cos(theta) / axes.a;
    // M = R^T diag(1/a^2, 1/b^2) R has det M = 1/(a b)^2; on the horizontal line at depth y, the
    // quadratic form has the minimum y^2 det M/M_xx, which is 1 if the line is tangent.
    const double m_xx = along_a * along_a + along_b * along_b;
    return axes.a * axes.b * std::sqrt(m_xx);
}

}  // namespace

ConstraintMatrix constraint_matrix(const Axes& axes, const Coordinates& q) {
    using namespace coordinate;
    const double s = std::sin(q[psi] - q[theta]);
    const double c = std::cos(q[psi] - q[theta]);
    ConstraintMatrix matrix;
    // clang-format off
    // physics (14); columns: x, z, theta, psi, r
    matrix <<
        1, 0, -q[r] * c, 0, 0,
        0, 1, -q[r] * s, q[r] * s, -c,
        0, 0, 0, -polar_radius(axes, q[psi]).derivative, 1,
        0, 0, -contact_angle_rate(axes, geometry(axes, q[theta])), 1, 0;
    // clang-format on
    return matrix;
}

Eigen::Vector4d constraint_drift(const Axes& axes, const Coordinates& q, const Coordinates& q_dot) {
    using namespace coordinate;
    const double s = std::sin(q[psi] - q[theta]);
    const double c = std::cos(q[psi] - q[theta]);
    const double omega = q_dot[theta];
    const double psi_dot = q_dot[psi];
    const double turn = psi_dot - omega;
    // The rows of A_dot q_dot, physics (15).
    return {(q[r] * s * turn - q_dot[r] * c) * omega,
            2 * q_dot[r] * s * turn + q[r] * c * turn * turn,
            -polar_radius(axes, q[psi]).second * psi_dot * psi_dot,
            -contact_angle_second(axes, geometry(axes, q[theta])) * omega * omega};
}

Eigen::Vector3d position_residuals(const Axes& axes, const Coordinates& q) {
    using namespace coordinate;
    const double offset = q[psi] - q[theta];
    // The residuals f2, f3 and f4, physics (13).
    return {q[z] - q[r] * std::cos(offset), q[r] - polar_radius(axes, q[psi]).value,
            offset - contact_angle_offset(geometry(axes, q[theta]))};
}

ConstraintResiduals constraints(const Axes& axes, const Coordinates& q, const Coordinates& q_dot) {
    using namespace coordinate;
    const double depth = lowest_depth(axes, q[theta]);
    // The slip is the component of v + omega x d along the ground; for the clockwise omega, it is
    // x_dot + omega d_z: physics (12).
    return {position_residuals(axes, q), constraint_matrix(axes, q) * q_dot, q[z] - depth,
            q_dot[x] - q_dot[theta] * depth};
}

CoordinateState kinematics(const Axes& axes, double theta, double omega) {
    const Geometry at = geometry(axes, theta);
    const double psi = contact_angle(axes, theta);
    const double psi_dot = contact_angle_rate(axes, at) * omega;
    // The radius at the rounded psi makes f3 zero to within rounding; f2, which is stationary in
    // psi, hardly changes.
    const PolarRadius r = polar_radius(axes, psi);
    CoordinateState state;
    state.q << centre_path(axes, theta), at.h, theta, psi, r.value;
    // The velocities of a rolling body, physics (12).
    state.q_dot << at.h * omega, at.dh * omega, omega, psi_dot, r.derivative * psi_dot;
    return state;
}

}  // namespace rolling_ellipse
