// The four constraints on the report's coordinates q = (x, z, theta, psi, r), evaluated for any
// state: physics (13)
//     f1 = x_dot - r cos(psi - theta) theta_dot
//     f2 = z - r cos(psi - theta)
//     f3 = r - a b/sqrt(b^2 sin^2 psi + a^2 cos^2 psi)
//     f4 = psi - theta - atan2((a^2 - b^2) sin theta cos theta, b^2 cos^2 theta + a^2 sin^2 theta)
// f1 is the report's eq 10, corrected: the material point at the contact, not the geometric one, is
// at rest. f4 is the report's eq 5 on the branch that is continuous over all theta.
#pragma once

#include <Eigen/Core>

#include "geometry/ellipse.hpp"

namespace rolling_ellipse {

using Coordinates = Eigen::Matrix<double, 5, 1>;
using ConstraintMatrix = Eigen::Matrix<double, 4, 5>;

struct CoordinateState {
    Coordinates q;
    Coordinates q_dot;
};

namespace coordinate {
enum : int { x, z, theta, psi, r };
}

// The matrix A of the constraints A q_dot = 0. Its rows are the coefficients of q_dot in f1 and in
// the rates of f2, f3, f4: physics (14).
ConstraintMatrix constraint_matrix(const Axes& axes, const Coordinates& q);

// A_dot q_dot, the velocity term in the second derivatives of the constraints: physics (15).
Eigen::Vector4d constraint_drift(const Axes& axes, const Coordinates& q, const Coordinates& q_dot);

// The residuals f2 [m], f3 [m], f4 [rad].
Eigen::Vector3d position_residuals(const Axes& axes, const Coordinates& q);

struct ConstraintResiduals {
    Eigen::Vector3d position;  // f2 [m], f3 [m], f4 [rad]
    Eigen::Vector4d velocity;  // f1 [m/s] and the rates of f2, f3, f4
    double gap;                // height of the lowest point above the ground [m]
    double slip;               // velocity of the lowest material point along the ground [m/s]
};

ConstraintResiduals constraints(const Axes& axes, const Coordinates& q, const Coordinates& q_dot);

// The state that satisfies all constraints at theta and omega; its x is the path from theta = 0.
CoordinateState kinematics(const Axes& axes, double theta, double omega);

}  // namespace rolling_ellipse
