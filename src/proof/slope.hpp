// The friction that rolling for ever needs on a slope.
#pragma once

#include "scene/scene.hpp"

namespace rolling_ellipse {

// The largest |F|/N of the rolling motion from a state on a slope, for all times. A circle and a
// body in equilibrium need the same all the time; a body that rocks has turning points; all others
// run downhill faster and faster until no ground holds them: infinite.
double friction_needed_on_slope(const Scene& scene, const State& start);

}  // namespace rolling_ellipse
