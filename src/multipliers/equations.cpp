#include "multipliers/equations.hpp"

#include <algorithm>
#include <cmath>

#include "numerics/lu.hpp"

namespace rolling_ellipse {
namespace {

// The direction of rolling in q, with dtheta = 1 and A dq = 0.
Coordinates rolling_direction(const ConstraintMatrix& a) {
    using namespace coordinate;
    Coordinates direction;
    direction[x] = -a(0, theta);
    direction[theta] = 1.0;
    direction[psi] = -a(3, theta);
    direction[r] = -a(2, psi) * direction[psi];
    direction[z] = -(a(1, theta) + a(1, psi) * direction[psi] + a(1, r) * direction[r]);
    return direction;
}

// The second derivatives of all coordinates, and the multipliers equivalent to a contact force.
//
// The multipliers of f1 and f2 are lambda1 = F and lambda2 = N. The rows of psi and r carry no
// mass: 0 = r sin lambda2 - R' lambda3 + lambda4, 0 = -cos lambda2 + lambda3. At the contact r
// cos(psi - theta) is stationary in psi, so that lambda4 = 0: physics (22).
MultiplierSolution contact_solution(const Axes& axes, const Geometry& at,
                                    const CoordinateState& state, const ContactForce& force,
                                    const RollingEquation::Accelerations& acceleration) {
    const double omega = state.q_dot[coordinate::theta];
    const double psi = state.q[coordinate::psi];
    const double psi_dot = contact_angle_rate(axes, at) * omega;
    const double psi_ddot = contact_angle_rate(axes, at) * acceleration.theta +
                            contact_angle_second(axes, at) * omega * omega;
    const PolarRadius r = polar_radius(axes, psi);
    const double r_ddot = r.derivative * psi_ddot + r.second * psi_dot * psi_dot;
    const double stationary = force.normal * std::cos(psi - state.q[coordinate::theta]);
    MultiplierSolution result;
    result.q_ddot << acceleration.x, acceleration.z, acceleration.theta, psi_ddot, r_ddot;
    result.multipliers << force.friction, force.normal, stationary, 0.0;
    return result;
}

}  // namespace

CoordinateState coordinate_state(const Axes& axes, const State& state) {
    using namespace coordinate;
    CoordinateState result = kinematics(axes, state.theta, state.omega);
    result.q[x] = state.x;
    result.q[z] = state.z;
    result.q_dot[x] = state.x_dot;
    result.q_dot[z] = state.z_dot;
    return result;
}

MultiplierSolution accelerations(const Scene& scene, const CoordinateState& state,
                                 const ContactForce& force) {
    const Geometry at = geometry(scene.axes(), state.q[coordinate::theta]);
    const GroundGravity gravity = scene.ground_gravity();
    const double most = scene.rolling_resistance * force.normal;
    const double torque = -(at.h * force.friction + at.dh * force.normal);
    const double omega = state.q_dot[coordinate::theta];
    // Without rotation, the couple of rolling resistance balances the torque, up to its limit.
    const double couple = omega == 0 ? std::clamp(torque, -most, most) : std::copysign(most, omega);
    const double omega_dot = (torque - couple) / scene.inertia;
    return contact_solution(scene.axes(), at, state, force,
                            {omega_dot, force.friction / scene.mass + gravity.along,
                             force.normal / scene.mass - gravity.into});
}

RollingDetail rolling_detail(const Scene& scene, double theta, double omega) {
    const Axes axes = scene.axes();
    const Geometry at = geometry(axes, theta);
    const RollingEquation rolling(scene.body(), scene.slope);
    const RollingEquation::Accelerations of_centre = rolling.accelerations(at, omega);
    const CoordinateState state = kinematics(axes, theta, omega);
    const ContactForce force = rolling.force(scene.mass, at, omega);
    return {contact_solution(axes, at, state, force, of_centre), state};
}

ConstrainedBody::ConstrainedBody(const Scene& scene)
    : axes_(scene.axes()),
      mass_(scene.mass),
      gyration2_(scene.body().gyration2),
      gravity_(scene.ground_gravity()),
      length_(std::max(scene.a, scene.b)) {}

// Solves with angles scaled to lengths, so that pivots are comparable; f4 is the last row of `a`.
template <int Rows>
ConstrainedBody::Saddle<Rows> ConstrainedBody::solve_saddle(
    const Eigen::Matrix<double, Rows, 5>& a, const Coordinates& force,
    const Eigen::Matrix<double, Rows, 1>& demand) const {
    constexpr int size = 5 + Rows;
    const Coordinates unit{1.0, 1.0, 1 / length_, 1 / length_, 1.0};
    Eigen::Matrix<double, Rows, 1> row_unit = Eigen::Matrix<double, Rows, 1>::Ones();
    row_unit[Rows - 1] = length_;
    const Eigen::Matrix<double, Rows, 5> rows = row_unit.asDiagonal() * a * unit.asDiagonal();

    Eigen::Matrix<double, size, size> matrix = Eigen::Matrix<double, size, size>::Zero();
    matrix.diagonal().template head<5>() = specific_mass().cwiseProduct(unit).cwiseProduct(unit);
    matrix.template topRightCorner<5, Rows>() = -rows.transpose();
    matrix.template bottomLeftCorner<Rows, 5>() = rows;
    Eigen::Matrix<double, size, 1> right;
    right << force.cwiseProduct(unit), row_unit.cwiseProduct(demand);
    const Eigen::Matrix<double, size, 1> solution = LU<double, size>(matrix).solve(right);
    return {solution.template head<5>().cwiseProduct(unit),
            solution.template tail<Rows>().cwiseProduct(row_unit)};
}

MultiplierSolution ConstrainedBody::solve(const Coordinates& q,
                                          const Eigen::Vector4d& demand) const {
    const auto [q_ddot, specific] =
        solve_saddle<4>(constraint_matrix(axes_, q), specific_force(), demand);
    return {q_ddot, mass_ * specific};
}

MultiplierSolution ConstrainedBody::solve(const CoordinateState& state) const {
    return solve(state.q, -constraint_drift(axes_, state.q, state.q_dot));
}

// physics (17)
SpecificEnergy ConstrainedBody::specific_energy(const CoordinateState& state) const {
    const auto& [q, q_dot] = state;
    return {0.5 * q_dot.dot(specific_mass().cwiseProduct(q_dot)), -specific_force().dot(q)};
}

double ConstrainedBody::largest_residual(const Coordinates& q) const {
    return as_length(position_residuals(axes_, q)) / length_;
}

// Projects by Newton's method until the residuals stop shrinking. psi and r have no mass and can be
// changed freely. If they are far off, they are first computed from theta, so that the projection
// hardly changes theta.
double ConstrainedBody::project(CoordinateState& state) const {
    constexpr int most_iterations = 20;
    auto& [q, q_dot] = state;
    const double missed = largest_residual(q);
    if (!(missed <= 1)) q.tail<2>() = kinematics(axes_, q[coordinate::theta], 0.0).q.tail<2>();
    double last = infinity;
    for (int i = 0; i < most_iterations; ++i) {
        const Eigen::Vector3d residuals = position_residuals(axes_, q);
        const double size = as_length(residuals);
        if (size == 0 || !(size < last)) break;
        last = size;
        const Eigen::Matrix<double, 3, 5> rows = constraint_matrix(axes_, q).bottomRows<3>();
        q += solve_saddle<3>(rows, Coordinates::Zero(), -residuals).change;
    }
    const ConstraintMatrix a = constraint_matrix(axes_, q);
    q_dot += solve_saddle<4>(a, Coordinates::Zero(), -a * q_dot).change;
    return missed;
}

// Projects by Newton's method along the rolling direction until the excess energy stops shrinking.
// Along this direction the energy changes by inertia (omega domega - pull dtheta), where `pull` is
// the component of the force divided by `inertia`. The correction minimises domega^2 +
// (g/L) dtheta^2, which is regular even at turning points.
double ConstrainedBody::project(CoordinateState& state, double energy) const {
    constexpr int most_iterations = 20;
    const double rate2 = root_of_squares(gravity_.into, gravity_.along) / length_;
    const double missed = project(state);
    double last = infinity;
    for (int i = 0; i < most_iterations; ++i) {
        const double excess = specific_energy(state).total() - energy;
        if (excess == 0 || !(std::abs(excess) < last)) return missed;
        last = std::abs(excess);
        const double omega = state.q_dot[coordinate::theta];
        const Coordinates along = rolling_direction(constraint_matrix(axes_, state.q));
        const double inertia = along.dot(specific_mass().cwiseProduct(along));
        const double pull = specific_force().dot(along) / inertia;
        const double steepness = inertia * (pull * pull / rate2 + omega * omega);
        if (steepness == 0) return missed;
        state.q += excess / steepness * pull / rate2 * along;
        state.q_dot -= excess / steepness * omega * along;
        project(state);
    }
    return missed;
}

double ConstrainedBody::as_length(const Eigen::Vector3d& residuals) const {
    return residuals.cwiseProduct(Eigen::Vector3d{1.0, 1.0, length_}).cwiseAbs().maxCoeff();
}

}  // namespace rolling_ellipse
