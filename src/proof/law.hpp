// The law of a contact that rolls, physics (25): N > 0 and |F| <= mu N.
#pragma once

#include <cmath>
#include <limits>

#include "scene/scene.hpp"

namespace rolling_ellipse {

// The margin of the law for a friction force in the direction `side`, -1 or 1; for an infinite
// friction coefficient, the margin is the normal force.
inline double law_margin(const ContactForce& force, double friction, double side) {
    if (std::isinf(friction)) return force.normal;
    return friction * force.normal - side * force.friction;
}

// The margin of the law for the actual direction of the friction force; the law holds where this
// margin is positive.
inline double law_margin(const ContactForce& force, double friction) {
    return law_margin(force, friction, std::copysign(1.0, force.friction));
}

// The sum of the magnitudes of the terms of a margin.
inline double law_size(const ContactForce& force, double friction) {
    const double normal = std::abs(force.normal);
    return std::isinf(friction) ? normal : friction * normal + std::abs(force.friction);
}

// Rounding error of a margin relative to its size, from all operations that compute the margin from
// the angle.
inline constexpr double law_rounding = 64 * epsilon;
// Smallest normal double; a smaller friction coefficient has fewer accurate digits.
inline constexpr double least_friction = std::numeric_limits<double>::min();

// Whether the margin of the law is 0 to within rounding.
inline bool at_the_limit(const ContactForce& force, double friction) {
    return std::abs(law_margin(force, friction)) <=
           law_rounding * law_size(force, friction) + least_friction * std::abs(force.normal);
}

// A slightly larger friction coefficient, with which a law at its limit holds by more than the
// rounding error.
inline double beyond_the_limit(double friction) {
    return friction * (1 + 8 * law_rounding) + 8 * least_friction;
}

// The friction coefficient |F|/N that the forces need; infinite where N <= 0, unless both vanish.
inline double friction_needed(const ContactForce& force) {
    if (force.normal > 0) return std::abs(force.friction) / force.normal;
    return force.normal == 0 && force.friction == 0 ? 0.0 : infinity;
}

}  // namespace rolling_ellipse
