#include "rolling/slope/motion.hpp"

#include <algorithm>
#include <cmath>

#include "numerics/bisect.hpp"
#include "numerics/wide.hpp"
#include "scene/centre_of_rolling.hpp"

namespace rolling_ellipse {
namespace {

// h times the moment of gravity about the contact, per unit mass. Near an equilibrium the
// difference of its two terms would be mere rounding error, so the product of physics (62) is used
// there.
double gravity_drive(const SlopeBody& body, const SlopePlace& at, double s, double c) {
    constexpr double far = 0.1;  // their difference is accurate above this fraction of the terms
    const double along = body.gravity.along * (body.short_axis2 + body.c2 * square(s));
    const double into = body.gravity.into * body.c2 * s * c;
    const double drive = along - into;
    if (!body.equilibria || std::abs(drive) > far * std::abs(into)) return drive;
    const double over_lying = double(at.angle + -body.equilibria->lying);
    const double over_upright = double(at.angle + -body.equilibria->upright);
    return is_odd(at.quarters) ? body.pull * std::sin(over_upright) * std::cos(over_lying)
                               : -body.pull * std::sin(over_lying) * std::cos(over_upright);
}

// With D h^2 = I = d0 + d1 sin^2 phi, u = h^2, p = h dh/dphi = c2 sin phi cos phi,
// q = c2 cos 2 phi, lambda = omega/h, S = d1/c2 and primes for time derivatives, physics (18)
// becomes, with I as the only divisor,
//     I lambda' = g_along u - g_into p - S p omega lambda,   omega = h lambda,   h' = p lambda
//     u' = 2 p omega,   I' = S u',   p' = q omega,   q' = -4 p omega
// Near an equilibrium the first coefficient of g_along u - g_into p is a small difference, which
// the caller computes to full accuracy (`drive`); later coefficients do not cancel. Gravity and
// omega are in the series' unit of time.
ROLLING_ELLIPSE_WIDE SlopeSeries slope_series(const SlopeBody& body, const GroundGravity& gravity,
                                              double sin, double cos, double omega, double drive) {
    SlopeSeries motion;
    LongSeries& angle = motion.angle;
    LongSeries& w = motion.omega;
    LongSeries& path = motion.path;
    LongSeries& h = motion.height;
    // Factors of products computed side by side, coefficient by coefficient: (h, p, p, q) times
    // (lambda, lambda, omega, omega) and, late in a step, (h, p omega, I) times (omega, lambda,
    // lambda').
    Factors left, right, late_left, late_right;
    const double sin2 = square(sin);
    double u = body.short_axis2 + body.c2 * sin2;
    double height = std::sqrt(u);
    double p = body.c2 * sin * cos;
    double q = body.c2 * (cos - sin) * (cos + sin);
    double lambda = omega / height;
    const double per_u = body.gyration2 + body.long_axis2 + body.short_axis2;
    const double inertia0 = body.d0 + body.d1 * sin2;
    const double over_inertia = 1 / inertia0;
    const double h0 = height;
    const double p0 = p;
    const double q0 = q;
    const double lambda0 = lambda;
    double p_omega0 = 0;
    double turning0 = 0;
    angle[0] = path[0] = 0.0;

    const auto step = [&](auto number) __attribute__((always_inline)) {
        constexpr int k = decltype(number)::value;
        const Quad known = inner(left, right, k);
        const Quad late = inner(late_left, late_right, k);
        // The terms of a product that contain coefficients 0 and k of its factors.
        const auto ends = [](double first, double second_k, double first_k, double second) {
            return k == 0 ? first * second_k : first * second_k + first_k * second;
        };
        h[k] = height;
        w[k] = k == 0 ? omega : known[0] + ends(h0, lambda, height, lambda0);
        const double height_rate = known[1] + ends(p0, lambda, p, lambda0);
        if (k == long_order) return;

        const double p_omega = known[2] + ends(p0, w[k], p, omega);
        const double q_omega = known[3] + ends(q0, w[k], q, omega);
        const double path_rate = late[0] + ends(h0, w[k], height, omega);
        const double inertia = k == 0 ? inertia0 : per_u * u;
        if (k == 0) p_omega0 = p_omega;
        const double loss = late[1] + ends(p_omega0, lambda, p_omega, lambda0);
        const double pull =
            k == 0 ? drive
                   : (gravity.along * u - gravity.into * p) - (late[2] + inertia * turning0);
        const double turning = (pull - per_u * loss) * over_inertia;
        if (k == 0) turning0 = turning;
        left[k] = Quad{height, p, p, q};
        right[k] = Quad{lambda, lambda, w[k], w[k]};
        late_left[k] = Quad{height, p_omega, inertia, 0};
        late_right[k] = Quad{w[k], lambda, turning, 0};

        const double over = over_next[k];
        angle[k + 1] = w[k] * over;
        path[k + 1] = path_rate * over;
        lambda = turning * over;
        height = height_rate * over;
        u = 2 * (p_omega * over);
        q = -2 * u;
        p = q_omega * over;
    };
    for_each_order(step);
    return motion;
}

// The time since the start of the piece at which the body turns back; infinite if it does not.
double turning_in(const SlopePiece& piece) {
    const double side = std::copysign(1.0, piece.from.omega);
    const auto onwards = [&](double since) {
        return side * value(piece.series.omega, since / piece.unit);
    };
    const bool is_moving = piece.from.omega != 0 && !std::isinf(piece.lasts);
    if (!is_moving || onwards(piece.lasts) > 0) return infinity;
    return bisect_root(0.0, piece.lasts, onwards).high;
}

}  // namespace

std::optional<Equilibria> equilibria(const Axes& lying, double incline) {
    // The tangents of both angles solve one quadratic equation; the product of its roots is known.
    const auto [long_axis, short_axis] = lying;
    const double c2 = lying.c2();
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
    body.equilibria = equilibria(body.lying(), body.gravity.along / body.gravity.into);
    body.pull = gravity * body.c2;
    body.short_axis2 = square(body.short_axis);
    body.long_axis2 = square(body.long_axis);
    body.d0 = body.short_axis2 * (body.gyration2 + body.short_axis2);
    body.d1 = body.c2 * (body.gyration2 + body.long_axis2 + body.short_axis2);
    body.slowest = std::sqrt(gravity * body.long_axis / (body.gyration2 + body.short_axis2));
    return body;
}

void measure_quarter(SlopeBody& body) {
    body.quarter_path = path_from_flat(body.lying(), 1.0, 0.0);
    body.gain = body.gravity.along * 2 * body.quarter_path;
}

Geometry geometry(const SlopeBody& body, double quarters, double angle) {
    const double s = std::sin(angle);
    const double c = std::cos(angle);
    return is_odd(quarters) ? geometry(body.lying(), c, -s) : geometry(body.lying(), s, c);
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

Datum datum_of(const SlopeBody& body, const SlopePlace& start) {
    const Geometry at = geometry(body, start);
    return {0.5 * inertia_about_contact(body.gyration2, at) * square(start.omega), at};
}

Tracked energy_at(const SlopeBody& body, const Datum& start, const SlopePlace& at,
                  const Geometry& here) {
    const double gained = body.gravity.along * double(at.path);
    return tracked(start.energy) + tracked(gained) +
           tracked(body.gravity.into) * fall(body, start.at, here);
}

SlopePiece piece_from(const SlopeBody& body, const SlopePlace& from, const Geometry& at) {
    const double unit = 1 / std::max(std::abs(from.omega), body.slowest);
    const double unit2 = square(unit);
    const GroundGravity gravity{body.gravity.into * unit2, body.gravity.along * unit2};
    const double drive = unit2 * gravity_drive(body, from, at.sin, at.cos);
    SlopePiece piece{from, unit, 0.0,
                     slope_series(body, gravity, at.sin, at.cos, from.omega * unit, drive)};
    piece.lasts = unit * reach({&piece.series.omega, &piece.series.path});
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

// The search ends where the body turns back, since it may pass the tip again on its way back. Until
// then the angle is monotone: the tip sought is the first one ahead. A piece of a nearly round body
// may span more than half a turn.
double time_of_tip(const SlopePiece& piece) {
    const double until = std::min(piece.lasts, turning_in(piece));
    if (std::isinf(until)) return infinity;
    const double from = double(piece.from.angle);
    const auto turned_by = [&](double since) {
        return value(piece.series.angle, since / piece.unit);
    };
    const double heading = std::copysign(1.0, turned_by(until));
    double tip = is_odd(piece.from.quarters) ? 0.0 : heading * half_pi;
    if (heading * (tip - from) <= equal_ulps * epsilon) tip += heading * pi;
    const auto passed = [&](double since) {
        const double angle = from + turned_by(since);
        return heading > 0 ? angle >= tip : angle < tip;
    };
    if (!passed(until)) return infinity;
    return double(piece.from.time + bisect(0.0, until, passed).high);
}

SlopePlace place_after(const SlopeBody& body, const Datum& start, const SlopePiece& piece) {
    constexpr double accurate = 0.1;  // W is accurate above this fraction of its terms
    SlopePlace place = place_in(piece, piece.lasts);
    const Geometry here = geometry(body, place);
    const Tracked w = energy_at(body, start, place, here);
    if (w.value > accurate * w.magnitude) {
        place.omega = std::copysign(omega_at(body, w.value, here), place.omega);
    }
    return place;
}

// Physics (18).
double acceleration_at(const SlopeBody& body, const Geometry& at, double omega) {
    const double drive =
        at.h * body.gravity.along - at.dh * (body.gravity.into + at.rho * square(omega));
    return drive / inertia_about_contact(body.gyration2, at);
}

ContactForce contact_force(const SlopeBody& body, const SlopePlace& place) {
    const Geometry at = geometry(body, place);
    const double w = bend_of_height(body.lying(), at);
    const auto& [into, along] = body.gravity;
    const auto [normal, friction] =
        centre_of_rolling(body.gyration2, into, along, at.h, at.dh, at.ddh, w, square(place.omega))
            .force_per_mass;
    return {normal, friction};
}

}  // namespace rolling_ellipse
