// The report's system: coordinates q = (x, z, theta, psi, r), constraints f1 ... f4 and their
// Lagrange multipliers, from its Lagrangian (eqs 11-15), physics (21):
//     M q_ddot = Q + A^T lambda,   A q_dot = 0,
//     M = diag(m, m, I, 0, 0),     Q = (m g sin, -m g cos, 0, 0, 0)
// Q contains the slope. M is singular in psi and r (eqs 19, 20); the saddle-point matrix of M and A
// is regular.
#pragma once

#include "geometry/constraints.hpp"
#include "rolling/stepped/equation.hpp"
#include "scene/scene.hpp"

namespace rolling_ellipse {

struct MultiplierSolution {
    Coordinates q_ddot;
    Eigen::Vector4d multipliers;  // [N, N, N, N m]; the first two are the forces F and N
};

// The coordinates of a body in any mode: psi and r are those of its lowest point.
CoordinateState coordinate_state(const Axes& axes, const State& state);

// Accelerations and multipliers from a state and its contact force, by Newton's and Euler's laws.
MultiplierSolution accelerations(const Scene& scene, const CoordinateState& state,
                                 const ContactForce& force);

// The coordinates and velocities of a rolling body (x is the integral of h from 0), with its
// accelerations and multipliers.
struct RollingDetail : MultiplierSolution {
    CoordinateState state;
};

RollingDetail rolling_detail(const Scene& scene, double theta, double omega);

class ConstrainedBody {
  public:
    explicit ConstrainedBody(const Scene& scene);

    const Axes& axes() const { return axes_; }
    double length() const { return length_; }

    // Accelerations and multipliers that satisfy A q_ddot = demand.
    MultiplierSolution solve(const Coordinates& q, const Eigen::Vector4d& demand) const;

    // Accelerations and multipliers that preserve the constraints.
    MultiplierSolution solve(const CoordinateState& state) const;

    SpecificEnergy specific_energy(const CoordinateState& state) const;

    // The diagonal of the mass matrix and the force, both divided by the mass: M/m and Q/m.
    Coordinates specific_mass() const { return {1.0, 1.0, gyration2_, 0.0, 0.0}; }
    Coordinates specific_force() const { return {gravity_.along, -gravity_.into, 0.0, 0.0, 0.0}; }

    // The largest residual at q, max(|f2|/L, |f3|/L, |f4|), L being the long semi-axis.
    double largest_residual(const Coordinates& q) const;

    // Projects a state to the nearest one, in the kinetic metric, that satisfies the constraints;
    // then, if an energy per mass is given, moves it along the rolling direction until it has this
    // energy. Returns the largest residual before the projection.
    double project(CoordinateState& state) const;
    double project(CoordinateState& state, double energy) const;

  private:
    template <int Rows>
    struct Saddle {
        Coordinates change;
        Eigen::Matrix<double, Rows, 1> multipliers;
    };

    // Solves [M, -A^T; A, 0] (change, multipliers) = (force, demand), with M, force and
    // multipliers per unit mass.
    template <int Rows>
    Saddle<Rows> solve_saddle(const Eigen::Matrix<double, Rows, 5>& a, const Coordinates& force,
                              const Eigen::Matrix<double, Rows, 1>& demand) const;

    double as_length(const Eigen::Vector3d& residuals) const;  // largest residual [m]

    Axes axes_;
    double mass_;
    double gyration2_;
    GroundGravity gravity_;
    double length_;  // the long semi-axis, which makes angles and displacements comparable
};

}  // namespace rolling_ellipse
