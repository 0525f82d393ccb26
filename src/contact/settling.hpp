// Bounces that are too small and too short to tell apart, taken together.
#pragma once

#include "contact/units.hpp"
#include "numerics/double_double.hpp"
#include "scene/settings.hpp"

namespace rolling_ellipse {

// Of a body that falls by its short semi-axis.
double speed_of_fall(const Scene& scene);

// The speed in units below which bounces may be summed. Throws std::invalid_argument where the one
// asked for is too large.
double rest_speed(const Scene& scene, const Units& units, const Settings& settings);

// A rebound, its ratio to the approach, and c after it.
struct Bounce {
    double rebound;
    double ratio;
    double c;
};

// Whether a bounce is the first of those that are summed.
bool settles(const Scene& scene, double omega, const Bounce& first, double rest_speed);

// How a body has settled, after some time and in place; its angle with all its digits.
struct Settled {
    double lasts;
    State state;
    DoubleDouble angle;
};
Settled settled(const Scene& scene, const State& start, double rebound, double c);

}  // namespace rolling_ellipse
