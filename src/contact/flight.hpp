// Flight, exact: the centre on a parabola, the angular velocity constant; its end, physics (55);
// and bounces that are too small and too short to resolve one by one, summed.
#pragma once

#include <optional>

#include "scene/scene.hpp"
#include "scene/settings.hpp"

namespace rolling_ellipse {

struct Flight {
    Axes axes;
    GroundGravity gravity;
    State start;
    double gap_rate;  // rate of the gap at the start; z_dot - h' omega would have fewer digits
    Mode mode = Mode::flight;
};

State state_at(const Flight& flight, double t);

// A state of free flight as that of the grazing contact which it follows.
State grazing(const Geometry& at, const State& free, Mode mode);

// The height of the centre above which the body does not touch the ground, however h is rounded.
double most_height(const Axes& axes);

// The first contact of a flight: the time since its start and, after a small turn, the rate of the
// gap, which then has more digits than the velocities. A start in contact counts as leaving the
// ground, with its velocity or its acceleration.
struct Landing {
    double after;
    std::optional<double> gap_rate;
};
Landing touch_down(const Flight& flight);

// The speed sqrt(g b) of a fall by half the short semi-axis b.
double speed_of_fall(const Scene& scene);

// The speed, in the given units, below which bounces may be summed. Throws std::invalid_argument if
// the speed in the settings is too large.
double rest_speed(const Scene& scene, const Units& units, const Settings& settings);

// A rebound: its speed, the ratio of this speed to the speed of approach, and c after it.
struct Bounce {
    double rebound;
    double ratio;
    double c;
};

// Whether a bounce is the first of those that are summed.
bool settles(const Scene& scene, double omega, const Bounce& first, double rest_speed);

// Bounces too small to resolve one by one, replaced by their averaged motion.
struct Settling {
    Axes axes;
    double lasts;
    State start;
    State end;
    DoubleDouble angle;  // theta of the end, to full accuracy
};

Settling settling(const Scene& scene, const State& start, const Bounce& first);

}  // namespace rolling_ellipse
