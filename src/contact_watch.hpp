// Contact forces along a computed motion, where no proof tells in advance that the ground can give
// them.
#pragma once

#include "rolling_steps.hpp"

namespace rolling_ellipse {

struct ContactWatch {
    double smallest_normal_force;  // [N]
    double smallest_normal_force_time;
    double largest_friction_needed;  // |F|/N
    double largest_friction_needed_time;
    double holds_until;  // first time at which N < 0 or |F| > mu N; infinite if there is none
};

// Looks several times into each step; a violation between two looks that are both in order is found
// by the minimum of what is left between them.
ContactWatch watch_contact(const Scene& scene, const SteppedRolling& motion,
                           const Checkpoint& checkpoint);

}  // namespace rolling_ellipse
