#include "rolling/phase_rates.hpp"

#include <cmath>
#include <cstdint>
#include <cstring>

#include "numerics/vector_levels.hpp"

namespace rolling_ellipse {
namespace {

// Loops over all lanes become vector instructions: all in them is arithmetic and choice.

// e^z - 1 for 0 <= z <= 700: z = k log 2 + r, and the Taylor series in r. Full relative accuracy.
[[gnu::always_inline]] inline double exp_minus_one(double z) {
    constexpr double per_log_2 = 1.4426950408889634;
    constexpr double log_2_high = 6.93147180369123816490e-01;  // 20 bits less: k times it is exact
    constexpr double log_2_low = 1.90821492927058770002e-10;
    constexpr double to_integer = 6755399441055744.0;  // 1.5 * 2^52: a sum with it is rounded
    const double shifted = z * per_log_2 + to_integer;
    const double k = shifted - to_integer;
    const double r = (z - k * log_2_high) - k * log_2_low;
    double sum = 1.0 / 6227020800;
    sum = sum * r + 1.0 / 479001600;
    sum = sum * r + 1.0 / 39916800;
    sum = sum * r + 1.0 / 3628800;
    sum = sum * r + 1.0 / 362880;
    sum = sum * r + 1.0 / 40320;
    sum = sum * r + 1.0 / 5040;
    sum = sum * r + 1.0 / 720;
    sum = sum * r + 1.0 / 120;
    sum = sum * r + 1.0 / 24;
    sum = sum * r + 1.0 / 6;
    sum = sum * r + 1.0 / 2;
    sum = sum * r * r + r;
    std::uint64_t bits;
    std::memcpy(&bits, &shifted, sizeof bits);
    bits = (bits << 52) + (std::uint64_t{1023} << 52);
    double power;  // 2^k
    std::memcpy(&power, &bits, sizeof power);
    return power * sum + (power - 1);
}

}  // namespace

ROLLING_ELLIPSE_VECTOR_LEVELS
PhaseWays phase_rates(const PhaseRate& rate, const PhaseMap& map, int quarters,
                      const PhaseLanes& offset) {
    const bool from_tip = quarters != 0;
    // Of the end from which the offsets are, and of the other one: is it the tip?
    const double tip_here = from_tip ? 1.0 : 0.0;
    const double tip_there = 1 - tip_here;
    const double scale2_here = from_tip ? map.tip_scale2 : map.flat_scale2;
    const double scale2_there = from_tip ? map.flat_scale2 : map.tip_scale2;
    const double cos2_factor = rate.rotates ? 1.0 : rate.amplitude2;
    const double sin2_factor = rate.rotates ? square(rate.kappa) : 0.0;
    const double quarter = map.quarter;
    const double half_turn = 2 * quarter;
    const double s2 = square(rate.short_axis);
    const double grade2 = square(map.grade);
    const auto [a0, a1, a2, a3] = map.a;
    const auto [b0, b1, b2] = map.b;
    PhaseWays rates;
    auto& [time, angle, path] = rates;
    // The distance from the nearest end, its scale, and whether it is the tip.
    std::array<double, phase_lanes> distance, scale2, tip;
    for (std::size_t i = 0; i < phase_lanes; ++i) {
        const double from_here = std::abs(offset[i]);
        const double a_turn_on = std::abs(from_here - half_turn);
        const double same = from_here < a_turn_on ? from_here : a_turn_on;
        const double other = std::abs(from_here - quarter);
        const double nearest = same < other ? same : other;
        distance[i] = nearest < largest_offset ? nearest : largest_offset;
        scale2[i] = same < other ? scale2_here : scale2_there;
        tip[i] = same < other ? tip_here : tip_there;
    }
    for (std::size_t i = 0; i < phase_lanes; ++i) {
        // The phase there.
        const double gain = exp_minus_one(2 * distance[i]);
        const double sinh2 = gain / (1 + gain) * (gain * 0.25);
        const double c = 1 + 2 * sinh2;
        const double a = a0 + c * (a1 + c * (a2 + c * a3));
        const double b = b0 + c * (b1 + c * b2);
        const double opposite = scale2[i] * sinh2 * (b * b);
        const double adjacent = a * a;
        const double inverse = 1 / (opposite + adjacent);
        const double sin2 = (tip[i] * adjacent + (1 - tip[i]) * opposite) * inverse;
        const double cos2 = (tip[i] * opposite + (1 - tip[i]) * adjacent) * inverse;
        // The rates there.
        const double sin2_phi = rate.amplitude2 * sin2;
        const double h = std::sqrt(s2 + rate.c2 * sin2_phi);
        const double graded = grade2 * cos2 + sin2;
        const double inertia = rate.d0 + rate.d1 * sin2_phi;
        time[i] =
            map.speed * std::sqrt(rate.scale2 * inertia * (rate.energy_height + h) * graded) / h;
        const double other = cos2_factor * cos2 + sin2_factor * sin2;
        angle[i] = map.speed * std::sqrt(graded * other);
        path[i] = h * angle[i];
    }
    if (rate.rotates) return rates;
    // A libration that has passed its turning point goes back.
    for (std::size_t i = 0; i < phase_lanes; ++i) {
        const double to_tip = quarters > 0 ? -offset[i] : offset[i];
        const bool forth = from_tip ? to_tip > 0 && to_tip < half_turn : std::abs(to_tip) < quarter;
        if (forth) continue;
        angle[i] = -angle[i];
        path[i] = -path[i];
    }
    return rates;
}

}  // namespace rolling_ellipse
