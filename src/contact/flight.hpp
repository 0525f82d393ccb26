// Flight: centre on a parabola, angular velocity constant; exact. And its end: physics (55).
#pragma once

#include "geometry/ellipse.hpp"
#include "scene/scene.hpp"

namespace rolling_ellipse {

struct Flight {
    Axes axes;
    GroundGravity gravity;
    State start;
};

State state_at(const Flight& flight, double t);

// The time of the first contact after the start, infinite where there is none. A start in contact
// counts as leaving the ground: with the velocity, or the acceleration, that it has.
double touch_down(const Flight& flight);

}  // namespace rolling_ellipse
