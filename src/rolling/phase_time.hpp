// Time as a function of the phase of an exact rolling motion, and its inverse.
//
// With L, S the long and short semi-axes, c^2 = L^2 - S^2, phi the angle from the flat position,
// H = E/(m g) the height of the energy and D = (d0 + d1 sin^2 phi)/h^2, physics (28), the integral
// of physics (27) becomes that of physics (29),
//     dt/dphase = scale sqrt(D (H + h)) / sqrt(cos^2 phase + kappa^2 sin^2 phase),
//     sin phi   = amplitude sin phase,
// rotation (phase = phi) and libration (phase = u of sin phi = sin phi_max sin u) are one integral:
//     rotation:  amplitude 1, scale^2 = 1/(2 g (H^2 - S^2)),   kappa^2 = (H^2 - L^2)/(H^2 - S^2)
//     libration: amplitude^2 = (H^2 - S^2)/c^2, scale^2 = 1/(2 g c^2), kappa^2 = (L^2 - H^2)/c^2
// No term is a difference that cancels, but for H - L itself.
//
// A quarter of the phase is split at 45 degrees. Each half is graded by tan(offset) = g sinh(v),
// physics (31), from its end (flat or tip), which places the singularities of the integrand at
// Im v = +-pi/2; g is kappa at the tip, at the flat the place of the zero of D. The part next to
// the split is measured from the split, w = W - v, sinh W = 1/g, so that nothing is lost however
// long the tip is.
#pragma once

#include "numerics/double_double.hpp"

namespace rolling_ellipse {

// One half of the quarter phase: from its end (flat or tip) to the split at 45 degrees.
struct Half {
    bool at_tip;
    double grade;        // g
    double rise_excess;  // sqrt(1 + g^2) - 1
    double length;       // W
    double end_length;   // v of the neck, where the two panels meet
    double rise_length;  // w of the neck
    DoubleDouble end_time;
    DoubleDouble rise_time;
};

// The constants of the integrand above.
struct PhaseRate {
    double short_axis;     // S
    double c2;             // L^2 - S^2
    double energy_height;  // H
    double amplitude2;
    double scale2;
    double kappa;
    double d0;
    double d1;
};

struct PhaseTime {
    PhaseRate rate;
    Half flat;
    Half tip;
    DoubleDouble split;         // from the flat position to 45 degrees
    DoubleDouble quarter_turn;  // to the tip or turning point; infinite on the separatrix
    DoubleDouble half_turn;     // in which the phase advances by pi
};

// A phase between -pi/2 and pi/2.
struct PhasePoint {
    double sin;
    double cos;
};

PhaseTime phase_time(const PhaseRate& rate);

// scale sqrt(D (H + h)) where phi has this sine.
double shape_factor(const PhaseRate& rate, double sin_phi);

DoubleDouble time_since_flat(const PhaseTime& phase, const PhasePoint& point);

// The inverse of time_since_flat, for |time| <= half_turn/2.
PhasePoint point_at_time(const PhaseTime& phase, DoubleDouble time);

}  // namespace rolling_ellipse
