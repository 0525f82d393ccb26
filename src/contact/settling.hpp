// Bounces that are too small and too short to resolve one by one, summed.
#pragma once

#include "numerics/numbers.hpp"
#include "scene/scene.hpp"
#include "scene/settings.hpp"

namespace rolling_ellipse {

// The speed sqrt(g b) of a fall by half the short semi-axis b.
double speed_of_fall(const Scene& scene);

// The speed, in the given units, below which bounces may be summed. Throws std::invalid_argument if
// the speed in the settings is too large.
double rest_speed(const Scene& scene, const Units& units, const Settings& settings);

// The speed of a rebound, its ratio to that of the approach, and c after it.
struct Bounce {
    double rebound;
    double ratio;
    double c;
};

// Whether a bounce is the first of those that are summed.
bool settles(const Scene& scene, double omega, const Bounce& first, double rest_speed);

// The end of settling in place: its duration, the state and the angle with all digits.
struct Settled {
    double lasts;
    State state;
    DoubleDouble angle;
};
Settled settled(const Scene& scene, const State& start, const Bounce& first);

}  // namespace rolling_ellipse
