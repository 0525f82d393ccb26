// The motion of the body with everything that its contact does: it rolls, slides, flies, hits and
// comes to rest, each on its own arc, joined by events.
#pragma once

#include "contact_arcs.hpp"
#include "settings.hpp"

namespace rolling_ellipse {

enum class ContactEnding { reached, jammed, max_events, max_steps, step_too_small };

struct ContactIntegration {
    ContactMotion motion;
    ContactEnding ending;
    double reached_until;  // time of the event that ended it
    StepCounts counts;
};

ContactIntegration integrate_contact(const Scene& scene, const State& start,
                                     const Settings& settings, double t_end,
                                     const Checkpoint& checkpoint);

}  // namespace rolling_ellipse
