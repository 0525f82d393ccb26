#include "rolling/path_series.hpp"

#include <cmath>

#include "numerics/sine_cosine.hpp"

namespace rolling_ellipse {

PathSeries::PathSeries(const Axes& axes)
    : axes_(axes),
      c2_((axes.a - axes.b) * (axes.a + axes.b)),
      off_axis_(std::atanh(std::fmin(axes.a, axes.b) / std::fmax(axes.a, axes.b))) {}

// From the nearest root of h, at which its series ends to converge.
double PathSeries::distance(double theta) const {
    const auto [rest, odd] = nearest_quarter(theta);
    const bool by_flat = odd == (c2_ < 0);
    return std::hypot(by_flat ? std::abs(rest) : half_pi - std::abs(rest), off_axis_);
}

// Intervals are halves of halves of [n, n + 1), the first that is a 3.5th of the distance or less:
// the 17 terms then leave out less than 1e-17 of h times the interval.
void PathSeries::move_to(double theta) {
    constexpr double share = 3.5;
    if (!(std::abs(theta) <= largest_in_quarters)) {
        path_ = {centre_path(axes_, theta)};
        low_ = high_ = middle_ = theta;
        return;
    }
    double width = 2.0;
    do {
        width /= 2;
        low_ = std::floor(theta / width) * width;
        middle_ = low_ + width / 2;
    } while (share * width > distance(middle_));
    high_ = low_ + width;

    // h^2 = u, u'' = -4 u + constant
    const double s = std::sin(middle_);
    const double c = std::cos(middle_);
    Series u;
    u[0] = square(axes_.a * s) + square(axes_.b * c);
    u[1] = 2 * c2_ * s * c;
    u[2] = c2_ * (c - s) * (c + s);
    for (int k = 3; k <= series_order; ++k) u[k] = -4 * u[k - 2] / (k * (k - 1));
    Series h;
    h[0] = std::sqrt(u[0]);
    const double half = 0.5 / h[0];
    path_[0] = centre_path(axes_, middle_);
    path_[1] = h[0];
    for (int k = 1; k < series_order; ++k) {
        h[k] = half * (u[k] - self_product(h, k, 1));
        path_[k + 1] = h[k] / (k + 1);
    }
}

}  // namespace rolling_ellipse
