#include "rolling/flow_kernel.hpp"

namespace rolling_ellipse {

FlowKernel flow_kernel(LaneLevel level) {
#ifdef ROLLING_ELLIPSE_HAS_LANES
    if (level == LaneLevel::avx512) return flow_kernel_avx512();
    if (level == LaneLevel::avx2) return flow_kernel_avx2();
#endif
    static_cast<void>(level);
    return flow_kernel_baseline();
}

const FlowKernel& flow_kernel() {
    static const FlowKernel best = flow_kernel(lane_levels().back());
    return best;
}

}  // namespace rolling_ellipse
