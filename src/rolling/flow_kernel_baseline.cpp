#include "rolling/flow_kernel_lanes.hpp"

namespace rolling_ellipse {

FlowKernel flow_kernel_baseline() { return compiled; }

}  // namespace rolling_ellipse
