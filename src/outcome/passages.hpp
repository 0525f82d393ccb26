// The times at which a quantity of a motion passes a value: of the motion itself, not of samples.
#pragma once

#include <string>
#include <vector>

#include "outcome/stretches.hpp"

namespace rolling_ellipse {

struct Passages {
    std::vector<std::vector<double>> times;  // [s], ascending; for each value
    std::vector<std::string> unproved;       // where, in words, some of them may be missing
};

// All times up to a last one. Direction: +1 where the quantity rises through the value, -1 where it
// falls, 0 for either and for touches. An event may take omega over the value at once, and counts.
Passages passages(const Motion& motion, double last, Quantity quantity,
                  const std::vector<double>& values, int direction, const Checkpoint& checkpoint);

// The same for the zeros of a function of which nothing is known.
Passages zeros(const Motion& motion, double last, const Measure& function, int direction,
               const Checkpoint& checkpoint);

}  // namespace rolling_ellipse
