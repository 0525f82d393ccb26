// Constants and the smallest of functions.
#pragma once

#include <limits>

namespace rolling_ellipse {

inline constexpr double infinity = std::numeric_limits<double>::infinity();
inline constexpr double epsilon = std::numeric_limits<double>::epsilon();
inline constexpr double pi = 3.14159265358979311600e+00;
inline constexpr double half_pi = 1.57079632679489655800e+00;

// Numbers that differ by no more ulp than this, the rounding of a few operations, count as equal.
inline constexpr double equal_ulps = 8;

// Positions, velocities, impulses and components of states are no larger: products of a few of them
// stay within the doubles.
inline constexpr double largest_number = 1e50;

constexpr double square(double x) { return x * x; }

}  // namespace rolling_ellipse
