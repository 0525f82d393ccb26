// The rates of time, angle and path in the coordinate y of rolling/level/phase.hpp:
//     dphase/dy = speed sqrt((g^2 cos^2 + sin^2) (cos^2 + kappa^2 sin^2)),
// whose last root cancels the root of the integrand. The path of the centre grows by h dphi.
#pragma once

#include "rolling/level/coordinate.hpp"
#include "rolling/level/kernel.hpp"

namespace rolling_ellipse {
namespace {

// scale^2 D (H + h), the square of the factor that depends on the shape: physics (28, 29).
template <class C, class T>
inline T shape_factor2(const PhaseRate<C>& rate, T sin2_phi) {
    const T h2 = rate.short_axis * rate.short_axis + rate.c2 * sin2_phi;
    return rate.scale2 * (rate.d0 + rate.d1 * sin2_phi) * (rate.energy_height + sqrt(h2)) / h2;
}

// The rates at y = quarters Y + offset, |quarters| <= 1. The constants C are those of one motion
// for all places T, or of one motion for each. The phase is known as sin^2/q and cos^2/q, and h^2 =
// N/q, so that all factors share one quotient. Terms without the offset are computed once for all
// places of a loop.
template <class C, class T>
inline PhaseIncrement<T> phase_rate_at(const PhaseRate<C>& rate, const PhaseMap<C>& map, C quarters,
                                       T offset) {
    constexpr double farthest = 150.0;  // e^(4 of it) is a double
    const C one = filled<C>(1.0);
    const C half_turn = 2 * map.quarter;
    const T tip_here = filled<T>(quarters != 0 ? one : C{});
    const T scale2_here = filled<T>(quarters != 0 ? map.tip_scale2 : map.flat_scale2);
    const T scale2_there = filled<T>(quarters != 0 ? map.flat_scale2 : map.tip_scale2);
    // The nearest flat position or tip: the origin of the offset, or a place one or two quarters
    // on.
    const T from_here = abs(offset);
    const T a_turn_on = abs(from_here - half_turn);
    const T same = from_here < a_turn_on ? from_here : a_turn_on;
    const T other = abs(from_here - map.quarter);
    const auto is_same = same < other;
    const T distance = min<T>(is_same ? same : other, filled<T>(farthest));
    const T scale2 = is_same ? scale2_here : scale2_there;
    const auto at_tip = (is_same ? tip_here : 1 - tip_here) > 0;

    const T sinh = hyperbolic(distance).sinh;
    const T sinh2 = sinh * sinh;
    const T c = 1 + 2 * sinh2;
    const T a = map.a[0] + c * (map.a[1] + c * (map.a[2] + c * map.a[3]));
    const T b = map.b[0] + c * (map.b[1] + c * map.b[2]);
    const T opposite = scale2 * sinh2 * (b * b);
    const T adjacent = a * a;
    const T q = opposite + adjacent;
    const T sin2 = at_tip ? adjacent : opposite;
    const T cos2 = at_tip ? opposite : adjacent;

    const T n = (rate.short_axis * rate.short_axis) * q + (rate.c2 * rate.amplitude2) * sin2;
    const T inertia = rate.d0 * q + (rate.d1 * rate.amplitude2) * sin2;
    const T graded = (map.grade * map.grade) * cos2 + sin2;
    const T along = (rate.rotates ? one : rate.amplitude2) * cos2 +
                    (rate.rotates ? rate.kappa * rate.kappa : C{}) * sin2;
    const T inverse = 1 / (q * n);
    const T per_q = n * inverse;
    const T h = sqrt(q * n) * per_q;
    const C time_factor = map.speed * map.speed * rate.scale2;
    const T time = sqrt((time_factor * inertia) * graded * ((rate.energy_height + h) * inverse));
    const T size = map.speed * sqrt(graded * along) * per_q;
    // The angle of a libration falls beyond its turning point.
    const T to_tip = quarters > 0 ? -offset : offset;
    const auto goes_on =
        quarters != 0 ? (to_tip > 0) & (to_tip < half_turn) : abs(to_tip) < map.quarter;
    const T swung = goes_on ? size : -size;
    const T angle = rate.rotates ? size : swung;
    return {time, angle, h * angle};
}

// The rates of bodies side by side, at a few places of each.
inline void phase_rates(const PhaseRate<Pack>& rate, const PhaseMap<Pack>& map, Pack quarters,
                        const Pack* offsets, int count, PhaseRates<Pack>& found) {
    for (int i = 0; i < count; ++i) {
        const PhaseIncrement<Pack> at = phase_rate_at(rate, map, quarters, offsets[i]);
        found.time[i] = at.time;
        found.angle[i] = at.angle;
        found.path[i] = at.path;
    }
}

// The rates of one body at places side by side; the arrays have room for a Pack after the last.
inline void phase_rates(const PhaseRate<double>& rate, const PhaseMap<double>& map, double quarters,
                        double* offsets, int count, PhaseRates<double>& found) {
    for (int i = count; i % widest_pack != 0; ++i) offsets[i] = offsets[count - 1];
    kernel().rates(rate, map, quarters, offsets, count, found);
}

}  // namespace
}  // namespace rolling_ellipse
