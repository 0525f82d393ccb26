// Truncated power series in one variable and the rules for their coefficients (A. Jorba, M. Zou,
// Experiment. Math. 14 (2005) 99), for doubles or several lanes.
#pragma once

#include <array>
#include <cstddef>
#include <type_traits>

namespace rolling_ellipse {

inline constexpr int series_order = 16;
using Series = std::array<double, series_order + 1>;

// The terms first .. last of the coefficient k of a product, as two independent sums.
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

// The coefficient k of a product.
template <class Coefficients>
[[gnu::always_inline]] inline auto product(const Coefficients& p, const Coefficients& q, int k) {
    return terms(p, q, k, 0, k);
}

// The coefficient k of a square, without the first `from` and the last `from` terms.
template <class Coefficients>
[[gnu::always_inline]] inline auto self_product(const Coefficients& p, int k, int from = 0) {
    const auto pairs = 2 * terms(p, p, k, from, (k + 1) / 2 - 1);
    return k % 2 == 0 && k / 2 >= from ? pairs + p[k / 2] * p[k / 2] : pairs;
}

// The value at z. Two independent sums halve the time of the chain of operations.
template <std::size_t Size>
double value(const std::array<double, Size>& series, double z) {
    static_assert(Size % 2 == 1 && Size > 2);
    const double z2 = z * z;
    double even = series[Size - 1];
    double odd = series[Size - 2];
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

}  // namespace rolling_ellipse
