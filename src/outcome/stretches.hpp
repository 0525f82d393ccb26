// Quantities of a motion, and times between which one only rises or only falls.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "contact/segments.hpp"
#include "numerics/turns.hpp"
#include "scene/settings.hpp"

namespace rolling_ellipse {

enum class Quantity { theta, x, z, omega, contact_x };

// A quantity, in SI units; or a function of which nothing is known.
struct Asked {
    std::optional<Quantity> quantity;
    Measure measure;
    double length;  // the rounding of which it has beside its own: paths are sums [m]
};

// The motion and the checkpoint have to live as long.
Asked asked(const Motion& motion, Quantity quantity, const Checkpoint& checkpoint);

// What a body does by one law, up to the next event.
struct Stretch {
    const char* where;          // in words
    std::vector<double> times;  // [s], ascending, the first and the last one included
    bool monotone = true;       // what is asked for, between each time and the next, provably
    // [s], of what repeats itself so often that times are those of two periods and of the last two.
    std::optional<DoubleDouble> period = {};
};

// The stretches of a motion up to a time [s]. Throws std::invalid_argument for a motion that is too
// long.
std::vector<Stretch> stretches(const Motion& motion, double last, const Asked& of,
                               const Checkpoint& checkpoint);

// Throws std::invalid_argument: what is asked for must ..., got ...
[[noreturn]] void refuse_length(const Asked& of, const std::string& requirement,
                                const std::string& got);

}  // namespace rolling_ellipse
