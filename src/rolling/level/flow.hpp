// Exact rolling on level ground: the state at any time. Nothing is stepped; the cost of one time
// does not depend on how far it is from the start.
#pragma once

#include <cmath>
#include <string>

#include "rolling/level/phase.hpp"
#include "rolling/level/start.hpp"

namespace rolling_ellipse {

// Angle and path since the flat position, each as quarter turns plus what is over the nearest one
// (|angle| <= pi/4): differences keep their digits near the flat and near the tip.
struct QuarterPosition {
    double quarters;
    double angle;
    double path;
};

enum class MotionKind { rest, uniform, libration, rotation };

// A motion, for single states.
struct RollingMotion : PhaseMotion<double> {
    MotionKind kind;
    // The start.
    double theta;
    double omega;
    double x;
    double gravity;
    FlatView start;
};

// The times and paths from which samples of many times and events are counted.
struct RollingFlow : RollingMotion {
    DoubleDouble start_time;
    QuarterPosition start_position;
    double quarter_path;
};

RollingMotion rolling_motion(const RollingStart& from, double x = 0.0);
RollingFlow rolling_flow(const RollingStart& from, double x = 0.0);

// Whether a move may be so short that one power series about its start knows it: by the time scale
// of the flat position and of turning.
inline bool may_be_short(double t, double omega, double gravity, double short_axis) {
    return std::abs(t) * (std::abs(omega) + std::sqrt(gravity / short_axis)) < 0.05;
}

// For |t| up to longest_time.
FlowSample sample(const RollingMotion& motion, double t);

// 1e15 half turns: beyond, a double does not know the phase.
double longest_time(const RollingMotion& motion);

// Throws std::invalid_argument for a time that is not finite or longer, in either direction.
void validate_time(double t, double longest, const std::string& name = "t");

// +1 or -1: which way the motion goes at its start, for angles and for omega.
double heading(const RollingMotion& motion);

// Where the body is at a phase on the way up.
QuarterPosition position_at(const RollingFlow& flow, const PhasePoint<double>& phase);

// Time of a full swing or of a full turn; infinite for a body at rest and on the separatrix.
double period(const RollingMotion& motion);

// The first time t >= 0 at which an ellipse that moves passes the angle theta with velocity of the
// given sign.
double time_of_passing(const RollingFlow& flow, double theta, double heading);

}  // namespace rolling_ellipse
