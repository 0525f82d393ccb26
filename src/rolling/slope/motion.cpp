#include "rolling/slope/motion.hpp"

#include <algorithm>
#include <cmath>

#include "numerics/bisect.hpp"

namespace rolling_ellipse {
namespace {

// h times the moment of gravity about the contact, per unit mass. Next to an equilibrium the
// difference of its two terms would be a rounding; a slope with equilibria uses the product of
// physics (62).
double gravity_drive(const SlopeBody& body, const SlopePlace& at, double s, double c) {
    if (!body.equilibria) {
        const double h2 = body.short_axis2 + body.c2 * square(s);
        return body.gravity.along * h2 - body.gravity.into * body.c2 * s * c;
    }
    const double over_lying = double(at.angle + -body.equilibria->lying);
    const double over_upright = double(at.angle + -body.equilibria->upright);
    return is_odd(at.quarters) ? body.pull * std::sin(over_upright) * std::cos(over_lying)
                               : -body.pull * std::sin(over_lying) * std::cos(over_upright);
}

// With D h^2 = I = d0 + d1 sin^2 phi, u = h^2, p = h h' = c2 sin phi cos phi, lambda = omega/h and
// S = d1/c2 physics (18) becomes, without a quotient but by I,
//     I lambda' = g_along u - g_into p - S p omega lambda,   omega = h lambda,   h' = p lambda
//     u' = 2 p omega,   I' = S u',   p' = q omega,   q' = -4 p omega
// Near an equilibrium the first coefficient of g_along u - g_into p is a small difference, which
// the caller computes with all its digits (`drive`); the later coefficients do not cancel. Gravity
// and omega are in the unit of time of the series.
SlopeSeries slope_series(const SlopeBody& body, const GroundGravity& gravity, double sin,
                         double cos, double omega, double drive) {
    SlopeSeries motion;
    auto& [angle, w, path, h] = motion;
    // Each name stands for a pair of series. Two pairs on a line are multiplied: first by first,
    // second by second.
    TwoSeries h_p, l_l;           // (h, p) by (lambda, lambda): omega and the rate of h
    TwoSeries p_q, w_w;           // (p, q) by (omega, omega): the rates of u and p
    TwoSeries h_pw, w_l;          // (h, p omega) by (omega, lambda): the rates of path and I
    LongSeries inertia, turning;  // I by lambda'
    const double sin2 = square(sin);
    double u = body.short_axis2 + body.c2 * sin2;
    double height = std::sqrt(u);
    double p = body.c2 * sin * cos;
    double q = body.c2 * (cos - sin) * (cos + sin);
    double lambda = omega / height;
    const double per_u = body.gyration2 + body.long_axis2 + body.short_axis2;
    inertia[0] = body.d0 + body.d1 * sin2;
    const double over_inertia = 1 / inertia[0];
    angle[0] = path[0] = 0.0;

    for (int k = 0; k <= long_order; ++k) {
        h[k] = height;
        h_p[k] = pair(height, p);
        l_l[k] = pair(lambda, lambda);
        const Pair known_turns = inner(p_q, w_w, k);
        const Pair known_rates = inner(h_pw, w_l, k);
        double rest =
            k == 0 ? drive : gravity.along * u - gravity.into * p - inner(inertia, turning, k);
        if (k > 0) {
            inertia[k] = per_u * u;
            rest -= inertia[k] * turning[0];
        }
        const Pair w_rate = inner(h_p, l_l, k) + outer(h_p, l_l, k);
        w[k] = k == 0 ? omega : w_rate[0];
        if (k == long_order) break;

        p_q[k] = pair(p, q);
        w_w[k] = pair(w[k], w[k]);
        const Pair turns = known_turns + outer(p_q, w_w, k);
        h_pw[k] = pair(height, turns[0]);
        w_l[k] = pair(w[k], lambda);
        const Pair rates = known_rates + outer(h_pw, w_l, k);
        turning[k] = (rest - per_u * rates[1]) * over_inertia;
        const double over = over_next[k];
        angle[k + 1] = w[k] * over;
        path[k + 1] = rates[0] * over;
        lambda = turning[k] * over;
        height = w_rate[1] * over;
        u = 2 * (turns[0] * over);
        q = -2 * u;
        p = turns[1] * over;
    }
    return motion;
}

// The time since the begin of the piece at which it turns back; infinite if it does not.
double turning_in(const SlopePiece& piece) {
    const double before = piece.from.omega;
    const auto turned = [&](double since) {
        return value(piece.series.omega, since / piece.unit) * before <= 0;
    };
    if (before == 0 || std::isinf(piece.lasts) || !turned(piece.lasts)) return infinity;
    return bisect(0.0, piece.lasts, turned).high;
}

}  // namespace

std::optional<Equilibria> equilibria(double long_axis, double short_axis, double incline) {
    // The tangents of both angles solve one quadratic equation; the product of its roots is known.
    const double c2 = (long_axis - short_axis) * (long_axis + short_axis);
    const double both = 2 * long_axis * short_axis * incline;
    const double root = (c2 - both) * (c2 + both);
    if (root <= 0) return std::nullopt;
    const double sum = c2 + std::sqrt(root);
    return Equilibria{std::atan2(2 * square(short_axis) * incline, sum),
                      -std::atan2(2 * square(long_axis) * incline, sum)};
}

SlopeBody slope_body(const Body& from, double slope) {
    const Axes axes = from.axes();
    const double long_axis = std::max(axes.a, axes.b);
    SlopeBody body{};
    const Units units = natural_units(from);
    body.length = units.length;
    body.time = units.time;
    body.side = slope < 0 ? -1.0 : 1.0;
    body.long_axis = long_axis / body.length;
    body.short_axis = std::min(axes.a, axes.b) / body.length;
    body.c2 = (body.long_axis - body.short_axis) * (body.long_axis + body.short_axis);
    body.gyration2 = from.gyration2 / body.length / body.length;
    const double gravity = from.gravity / body.length * body.time * body.time;
    body.gravity = ground_gravity(gravity, std::abs(slope));
    body.equilibria =
        equilibria(body.long_axis, body.short_axis, body.gravity.along / body.gravity.into);
    body.pull = gravity * body.c2;
    body.short_axis2 = square(body.short_axis);
    body.long_axis2 = square(body.long_axis);
    body.d0 = body.short_axis2 * (body.gyration2 + body.short_axis2);
    body.d1 = body.c2 * (body.gyration2 + body.long_axis2 + body.short_axis2);
    body.slowest = std::sqrt(gravity * body.long_axis / (body.gyration2 + body.short_axis2));
    body.quarter_path = path_from_flat(body.long_axis, body.short_axis, 1.0, 0.0);
    body.gain = body.gravity.along * 2 * body.quarter_path;
    return body;
}

Geometry geometry(const SlopeBody& body, double quarters, double angle) {
    const double s = std::sin(angle);
    const double c = std::cos(angle);
    const Axes axes{body.long_axis, body.short_axis};
    return is_odd(quarters) ? geometry(axes, c, -s) : geometry(axes, s, c);
}

double path_at(const SlopeBody& body, double quarters, double angle) {
    const double s = std::sin(std::abs(angle));
    const double c = std::cos(angle);
    const double over = is_odd(quarters) ? path_from_tip(body.long_axis, body.short_axis, s, c)
                                         : path_from_flat(body.long_axis, body.short_axis, s, c);
    return std::fma(quarters, body.quarter_path, std::copysign(over, angle));
}

Tracked fall(const SlopeBody& body, const Geometry& from, const Geometry& to) {
    const auto difference = [](double x, double y) {
        return tracked(square(x)) - tracked(square(y));
    };
    const bool by_tips =
        std::abs(from.cos) + std::abs(to.cos) < std::abs(from.sin) + std::abs(to.sin);
    return tracked(body.c2 / (from.h + to.h)) *
           (by_tips ? difference(to.cos, from.cos) : difference(from.sin, to.sin));
}

SlopeEnergy energy_of(const SlopeBody& body, const SlopePlace& start) {
    const Geometry at = geometry(body, start);
    return {0.5 * inertia_about_contact(body.gyration2, at) * square(start.omega), at};
}

Tracked energy_at(const SlopeBody& body, const SlopeEnergy& energy, const SlopePlace& at,
                  const Geometry& here) {
    const double gained = body.gravity.along * double(at.path);
    return tracked(energy.start) + tracked(gained) +
           tracked(body.gravity.into) * fall(body, energy.at, here);
}

SlopePiece piece_from(const SlopeBody& body, const SlopePlace& from) {
    const double s = std::sin(double(from.angle));
    const double c = std::cos(double(from.angle));
    SlopePiece piece{};
    piece.from = from;
    piece.unit = 1 / std::max(std::abs(from.omega), body.slowest);
    const double unit2 = square(piece.unit);
    const GroundGravity gravity{body.gravity.into * unit2, body.gravity.along * unit2};
    const bool tip = is_odd(from.quarters);
    const double sin = tip ? c : s;
    const double cos = tip ? -s : c;
    const double drive = unit2 * gravity_drive(body, from, sin, cos);
    piece.series = slope_series(body, gravity, sin, cos, from.omega * piece.unit, drive);
    piece.lasts = piece.unit * std::min(reach(piece.series.omega), reach(piece.series.path));
    return piece;
}

SlopePlace place_in(const SlopePiece& piece, double since) {
    const double z = since / piece.unit;
    SlopePlace place = piece.from;
    place.time = place.time + since;
    place.angle = place.angle + value(piece.series.angle, z);
    place.path = place.path + value(piece.series.path, z);
    place.omega = value(piece.series.omega, z) / piece.unit;
    const QuarterView nearest = quarter_view(place.angle);
    place.quarters += nearest.quarters;
    place.angle = nearest.rest;
    return place;
}

DoubleDouble time_of_turning(const SlopePiece& piece) {
    const double since = turning_in(piece);
    return since < infinity ? piece.from.time + since : DoubleDouble{infinity, 0.0};
}

// The first time at which a piece passes the tip: it may come back, so the search ends at its turn.
double time_of_tip(const SlopePiece& piece) {
    const double until = std::min(piece.lasts, turning_in(piece));
    if (std::isinf(until)) return infinity;
    const double from = double(piece.from.angle);
    const auto angle_at = [&](double since) {
        return from + value(piece.series.angle, since / piece.unit);
    };
    const double to = angle_at(until);
    double first = infinity;
    for (const double tip : {-half_pi, 0.0, half_pi}) {
        const bool is_tip = (tip == 0) == is_odd(piece.from.quarters);
        if (!is_tip || std::abs(from - tip) <= equal_ulps * epsilon) continue;
        if ((from < tip) == (to < tip)) continue;
        const auto passed = [&](double since) { return (angle_at(since) < tip) != (from < tip); };
        first = std::min(first, double(piece.from.time + bisect(0.0, until, passed).high));
    }
    return first;
}

SlopePlace place_after(const SlopeBody& body, const SlopeEnergy& energy, const SlopePiece& piece) {
    constexpr double accurate = 0.1;  // for omega from W: least share of W in its terms' sizes
    SlopePlace place = place_in(piece, piece.lasts);
    const Geometry here = geometry(body, place);
    const Tracked w = energy_at(body, energy, place, here);
    if (w.value > accurate * w.magnitude) {
        const double inertia = inertia_about_contact(body.gyration2, here);
        place.omega = std::copysign(std::sqrt(2 * w.value / inertia), place.omega);
    }
    return place;
}

// Physics (18, 20); RollingEquation has the same forces in SI units.
ContactForce contact_force(const SlopeBody& body, const SlopePlace& place) {
    const Geometry at = geometry(body, place);
    const double omega2 = square(place.omega);
    const double drive = at.h * body.gravity.along - at.dh * (body.gravity.into + at.rho * omega2);
    const double turning = drive / inertia_about_contact(body.gyration2, at);
    return {body.gravity.into + at.dh * turning + at.ddh * omega2,
            at.h * turning + at.dh * omega2 - body.gravity.along};
}

}  // namespace rolling_ellipse
