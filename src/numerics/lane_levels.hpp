// The vector levels for which files of lanes are compiled, see numerics/lanes.hpp.
#pragma once

#include <string>
#include <vector>

namespace rolling_ellipse {

enum class LaneLevel { one_by_one, sse2, avx2, avx512 };

std::string name(LaneLevel level);

// Those that the machine has and the build knows, the quickest last.
std::vector<LaneLevel> lane_levels();

}  // namespace rolling_ellipse
