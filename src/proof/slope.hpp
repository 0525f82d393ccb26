// The certificate of rolling on a slope, with the forces of a body that cannot leave its place.
#pragma once

#include "proof/certificate.hpp"

namespace rolling_ellipse {

// Whether the rolling motion from a state on a slope may be valid for ever. A circle and a body in
// equilibrium have the same forces all the time; a body that rocks has turning points; all others
// run downhill faster and faster until no ground holds them.
bool may_hold_for_ever(const Scene& scene, const State& start);

// The certificate of rolling that ends there.
Certificate certify_on_slope(const Scene& scene, const State& start, const EndOfRolling& end);

}  // namespace rolling_ellipse
