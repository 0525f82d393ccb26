// Times between which a quantity of a motion only rises or only falls.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "numerics/turns.hpp"
#include "outcome/quantities.hpp"

namespace rolling_ellipse {

// A motion that repeats itself: after the first time of a stretch come those of one period, those
// of the next one, and those of two such periods after `count` of them.
struct Repetition {
    std::size_t times;    // a period
    DoubleDouble period;  // [s]
    double count;
};

// What a body does by one law, up to the next event.
struct Stretch {
    const char* where;          // in words
    std::vector<double> times;  // [s], ascending, the first and the last one included
    bool constant = false;      // the quantity: there is one time
    bool monotone = true;       // the quantity, between each time and the next
    std::optional<Repetition> repetition = {};
};

// The stretches of a motion up to a time [s]. Without a quantity, for a function of which nothing
// is known, the times are close together: 16 a step, 64 a quarter turn. Throws
// std::invalid_argument where they would be too many.
std::vector<Stretch> stretches(const Motion& motion, double last, std::optional<Quantity> quantity,
                               const Gauge& gauge);

}  // namespace rolling_ellipse
