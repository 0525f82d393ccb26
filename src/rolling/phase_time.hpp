// Time as a function of the phase of an exact rolling motion, and its inverse: integrals of
// rolling/phase_rates.hpp.
//
// The rates are even about the flat and the tip and analytic for |Im y| < pi/2. So the trapezoidal
// rule has the time of a quarter, with an error that falls like exp(-pi^2/step) (L. N. Trefethen,
// J. A. C. Weideman, SIAM Rev. 56 (2014) 385). A part of a quarter is Gauss-Legendre quadrature,
// from where it starts, so that a short way is known as well as a long one.
#pragma once

#include <array>

#include "numerics/double_double.hpp"
#include "rolling/phase_rates.hpp"

namespace rolling_ellipse {

struct PhaseTime {
    PhaseRate rate;
    PhaseMap map;
    DoubleDouble quarter_turn;  // to the tip or turning point; infinite on the separatrix
    DoubleDouble half_turn;     // in which the phase advances by pi
    double quarter_path;        // of the centre; of a rotation
    // dt/dy at the steps of the map, and one beside them, and what cubics through it make of the
    // time since the flat: where to look for a time.
    static constexpr int most_steps = 160;
    std::array<double, most_steps + 3> slope;
    std::array<double, most_steps + 1> time;
};

PhaseTime phase_time(const PhaseRate& rate);

// scale sqrt(D (H + h)) where phi has this sine.
double shape_factor(const PhaseRate& rate, double sin_phi);

DoubleDouble time_since_flat(const PhaseTime& phase, const PhasePoint& point);

// Where a motion is after a time of at most a full swing, and the way there.
struct PhaseMove {
    Place to;
    PhaseWay way;
};
PhaseMove move(const PhaseTime& phase, const Place& from, double time);

// The path of the centre of a libration from a place to one beyond the next turning point, as it is
// without the way to that and back.
double path_between(const PhaseTime& phase, const Place& from, const Place& to);

}  // namespace rolling_ellipse
