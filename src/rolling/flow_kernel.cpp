#include "rolling/flow_kernel.hpp"

namespace rolling_ellipse {

const FlowKernel& flow_kernel() {
#if defined(__x86_64__) && defined(__GNUC__)
    static const FlowKernel best = __builtin_cpu_supports("avx512f") ? flow_kernel_avx512()
                                   : __builtin_cpu_supports("avx2")  ? flow_kernel_avx2()
                                                                     : flow_kernel_baseline();
#else
    static const FlowKernel best = flow_kernel_baseline();
#endif
    return best;
}

}  // namespace rolling_ellipse
