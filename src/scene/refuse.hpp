// Wrong numbers are refused by name: the argument, what was required and what came.
#pragma once

#include <string>

namespace rolling_ellipse {

// A double as Python prints it.
std::string text(double value);

// Throws std::invalid_argument, which Python shows as ValueError: "name must be requirement, got
// value".
[[noreturn]] void refuse(const std::string& name, const std::string& requirement, double value);

// A position, velocity or impulse; the unit is told as " [m]".
void require_finite(const std::string& name, const std::string& unit, double value);

// A quantity of a kind ("length [m]") that is positive and neither so small nor so large that
// products of it leave the range of doubles.
void require_positive(const std::string& name, const std::string& kind, double value);

}  // namespace rolling_ellipse
