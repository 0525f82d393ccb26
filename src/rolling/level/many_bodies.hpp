// Exact rolling of many bodies, each at its own time: several bodies side by side in the lanes of
// the processor's vectors. // A body has the bits that it has alone, at every level and in any
// company.
#pragma once

#include <cstddef>

#include "rolling/level/flow.hpp"
#include "rolling/level/kernel.hpp"

namespace rolling_ellipse {

// The states of n bodies at times of their own. The bodies are not validated; throws
// std::invalid_argument for a time that is out of range.
void sample(const Kernel& kernel, const RollingStart* starts, const double* times, std::size_t n,
            FlowSample* samples);

}  // namespace rolling_ellipse
