#include "losses.hpp"

#include <algorithm>
#include <cmath>

namespace rolling_ellipse {
namespace {

struct Energy {
    double value;  // per mass [m^2/s^2]
    double size;
};

Energy energy(const Scene& scene, const CoordinateState& at) {
    using namespace coordinate;
    const double kinetic = (square(at.q_dot[x]) + square(at.q_dot[z]) +
                            scene.inertia / scene.mass * square(at.q_dot[theta])) /
                           2;
    const double height = at.q[z] * std::cos(scene.slope) - at.q[x] * std::sin(scene.slope);
    const double potential = scene.gravity * height;
    return {kinetic + potential, kinetic + std::abs(potential)};
}

}  // namespace

Losses losses(const Solution& solution) {
    const Scene& scene = solution.motion.scene;
    const double times[] = {0.0, solution.followed_until};
    CoordinateState ends[2];
    Sampler(solution.motion, times[1], 2)(times, 2, ends);
    const Energy before = energy(scene, ends[0]);
    const Energy after = energy(scene, ends[1]);
    const Eigen::Vector3d missed = position_residuals(scene.axes(), ends[1].q).cwiseAbs();
    const double longer = std::max(scene.a, scene.b);
    return {std::abs(after.value - before.value) / std::max(before.size, after.size),
            std::max(std::max(missed[0], missed[1]) / longer, missed[2])};
}

}  // namespace rolling_ellipse
