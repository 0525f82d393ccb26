#include "losses.hpp"

#include <algorithm>
#include <cmath>

namespace rolling_ellipse {

Losses losses(const Solution& solution) {
    const Scene& scene = solution.motion.scene;
    const double times[] = {0.0, solution.followed_until};
    CoordinateState ends[2];
    Sampler(solution.motion, 2)(times, 2, ends);
    const ConstrainedBody body(scene);
    const SpecificEnergy before = body.specific_energy(ends[0].q, ends[0].q_dot);
    const SpecificEnergy after = body.specific_energy(ends[1].q, ends[1].q_dot);
    const auto size = [](const SpecificEnergy& e) { return e.kinetic + std::abs(e.potential); };
    const Eigen::Vector3d missed = position_residuals(scene.axes(), ends[1].q).cwiseAbs();
    const double longer = std::max(scene.a, scene.b);
    return {std::abs(after.total() - before.total()) / std::max(size(before), size(after)),
            std::max(std::max(missed[0], missed[1]) / longer, missed[2])};
}

}  // namespace rolling_ellipse
