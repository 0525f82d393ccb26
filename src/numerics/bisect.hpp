// Bisection to the last bit, a faster search for a sign change, and golden-section search.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "numerics/numbers.hpp"

namespace rolling_ellipse {

// An interval at whose ends a predicate is false (`low`) and true (`high`).
struct Bracket {
    double low;
    double high;
};

// Bisects the interval from `low`, where the predicate is false, to `high`, where it is true, until
// the ends are neighbouring doubles.
template <class Predicate>
Bracket bisect(double low, double high, const Predicate& is_high) {
    for (;;) {
        const double middle = low + 0.5 * (high - low);
        if (!(low < middle && middle < high)) return {low, high};
        (is_high(middle) ? high : low) = middle;
    }
}

// Finds a sign change of a function between two points by a secant method, the Illinois method (M.
// Dowell, P. Jarratt, BIT 11 (1971) 168). Every fourth step, and every step after the first forty,
// is a bisection. A point within a few doubles of an end is moved inwards, so that the other end
// approaches, too. The caller evaluates the function:
//     while (const auto x = bracket.next()) bracket.take(*x, f(*x));
class RootBracket {
  public:
    RootBracket(double low, double high, double f_low, double f_high)
        : ends_{low, high}, f_low_(f_low), f_high_(f_high), rises_(f_high > 0) {}

    // The next point at which to evaluate the function; empty if the ends are neighbouring doubles.
    std::optional<double> next() {
        constexpr int most_secants = 40;
        const auto [low, high] = ends_;
        const double few = 4 * epsilon * std::max(std::abs(low), std::abs(high));
        if (secants_ < most_secants && high - low > 2 * few) {
            const double place = (low * f_high_ - high * f_low_) / (f_high_ - f_low_);
            const bool halve = secants_++ % 4 == 3 || !(place >= low && place <= high);
            return std::clamp(halve ? 0.5 * (low + high) : place, low + few, high - few);
        }
        secants_ = most_secants;
        const double middle = low + 0.5 * (high - low);
        return low < middle && middle < high ? std::optional(middle) : std::nullopt;
    }

    void take(double x, double f) {
        if ((f > 0) == rises_) {
            ends_.high = x;
            f_high_ = f;
            if (moved_ == 1) f_low_ /= 2;
            moved_ = 1;
        } else {
            ends_.low = x;
            f_low_ = f;
            if (moved_ == -1) f_high_ /= 2;
            moved_ = -1;
        }
    }

    Bracket ends() const { return ends_; }

  private:
    Bracket ends_;
    double f_low_;
    double f_high_;
    bool rises_;
    int secants_ = 0;
    int moved_ = 0;  // the end that the last step moved: +1 upper, -1 lower, 0 none so far
};

// A guess of a root and of the slope there. bisect_root evaluates the function at the guess, then
// at twice the Newton step from the guess, usually on the other side of the root.
struct RootGuess {
    double root;
    double slope;
};

template <class Function>
Bracket bisect_root(double low, double high, const Function& f,
                    const std::optional<RootGuess>& guess = {}) {
    RootBracket bracket(low, high, f(low), f(high));
    double next = guess ? guess->root : low;
    for (int i = 0; i < 2 && bracket.ends().low < next && next < bracket.ends().high; ++i) {
        const double f_next = f(next);
        bracket.take(next, f_next);
        next -= 2 * f_next / guess->slope;
    }
    while (const auto x = bracket.next()) bracket.take(*x, f(*x));
    return bracket.ends();
}

// Finds the single extremum in an interval by golden-section search, to within 1e-8 of the width of
// the interval. Closer to the extremum, rounding hides the changes of the function. The comparison
// takes two points, the lower one first, and is true if the extremum lies below the upper one.
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
