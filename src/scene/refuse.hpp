// Refusals of wrong numbers by name: the argument, the requirement and the value.
#pragma once

#include <string>
#include <string_view>

#include "scene/field.hpp"

namespace rolling_ellipse {

// A double as Python prints it; 1e+15 and subnormal numbers in other digits.
std::string text(double value);

// Throws std::invalid_argument, which Python shows as ValueError: "name must be requirement, got
// value".
[[noreturn]] void refuse(std::string_view name, const std::string& requirement, double value);
[[noreturn]] void refuse(std::string_view name, const std::string& requirement,
                         const std::string& value);

// A unit as messages have it: " [m]".
std::string in_brackets(const Unit& unit);

// Throws unless a position, velocity or impulse is finite and small enough.
void require_finite(std::string_view name, const Unit& unit, double value);

// Throws unless a quantity of a kind ("length [m]") is positive and of a size whose products stay
// within the range of doubles.
void require_positive(std::string_view name, std::string_view kind, double value);

}  // namespace rolling_ellipse
