// The motion of the body with everything that its contact does: it rolls, slides, flies, hits and
// comes to rest, each on its own segment, joined by events.
#pragma once

#include "contact/segments.hpp"
#include "proof/certificate.hpp"
#include "scene/settings.hpp"

namespace rolling_ellipse {

// From a start, whose rolling ends as known where it begins with it; the rate of its gap [m/s]
// counts where it flies.
Integration<Motion> integrate_contact(const Scene& scene, const State& start, double gap_rate,
                                      const EndOfRolling& end_of_rolling, const Settings& settings,
                                      double t_end, const Checkpoint& checkpoint);

}  // namespace rolling_ellipse
