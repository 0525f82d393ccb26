// What a body does next that touches the ground and does not move into it.
#pragma once

#include "scene.hpp"

namespace rolling_ellipse {

struct Continuation {
    Mode mode;
    double side = 0.0;  // sign of the slip
    bool jams = false;
};

// The mode that the forces allow. Without slip it rolls where it may and can; else it starts to
// slide, or leaves the ground where its contact is not pressed any more.
Continuation continuation(const Scene& scene, const State& state, bool may_roll = true);

}  // namespace rolling_ellipse
