#include "rolling/level/kernel_code.hpp"

namespace rolling_ellipse {

Kernel kernel_avx2() { return compiled; }

}  // namespace rolling_ellipse
