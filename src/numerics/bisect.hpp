// Bisection to the last bit.
#pragma once

namespace rolling_ellipse {

// Two neighbouring doubles, of which only the upper one is "high".
struct Bracket {
    double low;
    double high;
};

// Between a number that is not high and one that is; low < high.
template <class Predicate>
Bracket bisect(double low, double high, const Predicate& is_high) {
    for (;;) {
        const double middle = low + 0.5 * (high - low);
        if (!(low < middle && middle < high)) return {low, high};
        (is_high(middle) ? high : low) = middle;
    }
}

}  // namespace rolling_ellipse
