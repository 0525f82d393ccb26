// What a computed motion has lost of what the body keeps.
#pragma once

#include "solution.hpp"

namespace rolling_ellipse {

struct Losses {
    double energy = 0.0;       // its change, beside kinetic and potential energy in size
    double constraints = 0.0;  // largest of |f2|, |f3| over the long semi-axis, and |f4|
};

// Those at the end of a motion that only rolls.
Losses losses(const Solution& solution);

}  // namespace rolling_ellipse
