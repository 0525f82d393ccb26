// The times at which a quantity of a motion passes a value, computed from the motion itself rather
// than from samples. The search examines intervals on each of which the quantity only rises or only
// falls.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "contact/segments.hpp"
#include "numerics/turns.hpp"
#include "scene/settings.hpp"

namespace rolling_ellipse {

enum class Quantity { theta, x, z, omega, contact_x };

template <>
inline constexpr std::array names<Quantity>{"theta", "x", "z", "omega", "contact_x"};

// A quantity as a function of time, in SI units, or a function of time given by the caller.
struct Observable {
    std::optional<Quantity> quantity;  // absent for the caller's function
    Measure measure;
    double length;  // scale of the rounding error of a path [m]; 0 for all other quantities
};

// Observes a quantity of a motion. Motion and checkpoint must outlive the observable.
Observable observable(const Motion& motion, Quantity quantity, const Checkpoint& checkpoint);

// One segment of a motion, divided at the turning points of an observable.
struct Stretch {
    const char* where;           // phrase for messages, such as "while it rolls"
    std::vector<double> times;   // start, turning points, end [s], ascending
    std::vector<double> values;  // values of the observable
    bool proved = true;  // whether the observable is proved to be monotone between the times
    // Set for a motion with many periods: the period [s]. `times` then cover only the first two and
    // the last two periods.
    std::optional<DoubleDouble> period = {};
};

// The stretches of a motion up to a time [s]. Throws std::invalid_argument if the motion has too
// many turns.
std::vector<Stretch> stretches(const Motion& motion, double last, const Observable& of,
                               const Checkpoint& checkpoint);

// Throws std::invalid_argument: "<observable> must <requirement>, got <got>: simulate a shorter
// motion".
[[noreturn]] void refuse_length(const Observable& of, const std::string& requirement,
                                const std::string& got);

struct Passages {
    std::vector<std::vector<double>> times;  // times of passing each value [s], ascending
    std::vector<std::string> unproved;       // phrases that say where passages may be missing
};

// All passages up to the time `last`. Direction: +1 where the observable rises through the value,
// -1 where it falls, 0 for both and for touches. A jump of omega across the value at an event
// counts as a passage.
Passages passages(const Motion& motion, double last, const Observable& of,
                  const std::vector<double>& values, int direction, const Checkpoint& checkpoint);

}  // namespace rolling_ellipse
