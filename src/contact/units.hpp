// Scenes, states and samples in units, and back.
#pragma once

#include "geometry/constraints.hpp"
#include "rolling/level/flow.hpp"
#include "scene/scene.hpp"

namespace rolling_ellipse {

// All numbers of a scene but those of its impulse.
Scene in_units(const Scene& scene, const Units& units);

State in_units(const State& state, const Units& units);

// Back to SI units.
State in_si(const State& state, const Units& units);
ContactSample in_si(const ContactSample& sample, const Units& units);
FlowSample in_si(const FlowSample& sample, const Units& units);
CoordinateState in_si(const CoordinateState& state, const Units& units);

}  // namespace rolling_ellipse
