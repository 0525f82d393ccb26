#include "rolling/level/kernel.hpp"

namespace rolling_ellipse {

Kernel kernel(LaneLevel level) {
#ifdef ROLLING_ELLIPSE_HAS_LANES
    if (level == LaneLevel::avx512) return kernel_avx512();
    if (level == LaneLevel::avx2) return kernel_avx2();
#endif
    static_cast<void>(level);
    return kernel_baseline();
}

const Kernel& kernel() {
    static const Kernel best = kernel(lane_levels().back());
    return best;
}

}  // namespace rolling_ellipse
