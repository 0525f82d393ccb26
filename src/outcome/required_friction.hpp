// The least coefficient of friction with which the ground holds the rolling for ever.
#pragma once

#include "scene/scene.hpp"

namespace rolling_ellipse {

// Blow included, whatever the friction of the scene; infinite where no finite one does.
double required_friction(const Scene& scene);

}  // namespace rolling_ellipse
