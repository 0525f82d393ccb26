// Truncated power series in one variable and rules for their coefficients (A. Jorba, M. Zou,
// Experiment. Math. 14 (2005) 99), for doubles or several lanes.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <type_traits>
#include <utility>

#include "numerics/numbers.hpp"

namespace rolling_ellipse {

inline constexpr int series_order = 16;
using Series = std::array<double, series_order + 1>;

// Terms first .. last of the sum for coefficient k of a product, added as two independent sums.
template <class Coefficients>
[[gnu::always_inline]] inline auto terms(const Coefficients& p, const Coefficients& q, int k,
                                         int first, int last) {
    using Number = std::decay_t<decltype(p[0])>;
    Number even{};
    Number odd{};
    int i = first;
    for (; i < last; i += 2) {
        even += p[i] * q[k - i];
        odd += p[i + 1] * q[k - i - 1];
    }
    if (i == last) even += p[i] * q[k - i];
    return even + odd;
}

// Coefficient k of the product of two series.
template <class Coefficients>
[[gnu::always_inline]] inline auto product(const Coefficients& p, const Coefficients& q, int k) {
    return terms(p, q, k, 0, k);
}

// Coefficient k of the square of a series, without the first and last `from` terms of its sum.
template <class Coefficients>
[[gnu::always_inline]] inline auto self_product(const Coefficients& p, int k, int from = 0) {
    const auto pairs = 2 * terms(p, p, k, from, (k + 1) / 2 - 1);
    return k % 2 == 0 && k / 2 >= from ? pairs + p[k / 2] * p[k / 2] : pairs;
}

// The value of a series at z, a double or several lanes. Two independent sums halve the length of
// the chain of operations.
template <std::size_t Size, class Number>
[[gnu::always_inline]] inline Number value(const std::array<double, Size>& series, Number z) {
    static_assert(Size % 2 == 1 && Size > 2);
    const Number z2 = z * z;
    Number even = series[Size - 1] - Number{};
    Number odd = series[Size - 2] - Number{};
    for (int k = int(Size) - 3; k > 0; k -= 2) {
        even = even * z2 + series[k];
        odd = odd * z2 + series[k - 1];
    }
    return series[0] + (z * odd + z2 * even);
}

template <std::size_t Size>
double derivative(const std::array<double, Size>& series, double z) {
    double sum = 0.0;
    for (int k = int(Size) - 1; k > 0; --k) sum = sum * z + k * series[k];
    return sum;
}

// Four doubles, held in one register where the build and the processor allow it
// (numerics/wide.hpp). Results are bit-identical to those of scalar arithmetic.
using Quad = double __attribute__((vector_size(4 * sizeof(double))));

// Order of the power series that follow a motion piece by piece. A higher order makes a piece
// longer and costlier by nearly the same factor, but each piece also has a fixed cost.
inline constexpr int long_order = 24;
using LongSeries = std::array<double, long_order + 1>;

// The terms 1 .. k-1 of coefficient k of a product, which need coefficient k of neither factor. The
// terms with the newest coefficients are added last, so that the others need not wait for them.
template <class Coefficients>
[[gnu::always_inline]] inline auto inner(const Coefficients& p, const Coefficients& q, int k) {
    using Number = std::decay_t<decltype(p[0])>;
    if (k < 2) return Number{};
    if (k == 2) return Number(p[1] * q[1]);
    return Number(terms(p, q, k, 2, k - 2) + (p[1] * q[k - 1] + p[k - 1] * q[1]));
}

// Factors of four products, one in each lane, which are computed side by side, coefficient by
// coefficient.
using Factors = std::array<Quad, long_order + 1>;

// Coefficient k of the product in one lane, from its inner terms and coefficient k of both factors.
struct ProductAt {
    int k;

    [[gnu::always_inline]] double operator()(const Quad& known, const Factors& first,
                                             const Factors& second, int lane, double first_k,
                                             double second_k) const {
        const double ends =
            k == 0 ? first_k * second_k : first[0][lane] * second_k + first_k * second[0][lane];
        return known[lane] + ends;
    }
};

// The factors 1/(k + 1) that turn coefficient k of a rate into coefficient k + 1 of its integral.
inline constexpr auto over_next = [] {
    std::array<double, long_order + 1> found{};
    for (int k = 0; k <= long_order; ++k) found[k] = 1.0 / (k + 1);
    return found;
}();

// Calls a function with 0 ... long_order as compile-time constants.
template <class Function, int... numbers>
[[gnu::always_inline]] inline void for_each_order(const Function& call,
                                                  std::integer_sequence<int, numbers...>) {
    (call(std::integral_constant<int, numbers>{}), ...);
}
template <class Function>
[[gnu::always_inline]] inline void for_each_order(const Function& call) {
    for_each_order(call, std::make_integer_sequence<int, long_order + 1>{});
}

// The radius at which the last terms of each series are at most a twentieth of an ulp of the
// largest of its first three terms; the omitted terms are smaller still. Half an ulp would be too
// much, since the error may have the same sign step after step. The last four terms are used, since
// three of them may vanish by symmetry; the earlier ones are reduced as if successive terms fell by
// a factor of five. Each step of the fixed-point iteration divides the error of log(radius) by at
// least 24/5.
inline double reach(std::initializer_list<const LongSeries*> all) {
    constexpr double rest = 1e-17;
    constexpr double fall = 0.2;
    double r = 0.3;
    for (int i = 0; i < 3; ++i) {
        const double over = 1 / r;
        double least = infinity;
        for (const LongSeries* each : all) {
            const LongSeries& series = *each;
            const double size = std::max(
                {std::abs(series[0]), std::abs(series[1]) * r, std::abs(series[2]) * square(r)});
            double ends = square(fall) * fall * std::abs(series[long_order - 3]);
            ends = square(fall) * std::abs(series[long_order - 2]) + ends * over;
            ends = fall * std::abs(series[long_order - 1]) + ends * over;
            ends = std::abs(series[long_order]) + ends * over;
            if (ends > 0) least = std::min(least, size / ends);
        }
        if (std::isinf(least)) return infinity;
        r = std::exp(std::log(rest * least) * (1.0 / long_order));
    }
    return r;
}

}  // namespace rolling_ellipse
