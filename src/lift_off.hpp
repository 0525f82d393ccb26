// From which speed on a rolling body really leaves the ground: after its rolling has ended.
#pragma once

#include "scene.hpp"

namespace rolling_ellipse {

// The least |omega| when passing the flat position with which the body, once it slips, leaves the
// ground before it passes the tip; infinite if there is none. Below slip_speed it does not slip.
double lift_off_speed(const Body& body, double friction, double slip_speed);

}  // namespace rolling_ellipse
