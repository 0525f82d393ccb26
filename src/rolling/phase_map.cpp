#include "rolling/phase_map.hpp"

#include <algorithm>
#include <cmath>

namespace rolling_ellipse {
namespace {

// A and B as polynomials of c; the terms left out are below rounding for q <= 1/32.
void set_theta_functions(PhaseMap& map, double q) {
    const double q2 = square(q);
    const double q4 = square(q2);
    const double q6 = q2 * q4;
    const double q9 = q * square(q4);
    const double theta_3 = 1 + 2 * (q + q4 + q9);
    map.speed = square(theta_3);
    map.sine_scale = theta_3 / (1 + q2 + q6);
    map.a = {1 - 2 * q4, 6 * q9 - 2 * q, 4 * q4, -8 * q9};
    map.b = {1 - q2 - q6, 2 * (q6 - q2), 4 * q6};
}

// sc of x = sinh(y).
double sine_ratio(const PhaseMap& map, double x) {
    const double c = 1 + 2 * square(x);
    const double a = map.a[0] + c * (map.a[1] + c * (map.a[2] + c * map.a[3]));
    const double b = map.b[0] + c * (map.b[1] + c * map.b[2]);
    return map.sine_scale * x * b / a;
}

}  // namespace

PhaseMap phase_map(double kappa, double largest_grade) {
    constexpr double longest_step = 0.25;
    constexpr double largest_complement = 0.70710678118654752;  // q = 1/32
    PhaseMap map{};
    map.kappa = kappa;
    const double complement = std::min(kappa * largest_grade, largest_complement);
    const double quarter = std::log(4 / complement);  // q a little below the nome of k'
    const double tail = 20 + std::log(2 / largest_grade);
    map.has_tail = quarter > tail;
    map.steps = static_cast<int>(std::ceil(std::min(quarter, tail) / longest_step));
    if (map.has_tail) {
        map.step = longest_step;
        map.quarter = quarter;
        map.grade = largest_grade;
        set_theta_functions(map, std::exp(-2 * quarter));
    } else {
        map.step = quarter / map.steps;
        map.quarter = map.steps * map.step;
        const double root_q = std::exp(-map.quarter);
        set_theta_functions(map, square(root_q));
        map.grade = 4 * root_q / (square(map.sine_scale) * kappa);
    }
    map.flat_scale2 = square(map.grade * map.sine_scale);
    map.tip_scale2 = square(kappa * map.sine_scale);
    return map;
}

Place place_of(const PhaseMap& map, const PhasePoint& phase) {
    constexpr double converged = 1e-8;
    const double sin = std::abs(phase.sin);
    const double cos = std::abs(phase.cos);
    const bool at_tip = map.kappa * square(sin) > map.grade * square(cos);
    const double ratio = at_tip ? cos / (sin * map.kappa) : sin / (cos * map.grade);
    // sc(y) = ratio for x = sinh y: Newton's method, from the root with B = 1, A = A_0 - 2 q c.
    const double complement = map.kappa * map.grade;
    const double q2 = -map.a[1];
    double x =
        2 * ratio * (1 - q2) /
        (map.sine_scale + std::sqrt(square(map.sine_scale) + 8 * q2 * square(ratio) * (1 - q2)));
    for (int i = 0; i < 10; ++i) {
        const double sc = sine_ratio(map, x);
        const double slope = map.speed * std::sqrt((1 + square(sc)) *
                                                   (1 + square(complement * sc)) / (1 + square(x)));
        const double change = (ratio - sc) / slope;
        x += change;
        if (std::abs(change) <= converged * x) break;
    }
    const double offset = std::asinh(x);
    const double side = std::copysign(1.0, phase.sin);
    if (at_tip) return {static_cast<int>(side), -side * offset};
    return {0, side * offset};
}

PhasePoint phase_point(const PhaseMap& map, const Place& at) {
    const bool at_tip = at.quarters % 2 != 0;
    const double x = std::sinh(std::clamp(at.offset, -largest_offset, largest_offset));
    const double tan = (at_tip ? map.kappa : map.grade) * sine_ratio(map, x);
    const double cos = 1 / std::sqrt(1 + square(tan));
    const double sin = tan * cos;
    switch (at.quarters & 3) {
        case 0:
            return {sin, cos};
        case 1:
            return {cos, -sin};
        case 2:
            return {-sin, -cos};
        default:
            return {-cos, sin};
    }
}

Place moved(const PhaseMap& map, const Place& from, double distance) {
    Place to{from.quarters, from.offset + distance};
    if (std::abs(to.offset) > 0.5 * map.quarter) {
        const double quarters = std::nearbyint(to.offset / map.quarter);
        to.quarters += static_cast<int>(quarters);
        to.offset = from.offset - quarters * map.quarter + distance;
    }
    return to;
}

}  // namespace rolling_ellipse
