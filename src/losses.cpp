#include <algorithm>
#include <cmath>

#include "simulate.hpp"

namespace rolling_ellipse {
namespace {

// Raises the maximum to a value; NaN counts as infinite.
void raise(double& maximum, double value) {
    if (!(value <= maximum)) maximum = std::isnan(value) ? infinity : value;
}

Losses losses_in(const std::vector<Invariants>& found) {
    const double start = found.front().energy.total();
    Losses worst;
    double size = 0.0;
    for (const auto& [energy, residual] : found) {
        size = std::max(size, energy.kinetic + std::abs(energy.potential));
        raise(worst.energy, std::abs(energy.total() - start));
        raise(worst.constraints, residual);
    }
    worst.energy /= size;
    return worst;
}

}  // namespace

std::optional<Losses> losses(const Solution& solution) {
    if (solution.motion.segments.empty()) return {};
    const auto& law = solution.motion.segments.front().law;
    const long evaluations = solution.counts.evaluations;
    if (const auto* rolling = std::get_if<SteppedRolling>(&law)) {
        return losses_in(invariants(*rolling, evaluations));
    }
    if (const auto* multipliers = std::get_if<SteppedMultipliers>(&law)) {
        Losses found = losses_in(invariants(*multipliers, evaluations));
        found.projected = multipliers->most_projected;
        return found;
    }
    return {};
}

}  // namespace rolling_ellipse
