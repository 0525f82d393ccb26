#include "numerics/lane_levels.hpp"

namespace rolling_ellipse {

std::string name(LaneLevel level) {
    switch (level) {
        case LaneLevel::avx512:
            return "avx512";
        case LaneLevel::avx2:
            return "avx2";
        case LaneLevel::sse2:
            return "sse2";
        case LaneLevel::one_by_one:
            break;
    }
    return "one by one";
}

std::vector<LaneLevel> lane_levels() {
    std::vector<LaneLevel> levels{LaneLevel::one_by_one};
#ifdef ROLLING_ELLIPSE_HAS_LANES
    levels.push_back(LaneLevel::sse2);
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
        levels.push_back(LaneLevel::avx2);
        if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
            __builtin_cpu_supports("avx512vl")) {
            levels.push_back(LaneLevel::avx512);
        }
    }
#endif
    return levels;
}

}  // namespace rolling_ellipse
