// Constants, very small functions, and sums of two doubles with 106 bits.
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

// The sum high + low with |low| <= ulp(high)/2, for periods, phases and multiples of pi; T is a
// double or several lanes (numerics/lanes.hpp). Algorithms: T. J. Dekker, Numer. Math. 18 (1971)
// 224; J. R. Shewchuk, Discrete Comput. Geom. 18 (1997) 305.
template <class T>
struct TwoParts {
    T high{};
    T low{};

    explicit operator T() const { return high + low; }
};
using DoubleDouble = TwoParts<double>;

template <class T>
inline TwoParts<T> quick_two_sum(T large, T small) {
    const T sum = large + small;
    return {sum, small - (sum - large)};
}

template <class T>
inline TwoParts<T> two_sum(T x, T y) {
    const T sum = x + y;
    const T y_part = sum - x;
    return {sum, (x - (sum - y_part)) + (y - y_part)};
}

inline DoubleDouble two_product(double x, double y) {
    const double product = x * y;
    return {product, std::fma(x, y, -product)};
}

inline DoubleDouble operator-(const DoubleDouble& x) { return {-x.high, -x.low}; }

template <class T>
inline TwoParts<T> operator+(const TwoParts<T>& x, T y) {
    const TwoParts<T> sum = two_sum(x.high, y);
    return quick_two_sum(sum.high, sum.low + x.low);
}

inline DoubleDouble operator+(const DoubleDouble& x, const DoubleDouble& y) {
    const DoubleDouble sum = two_sum(x.high, y.high);
    return quick_two_sum(sum.high, sum.low + (x.low + y.low));
}

inline DoubleDouble operator-(const DoubleDouble& x, const DoubleDouble& y) { return x + (-y); }

inline DoubleDouble operator*(const DoubleDouble& x, double y) {
    const DoubleDouble product = two_product(x.high, y);
    return quick_two_sum(product.high, std::fma(x.low, y, product.low));
}

inline constexpr DoubleDouble half_pi_exact = {half_pi, 6.12323399573676603587e-17};

}  // namespace rolling_ellipse
