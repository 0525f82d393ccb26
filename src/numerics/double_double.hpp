// Sums of two doubles with 106 bits, for periods, phases and multiples of pi. Algorithms: T. J.
// Dekker, Numer. Math. 18 (1971) 224; J. R. Shewchuk, Discrete Comput. Geom. 18 (1997) 305.
#pragma once

#include <cmath>

#include "numerics/numbers.hpp"

namespace rolling_ellipse {

// The sum high + low with |low| <= ulp(high)/2; T is a double or several lanes
// (numerics/lanes.hpp).
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
