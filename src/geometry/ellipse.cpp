#include "geometry/ellipse.hpp"

#include <algorithm>
#include <cmath>

namespace rolling_ellipse {
namespace {

// Carlson's symmetric integrals R_F(x, y, z) and R_D(x, y, z).
struct CarlsonPair {
    double rf;
    double rd;
};

// R_F and R_D by the duplication theorem, then by series in symmetric functions of the deviations.
// B. C. Carlson, Numer. Algorithms 10 (1995) 13; DLMF 19.36(i). Both series end at order 7: the
// error is about (largest deviation)^8 / 100, below 1e-18 for deviations < 1e-2.
CarlsonPair carlson(double x, double y, double z) {
    constexpr double series_radius = 1e-2;
    double rd_sum = 0.0;
    double power = 1.0;  // 4^-n
    for (;;) {
        const double mean = (x + y + 3 * z) / 5;
        const double spread =
            std::max({std::abs(mean - x), std::abs(mean - y), std::abs(mean - z)});
        if (!(spread >= series_radius * mean)) break;  // a NaN ends the loop, too
        const double rx = std::sqrt(x);
        const double ry = std::sqrt(y);
        const double rz = std::sqrt(z);
        const double lambda = rx * (ry + rz) + ry * rz;
        rd_sum += power / (rz * (z + lambda));
        power /= 4;
        x = (x + lambda) / 4;
        y = (y + lambda) / 4;
        z = (z + lambda) / 4;
    }

    CarlsonPair result;
    {
        const double mean = (x + y + z) / 3;
        const double dx = (mean - x) / mean;
        const double dy = (mean - y) / mean;
        const double dz = -(dx + dy);
        const double e2 = dx * dy - dz * dz;
        const double e3 = dx * dy * dz;
        result.rf = (1 - e2 / 10 + e3 / 14 + e2 * e2 / 24 - 3 * e2 * e3 / 44 -
                     5 * e2 * e2 * e2 / 208 + 3 * e3 * e3 / 104 + e2 * e2 * e3 / 16) /
                    std::sqrt(mean);
    }
    {
        const double mean = (x + y + 3 * z) / 5;
        const double dx = (mean - x) / mean;
        const double dy = (mean - y) / mean;
        const double dz = -(dx + dy) / 3;
        const double xy = dx * dy;
        const double zz = dz * dz;
        const double e2 = xy - 6 * zz;
        const double e3 = (3 * xy - 8 * zz) * dz;
        const double e4 = 3 * (xy - zz) * zz;
        const double e5 = xy * zz * dz;
        const double series = 1 - 3 * e2 / 14 + e3 / 6 + 9 * e2 * e2 / 88 - 3 * e4 / 22 -
                              9 * e2 * e3 / 52 + 3 * e5 / 26 - e2 * e2 * e2 / 16 +
                              3 * e3 * e3 / 40 + 3 * e2 * e4 / 20 + 45 * e2 * e2 * e3 / 272 -
                              9 * (e3 * e4 + e2 * e5) / 68;
        result.rd = 3 * rd_sum + power * series / (mean * std::sqrt(mean));
    }
    return result;
}

// Arc length of the ellipse from the tip to the contact, as a function of the sine and cosine of
// the angle through which the body has turned from the tip, physics (10). This is DLMF 19.25.10
// without its last term -h', the lead of the centre over the contact.
double arc_from_tip(const Axes& lying, double s, double c) {
    const auto [long_axis, short_axis] = lying;
    const double h = root_of_squares(long_axis * c, short_axis * s);
    const double l2 = long_axis * long_axis;
    const auto [rf, rd] = carlson(l2 * c * c, l2, h * h);
    return short_axis * short_axis * s * (rf + lying.c2() * s * s / 3 * rd);
}

// The path of the centre, and the arc of the contact along the ellipse (longer by h'), from
// theta = 0 to an angle with sine and cosine >= 0: physics (9). Short paths stay accurate.
struct QuarterPath {
    double centre;
    double contact;
};

QuarterPath quarter_path(const Axes& axes, double s, double c) {
    if (axes.a >= axes.b) {
        const double centre = path_from_flat(axes, s, c);
        return {centre, centre + geometry(axes, s, c).dh};
    }
    const double contact = arc_from_tip({axes.b, axes.a}, s, c);
    return {contact - geometry(axes, s, c).dh, contact};
}

// The paths for any angle: those of the whole half turns plus those of the remainder.
QuarterPath unwrapped_path(const Axes& axes, double theta) {
    if (axes.a == axes.b) return {axes.a * theta, axes.a * theta};
    const double s = std::sin(theta);
    const double c = std::cos(theta);
    const double offset = std::atan2(c < 0 ? -s : s, std::abs(c));
    const double half_turns = std::nearbyint((theta - offset) / pi);
    const QuarterPath over = quarter_path(axes, std::abs(s), std::abs(c));
    const double half_turn = half_turns == 0 ? 0.0 : 2 * quarter_path(axes, 1.0, 0.0).centre;
    return {std::fma(half_turns, half_turn, std::copysign(over.centre, offset)),
            std::fma(half_turns, half_turn, std::copysign(over.contact, offset))};
}

}  // namespace

// physics (10): DLMF 19.25.9 with a negative parameter, for which every term is positive.
double path_from_flat(const Axes& lying, double s, double c) {
    const double c2 = lying.c2();
    const double s2 = lying.b * lying.b;
    const double h2 = s2 + c2 * s * s;
    const auto [rf, rd] = carlson(s2 * c * c, h2, s2);
    return s2 * s * (rf + c2 * s * s / 3 * rd);
}

double path_from_tip(const Axes& lying, double s, double c) {
    return arc_from_tip(lying, s, c) +
           lying.c2() * s * c / root_of_squares(lying.a * c, lying.b * s);
}

FlatView flat_view(const Axes& axes, double theta) {
    return flat_view(axes, std::sin(theta), std::cos(theta));
}

FlatView flat_view(const Axes& axes, double sin, double cos) {
    const bool a_is_long = axes.a >= axes.b;
    const auto [long_axis, short_axis] = a_is_long ? axes : Axes{axes.b, axes.a};
    const double s = a_is_long ? sin : -cos;
    const double c = a_is_long ? cos : sin;
    return {long_axis, short_axis, std::abs(axes.c2()), c < 0 ? -s : s, std::abs(c)};
}

bool is_equilibrium(const Geometry& at, double incline) {
    const bool is_circle = at.dh == 0 && at.ddh == 0;
    if (is_circle) return incline == 0;
    // The criterion is the angle from equilibrium, h'/h'': for a nearly round body, h' itself is
    // small at every angle.
    const double size = std::min(at.h, std::abs(at.ddh) + std::abs(incline) * at.h);
    return std::abs(at.dh - incline * at.h) <= equal_ulps * epsilon * size;
}

// physics (5)
double contact_angle_offset(const Geometry& at) { return std::atan2(at.dh, at.h); }

double contact_angle(const Axes& axes, double theta) {
    return theta + contact_angle_offset(geometry(axes, theta));
}

// From tan(psi) = (a^2/b^2) tan(theta): psi' = a^2 b^2 / w, w = b^4 cos^2 + a^4 sin^2 = (r h)^2;
// physics (6), with psi'' below.
double contact_angle_rate(const Axes& axes, const Geometry& at) {
    const double rh = contact_distance(axes, at) * at.h;
    const double ratio = axes.a * axes.b / rh;
    return ratio * ratio;
}

double contact_angle_second(const Axes& axes, const Geometry& at) {
    const double a2 = axes.a * axes.a;
    const double b2 = axes.b * axes.b;
    const double rh = contact_distance(axes, at) * at.h;
    const double dw = 2 * axes.c2() * (a2 + b2) * at.sin * at.cos;
    return -contact_angle_rate(axes, at) * dw / (rh * rh);
}

// physics (5)
double contact_distance(const Axes& axes, const Geometry& at) {
    return root_of_squares(axes.a * axes.a * at.sin, axes.b * axes.b * at.cos) / at.h;
}

double centre_path(const Axes& axes, double theta) { return unwrapped_path(axes, theta).centre; }

double arc_length(const Axes& axes, double theta) { return unwrapped_path(axes, theta).contact; }

}  // namespace rolling_ellipse
