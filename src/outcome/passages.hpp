// The times at which an observable of a motion passes a value. They belong to the motion itself,
// not to samples of it.
#pragma once

#include <string>
#include <vector>

#include "outcome/stretches.hpp"

namespace rolling_ellipse {

struct Passages {
    std::vector<std::vector<double>> times;  // [s], ascending; for each value
    std::vector<std::string> unproved;       // phrases: where passages may be missing
};

// All passages up to a last time. Direction: +1 where the observable rises through the value, -1
// where it falls, 0 for both and for touches. A jump of omega across the value at an event counts.
Passages passages(const Motion& motion, double last, const Observable& of,
                  const std::vector<double>& values, int direction, const Checkpoint& checkpoint);

}  // namespace rolling_ellipse
