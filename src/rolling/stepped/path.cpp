#include "rolling/stepped/path.hpp"

#include <algorithm>
#include <cmath>

#include "numerics/numbers.hpp"

namespace rolling_ellipse {

PathSeries::PathSeries(const Axes& axes)
    : axes_(axes),
      c2_((axes.a - axes.b) * (axes.a + axes.b)),
      off_axis_(std::atanh(std::fmin(axes.a, axes.b) / std::fmax(axes.a, axes.b))) {}

void PathSeries::move_to(double angle) {
    constexpr std::size_t most_known = 256;  // a half turn of the thinnest body has about a hundred
    if (!(angle <= largest_in_quarters)) {
        here_ = {angle, angle, angle, {centre_path(axes_, angle)}};
        return;
    }
    const auto known =
        std::find_if(known_.begin(), known_.end(),
                     [angle](const Interval& interval) { return interval.holds(angle); });
    if (known != known_.end()) {
        here_ = *known;
        return;
    }
    here_ = interval_at(angle);
    if (known_.size() == most_known) known_.clear();
    known_.push_back(here_);
}

// Distance of an angle from the nearest root of h, at which its series ceases to converge.
double PathSeries::distance(double angle) const {
    const auto [rest, odd] = nearest_quarter(angle);
    const bool by_flat = odd == (c2_ < 0);
    return root_of_squares(by_flat ? std::abs(rest) : half_pi - std::abs(rest), off_axis_);
}

// The longest of the halves of halves of [n, n + 1) about an angle that is at most a 3.5th of the
// distance: the 17 terms then leave out less than 1e-17 of h times the interval.
PathSeries::Interval PathSeries::interval_at(double angle) const {
    constexpr double share = 3.5;
    Interval found;
    double width = 2.0;
    do {
        width /= 2;
        found.low = std::floor(angle / width) * width;
        found.middle = found.low + width / 2;
    } while (share * width > distance(found.middle));
    found.high = found.low + width;

    // h^2 = u, u'' = -4 u + constant
    const double s = std::sin(found.middle);
    const double c = std::cos(found.middle);
    Series u;
    u[0] = square(axes_.a * s) + square(axes_.b * c);
    u[1] = 2 * c2_ * s * c;
    u[2] = c2_ * ((c - s) * (c + s));
    for (int k = 3; k <= series_order; ++k) u[k] = -4 * u[k - 2] / (k * (k - 1));
    Series h;
    h[0] = std::sqrt(u[0]);
    const double half = 0.5 / h[0];
    found.path[0] = centre_path(axes_, found.middle);
    found.path[1] = h[0];
    for (int k = 1; k < series_order; ++k) {
        h[k] = half * (u[k] - self_product(h, k, 1));
        found.path[k + 1] = h[k] / (k + 1);
    }
    return found;
}

}  // namespace rolling_ellipse
