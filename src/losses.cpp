#include "losses.hpp"

#include <algorithm>
#include <cmath>

namespace rolling_ellipse {
namespace {

// Times of looks: knots, evenly over the motion, and the middles of the steps after some of them.
// A look at a knot costs as much as two evaluations of the equation of rolling, one at a middle as
// a step: each kind makes a fortieth of the steps.
template <class Steps>
std::vector<double> times_of_looks(const Steps& steps, std::size_t evaluations) {
    constexpr std::size_t least = 4;
    constexpr std::size_t evaluations_per_knot = 80;
    constexpr std::size_t steps_per_middle = 40;
    const auto& knots = steps.knots;
    const std::size_t n = knots.size() - 1;
    const std::size_t looks = std::min(n, least + evaluations / evaluations_per_knot);
    const std::size_t middles = std::min(looks, least + n / steps_per_middle);
    std::vector<double> times;
    times.reserve(looks + middles + 1);
    for (std::size_t i = 0; i < looks; ++i) {
        const auto& knot = knots[i * n / looks];
        times.push_back(knot.t);
        if ((i + 1) * middles / looks > i * middles / looks) {
            times.push_back(knot.t + 0.5 * ((&knot)[1].t - knot.t));
        }
    }
    times.push_back(knots.back().t);
    return times;
}

// What is not a number is lost altogether.
void note(double value, double& worst) {
    if (!(value <= worst)) worst = std::isnan(value) ? infinity : value;
}

template <class Law>
Losses losses_at(const Law& motion, const std::vector<double>& times) {
    std::vector<Invariants> found(times.size());
    sample(motion, times.data(), times.size(), found.data());
    const double start = found.front().energy.total();
    Losses worst;
    double size = 0.0;
    for (const auto& [energy, residual] : found) {
        size = std::max(size, energy.kinetic + std::abs(energy.potential));
        note(std::abs(energy.total() - start), worst.energy);
        note(residual, worst.constraints);
    }
    worst.energy /= size;
    return worst;
}

}  // namespace

std::optional<Losses> losses(const Solution& solution) {
    if (solution.motion.segments.empty()) return {};
    const auto& law = solution.motion.segments.front().law;
    const auto times = [&](const auto& steps) {
        return times_of_looks(steps, static_cast<std::size_t>(solution.counts.evaluations));
    };
    if (const auto* rolling = std::get_if<SteppedRolling>(&law)) {
        return losses_at(*rolling, times(rolling->steps));
    }
    if (const auto* multipliers = std::get_if<SteppedMultipliers>(&law)) {
        Losses found = losses_at(*multipliers, std::visit(times, multipliers->steps));
        found.projected = multipliers->most_projected;
        return found;
    }
    return {};
}

}  // namespace rolling_ellipse
