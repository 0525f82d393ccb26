#include "solution.hpp"

namespace rolling_ellipse {
namespace {

void sample(const RollingFlow& flow, const double* times, std::size_t n, FlowSample* samples) {
    for (std::size_t i = 0; i < n; ++i) samples[i] = sample(flow, times[i]);
}

}  // namespace

void sample(const Solution& solution, const double* times, std::size_t n, FlowSample* samples) {
    const Segment& segment = solution.segments.front();
    std::visit([&](const auto& motion) { sample(motion, times, n, samples); }, segment.motion);
}

}  // namespace rolling_ellipse
