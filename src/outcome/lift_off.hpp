// The speed from which on a rolling body leaves the ground, some time after its rolling has ended.
#pragma once

#include <vector>

#include "scene/scene.hpp"
#include "scene/settings.hpp"

namespace rolling_ellipse {

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
