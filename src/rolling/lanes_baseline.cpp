#include "rolling/kernel_lanes.hpp"

namespace rolling_ellipse {

Kernel kernel_baseline() { return compiled; }

}  // namespace rolling_ellipse
