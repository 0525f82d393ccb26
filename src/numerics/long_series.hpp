// Power series that solve an arc, a few to each: their cost grows with the order little faster than
// their reach, and each has its price besides.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "numerics/numbers.hpp"
#include "numerics/series.hpp"

namespace rolling_ellipse {

// Two doubles that are computed at once where the processor can, with the bits of one after the
// other.
using Pair = double __attribute__((vector_size(2 * sizeof(double))));

inline Pair pair(double first, double second) { return Pair{first, second}; }

inline constexpr int long_order = 24;
using LongSeries = std::array<double, long_order + 1>;

// Two series, of which two products at a time are made.
using TwoSeries = std::array<Pair, long_order + 1>;

// The terms of the coefficient k of a product for which all is known before the coefficients k.
template <class Coefficients>
inline auto inner(const Coefficients& p, const Coefficients& q, int k) {
    return terms(p, q, k, 1, k - 1);
}

// The terms 0 and k, of which the one is the other for k = 0.
template <class Coefficients>
inline auto outer(const Coefficients& p, const Coefficients& q, int k) {
    return k == 0 ? p[0] * q[0] : p[0] * q[k] + p[k] * q[0];
}

// 1/(k + 1), what the coefficient k of a rate is to be multiplied with.
inline constexpr auto over_next = [] {
    std::array<double, long_order + 1> found{};
    for (int k = 0; k <= long_order; ++k) found[k] = 1.0 / (k + 1);
    return found;
}();

// The distance from its centre at which the last terms of a series are a twentieth of an ulp beside
// its own size; the terms left out are smaller by another fifth. Half an ulp would be too much,
// since it may have the same sign in one step after another. Four terms are looked at, as symmetry
// may hide three; each as it would be at the end of a series that falls by a fifth from term to
// term. Found as a fixed point, of which each step divides the error of the logarithm by eight.
inline double reach(const LongSeries& series) {
    constexpr double rest = 1e-17;
    constexpr double fall = 0.2;
    const double last[] = {std::abs(series[long_order]), fall * std::abs(series[long_order - 1]),
                           square(fall) * std::abs(series[long_order - 2]),
                           fall * square(fall) * std::abs(series[long_order - 3])};
    double r = 0.3;
    for (int i = 0; i < 3; ++i) {
        const double size = std::max(
            {std::abs(series[0]), std::abs(series[1]) * r, std::abs(series[2]) * square(r)});
        const double over = 1 / r;
        const double ends = last[0] + (last[1] + (last[2] + last[3] * over) * over) * over;
        if (!(ends > 0)) return infinity;
        r = std::exp(std::log(rest * size / ends) * (1.0 / long_order));
    }
    return r;
}

}  // namespace rolling_ellipse
