// Angles as half turns and a rest: the ellipse is the same after half a turn.
#pragma once

#include "numerics/double_double.hpp"

namespace rolling_ellipse {

inline constexpr DoubleDouble half_turn = {2 * half_pi_exact.high, 2 * half_pi_exact.low};

// The angle itself, or what is left of it without full turns, when it is more than half a turn.
inline double within_a_turn(double angle) {
    return std::abs(angle) > pi ? std::atan2(std::sin(angle), std::cos(angle)) : angle;
}

inline bool is_odd(double quarters) { return std::fmod(quarters, 2.0) != 0.0; }

// An angle from the flat position or tip beside it, where it has the most digits.
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

// An angle of which sums with others still see a part of a turn: itself up to 1e15, where a double
// has 0.1 rad, and what is left of it without full turns beyond.
inline double resolved(double angle) {
    constexpr double largest = 1e15;
    return std::abs(angle) > largest ? within_a_turn(angle) : angle;
}

// Take full half turns off angle + carry once it exceeds one; returns how many.
inline double take_half_turns_off(double& angle, double& carry) {
    if (!(std::abs(angle) > pi)) return 0.0;
    const double over = std::nearbyint(angle / pi);
    const DoubleDouble rest = DoubleDouble{angle, carry} - half_turn * over;
    angle = rest.high;
    carry = rest.low;
    return over;
}

}  // namespace rolling_ellipse
