// Exact rolling on level ground: the state at any time, from the energy integral alone.
//
// With L, S the long and short semi-axes, phi the angle from the flat position, H = E/(m g) the
// height of the energy, D = (d0 + d1 sin^2 phi)/h^2 and
//     dt/dphase = scale sqrt(D (H + h)) / sqrt(cos^2 phase + kappa^2 sin^2 phase),
//     sin phi   = amplitude sin phase,
// rotation (phase = phi) and libration (phase = u of sin phi = sin phi_max sin u) are one integral:
//     rotation:  amplitude 1, scale^2 = 1/(2 g (H^2 - S^2)),   kappa^2 = (H^2 - L^2)/(H^2 - S^2)
//     libration: amplitude^2 = (H^2 - S^2)/c^2, scale^2 = 1/(2 g c^2), kappa^2 = (L^2 - H^2)/c^2
// with c^2 = L^2 - S^2. No term is a difference that cancels, but for H - L itself.
//
// A quarter of the phase is split at 45 degrees. Each half is graded by tan(offset) = g sinh(v) from
// its end (flat or tip), which places the singularities of the integrand at Im v = +-pi/2; g is
// kappa at the tip, at the flat the place of the zero of D. The half next to the split is measured
// from the split, w = W - v, sinh W = 1/g, so that nothing is lost however long the tip is.
#pragma once

#include "double_double.hpp"
#include "ellipse.hpp"

namespace rolling_ellipse {

// One half of the quarter phase: from its end (flat or tip) to the split at 45 degrees.
struct Half {
    bool at_tip;
    double grade;         // g
    double slope_excess;  // sqrt(1 + g^2) - 1
    double length;        // W
    double end_length;    // v of the neck, where the two panels meet
    double slope_length;  // w of the neck
    DoubleDouble end_time;
    DoubleDouble slope_time;
};

// Angle and path since the flat position, each as quarter turns plus what is over the nearest one
// (|angle| <= pi/4): differences keep their digits near the flat and near the tip.
struct QuarterPosition {
    double quarters;
    double angle;
    double path;
};

enum class MotionKind { rest, uniform, libration, rotation };

struct RollingFlow {
    MotionKind kind;
    // The start.
    double theta;
    double omega;
    double x;
    FlatView start;
    // The motion.
    double direction;      // of rotation; +1 for libration
    double energy_height;  // H
    double amplitude2;
    double scale2;
    double kappa;
    double d0;
    double d1;
    Half flat;
    Half tip;
    DoubleDouble half_turn_time;  // in which the phase advances by pi
    // The start as the motion sees it.
    bool start_on_way_back;  // of a libration: phase beyond +-pi/2
    DoubleDouble start_time;
    QuarterPosition start_position;
    double quarter_path;
};

struct FlowSample {
    double theta;
    double omega;
    double x;
};

RollingFlow rolling_flow(const Body& body, double theta, double omega, double x = 0.0);

FlowSample sample(const RollingFlow& flow, double t);

// Time of a full swing or of a full turn; infinite for a body at rest and on the separatrix.
double period(const RollingFlow& flow);

// The first time t >= 0 at which the body passes the angle theta with velocity of the given sign.
double time_of_passing(const RollingFlow& flow, double theta, double heading);

// The height H = E/(m g) of the energy [m], and how far it is over the tip (H - L, negative in
// libration) and over the flat position (H - S), by forms that do not cancel.
struct EnergyHeight {
    double total;
    double over_tip;
    double over_flat;
};

EnergyHeight energy_height(const FlatView& at, double gyration2, double gravity, double omega);

}  // namespace rolling_ellipse
