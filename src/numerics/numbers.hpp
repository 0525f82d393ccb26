// Constants, small functions, double-double numbers of 106 bits, and sine and cosine for inner
// loops.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <limits>

namespace rolling_ellipse {

inline constexpr double infinity = std::numeric_limits<double>::infinity();
inline constexpr double epsilon = std::numeric_limits<double>::epsilon();
inline constexpr double pi = 3.14159265358979311600e+00;
inline constexpr double half_pi = 1.57079632679489655800e+00;

// Largest difference [ulp] between values that count as equal: the rounding errors of a few
// operations.
inline constexpr double equal_ulps = 8;

// Largest magnitude of positions, velocities, impulses and components of states; products of a few
// of them do not overflow.
inline constexpr double largest_number = 1e50;

// 1.5 * 2^52; adding and then subtracting this constant rounds a number to a whole number.
inline constexpr double to_integer = 6755399441055744.0;

// Result of a comparison: a bool for doubles, or one truth value for each lane.
template <class T>
using Mask = decltype(T{} < T{});

constexpr double square(double x) { return x * x; }

// sqrt(x^2 + y^2) to within 1.5 ulp, for numbers whose squares neither overflow nor underflow.
// The hypot of C libraries is within 1 ulp, but its bits differ between versions.
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

// Always inlined, since code for wider vectors passes packs of doubles in different registers.
template <class T>
[[gnu::always_inline]] inline TwoParts<T> quick_two_sum(T large, T small) {
    const T sum = large + small;
    return {sum, small - (sum - large)};
}

template <class T>
[[gnu::always_inline]] inline TwoParts<T> two_sum(T x, T y) {
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
[[gnu::always_inline]] inline TwoParts<T> operator+(const TwoParts<T>& x, T y) {
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

inline DoubleDouble operator*(const DoubleDouble& x, const DoubleDouble& y) {
    const DoubleDouble product = two_product(x.high, y.high);
    return quick_two_sum(product.high, product.low + (x.high * y.low + x.low * y.high));
}

inline DoubleDouble operator/(const DoubleDouble& x, double y) {
    const double quotient = x.high / y;
    return quick_two_sum(quotient, (std::fma(-quotient, y, x.high) + x.low) / y);
}

inline DoubleDouble square_root(const DoubleDouble& x) {
    const double root = std::sqrt(x.high);
    return quick_two_sum(root, (std::fma(-root, root, x.high) + x.low) / (2 * root));
}

inline constexpr DoubleDouble half_pi_exact = {half_pi, 6.12323399573676603587e-17};

// Largest angle [rad] that nearest_quarter accepts.
inline constexpr double largest_in_quarters = 1e5;

// An angle minus the nearest multiple of pi/2, to within 1 ulp, and whether the multiple is odd. W.
// J. Cody, W. Waite, Software Manual for the Elementary Functions, 1980, chapter 8.
struct QuarterAngle {
    double rest;
    bool odd;
};

inline QuarterAngle nearest_quarter(double angle) {
    constexpr double per_radian = 6.36619772367581382433e-01;
    // pi/2 as two parts of 33 bits, whose multiples are exact, and the remainder
    constexpr double first = 1.5707963267341256;
    constexpr double second = 6.077100506303966e-11;
    constexpr double third = 2.0222662487959506e-21;
    const double shifted = angle * per_radian + to_integer;
    const double quarters = shifted - to_integer;
    std::uint64_t bits;
    std::memcpy(&bits, &shifted, sizeof bits);
    const double rest = ((angle - quarters * first) - quarters * second) - quarters * third;
    return {rest, (bits & 1) != 0};
}

struct SineCosine {
    double sine;
    double cosine;
};

// Sine and cosine for |angle| <= pi/4, without calls or branches; the bits are the same with every
// C library. The omitted terms of the series are at most 5e-17 for the sine and 2e-18 for the
// cosine.
inline SineCosine sine_cosine_of_rest(double angle) {
    const double z = angle * angle;
    const double z2 = z * z;
    const double z4 = z2 * z2;
    const double s0 = -1.0 / 6 + z * (1.0 / 120);
    const double s1 = -1.0 / 5040 + z * (1.0 / 362880);
    const double s2 = -1.0 / 39916800 + z * (1.0 / 6227020800);
    const double s3 = -1.0 / 1307674368000;
    const double c0 = 1.0 / 24 - z * (1.0 / 720);
    const double c1 = 1.0 / 40320 - z * (1.0 / 3628800);
    const double c2 = 1.0 / 479001600 - z * (1.0 / 87178291200);
    const double c3 = 1.0 / 20922789888000;
    const double sine = (s0 + z2 * s1) + z4 * (s2 + z2 * s3);
    const double cosine = (c0 + z2 * c1) + z4 * (c2 + z2 * c3);
    return {angle + angle * z * sine, (1.0 - 0.5 * z) + z2 * cosine};
}

struct LongSineCosine {
    DoubleDouble sine;
    DoubleDouble cosine;
};

// Sine and cosine for |angle| <= pi/4 to within 3e-18; the first terms are computed to 106 bits.
inline LongSineCosine sine_cosine_of_rest(const DoubleDouble& angle) {
    const DoubleDouble squared = angle * angle;
    const double z = squared.high;
    double s = 0.0;
    double c = 0.0;
    for (const double factorial :
         {355687428096000.0, 1307674368000.0, 6227020800.0, 39916800.0, 362880.0, 5040.0, 120.0}) {
        s = 1 / factorial - z * s;
    }
    for (const double factorial :
         {20922789888000.0, 87178291200.0, 479001600.0, 3628800.0, 40320.0, 720.0}) {
        c = 1 / factorial - z * c;
    }
    const DoubleDouble cubic = angle * squared / -6;
    const DoubleDouble quartic = squared * squared / 24;
    return {angle + (cubic + angle.high * z * z * s),
            (squared / -2 + 1.0) + (quartic + -z * z * z * c)};
}

}  // namespace rolling_ellipse
