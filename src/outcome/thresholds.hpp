// The speeds and friction coefficients at which the motion on level ground changes its kind.
#pragma once

#include <optional>

#include "scene/scene.hpp"

namespace rolling_ellipse {

// Speeds are |omega| when passing the flat position [rad/s]; angles are theta in [0, pi/2]. A speed
// or friction is infinite, and its angle absent, where the change never happens.
struct Thresholds {
    double roll_over_speed;     // above it the body turns over
    double contact_loss_speed;  // from it on rolling would need N < 0 somewhere
    std::optional<double> contact_loss_angle;
    double slip_speed;  // from it on rolling needs more friction than there is
    std::optional<double> slip_angle;
    double friction_to_roll_over;  // max |F|/N of rolling at the roll-over speed
    double painleve_friction;      // least mu for which sliding may jam
    std::optional<double> painleve_angle;
    double rocking_rate;  // angular frequency of small rocking [rad/s]
    double tip_rate;      // growth rate of falling from the tip [1/s]
};

Thresholds thresholds(const Body& body, double friction);

// The roll-over speed alone, physics (44): it needs no search.
double roll_over_speed(const Body& body);

}  // namespace rolling_ellipse
