// Constants and the smallest of functions.
#pragma once

#include <cmath>
#include <limits>

namespace rolling_ellipse {

inline constexpr double infinity = std::numeric_limits<double>::infinity();
inline constexpr double epsilon = std::numeric_limits<double>::epsilon();
inline constexpr double pi = 3.14159265358979311600e+00;
inline constexpr double half_pi = 1.57079632679489655800e+00;

// Numbers that differ by no more ulp than this, the rounding of a few operations, count as equal.
inline constexpr double equal_ulps = 8;

// Positions, velocities, impulses, components of states and finite frictions are no larger:
// products of a few of them stay within the doubles.
inline constexpr double largest_number = 1e50;

// 1.5 2^52, beside which only integers are left: a sum with it is rounded to one.
inline constexpr double to_integer = 6755399441055744.0;

// A comparison of two numbers: of doubles a bool, of several side by side the truth of each.
template <class T>
using Mask = decltype(T{} < T{});

constexpr double square(double x) { return x * x; }

// sqrt(x^2 + y^2) of lengths and the like, whose squares stay within the doubles: within 1.5 ulp.
// The hypot of C libraries is within 1, in bits that differ from version to version.
inline double root_of_squares(double x, double y) { return std::sqrt(x * x + y * y); }

}  // namespace rolling_ellipse
