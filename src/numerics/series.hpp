// Power series in one variable, cut at a fixed order, and the rules for their coefficients
// (A. Jorba, M. Zou, Experiment. Math. 14 (2005) 99).
#pragma once

#include <array>

namespace rolling_ellipse {

inline constexpr int series_order = 16;
using Series = std::array<double, series_order + 1>;

// The terms first .. last of the coefficient k of a product; two sums need not wait for each other.
inline double terms(const Series& p, const Series& q, int k, int first, int last) {
    double even = 0.0;
    double odd = 0.0;
    int i = first;
    for (; i < last; i += 2) {
        even += p[i] * q[k - i];
        odd += p[i + 1] * q[k - i - 1];
    }
    if (i == last) even += p[i] * q[k - i];
    return even + odd;
}

// The coefficient k of a product.
inline double product(const Series& p, const Series& q, int k) { return terms(p, q, k, 0, k); }

// The coefficient k of a square, without the first `from` terms and as many of the last.
inline double self_product(const Series& p, int k, int from = 0) {
    const double pairs = terms(p, p, k, from, (k + 1) / 2 - 1);
    return 2 * pairs + (k % 2 == 0 && k / 2 >= from ? p[k / 2] * p[k / 2] : 0.0);
}

inline double value(const Series& series, double z) {
    double sum = series[series_order];
    for (int k = series_order - 1; k >= 0; --k) sum = sum * z + series[k];
    return sum;
}

}  // namespace rolling_ellipse
