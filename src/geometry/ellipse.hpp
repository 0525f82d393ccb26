// Geometry of an ellipse on straight ground, from its support function.
//
// theta is the clockwise rotation of the body; at theta = 0 the axis a is parallel to the ground.
// Unless stated otherwise, functions hold for a > b, a = b and a < b and for any angle.
#pragma once

#include <cmath>

#include "numerics/numbers.hpp"

namespace rolling_ellipse {

struct Axes {
    double a;
    double b;

    double c2() const { return (a - b) * (a + b); }  // a^2 - b^2 to full accuracy
};

// The geometry at an angle theta.
struct Geometry {
    double sin;
    double cos;
    double h;    // height of the centre above the tangent line [m]
    double dh;   // h' = x_C - x_G, contact minus centre [m]
    double ddh;  // h'' [m]
    double rho;  // h + h'', radius of curvature at the contact [m]
};

// D = k^2 + h^2 + h'^2, moment of inertia about the contact per mass [m^2].
inline double inertia_about_contact(double gyration2, const Geometry& at) {
    return gyration2 + at.h * at.h + at.dh * at.dh;
}

inline Geometry geometry(const Axes& axes, double s, double c) {
    const auto [a, b] = axes;
    Geometry at{s, c, std::sqrt(a * a * s * s + b * b * c * c), 0.0, 0.0, 0.0};  // physics (1)
    at.dh = axes.c2() * s * c / at.h;                                            // physics (2)
    const double h3 = at.h * at.h * at.h;
    at.rho = a * a * b * b / h3;  // physics (4)
    // rho - h, factorised to stay accurate for nearly circular bodies: physics (3).
    at.ddh = axes.c2() * (b * c * c - a * s * s) * (b * c * c + a * s * s) / h3;
    return at;
}

inline Geometry geometry(const Axes& axes, double theta) {
    return geometry(axes, std::sin(theta), std::cos(theta));
}

// h h'' - h'^2 as a product, ordered so that mirror images give the same bits.
inline double bend_of_height(const Axes& axes, const Geometry& at) {
    const double across = axes.b * at.cos;
    const double along = axes.a * at.sin;
    return axes.c2() * ((across - along) * (across + along)) / square(at.h);
}

// A position given by its angle phi from the flat position: phi is theta for a >= b, otherwise
// theta - pi/2. Half turns, which map the ellipse to itself, are subtracted so that cos phi >= 0.
struct FlatView {
    double long_axis;
    double short_axis;
    double c2;  // long_axis^2 - short_axis^2
    double sin;
    double cos;

