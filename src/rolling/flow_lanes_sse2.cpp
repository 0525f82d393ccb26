#include "rolling/flow_lanes_kernel.hpp"

namespace rolling_ellipse::detail {

void sample_sse2(const LaneBodies& bodies, FlowSample* samples, double* losses) {
    sample(bodies, samples, losses);
}

}  // namespace rolling_ellipse::detail
