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
    const Body body = scene.body();
    if (scene.slope != 0) {
        const std::optional<SlopeExtremes> found = extremes_on_slope(rough, start);
        return found ? std::max(in_the_blow, found->most_friction) : infinity;
    }
    const RollingStart rolling = rolling_start(body, start.theta, start.omega);
    const Certificate found = certify_rolling(rolling, scene.mass, rough.friction);
    return std::max(in_the_blow, *found.largest_friction_needed);
}

}  // namespace rolling_ellipse
