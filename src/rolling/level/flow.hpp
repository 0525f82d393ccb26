// Exact rolling on level ground: its start and the state at any time. Nothing is stepped; the cost
// of one time does not depend on its distance from the start.
#pragma once

#include <cmath>
#include <string>

#include "rolling/level/phase.hpp"
#include "scene/scene.hpp"

namespace rolling_ellipse {

// The height H = E/(m g) of the energy [m], and how far it is over the tip (H - L, negative in
// libration) and over the flat position (H - S), by forms that do not cancel: physics (26).
struct EnergyHeight {
    double total;
    double over_tip;
    double over_flat;
};

struct RollingStart {
    Body body;
    double theta;
    double omega;
    FlatView view;
    EnergyHeight height;
    bool rests;  // in equilibrium for all times
};

RollingStart rolling_start(const Body& body, double theta, double omega);

enum class MotionKind { rest, uniform, libration, rotation };

// An exact motion. Its phase is set for libration and rotation only.
struct RollingFlow : PhaseMotion<double> {
    MotionKind kind;
    RollingStart from;
    double x;  // position of the centre at the start [m]
};

RollingFlow rolling_flow(const RollingStart& from, double x = 0.0);

// Whether one power series about the start may cover a move: a bound by the time scales of the flat
// position and of turning.
inline bool may_be_short(const RollingStart& from, double t) {
    const double rate = std::sqrt(from.body.gravity / from.view.short_axis);
    return std::abs(t) * (std::abs(from.omega) + rate) < 0.05;
}

// The state at a time |t| <= longest_time.
FlowSample sample(const RollingFlow& flow, double t);

// 1e15 half turns [s]; beyond, a double does not resolve the phase.
double longest_time(const RollingFlow& flow);

// Throws std::invalid_argument for a time that is not finite or, in size, above `longest`.
void validate_time(double t, double longest, const std::string& name = "t");

// Time of a full swing or of a full turn [s]; infinite for a body at rest and on the separatrix.
double period(const RollingFlow& flow);

// Time from the flat position to a phase of the same half turn.
DoubleDouble time_since_flat(const RollingFlow& flow, const PhasePoint<double>& phase);

// The first time t >= 0 at which an ellipse that moves passes the angle theta with velocity of the
// given sign.
double time_of_passing(const RollingFlow& flow, double theta, double heading);

}  // namespace rolling_ellipse
