// The coordinate y in which the phase of a rolling motion is swept evenly, physics (61): nothing
// peaks in it, at the flat however thin the body, or at the tip however near the separatrix.
//
//     tan phase = g sc(w, k),   k' = kappa g,   w = theta_3(q)^2 y,   q = e^(-2 Y),
//
// sc = sn/cn of Jacobi with the complementary modulus k'. The flat position is at y = 0, the tip or
// turning point at y = Y, and all is symmetric about both. The integrand of the time is singular
// where tan phase is imaginary, between g and 1/kappa: on the line Im y = pi/2 (DLMF 22.4). Near
// either end y is the v of physics (31).
//
// By the theta functions of the nome q (DLMF 20.2, 22.2), with c = cosh 2y,
//     sc = C sinh(y) B(c)/A(c),   sc(Y - y) = 1/(k' sc(y)).
#pragma once

#include <array>

#include "numerics/numbers.hpp"

namespace rolling_ellipse {

// The hyperbolic sine of so much is infinite beside the phase; its square is not, as doubles go.
inline constexpr double largest_offset = 300.0;

struct PhaseMap {
    double quarter;  // Y; infinite on the separatrix
    double step;     // of the trapezoidal rule that integrates over a quarter
    int steps;       // in a quarter, or as far as the tail
    bool has_tail;   // the quarter is longer than the steps: as doubles go, the tip is reached
    double grade;    // g
    double kappa;
    double speed;        // dw/dy
    double sine_scale;   // C
    double flat_scale2;  // (g C)^2
    double tip_scale2;   // (kappa C)^2
    std::array<double, 4> a;
    std::array<double, 3> b;
};

// A point of the coordinate, y = quarters Y + offset; the nearest quarter unless told otherwise.
struct Place {
    int quarters;
    double offset;
};

// A phase, as its sine and cosine.
struct PhasePoint {
    double sin;
    double cos;
};

// For kappa, and a g that is no larger than the given one.
PhaseMap phase_map(double kappa, double largest_grade);

Place place_of(const PhaseMap& map, const PhasePoint& phase);

// With full relative accuracy of both, for a place that has the nearest quarter.
PhasePoint phase_point(const PhaseMap& map, const Place& at);

// The place so much further on, with the nearest quarter.
Place moved(const PhaseMap& map, const Place& from, double distance);

}  // namespace rolling_ellipse
