// Two doubles that are computed at once where the processor can: the same bits as one after the
// other.
#pragma once

namespace rolling_ellipse {

using Pair = double __attribute__((vector_size(2 * sizeof(double))));

inline Pair pair(double first, double second) { return Pair{first, second}; }

}  // namespace rolling_ellipse
