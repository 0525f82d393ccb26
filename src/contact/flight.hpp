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

// The first contact after the start, after infinite time where there is none. A start in contact
// counts as leaving the ground: with the velocity, or the acceleration, that it has.
//
// A body that is free but for rounding, as on a tip that is just not thrown off, may stay on the
// ground, or hop lower than numbers tell: it grazes. That lasts until the free acceleration c into
// the ground is clear of its rounding again, and ends without an impact.
struct Landing {
    double after;
    bool grazes;
};
Landing touch_down(const Flight& flight);

}  // namespace rolling_ellipse
