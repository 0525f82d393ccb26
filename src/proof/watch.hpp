// Contact forces along a computed motion, where no proof decides in advance whether the ground can
// give them.
#pragma once

#include <functional>
#include <vector>

#include "scene/scene.hpp"
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

// Samples the forces eight times between each two of the times. A violation between two samples
// that obey the law is found at the minimum of the margin between them.
ContactWatch watch_contact(double friction, const std::vector<double>& times,
                           const ForcesAt& forces_at, const Checkpoint& checkpoint);

}  // namespace rolling_ellipse
