// Flight: centre on a parabola, angular velocity constant; exact. And its end: physics (55).
#pragma once

#include <optional>

#include "geometry/ellipse.hpp"
#include "scene/scene.hpp"

namespace rolling_ellipse {

struct Flight {
    Axes axes;
    GroundGravity gravity;
    State start;
    double gap_rate;  // at the start: z_dot - h' omega has less digits of a low hop
    Mode mode = Mode::flight;
};

State state_at(const Flight& flight, double t);

// The first contact after the start, after infinite time where there is none. A start in contact
// counts as leaving the ground: with the velocity, or the acceleration, that it has. After a small
// turn the rate of the gap has digits that the velocities there do not have.
struct Landing {
    double after;
    std::optional<double> gap_rate;
};
Landing touch_down(const Flight& flight);

}  // namespace rolling_ellipse
