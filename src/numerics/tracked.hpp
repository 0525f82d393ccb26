// Numbers that know how far rounding may have moved them.
#pragma once

#include <cmath>

#include "numerics/numbers.hpp"

namespace rolling_ellipse {

// A number and the magnitude of the terms that were summed up to it.
struct Tracked {
    double value = 0.0;
    double magnitude = 0.0;
};

inline Tracked tracked(double value) { return {value, std::abs(value)}; }

inline Tracked operator+(Tracked x, Tracked y) {
    return {x.value + y.value, x.magnitude + y.magnitude};
}

inline Tracked operator-(Tracked x, Tracked y) {
    return {x.value - y.value, x.magnitude + y.magnitude};
}

inline Tracked operator*(Tracked x, Tracked y) {
    return {x.value * y.value, x.magnitude * y.magnitude};
}

enum class Sign { positive, negative, undecided };

// How far rounding may have moved a number: coefficients of degree 10 pass some 60 additions and
// products, each good to half an ulp, and the parameters they start from are rounded themselves.
inline double margin(Tracked number) {
    constexpr double rounding_units = 64;
    return rounding_units * epsilon * number.magnitude;
}

inline Sign sign(Tracked number) {
    if (number.value > margin(number)) return Sign::positive;
    return number.value < -margin(number) ? Sign::negative : Sign::undecided;
}

}  // namespace rolling_ellipse
