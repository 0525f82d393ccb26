// Sine and cosine for inner loops, without calls and branches; the bits are the same with every C
// library.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

#include "numerics/numbers.hpp"

namespace rolling_ellipse {

// Largest angle [rad] that nearest_quarter takes.
inline constexpr double largest_in_quarters = 1e5;

// An angle less the nearest multiple of pi/2, to the last bit, and whether the multiple is odd.
// W. J. Cody, W. Waite, Software Manual for the Elementary Functions, 1980, chapter 8.
struct QuarterAngle {
    double rest;
    bool odd;
};

inline QuarterAngle nearest_quarter(double angle) {
    constexpr double per_radian = 6.36619772367581382433e-01;
    // pi/2 in parts of 33 bits, whose multiples are exact, and the rest
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

// Sine and cosine for |angle| <= pi/4. The terms left out of the series are 5e-17 of the sine and
// 2e-18 of the cosine. Pairs of terms are independent of each other.
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

}  // namespace rolling_ellipse
