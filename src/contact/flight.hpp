// Flight, exact: the centre on a parabola, the angular velocity constant; and its end, physics
// (55).
#pragma once

#include <optional>

#include "geometry/ellipse.hpp"
#include "scene/scene.hpp"

namespace rolling_ellipse {

struct Flight {
    Axes axes;
    GroundGravity gravity;
    State start;
    double gap_rate;  // at the start; z_dot - h' omega has fewer digits of it for a low hop
    Mode mode = Mode::flight;
};

State state_at(const Flight& flight, double t);

// The first contact after the start. A start in contact counts as leaving the ground, with its
// velocity or its acceleration. The rate of the gap is given after a small turn, where it has more
// digits than the velocities.
struct Landing {
    double after;
    std::optional<double> gap_rate;
};
Landing touch_down(const Flight& flight);

}  // namespace rolling_ellipse
