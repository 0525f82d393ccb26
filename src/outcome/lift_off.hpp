// From which speed on a rolling body really leaves the ground: after its rolling has ended.
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
    double speed;  // the least with which it leaves the ground; infinite if there is none
    std::vector<SpeedRange> jam_speeds;
};

// What becomes of the body once it slips, before it passes the tip; below slip_speed it does not
// slip. Above Painleve's friction it may jam instead of leaving the ground, and leave it again at
// higher speeds; those ranges are found by a scan, and refined to the last bit.
LiftOff lift_off(const Body& body, double friction, double slip_speed, double painleve_friction,
                 const Checkpoint& checkpoint);

}  // namespace rolling_ellipse
