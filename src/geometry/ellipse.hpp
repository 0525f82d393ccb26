// Geometry of an ellipse that touches a straight ground, by its support function.
//
// theta is the clockwise rotation of the body; at theta = 0 the axis a is parallel to the ground.
// All functions hold for a > b, a = b and a < b and for any angle.
#pragma once

#include <cmath>

#include "numerics/numbers.hpp"

namespace rolling_ellipse {

struct Axes {
    double a;
    double b;
};

// The local geometry at an angle.
struct Geometry {
    double sin;
    double cos;
    double h;    // height of the centre over its tangent line [m]
    double dh;   // h' = x_C - x_G [m]
    double ddh;  // h'' [m]
    double rho;  // h + h'', radius of curvature at the contact [m]
};

// D = k^2 + h^2 + h'^2, moment of inertia about the contact per mass [m^2].
inline double inertia_about_contact(double gyration2, const Geometry& at) {
    return gyration2 + at.h * at.h + at.dh * at.dh;
}

inline Geometry geometry(const Axes& axes, double s, double c) {
    const auto [a, b] = axes;
    const double c2 = (a - b) * (a + b);
    Geometry at{s, c, std::sqrt(a * a * s * s + b * b * c * c), 0.0, 0.0, 0.0};  // physics (1)
    at.dh = c2 * s * c / at.h;                                                   // physics (2)
    const double h3 = at.h * at.h * at.h;
    at.rho = a * a * b * b / h3;  // physics (4)
    // rho - h, factorised so that it keeps its digits for nearly circular bodies: physics (3).
    at.ddh = c2 * (b * c * c - a * s * s) * (b * c * c + a * s * s) / h3;
    return at;
}

inline Geometry geometry(const Axes& axes, double theta) {
    return geometry(axes, std::sin(theta), std::cos(theta));
}

// A position by its angle phi from the flat one: phi is theta for a >= b, otherwise theta - pi/2.
// Half turns, after which the ellipse is the same, fold it to cos phi >= 0.
struct FlatView {
    double long_axis;
    double short_axis;
    double c2;  // long_axis^2 - short_axis^2
    double sin;
    double cos;
};

FlatView flat_view(const Axes& axes, double theta);
FlatView flat_view(const Axes& axes, double sin, double cos);

// The heights L - h and h - S of the centre under its place over the tip and over its place over
// the flat [m]. They are products, since differences of heights would lose digits.
inline double under_tip(const FlatView& at, double h) {
    return at.c2 * square(at.cos) / (at.long_axis + h);
}
inline double over_flat(const FlatView& at, double h) {
    return at.c2 * square(at.sin) / (at.short_axis + h);
}

// Whether the contact is right below the centre, to within 8 ulp of the height and of the angle. On
// a slope the vertical meets the ground h tan(slope) = h incline downhill of the foot of h.
bool is_equilibrium(const Geometry& at, double incline = 0.0);

// The angle psi - theta = atan2(h', h) from the vertical to the contact, between -pi/2 and pi/2.
double contact_angle_offset(const Geometry& at);

// The angle psi of the report's eq 5, continuous over all theta.
double contact_angle(const Axes& axes, double theta);

// The derivatives d psi/d theta and d^2 psi/d theta^2.
double contact_angle_rate(const Axes& axes, const Geometry& at);
double contact_angle_second(const Axes& axes, const Geometry& at);

// Distance r of the contact from the centre [m], r^2 = h^2 + h'^2.
double contact_distance(const Axes& axes, const Geometry& at);

// Radius of the ellipse in the body direction psi (report eq 6, physics (7)), and its derivatives.
double polar_radius(const Axes& axes, double psi);
double polar_radius_derivative(const Axes& axes, double psi);
double polar_radius_second(const Axes& axes, double psi);

// The path of the centre in rolling from 0 to theta [m], the integral of h: physics (9).
double centre_path(const Axes& axes, double theta);

// Arc length along the ellipse from the contact at 0 to the contact at theta [m]: centre_path + h'.
double arc_length(const Axes& axes, double theta);

// The path of the centre over an offset with sine s >= 0 and cosine c >= 0, from the flat position
// (long axis parallel to the ground) or from the tip (short axis parallel to the ground).
double path_from_flat(double long_axis, double short_axis, double s, double c);
double path_from_tip(double long_axis, double short_axis, double s, double c);

}  // namespace rolling_ellipse
