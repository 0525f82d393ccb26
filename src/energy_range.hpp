// The heights h that a rolling motion reaches, and the contact forces there as rational functions.
//
// Lengths in units of the long semi-axis, forces in units of m g. With B = S^2, K = k^2, u = h^2,
// s = K + 1 + B, V = s u - B and H the height of the energy, P and Q of h are
//     P = 3 s h^5 - 2 H s h^4 + (K s - 5 B) h^3 + 4 H B h^2 - 3 K B h + 2 H K B
//     Q = -3 s h^3 + 2 H s h^2 + 5 B h - 4 H B
//     N = h P/V^2,   F = h' u Q/V^2,   (h h')^2 = G = (1 - u)(u - B)
// from D = V/u and omega^2 = 2 (H - h)/D in N and F of rolling. In y = u - B, with c2 = 1 - B:
//     P = h (B (K+B) (K+B-2c2) + (K+B) (K+7B+c2) y + 3 s y^2) + 2 H (B (K+B) (c2-2y) - s y^2)
//     Q = h (B (2c2-3K-B) - 3 s y) + 2 H (B (K-c2) + s y),   V = B (K+B) + s y
// where a nearly circular body keeps its digits: that is how they are evaluated.
#pragma once

#include "flow.hpp"
#include "polynomial.hpp"

namespace rolling_ellipse {

// h = short_axis + width x, 0 <= x <= 1.
struct EnergyRange {
    double short_axis;
    double gyration2;
    double c2;
    double energy;      // H
    double width;       // of the heights reached
    double energy_gap;  // H minus the greatest height reached (0 in libration)
    double tip_gap;     // 1 minus the greatest height reached (0 in rotation)
    bool libration;
};

EnergyRange energy_range(const FlatView& at, const Body& body, double omega);

// The range of a rotation with the energy of the separatrix, H = 1.
EnergyRange separatrix_range(double short_axis, double gyration2, double c2);

// Polynomials in x. P = normal_free + H normal_energy.
struct ForcePolynomials {
    Polynomial height;
    Polynomial normal_free;
    Polynomial normal_energy;
    Polynomial normal;        // P
    Polynomial friction;      // Q
    Polynomial slope_square;  // G
    Polynomial weight;        // V
};

ForcePolynomials force_polynomials(const EnergyRange& range);

// The contact forces at one place, straight from the equations of rolling.
struct RollingForces {
    double x;
    double angle;     // from the flat position, 0 .. pi/2
    double normal;    // N/(m g)
    double friction;  // |F|/(m g)

    double needed() const;  // |F|/N; infinite where N <= 0 without N = F = 0
};

RollingForces rolling_forces(const EnergyRange& range, double x);

// By sin^2 and cos^2 of the angle from the flat position and omega^2 in units of g/L: near the tip
// the angle knows more than x.
RollingForces rolling_forces(const EnergyRange& range, double sin2, double cos2, double omega2);

struct ForceExtremes {
    RollingForces least_normal;
    RollingForces most_friction;  // largest |F|/N
};

// From the critical points of N and of |F|/N, the ends of the range, and the zeros of N.
ForceExtremes force_extremes(const EnergyRange& range, const ForcePolynomials& polynomials);

}  // namespace rolling_ellipse
