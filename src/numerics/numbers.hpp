// Constants and very small functions.
#pragma once

#include <cmath>
#include <limits>

namespace rolling_ellipse {

inline constexpr double infinity = std::numeric_limits<double>::infinity();
inline constexpr double epsilon = std::numeric_limits<double>::epsilon();
inline constexpr double pi = 3.14159265358979311600e+00;
inline constexpr double half_pi = 1.57079632679489655800e+00;

// Largest difference [ulp] of numbers that count as equal: the rounding of a few operations.
inline constexpr double equal_ulps = 8;

// Largest size of positions, velocities, impulses, components of states and finite frictions:
// products of a few of them stay within the doubles.
inline constexpr double largest_number = 1e50;

// 1.5 2^52: a sum with it is rounded to a whole number.
inline constexpr double to_integer = 6755399441055744.0;

// Result of a comparison of numbers: bool for doubles, the truth of each lane for several lanes.
template <class T>
using Mask = decltype(T{} < T{});

constexpr double square(double x) { return x * x; }

// sqrt(x^2 + y^2) within 1.5 ulp, for numbers whose squares stay within the doubles. The hypot of C
// libraries is within 1 ulp, in bits that differ from version to version.
inline double root_of_squares(double x, double y) { return std::sqrt(x * x + y * y); }

}  // namespace rolling_ellipse
