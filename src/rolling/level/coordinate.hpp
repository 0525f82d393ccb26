// The coordinate y of rolling/level/phase.hpp. By the theta functions of the nome q
// (DLMF 20.2, 22.2), with c = cosh 2y,
//     sc = C sinh(y) B(c)/A(c),   sc(Y - y) = 1/(k' sc(y)).
#pragma once

#include "numerics/lanes.hpp"
#include "rolling/level/phase.hpp"

namespace rolling_ellipse {
namespace {

// At this offset the tip is reached within rounding, and the square of sinh is still a double.
constexpr double largest_offset = 300.0;

// Sets A and B as polynomials of c; the terms left out are below rounding for q <= 1/32.
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

// Sets the map for kappa and a g of at most the given one.
template <class T>
void set_phase_map(PhaseMap<T>& map, T kappa, T largest_grade) {
    constexpr double steps_per_unit = 4.0;
    constexpr double largest_complement = 0.70710678118654752;  // q = 1/32
    constexpr double tail = 20.0;                               // beyond log(2/largest_grade)
    constexpr double falling_in_tail = 2.0611536224385579e-9;   // e^-tail
    map.kappa = kappa;
    const T complement = min<T>(kappa * largest_grade, filled<T>(largest_complement));
    const T quarter = complement > 0 ? log<T>(4 / complement) : filled<T>(infinity);
    map.has_tail = complement < 2 * falling_in_tail * largest_grade;
    T length = quarter;  // whole steps of it give a nome a little below that of k'
    if (any(map.has_tail)) length = map.has_tail ? tail + log<T>(2 / largest_grade) : quarter;
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

// The place of a phase.
template <class T>
PhasePlace<T> place_of(const PhaseMap<T>& map, const PhasePoint<T>& phase) {
    constexpr double converged = 1e-8;
    constexpr int most_steps = 10;
    const T sin = abs(phase.sin);
    const T cos = abs(phase.cos);
    const auto at_tip = map.kappa * (sin * sin) > map.grade * (cos * cos);
    const T ratio = (at_tip ? cos : sin) / (at_tip ? sin * map.kappa : cos * map.grade);
    // sc(y) = ratio for x = sinh y: Newton's method, from the root with B = 1, A = A_0 - 2 q c.
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

// Sine and cosine of the phase, each to full relative accuracy; `at` must use the nearest quarter.
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

// The place at a distance from another one, with the nearest quarter.
template <class T>
PhasePlace<T> moved(const PhaseMap<T>& map, const PhasePlace<T>& from, T distance) {
    const T offset = from.offset + distance;
    const auto is_beyond = abs(offset) > 0.5 * map.quarter;
    const T quarters = is_beyond ? nearest<T>(offset / map.quarter) : T{};
    return {from.quarters + quarters,
            is_beyond ? from.offset - quarters * map.quarter + distance : offset};
}

}  // namespace
}  // namespace rolling_ellipse
