// Exact flight, with the centre on a parabola and a constant angular velocity; the end of a flight,
// physics (55); and the sum of bounces that are too small and too short to resolve one by one.
#pragma once

#include <optional>

#include "scene/scene.hpp"
#include "scene/settings.hpp"

namespace rolling_ellipse {

struct Flight {
    Axes axes;
    GroundGravity gravity;
    State start;
    double gap_rate;  // initial rate of the gap, more accurate than z_dot - h' omega
    Mode mode = Mode::flight;
};

State state_at(const Flight& flight, double t);

// The state of a body in grazing contact, given the state of the free flight followed instead.
State grazing(const Geometry& at, const State& free, Mode mode);

// The height of the centre above which the body cannot touch the ground, however h is rounded.
double most_height(const Axes& axes);

// The first contact of a flight: the time from its start and, if the body has turned only a little,
// the rate of the gap, more accurate than the velocities would give it. A body in contact at the
// start counts as leaving the ground, through its velocity or its acceleration.
struct Landing {
    double after;
    std::optional<double> gap_rate;
};
Landing touch_down(const Flight& flight);

// The speed sqrt(g b) after a fall of half the short semi-axis b.
double speed_of_fall(const Scene& scene);

// The speed, in the given units, below which bounces may be summed instead of followed. Throws
// std::invalid_argument if the speed in the settings is too large.
double rest_speed(const Scene& scene, const Units& units, const Settings& settings);

// A rebound: its speed, the ratio of this speed to the speed of approach, and the free acceleration
// c after the rebound.
struct Bounce {
    double rebound;
    double ratio;
    double c;
};

// Whether summation starts at this bounce.
bool settles(const Scene& scene, double omega, const Bounce& first, double rest_speed);

// Bounces too small to resolve one by one, replaced by their averaged motion.
struct Settling {
    Axes axes;
    double lasts;
    State start;
    State end;
    DoubleDouble angle;  // final theta, to full accuracy
};

Settling settling(const Scene& scene, const State& start, const Bounce& first);

}  // namespace rolling_ellipse
