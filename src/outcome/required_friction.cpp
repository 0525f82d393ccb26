#include "outcome/required_friction.hpp"

#include <algorithm>

#include "proof/certificate.hpp"
#include "proof/slope.hpp"
#include "scene/impact.hpp"

namespace rolling_ellipse {

double required_friction(const Scene& scene) {
    const double in_the_blow = sticking_friction(scene);
    if (in_the_blow == infinity) return infinity;
    Scene rough = scene;
    rough.friction = infinity;
    const State start = initial_state(rough).state;
    const Certificate found =
        scene.slope != 0 ? certify_on_slope(rough, start, {Validity::no_proof})
                         : certify_rolling(rolling_start(scene.body(), start.theta, start.omega),
                                           scene.mass, rough.friction);
    return std::max(in_the_blow, *found.largest_friction_needed);
}

}  // namespace rolling_ellipse
