// The motion of the body with everything that its contact does: it rolls, slides, flies, hits and
// comes to rest, each on its own arc, joined by events.
#pragma once

#include "contact/arcs.hpp"
#include "scene/settings.hpp"

namespace rolling_ellipse {

// undetermined: more than one motion goes on.
enum class ContactEnding { reached, jammed, undetermined, max_events, max_steps, step_too_small };

struct ContactIntegration {
    ContactMotion motion;
    ContactEnding ending;
    double reached_until;  // time at which it ended [s]
    StepCounts counts;
};

ContactIntegration integrate_contact(const Scene& scene, const State& start,
                                     const Settings& settings, double t_end,
                                     const Checkpoint& checkpoint);

}  // namespace rolling_ellipse
