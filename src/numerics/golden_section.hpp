// Golden section: the place of the one extremum in an interval.
#pragma once

namespace rolling_ellipse {

// To 1e-8 of the interval: an extremum is flat there. The comparison of two places, the lower one
// first, tells whether the extremum is below the upper one.
template <class Comparison>
double golden_section(double low, double high, const Comparison& is_below_upper) {
    constexpr double golden = 0.6180339887498949;
    constexpr int sections = 40;
    for (int i = 0; i < sections; ++i) {
        const double left = high - golden * (high - low);
        const double right = low + golden * (high - low);
        if (is_below_upper(left, right)) {
            high = right;
        } else {
            low = left;
        }
    }
    return 0.5 * (low + high);
}

}  // namespace rolling_ellipse
