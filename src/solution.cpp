#include "solution.hpp"

namespace rolling_ellipse {
namespace {

template <int N>
std::vector<double> times_of(const Steps<N>& steps) {
    std::vector<double> times;
    times.reserve(steps.knots.size());
    for (const Knot<N>& knot : steps.knots) times.push_back(knot.t);
    return times;
}

std::vector<double> times_of(const SteppedRolling& motion) { return times_of(motion.steps); }

std::vector<double> times_of(const SteppedMultipliers& motion) {
    return std::visit([](const auto& steps) { return times_of(steps); }, motion.steps);
}

}  // namespace

RollingSampler::RollingSampler(const Solution& solution, std::size_t expected)
    : solution_(solution) {
    if (const auto* flow = std::get_if<RollingFlow>(&solution.motion)) {
        exact_.emplace(*flow, solution.followed_until, expected);
    }
}

void RollingSampler::operator()(const double* times, std::size_t n, FlowSample* samples) const {
    if (exact_) return (*exact_)(times, n, samples);
    sample(std::get<SteppedRolling>(solution_.motion), times, n, samples);
}

void sample(const Solution& solution, const double* times, std::size_t n,
            CoordinateState* samples) {
    sample(std::get<SteppedMultipliers>(solution.motion), times, n, samples);
}

void sample(const Solution& solution, const double* times, std::size_t n, ContactSample* samples) {
    sample(std::get<ContactMotion>(solution.motion), times, n, samples);
}

std::vector<double> knot_times(const Solution& solution) {
    if (const auto* rolling = std::get_if<SteppedRolling>(&solution.motion)) {
        return times_of(*rolling);
    }
    return times_of(std::get<SteppedMultipliers>(solution.motion));
}

void contact_forces(const Solution& solution, const Scene& scene, const Settings& settings,
                    const double* times, std::size_t n, ContactForce* forces) {
    if (const auto* multipliers = std::get_if<SteppedMultipliers>(&solution.motion)) {
        std::vector<CoordinateState> states(n);
        sample(*multipliers, times, n, states.data());
        for (std::size_t i = 0; i < n; ++i) {
            const auto lambda = accelerations(multipliers->body, settings, states[i]).multipliers;
            forces[i] = {lambda[1], lambda[0]};
        }
        return;
    }
    std::vector<FlowSample> states(n);
    RollingSampler{solution, n}(times, n, states.data());
    const RollingDynamics dynamics(scene);
    for (std::size_t i = 0; i < n; ++i) {
        forces[i] = dynamics.force(geometry(scene.axes(), states[i].theta), states[i].omega);
    }
}

}  // namespace rolling_ellipse
