#include "rolling/stepped/equation.hpp"

#include <algorithm>
#include <cmath>

namespace rolling_ellipse {

RollingEquation::RollingEquation(const Body& body, double slope)
    : axes_(body.axes()),
      turned_{{square(body.a), square(body.b), (body.a - body.b) * (body.a + body.b)},
              {square(body.b), square(body.a), (body.b - body.a) * (body.b + body.a)}},
      gyration2_(body.gyration2),
      gravity_(ground_gravity(body.gravity, slope)),
      long_axis_(std::max(body.a, body.b)) {}

// physics (19), with D' = 2 h' rho and rho' = -3 rho h'/h.
Matrix<2> RollingEquation::jacobian(double, const Vector<2>& y) const {
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

// physics (17)
SpecificEnergy RollingEquation::energy(const Geometry& at, double omega, double x) const {
    return {0.5 * inertia_about_contact(gyration2_, at) * omega * omega,
            gravity_.into * at.h - gravity_.along * x};
}

RollingEquation::Accelerations RollingEquation::accelerations(const Geometry& at,
                                                              double omega) const {
    const double omega2 = omega * omega;
    const double omega_dot = acceleration(at.sin, at.cos, omega);
    return {omega_dot, at.h * omega_dot + at.dh * omega2, at.dh * omega_dot + at.ddh * omega2};
}

ContactForce RollingEquation::force(double mass, const Accelerations& of_centre) const {
    return {mass * (gravity_.into + of_centre.z), mass * (of_centre.x - gravity_.along)};
}

ContactForce rolling_force(const Scene& scene, double theta, double omega) {
    const RollingEquation rolling(scene.body(), scene.slope);
    return rolling.force(scene.mass, geometry(scene.axes(), theta), omega);
}

}  // namespace rolling_ellipse
