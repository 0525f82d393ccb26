// Times between which a quantity of a motion only rises or only falls.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "contact/segments.hpp"
#include "scene/settings.hpp"

namespace rolling_ellipse {

enum class Quantity { theta, x, z, omega, contact_x };

// The name of a quantity in messages; none is a function of which nothing is known.
const char* name_of(std::optional<Quantity> quantity);

// A number in three digits.
std::string short_text(double value);

// A number at each of some ascending times [s].
using Measure = std::function<std::vector<double>(const std::vector<double>& times)>;

// The quantities of a motion as its samples have them, in SI units. The motion has to live as long.
class Gauge {
  public:
    Gauge(const Motion& motion, const Checkpoint& checkpoint);

    std::vector<double> operator()(Quantity quantity, const std::vector<double>& times) const;
    double length() const { return std::max(axes_.a, axes_.b); }  // [m]

  private:
    void measure(Quantity quantity, const double* times, std::size_t n, double* values) const;

    const Motion& motion_;
    const Checkpoint& checkpoint_;
    Sampler sample_;
    Axes axes_;  // [m]
    bool has_coordinates_;
};

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
