// The first thing that happens to a body, after a blow or out of rolling, and the inverse: the
// blow, or the friction, for an outcome.
#pragma once

#include <cstdint>

#include "scene/scene.hpp"
#include "scene/settings.hpp"

namespace rolling_ellipse {

enum class Outcome : std::int8_t {
    rests,
    rocks,          // the body turns back before anything else happens
    rolls_over,     // it passes the tip before anything else happens
    slips,          // the contact slides
    loses_contact,  // it leaves the ground, or is in the air
    jams,           // not out of rolling, see outcome/outcome.cpp
    edge,           // undecided within rounding
};

// The outcome for a body that rolls (or rests) on level ground with the given angle and angular
// velocity, from signs of polynomials alone.
Outcome classify(const Body& body, double friction, double theta, double omega);

// The first thing that happens to a body after the blow of its scene. On level ground it is known
// without integration. On a slope the rolling motion is followed until it turns back, passes the
// tip (a circle: half a turn) or ends; `edge` if it does none of these for long.
Outcome outcome(const Scene& scene, const Checkpoint& checkpoint);

// The downward impulse at a horizontal distance from the centre after which the body has an angular
// velocity, if the contact sticks: physics (38, 40). Negative if it would have to be a pull;
// infinite if its lever is so small that no impulse of a scene would do.
double press_to(const Scene& scene, double distance, double omega);

// The angular velocity at the angle of the scene with which a body that rolls on level ground just
// reaches the tip: physics (26).
double speed_to_the_tip(const Scene& scene);

// The least friction coefficient with which neither the blow nor the rolling after it ever slips,
// whatever the friction of the scene; infinite where no finite one does.
double required_friction(const Scene& scene);

}  // namespace rolling_ellipse
