// Wrong numbers are refused by name: the argument, what was required and what came.
#pragma once

#include <string>
#include <string_view>

namespace rolling_ellipse {

// A double as Python prints it; 1e+15 and subnormal numbers in other words.
std::string text(double value);

// Throws std::invalid_argument, which Python shows as ValueError: "name must be requirement, got
// value".
[[noreturn]] void refuse(std::string_view name, const std::string& requirement, double value);

// A position, velocity or impulse; the unit is told as " [m]".
void require_finite(std::string_view name, std::string_view unit, double value);

// A quantity of a kind ("length [m]") that is positive and neither so small nor so large that
// products of it leave the range of doubles.
void require_positive(std::string_view name, std::string_view kind, double value);

}  // namespace rolling_ellipse
