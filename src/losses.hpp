// Energy and constraints lost by an integrated motion.
#pragma once

#include <optional>

#include "solution.hpp"

namespace rolling_ellipse {

struct Losses {
    // Largest change of the energy over the largest kinetic + |potential| energy. The height is 0
    // on the ground where the motion starts: so the result does not depend on the origin of x.
    double energy = 0.0;
    double constraints = 0.0;  // largest of |f2|/L, |f3|/L and |f4|; L is the long semi-axis
    double projected = 0.0;    // that maximum within a step, before its projection
};

// The losses along a stepped motion; empty for an exact one.
std::optional<Losses> losses(const Solution& solution);

}  // namespace rolling_ellipse
