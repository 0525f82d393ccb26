// Exact rolling of many bodies, each at its own time, several side by side in the lanes of a vector
// register. A body has the same bits as alone, at every vector level and beside any others.
#pragma once

#include <cstddef>

#include "rolling/level/flow.hpp"
#include "rolling/level/kernel.hpp"

namespace rolling_ellipse {

// The states of n bodies. The bodies are not validated; throws std::invalid_argument for a time
// that is out of range.
void sample(const Kernel& kernel, const RollingStart* starts, const double* times, std::size_t n,
            FlowSample* samples);

}  // namespace rolling_ellipse
