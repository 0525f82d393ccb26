// What a blow makes of a body, and the blow that makes something of it.
#pragma once

#include "outcome/classify.hpp"
#include "scene/settings.hpp"

namespace rolling_ellipse {

// The first thing that happens to a body from the blow of its scene on. On level ground it is known
// without integrating; on a slope the rolling motion is followed until it turns back, passes the
// tip (a circle: half a turn) or comes to the end of its rolling, and edge is what is left to say
// where it does none of it for long.
Outcome outcome(const Scene& scene, const Checkpoint& checkpoint);

// The downward impulse at a horizontal distance from the centre after which the body has an angular
// velocity, if the contact sticks: physics (38, 40). Negative where it would have to be a pull,
// infinite where it has so little lever that no impulse of a scene would do.
double press_to(const Scene& scene, double distance, double omega);

// The angular velocity with which a body that rolls on level ground from the angle of the scene
// comes to rest on the tip: physics (26).
double speed_to_the_tip(const Scene& scene);

}  // namespace rolling_ellipse