    Axes lying() const { return {long_axis, short_axis}; }
};

FlatView flat_view(const Axes& axes, double theta);
FlatView flat_view(const Axes& axes, double sin, double cos);

// under_tip is L - h, the depth of the centre below its highest position [m]; over_flat is h - S,
// its height above its lowest position [m]. Both are products, since the differences would lose
// accuracy.
inline double under_tip(const FlatView& at, double h) {
    return at.c2 * square(at.cos) / (at.long_axis + h);
}
inline double over_flat(const FlatView& at, double h) {
    return at.c2 * square(at.sin) / (at.short_axis + h);
}

// Whether the contact lies vertically below the centre, to within 8 epsilon times the height and 8
// epsilon radians of rotation. On a slope, the vertical through the centre meets the ground a
// distance h tan(slope) = h incline downhill of the foot of the perpendicular.
bool is_equilibrium(const Geometry& at, double incline = 0.0);

// The angle psi - theta = atan2(h', h) from the ground's normal to the contact, in (-pi/2, pi/2).
double contact_angle_offset(const Geometry& at);

// The angle psi of the report's eq 5, continuous over all theta.
double contact_angle(const Axes& axes, double theta);

// contact_angle_rate is d psi/d theta, contact_angle_second is d^2 psi/d theta^2.
double contact_angle_rate(const Axes& axes, const Geometry& at);
double contact_angle_second(const Axes& axes, const Geometry& at);

// Distance r of the contact from the centre [m], r^2 = h^2 + h'^2.
double contact_distance(const Axes& axes, const Geometry& at);

// The radius R of the ellipse in the body direction psi (report eq 6, physics (7)) and its first
// two derivatives: R = a b w^(-1/2), w = b^2 sin^2 + a^2 cos^2, so
// R' = R^3 (a^2 - b^2) sin cos/(a b)^2, physics (8).
struct PolarRadius {
    double value;
    double derivative;
    double second;
};

inline PolarRadius polar_radius(const Axes& axes, double psi) {
    const auto [a, b] = axes;
    const double s = std::sin(psi);
    const double c = std::cos(psi);
    const double radius = a * b / std::sqrt(square(b * s) + square(a * c));
    const double scale = radius / (a * b);
    const double gain = radius * scale * scale * (a - b) * (a + b);
    const double derivative = gain * s * c;
    return {radius, derivative, 3 * derivative * derivative / radius + gain * std::cos(2 * psi)};
}

// The path of the centre when rolling from 0 to theta [m], the integral of h: physics (9).
double centre_path(const Axes& axes, double theta);

// Arc length along the ellipse from the contact at 0 to the contact at theta [m]: centre_path + h'.
double arc_length(const Axes& axes, double theta);

// The path of the centre while the body turns from the flat position (path_from_flat, long axis
// along the ground) or from the tip (path_from_tip) by an angle with sine s >= 0 and cosine c >= 0;
// a >= b.
double path_from_flat(const Axes& lying, double s, double c);
double path_from_tip(const Axes& lying, double s, double c);

// Half a turn, after which the ellipse looks the same: pi as a double-double.
inline constexpr DoubleDouble half_turn = {2 * half_pi_exact.high, 2 * half_pi_exact.low};

// An angle reduced by full turns if it exceeds half a turn; unchanged otherwise.
inline double within_a_turn(double angle) {
    return std::abs(angle) > pi ? std::atan2(std::sin(angle), std::cos(angle)) : angle;
}

inline bool is_odd(double quarters) { return std::fmod(quarters, 2.0) != 0.0; }

// An angle as a number of quarter turns and the angle from the nearest flat position or tip. This
// form preserves the precision of a DoubleDouble.
struct QuarterView {
    double quarters;
    DoubleDouble rest;
};

inline QuarterView quarter_view(const DoubleDouble& angle) {
    const double quarters = std::nearbyint(angle.high / half_pi);
    if (quarters == 0) return {quarters, angle};  // the usual case
    return {quarters, angle - half_pi_exact * quarters};
}

// The quarter view of an angle of at most a quarter turn, given its sine and cosine.
inline QuarterView quarter_view(double sin, double cos) {
    const double s = std::abs(sin);
    if (s <= cos) return {0.0, {std::atan2(sin, cos), 0.0}};
    return {std::copysign(1.0, sin), {-std::copysign(std::atan2(cos, s), sin), 0.0}};
}

// An equivalent angle, small enough that sums with it resolve a fraction of a turn. Angles up to
// 1e15, where a double resolves 0.1 rad, are unchanged; larger ones are reduced by full turns.
inline double resolved(double angle) {
    constexpr double largest = 1e15;
    return std::abs(angle) > largest ? within_a_turn(angle) : angle;
}

// If the angle exceeds half a turn, subtracts whole half turns from angle + carry and returns their
// number; otherwise returns 0.
inline double take_half_turns_off(double& angle, double& carry) {
    if (!(std::abs(angle) > pi)) return 0.0;
    const double over = std::nearbyint(angle / pi);
    const DoubleDouble rest = DoubleDouble{angle, carry} - half_turn * over;
    angle = rest.high;
    carry = rest.low;
    return over;
}

}  // namespace rolling_ellipse
