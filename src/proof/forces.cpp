#include "proof/forces.hpp"

#include <algorithm>
#include <cmath>

namespace rolling_ellipse {
namespace {

// Numerator of dN/dx, where N = h P/V^2: physics (36).
Polynomial<7> normal_derivative(const ForcePolynomials& p) {
    const Polynomial<6> moment = p.height * p.normal;
    return derivative(moment) * p.weight - 2.0 * (moment * derivative(p.weight));
}

// Numerator of d(F/N)^2/dx divided by Q, where (F/N)^2 = G Q^2/P^2: physics (36).
Polynomial<11> needed_derivative(const ForcePolynomials& p) {
    const Polynomial<7> bracket =
        derivative(p.friction) * p.normal - p.friction * derivative(p.normal);
    return derivative(p.slope_square) * p.friction * p.normal + 2.0 * (p.slope_square * bracket);
}

ShapePlace place_at(const Shape& shape, double h2, double sin2, double cos2) {
    const double b = shape.short_axis;
    const double h = std::sqrt(h2);
    const double dh2 = square(shape.c2) * sin2 * cos2 / h2;
    const double ddh = shape.c2 * (b * cos2 - sin2) * (b * cos2 + sin2) / (h * h2);
    const double kh = shape.gyration2 + h2;
    return {h2, h, dh2, kh, ddh * kh - h * dh2};
}

}  // namespace

Shape shape(const Body& body, const FlatView& view) {
    const double unit = view.long_axis;
    return {view.short_axis / unit, body.gyration2 / square(unit), view.c2 / square(unit)};
}

ShapePlace place_at(const Shape& shape, double sin2, double cos2) {
    return place_at(shape, square(shape.short_axis) * cos2 + sin2, sin2, cos2);
}

EnergyRange energy_range(const RollingStart& start) {
    const FlatView& at = start.view;
    const double unit = at.long_axis;
    const Shape body = shape(start.body, at);
    return energy_range(body, start.height.over_flat / unit, start.height.over_tip / unit);
}

EnergyRange energy_range(const Shape& shape, double over_flat, double over_tip) {
    EnergyRange range = separatrix_range(shape);
    range.libration = over_tip < 0;
    if (range.libration) {
        range.width = over_flat;
        range.tip_gap = -over_tip;
    } else {
        range.energy_gap = over_tip;
    }
    return range;
}

EnergyRange separatrix_range(const Shape& shape) {
    return {shape, shape.c2 / (1 + shape.short_axis), 0.0, 0.0, false};
}

ForcePolynomials force_polynomials(const EnergyRange& range) {
    const double b = range.short_axis;
    const double b2 = square(b);
    const double k2 = range.gyration2;
    const double c2 = range.c2;
    const double w = range.width;
    const double kb = k2 + b2;
    const double s = kb + 1;
    Polynomial<0> friction_flat;  // B (K - c2), which may cancel
    friction_flat.coefficients[0] = tracked(b2) * (tracked(k2) - tracked(c2));

    ForcePolynomials p;
    p.height = polynomial(b, w);
    const Polynomial<2> y = polynomial(0.0, 2 * b * w, w * w);
    const Polynomial<1> energy = polynomial(range.energy_gap + w, -w);
    p.weight = polynomial(b2 * kb) + s * y;  // physics (32)
    p.normal_at_rest = p.height * p.weight * (polynomial(kb) + y);
    p.normal_moving = 2.0 * (b2 * kb * (polynomial(c2) - 2.0 * y) - s * (y * y));
    p.normal = p.normal_at_rest + energy * p.normal_moving;                     // physics (33)
    p.friction = 2.0 * energy * (friction_flat + s * y) - p.height * p.weight;  // physics (34)
    // physics (35): (h - S)(h + S)(1 - h)(1 + h), with h - S = w x and 1 - h = tip_gap + w (1 - x).
    p.slope_square = y * polynomial(range.tip_gap + w, -w) * polynomial(1 + b, w);
    return p;
}

RollingForces rolling_forces(const EnergyRange& range, double sin2, double cos2, double omega2) {
    const ShapePlace at = place_at(range, sin2, cos2);
    const double d = at.inertia();
    const double normal = (at.kh + omega2 * at.normal_part) / d;  // physics (23)
    // physics (24): F = h theta'' + h' omega^2 with theta'' of physics (18), rho h = S^2/h^2
    const double inertial = omega2 * (d - square(range.short_axis) / at.h2);
    const double friction = std::sqrt(at.dh2) * std::abs(inertial - at.h) / d;
    return {std::sqrt(sin2), std::sqrt(cos2), normal, friction};
}

RollingForces rolling_forces(const EnergyRange& range, double x) {
    const double over_flat = range.width * x;
    const double to_top = range.width * (1 - x);
    const double h = range.short_axis + over_flat;
    const double sin2 = over_flat * (h + range.short_axis) / range.c2;
    const double cos2 = (range.tip_gap + to_top) * (1 + h) / range.c2;
    const double energy = range.energy_gap + to_top;
    const double inertia = place_at(range, h * h, sin2, cos2).inertia();
    return rolling_forces(range, sin2, cos2, 2 * energy / inertia);
}

RollingForces rolling_forces(const EnergyRange& range, double sin2, double cos2) {
    const ShapePlace at = place_at(range, sin2, cos2);
    const double to_tip = range.c2 * cos2 / (1 + at.h);
    const double over_flat = range.c2 * sin2 / (at.h + range.short_axis);
    const double to_top = sin2 > cos2 ? to_tip - range.tip_gap : range.width - over_flat;
    const double energy = range.energy_gap + std::max(to_top, 0.0);
    return rolling_forces(range, sin2, cos2, 2 * energy / at.inertia());
}

ForceExtremes force_extremes(const EnergyRange& range, const ForcePolynomials& polynomials) {
    const RollingForces flat = rolling_forces(range, 0.0);
    ForceExtremes extremes{flat, flat};
    const auto take = [&](const RollingForces& forces) {
        if (forces.normal < extremes.least_normal.normal) extremes.least_normal = forces;
        if (forces.needed() > extremes.most_friction.needed()) extremes.most_friction = forces;
    };
    // The zeros of N come first, so that one of them is reported if several positions have an
    // infinite |F|/N.
    for (const double x : roots_on_unit_interval(bernstein(polynomials.normal))) {
        RollingForces forces = rolling_forces(range, x);
        forces.normal = 0.0;
        take(forces);
    }
    const auto take_at_roots = [&](const auto& derivative) {
        for (const double x : roots_on_unit_interval(bernstein(derivative))) {
            take(rolling_forces(range, x));
        }
    };
    take_at_roots(normal_derivative(polynomials));
    take_at_roots(needed_derivative(polynomials));
    take(rolling_forces(range, 1.0));
    return extremes;
}

}  // namespace rolling_ellipse
