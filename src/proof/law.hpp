// The law of a contact that rolls, physics (25): N > 0 and |F| <= mu N.
#pragma once

#include <cmath>

#include "scene/state.hpp"

namespace rolling_ellipse {

// What is left of the law, which holds where this is positive; with infinite friction only the
// normal force counts.
inline double law_margin(const ContactForce& force, double friction) {
    if (std::isinf(friction)) return force.normal;
    return friction * force.normal - std::abs(force.friction);
}

// The friction coefficient that the forces need, |F|/N; infinite where N <= 0, unless both vanish.
inline double friction_needed(const ContactForce& force) {
    if (force.normal > 0) return std::abs(force.friction) / force.normal;
    return force.normal == 0 && force.friction == 0 ? 0.0 : infinity;
}

}  // namespace rolling_ellipse
