// The coordinate y of rolling/level/flow.hpp, and the rates of time, angle and path with respect to
// y. In terms of theta functions of the nome q (DLMF 20.2, 22.2), with c = cosh 2y,
//     sc = C sinh(y) B(c)/A(c),   sc(Y - y) = 1/(k' sc(y)),
//     dphase/dy = speed sqrt((g^2 cos^2 + sin^2) (cos^2 + kappa^2 sin^2)),
// where the factor cos^2 + kappa^2 sin^2 cancels the root in the integrand. The path of the centre
// increases by h dphi.
#pragma once

#include "numerics/lanes.hpp"
#include "rolling/level/kernel.hpp"

namespace rolling_ellipse {
namespace {

// At this offset, the body is on the tip to within rounding, and sinh^2 does not overflow yet.
constexpr double largest_offset = 300.0;

// A quarter has a tail only if kappa is below this bound; the sharp bound is 4.1e-9.
constexpr double largest_tail_kappa = 5e-9;

// Sets A and B as polynomials in c; for q <= 1/32, the omitted terms are below rounding.
template <class T>
void set_theta_functions(PhaseMap<T>& map, T q) {
    const T q2 = q * q;
    const T q4 = q2 * q2;
    const T q6 = q2 * q4;
    const T q9 = q * (q4 * q4);
    const T theta_3 = 1 + 2 * (q + q4 + q9);
    map.speed = theta_3 * theta_3;
    map.sine_scale = theta_3 / (1 + q2 + q6);
    map.a[0] = 1 - 2 * q4;
    map.a[1] = 6 * q9 - 2 * q;
    map.a[2] = 4 * q4;
    map.a[3] = -8 * q9;
    map.b[0] = 1 - q2 - q6;
    map.b[1] = 2 * (q6 - q2);
    map.b[2] = 4 * q6;
}

// The ratio sc for x = sinh(y).
template <class C, class T>
inline T sine_ratio(const PhaseMap<C>& map, T x) {
    const T c = 1 + 2 * (x * x);
    const T a = map.a[0] + c * (map.a[1] + c * (map.a[2] + c * map.a[3]));
    const T b = map.b[0] + c * (map.b[1] + c * map.b[2]);
    return map.sine_scale * x * b / a;
}

// Sets the map for kappa, with g at most `largest_grade`.
template <class T>
void set_phase_map(PhaseMap<T>& map, T kappa, T largest_grade) {
    constexpr double steps_per_unit = 4.0;
    constexpr double largest_complement = 0.70710678118654752;  // largest kappa g, with q = 1/32
    constexpr double before_tail = 20.0;                        // y of the last step minus log(2/g)
    constexpr double falling_at_tail = 2.0611536224385579e-9;   // e^-before_tail
    map.kappa = kappa;
    const T complement = min<T>(kappa * largest_grade, filled<T>(largest_complement));
    const T quarter = complement > 0 ? log<T>(4 / complement) : filled<T>(infinity);
    map.has_tail = complement < 2 * falling_at_tail * largest_grade;
    // Rounding this length up to whole steps makes the nome, and hence g, slightly smaller.
    const T length = any(map.has_tail) ? before_tail + log<T>(2 / largest_grade) : quarter;
    map.steps = rounded_up<T>(length * steps_per_unit);
    map.step = map.has_tail ? filled<T>(1 / steps_per_unit) : quarter / map.steps;
    map.quarter = map.has_tail ? quarter : map.steps * map.step;
    const T root_q = map.quarter < largest_offset ? hyperbolic(map.quarter).falling : T{};
    set_theta_functions<T>(map, root_q * root_q);
    const T sine_scale2 = map.sine_scale * map.sine_scale;
    map.grade = map.has_tail ? largest_grade : 4 * root_q / (sine_scale2 * kappa);
    map.flat_scale2 = map.grade * map.grade * sine_scale2;
    map.tip_scale2 = kappa * kappa * sine_scale2;
}

// The coordinate y of a phase: physics (61), solved by Newton's method.
template <class T>
PhasePlace<T> place_of(const PhaseMap<T>& map, const PhasePoint<T>& phase) {
    constexpr double converged = 1e-8;
    constexpr int most_steps = 10;
    const T sin = abs(phase.sin);
    const T cos = abs(phase.cos);
    const auto at_tip = map.kappa * (sin * sin) > map.grade * (cos * cos);
    const T ratio = (at_tip ? cos : sin) / (at_tip ? sin * map.kappa : cos * map.grade);
    // Newton's method for x = sinh y with sc(y) = ratio. The initial guess is the root of the
    // equation with the theta series truncated to B = 1 and A = 1 + a[1] c, where c = 1 + 2 x^2.
    const T complement = map.kappa * map.grade;
    const T q2 = -map.a[1];
    T x = 2 * ratio * (1 - q2) /
          (map.sine_scale +
           sqrt(map.sine_scale * map.sine_scale + 8 * q2 * (ratio * ratio) * (1 - q2)));
    auto open = x > 0;
    for (int i = 0; i < most_steps && any(open); ++i) {
        const T sc = sine_ratio(map, x);
        const T other = complement * sc;
        const T root = sqrt((1 + sc * sc) * (1 + other * other) / (1 + x * x));
        const T change = (ratio - sc) / (map.speed * root);
        x = open ? x + change : x;
        open = open & (abs(change) > converged * x);
    }
    const T offset = asinh(x);
    const T side = copysign(filled<T>(1.0), phase.sin);
    return {at_tip ? side : T{}, side * (at_tip ? -offset : offset)};
}

// Sine and cosine of the phase, each to full relative accuracy; `at` must be measured from the
// nearest quarter.
template <class C, class T>
PhasePoint<T> phase_point(const PhaseMap<C>& map, const PhasePlace<T>& at) {
    const auto at_tip = is_odd(at.quarters);
    const T sinh = hyperbolic(min<T>(abs(at.offset), filled<T>(largest_offset))).sinh;
    const T scale = at_tip ? filled<T>(map.kappa) : filled<T>(map.grade);
    const T tan = scale * sine_ratio(map, copysign(sinh, at.offset));
    const T cos = 1 / sqrt(1 + tan * tan);
    const T sin = tan * cos;
    const T half_turns = rounded_down<T>(0.5 * at.quarters);
    const T sign = is_odd(half_turns) ? filled<T>(-1.0) : filled<T>(1.0);
    return {sign * (at_tip ? cos : sin), sign * (at_tip ? -sin : cos)};
}

// The point at a given distance in y from another point, expressed as an offset from the nearest
// quarter.
template <class T>
PhasePlace<T> moved(const PhaseMap<T>& map, const PhasePlace<T>& from, T distance) {
    const T offset = from.offset + distance;
    const auto is_beyond = abs(offset) > 0.5 * map.quarter;
    const T quarters = is_beyond ? nearest<T>(offset / map.quarter) : T{};
    return {from.quarters + quarters,
            is_beyond ? from.offset - quarters * map.quarter + distance : offset};
}

// The rates at y = quarters Y + offset, |quarters| <= 1. The constants, of type C, are those of one
// motion for all points, or those of a separate motion for each point. Since sin^2 phase = sin2/q,
// cos^2 phase = cos2/q and h^2 = n/q, a single division suffices. The compiler moves terms that do
// not depend on the offset out of loops over points.
template <class C, class T>
inline PhaseIncrement<T> phase_rate_at(const PhaseIntegrand<C>& integrand, const PhaseMap<C>& map,
                                       C quarters, T offset) {
    constexpr double farthest = 150.0;  // e^(4 farthest) does not overflow
    const C one = filled<C>(1.0);
    const C half_turn = 2 * map.quarter;
    const T tip_here = filled<T>(quarters != 0 ? one : C{});
    const T scale2_here = filled<T>(quarters != 0 ? map.tip_scale2 : map.flat_scale2);
    const T scale2_there = filled<T>(quarters != 0 ? map.flat_scale2 : map.tip_scale2);
    // The distance to the nearest flat position or tip: the origin of the offset, or a point one or
    // two quarters further on.
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

    const T n = (integrand.short_axis * integrand.short_axis) * q +
                (integrand.c2 * integrand.amplitude2) * sin2;
    const T inertia = integrand.d0 * q + (integrand.d1 * integrand.amplitude2) * sin2;
    const T graded = (map.grade * map.grade) * cos2 + sin2;
    const T along = (integrand.rotates ? one : integrand.amplitude2) * cos2 +
                    (integrand.rotates ? integrand.kappa * integrand.kappa : C{}) * sin2;
    const T inverse = 1 / (q * n);
    const T per_q = n * inverse;
    const T h = sqrt(q * n) * per_q;
    const C time_factor = map.speed * map.speed * integrand.scale2;
    const T time =
        sqrt((time_factor * inertia) * graded * ((integrand.energy_height + h) * inverse));
    const T size = map.speed * sqrt(graded * along) * per_q;
    const T to_tip = quarters > 0 ? -offset : offset;
    const auto goes_on =
        quarters != 0 ? (to_tip > 0) & (to_tip < half_turn) : abs(to_tip) < map.quarter;
    // The rate of the angle of a libration is negative beyond its turning point.
    const T swung = goes_on ? size : -size;
    const T angle = integrand.rotates ? size : swung;
    return {time, angle, h * angle};
}

// The rates of several bodies, one in each lane, at `count` points each.
inline void phase_rates(const PhaseIntegrand<Pack>& integrand, const PhaseMap<Pack>& map,
                        Pack quarters, const Pack* offsets, int count, PhaseRates<Pack>& found) {
    for (int i = 0; i < count; ++i) {
        const PhaseIncrement<Pack> at = phase_rate_at(integrand, map, quarters, offsets[i]);
        found.time[i] = at.time;
        found.angle[i] = at.angle;
        found.path[i] = at.path;
    }
}

// The rates of one body at several points, side by side; the arrays have room for a Pack after the
// last point.
inline void phase_rates(const PhaseIntegrand<double>& integrand, const PhaseMap<double>& map,
                        double quarters, double* offsets, int count, PhaseRates<double>& found) {
    for (int i = count; i % widest_pack != 0; ++i) offsets[i] = offsets[count - 1];
    kernel().rates(integrand, map, quarters, offsets, count, found);
}

}  // namespace
}  // namespace rolling_ellipse
