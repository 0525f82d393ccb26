// Energy and constraints lost by an integrated motion.
#pragma once

#include <optional>

#include "solution.hpp"

namespace rolling_ellipse {

struct Losses {
    // The largest change of the energy, over the largest kinetic and |potential| energy; the height
    // is 0 on the ground where the motion starts, so that x may be 0 anywhere.
    double energy = 0.0;
    double constraints = 0.0;  // largest of |f2|, |f3| over the long semi-axis, and |f4|
    double projected = 0.0;    // the same of a step before its projection
};

// The losses along a motion, as `survey` sees them. Empty where nothing was stepped.
std::optional<Losses> losses(const Solution& solution);

}  // namespace rolling_ellipse
