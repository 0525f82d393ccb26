#include "rolling/level/kernel_code.hpp"

namespace rolling_ellipse {

const std::vector<Kernel>& kernels() {
    static const std::vector<Kernel> found = [] {
        Kernel one_by_one = compiled;
        one_by_one.name = "one by one";
        one_by_one.sample = nullptr;
        std::vector<Kernel> all{one_by_one};
#ifdef ROLLING_ELLIPSE_HAS_LANES
        all.push_back(compiled);
        if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
            all.push_back(kernel_avx2());
            if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
                __builtin_cpu_supports("avx512vl")) {
                all.push_back(kernel_avx512());
            }
        }
#endif
        return all;
    }();
    return found;
}

const Kernel& kernel() {
    static const Kernel best = kernels().back();
    return best;
}

}  // namespace rolling_ellipse
