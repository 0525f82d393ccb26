// The heights h of a rolling motion, and its contact forces as rational functions of h.
//
// Lengths are in units of the long semi-axis, forces in units of m g. With the short semi-axis S,
// B = S^2, c2 = 1 - B, K = k^2, u = h^2, y = u - B, s = K + 1 + B, H = E/(m g) and e = H - h:
//     V = s u - B = B (K + B) + s y,           D = V/u,   omega^2 = 2 e/D    physics (32)
//     P = h V (K + u) + 2 e (B (K + B) (c2 - 2y) - s y^2),   N = h P/V^2     physics (33)
//     Q = -h V + 2 e (B (K - c2) + s y),                     F = h' u Q/V^2  physics (34)
//     G = (h h')^2 = (1 - u) y                                               physics (35)
// These formulas follow from physics (23, 24). Cancellation is avoided: c2 is accurate even for a
// nearly circular body, and e even for a thin body near a turning point.
#pragma once

#include "numerics/polynomial.hpp"
#include "proof/law.hpp"
#include "rolling/level/flow.hpp"

namespace rolling_ellipse {

// A body in units of its long semi-axis.
struct Shape {
    double short_axis;
    double gyration2;
    double c2;  // 1 - short_axis^2
};

Shape shape(const Body& body, const FlatView& view);

// The quantities at a position of a rolling body from which D = kh + h'^2 and N = (kh + omega^2
// normal_part)/D are computed, physics (16, 23).
struct ShapePlace {
    double h2;
    double h;
    double dh2;
    double kh;  // k^2 + h^2
    double normal_part;

    double inertia() const { return kh + dh2; }
};

ShapePlace place_at(const Shape& shape, double sin2, double cos2);

// The heights h = short_axis + width x, 0 <= x <= 1, that a body reaches with a given energy.
struct EnergyRange : Shape {
    double width;       // width of the range of heights
    double energy_gap;  // H minus the greatest height reached; 0 in libration
    double tip_gap;     // 1 minus the greatest height reached; 0 in rotation
    bool libration;
};

EnergyRange energy_range(const RollingStart& start);

// The range of heights for an energy that is over_flat = H - S above the flat position and
// over_tip = H - 1 above the tip.
EnergyRange energy_range(const Shape& shape, double over_flat, double over_tip);

// The range of heights at the energy of the separatrix, H = 1.
EnergyRange separatrix_range(const Shape& shape);

// The polynomials of the forces in x; P = normal_at_rest + e normal_moving.
struct ForcePolynomials {
    Polynomial<1> height;
    Polynomial<2> weight;  // V in D = V/u
    Polynomial<5> normal_at_rest;
    Polynomial<4> normal_moving;
    Polynomial<5> normal;        // P in N = h P/V^2
    Polynomial<3> friction;      // Q in F = h' u Q/V^2
    Polynomial<4> slope_square;  // G = (h h')^2
};

ForcePolynomials force_polynomials(const EnergyRange& range);

// Contact forces at one position, from the equations of rolling.
struct RollingForces {
    double sin;       // sine of the angle from the flat position
    double cos;       // cosine of that angle; both are >= 0
    double normal;    // N/(m g)
    double friction;  // |F|/(m g)

    // angle() is measured from the flat position, 0 .. pi/2; angle_to_tip() is accurate near the
    // tip.
    double angle() const { return std::atan2(sin, cos); }
    double angle_to_tip() const { return std::atan2(cos, sin); }
    // The friction needed, |F|/N; infinite where N <= 0, unless N = F = 0.
    double needed() const { return friction_needed({normal, friction}); }
};

// Contact forces at the height h = short_axis + width x.
RollingForces rolling_forces(const EnergyRange& range, double x);

// Contact forces from sin^2 and cos^2 of the angle, which are more accurate than x near the tip.
RollingForces rolling_forces(const EnergyRange& range, double sin2, double cos2);

// Contact forces from sin^2 and cos^2 of the angle and omega^2 in units of g/L.
RollingForces rolling_forces(const EnergyRange& range, double sin2, double cos2, double omega2);

struct ForceExtremes {
    RollingForces least_normal;
    RollingForces most_friction;  // forces at the largest |F|/N
};

// The extremes of N and |F|/N over a range, among their critical points, the ends of the range and
// the zeros of N.
ForceExtremes force_extremes(const EnergyRange& range, const ForcePolynomials& polynomials);

}  // namespace rolling_ellipse
