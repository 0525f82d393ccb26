// How fast time, angle and path grow along the coordinate y of rolling/level/phase.hpp:
//     dphase/dy = speed sqrt((g^2 cos^2 + sin^2) (cos^2 + kappa^2 sin^2)),
// whose last root cancels that of the integrand. The path of the centre grows by h dphi.
#pragma once

#include "rolling/level/coordinate.hpp"
#include "rolling/level/kernel.hpp"

namespace rolling_ellipse {
namespace {

// scale^2 D (H + h), the square of the factor that depends on the shape: physics (28, 29).
template <class T>
inline T shape_factor2(const PhaseRate<T>& rate, T sin2_phi) {
    const T h2 = rate.short_axis * rate.short_axis + rate.c2 * sin2_phi;
    return rate.scale2 * (rate.d0 + rate.d1 * sin2_phi) * (rate.energy_height + sqrt(h2)) / h2;
}

// What the rates at several places have in common. "Here" is the flat or the tip from which the
// places are counted, "there" the other one.
template <class T>
struct RateConstants {
    T quarter, half_turn, speed;
    T tip_here;  // 1 or 0
    T scale2_here, scale2_there;
    T a[4], b[3];
    T grade2;
    T cos2_factor, sin2_factor;
    T s2, c2, d0, d1, energy_height, time_factor;
    T side;  // +-1: the way to the tip, from the flat or beyond
    Truth<T> rotates;
};

template <class T>
inline RateConstants<T> rate_constants(const PhaseRate<T>& rate, const PhaseMap<T>& map,
                                       T quarters) {
    const auto from_tip = quarters != 0;
    const T one = filled<T>(1.0);
    RateConstants<T> of;
    of.quarter = map.quarter;
    of.half_turn = 2 * map.quarter;
    of.speed = map.speed;
    of.tip_here = from_tip ? one : T{};
    of.scale2_here = from_tip ? map.tip_scale2 : map.flat_scale2;
    of.scale2_there = from_tip ? map.flat_scale2 : map.tip_scale2;
    for (int i = 0; i < 4; ++i) of.a[i] = map.a[i];
    for (int i = 0; i < 3; ++i) of.b[i] = map.b[i];
    of.grade2 = map.grade * map.grade;
    of.cos2_factor = rate.rotates ? one : rate.amplitude2;
    of.sin2_factor = rate.rotates ? rate.kappa * rate.kappa : T{};
    of.s2 = rate.short_axis * rate.short_axis;
    of.c2 = rate.c2 * rate.amplitude2;
    of.d0 = rate.d0;
    of.d1 = rate.d1 * rate.amplitude2;
    of.energy_height = rate.energy_height;
    of.time_factor = map.speed * map.speed * rate.scale2;
    of.side = quarters > 0 ? -one : one;
    of.rotates = rate.rotates;
    return of;
}

// The rates at y = quarters Y + offset, |quarters| <= 1. With the phase as sin^2/q and cos^2/q,
// h^2 = N/q, and so the other factors: one quotient serves all.
template <class T>
inline PhaseWay<T> phase_rate_at(const RateConstants<T>& of, T offset) {
    constexpr double farthest = 150.0;  // e^(4 of it) is a double
    const T from_here = abs(offset);
    const T a_turn_on = abs(from_here - of.half_turn);
    const T same = from_here < a_turn_on ? from_here : a_turn_on;
    const T other = abs(from_here - of.quarter);
    const auto is_same = same < other;
    const T distance = min<T>(is_same ? same : other, filled<T>(farthest));
    const T scale2 = is_same ? of.scale2_here : of.scale2_there;
    const auto at_tip = (is_same ? of.tip_here : 1 - of.tip_here) > 0;

    const T sinh = hyperbolic(distance).sinh;
    const T sinh2 = sinh * sinh;
    const T c = 1 + 2 * sinh2;
    const T a = of.a[0] + c * (of.a[1] + c * (of.a[2] + c * of.a[3]));
    const T b = of.b[0] + c * (of.b[1] + c * of.b[2]);
    const T opposite = scale2 * sinh2 * (b * b);
    const T adjacent = a * a;
    const T q = opposite + adjacent;
    const T sin2 = at_tip ? adjacent : opposite;
    const T cos2 = at_tip ? opposite : adjacent;

    const T n = of.s2 * q + of.c2 * sin2;
    const T inertia = of.d0 * q + of.d1 * sin2;
    const T graded = of.grade2 * cos2 + sin2;
    const T along = of.cos2_factor * cos2 + of.sin2_factor * sin2;
    const T inverse = 1 / (q * n);
    const T per_q = n * inverse;
    const T h = sqrt(q * n) * per_q;
    const T time = sqrt((of.time_factor * inertia) * graded * ((of.energy_height + h) * inverse));
    const T size = of.speed * sqrt(graded * along) * per_q;
    // A libration that has passed its turning point goes back.
    const T to_tip = of.side * offset;
    const auto goes_on =
        of.tip_here > 0 ? (to_tip > 0) & (to_tip < of.half_turn) : abs(to_tip) < of.quarter;
    const T angle = (goes_on | of.rotates) ? size : -size;
    return {time, angle, h * angle};
}

// The constants of one body in all lanes.
inline PhaseRate<Pack> spread(const PhaseRate<double>& of) {
    return {pack(of.short_axis), pack(of.c2),     pack(of.energy_height),
            pack(of.amplitude2), pack(of.scale2), pack(of.kappa),
            pack(of.d0),         pack(of.d1),     pack(of.rotates) > 0};
}
inline PhaseMap<Pack> spread(const PhaseMap<double>& of) {
    return {pack(of.quarter),
            pack(of.step),
            pack(of.steps),
            pack(of.has_tail) > 0,
            pack(of.grade),
            pack(of.kappa),
            pack(of.speed),
            pack(of.sine_scale),
            pack(of.flat_scale2),
            pack(of.tip_scale2),
            {pack(of.a[0]), pack(of.a[1]), pack(of.a[2]), pack(of.a[3])},
            {pack(of.b[0]), pack(of.b[1]), pack(of.b[2])}};
}

// The rates of bodies side by side, at a few places of each.
inline void phase_rates(const PhaseRate<Pack>& rate, const PhaseMap<Pack>& map, Pack quarters,
                        const Pack* offsets, int count, PhaseWays<Pack>& found) {
    const RateConstants<Pack> of = rate_constants(rate, map, quarters);
    for (int i = 0; i < count; ++i) {
        const PhaseWay<Pack> at = phase_rate_at(of, offsets[i]);
        found.time[i] = at.time;
        found.angle[i] = at.angle;
        found.path[i] = at.path;
    }
}

// Those of one body, at places side by side; after the last of them there is room for a Pack.
inline void phase_rates(const PhaseRate<double>& rate, const PhaseMap<double>& map, double quarters,
                        double* offsets, int count, PhaseWays<double>& found) {
    for (int i = count; i % widest_pack != 0; ++i) offsets[i] = offsets[count - 1];
    kernel().rates(rate, map, quarters, offsets, count, found);
}

}  // namespace
}  // namespace rolling_ellipse
