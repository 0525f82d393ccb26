// The applied impulse: a collision without restitution of a body that the impulse has just moved.
#pragma once

#include "scene.hpp"

namespace rolling_ellipse {

// The state just after the applied impulse (or the scene's own state, where there is none).
struct InitialState {
    State state;
    double reaction_x;  // impulse of the ground [N s]
    double reaction_z;
    double free_omega;  // without the ground's reaction: the report's eq 48
};

InitialState initial_state(const Scene& scene);

}  // namespace rolling_ellipse
