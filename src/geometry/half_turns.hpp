// Angles as half turns and a remainder: the ellipse is the same after half a turn.
#pragma once

#include "numerics/numbers.hpp"

namespace rolling_ellipse {

inline constexpr DoubleDouble half_turn = {2 * half_pi_exact.high, 2 * half_pi_exact.low};

// An angle of at most half a turn as it is; a larger one without full turns.
inline double within_a_turn(double angle) {
    return std::abs(angle) > pi ? std::atan2(std::sin(angle), std::cos(angle)) : angle;
}

inline bool is_odd(double quarters) { return std::fmod(quarters, 2.0) != 0.0; }

// An angle as quarter turns and a remainder: the angle from the nearest flat position or tip, where
// it has the most digits.
struct QuarterView {
    double quarters;
    DoubleDouble rest;

    bool is_odd() const { return rolling_ellipse::is_odd(quarters); }
};

inline QuarterView quarter_view(const DoubleDouble& angle) {
    const double quarters = std::nearbyint(angle.high / half_pi);
    if (quarters == 0) return {quarters, angle};  // mostly
    return {quarters, angle - half_pi_exact * quarters};
}

// An angle whose sums with others still resolve a part of a turn: unchanged up to 1e15, where a
// double resolves 0.1 rad, and without full turns beyond.
inline double resolved(double angle) {
    constexpr double largest = 1e15;
    return std::abs(angle) > largest ? within_a_turn(angle) : angle;
}

// Takes the half turns off angle + carry if it exceeds one; returns their number.
inline double take_half_turns_off(double& angle, double& carry) {
    if (!(std::abs(angle) > pi)) return 0.0;
    const double over = std::nearbyint(angle / pi);
    const DoubleDouble rest = DoubleDouble{angle, carry} - half_turn * over;
    angle = rest.high;
    carry = rest.low;
    return over;
}

}  // namespace rolling_ellipse
