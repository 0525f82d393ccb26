// The speeds and friction coefficients at which the motion on level ground changes its kind.
#pragma once

#include <optional>
#include <vector>

#include "scene/scene.hpp"
#include "scene/settings.hpp"

namespace rolling_ellipse {

// Speeds are |omega| when passing the flat position [rad/s]; angles are theta in [0, pi/2]. A speed
// or friction is infinite, and its angle absent, where the change never happens.
struct Thresholds {
    double roll_over_speed;                // above it the body turns over
    double contact_loss_speed = infinity;  // from it on rolling would need N < 0 somewhere
    std::optional<double> contact_loss_angle;
    double slip_speed = infinity;  // from it on rolling needs more friction than there is
    std::optional<double> slip_angle;
    double friction_to_roll_over;         // max |F|/N of rolling at the roll-over speed
    double painleve_friction = infinity;  // least mu for which sliding may jam
    std::optional<double> painleve_angle;
    double rocking_rate;  // angular frequency of small rocking [rad/s]
    double tip_rate;      // growth rate of falling from the tip [1/s]
};

Thresholds thresholds(const Body& body, double friction);

// The roll-over speed alone, physics (44): it needs no search.
double roll_over_speed(const Body& body);

// Speeds |omega| when passing the flat position [rad/s]; the upper one may be infinite.
struct SpeedRange {
    double lower;
    double upper;
};

struct LiftOff {
    double speed = infinity;  // the least with which it leaves the ground
    std::vector<SpeedRange> jam_speeds;
};

// Lift-off of a body between its first slip and the tip; below slip_speed it does not slip. Above
// Painleve's friction it may jam instead of leaving the ground, and leave it again at higher
// speeds. A scan finds those ranges, and bisection refines them to the last bit.
LiftOff lift_off(const Body& body, double friction, double slip_speed, double painleve_friction,
                 const Checkpoint& checkpoint);

}  // namespace rolling_ellipse
