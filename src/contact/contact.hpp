// The motion of a body with everything that its contact does: it rolls, slides, flies, hits the
// ground and comes to rest, each on a segment of its own, joined by events.
#pragma once

#include "contact/segments.hpp"
#include "proof/certificate.hpp"
#include "scene/settings.hpp"

namespace rolling_ellipse {

// The motion from a start on. The end of its rolling counts if it begins with that, the rate of its
// gap [m/s] if it begins in flight.
Integration<Motion> integrate_contact(const Scene& scene, const State& start, double gap_rate,
                                      const EndOfRolling& end_of_rolling, const Settings& settings,
                                      double t_end, const Checkpoint& checkpoint);

}  // namespace rolling_ellipse
