#include "rolling/level/kernel_code.hpp"

namespace rolling_ellipse {

Kernel kernel_baseline() { return compiled; }

}  // namespace rolling_ellipse
