// Contact forces along a computed motion, where no proof tells in advance that the ground can give
// them.
#pragma once

#include <functional>
#include <vector>

#include "rolling/stepped/equation.hpp"
#include "scene/settings.hpp"

namespace rolling_ellipse {

struct ContactWatch {
    double smallest_normal_force;  // [N]
    double smallest_normal_force_time;
    double largest_friction_needed;  // |F|/N
    double largest_friction_needed_time;
    double holds_until;  // first time at which N < 0 or |F| > mu N; infinite if there is none
};

// The contact forces at n times.
using ForcesAt = std::function<void(const double* times, std::size_t n, ContactForce* forces)>;

// Looks several times between each two of the times; a violation between two looks that are both in
// order is found by the minimum of what is left between them.
ContactWatch watch_contact(double friction, const std::vector<double>& times,
                           const ForcesAt& forces_at, const Checkpoint& checkpoint);

}  // namespace rolling_ellipse
