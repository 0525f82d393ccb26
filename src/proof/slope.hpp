// Rolling on a slope: its certificate, and the forces of a body that cannot leave its place.
#pragma once

#include <optional>

#include "proof/slope_end.hpp"

namespace rolling_ellipse {

struct SlopeExtremes {
    double least_normal;        // [N]
    double least_normal_angle;  // theta
    double most_friction;       // |F|/N
    double most_friction_angle;
};

// Whether the rolling motion from a state on a slope may be true for ever. A circle and a body in
// equilibrium have the same forces all the time; a body that rocks has turning points; all others
// run downhill faster and faster until no ground holds them.
bool may_hold_for_ever(const Scene& scene, const State& start);

// Of such a motion, for all times; else nothing.
std::optional<SlopeExtremes> extremes_on_slope(const Scene& scene, const State& start);

// The certificate of rolling that meets the law so.
Certificate certify_on_slope(const Scene& scene, const State& start, const LawMeetings& met);

}  // namespace rolling_ellipse
