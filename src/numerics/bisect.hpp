// Bisection to the last bit, and what comes to the same more quickly.
#pragma once

#include <algorithm>
#include <cmath>

#include "numerics/numbers.hpp"

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

// The same for the sign of a function, by the secants of the Illinois method (M. Dowell, P.
// Jarratt, BIT 11 (1971) 168). A place next to an end of the bracket is moved a few doubles on: so
// the other end comes near, too.
template <class Function>
Bracket bisect_root(double low, double high, const Function& f) {
    constexpr int most_secants = 40;
    double f_low = f(low);
    double f_high = f(high);
    const bool rises = f_high > 0;
    int kept = 0;
    for (int i = 0; i < most_secants; ++i) {
        const double few = 4 * epsilon * std::max(std::abs(low), std::abs(high));
        if (high - low <= 2 * few) break;
        const double secant = (low * f_high - high * f_low) / (f_high - f_low);
        double x = i % 4 == 3 || !(secant >= low && secant <= high) ? 0.5 * (low + high) : secant;
        x = std::clamp(x, low + few, high - few);
        const double now = f(x);
        if ((now > 0) == rises) {
            high = x;
            f_high = now;
            if (kept == 1) f_low /= 2;
            kept = 1;
        } else {
            low = x;
            f_low = now;
            if (kept == -1) f_high /= 2;
            kept = -1;
        }
    }
    return bisect(low, high, [&](double x) { return (f(x) > 0) == rises; });
}

}  // namespace rolling_ellipse
