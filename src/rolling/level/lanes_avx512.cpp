#include "rolling/level/kernel_code.hpp"

namespace rolling_ellipse {

Kernel kernel_avx512() { return compiled; }

}  // namespace rolling_ellipse
