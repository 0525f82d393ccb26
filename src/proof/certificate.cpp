#include "proof/certificate.hpp"

#include <algorithm>
#include <cmath>

#include "numerics/bisect.hpp"
#include "proof/law.hpp"

namespace rolling_ellipse {
namespace {

double theta_of(const Body& body, double angle_from_flat) {
    return body.a >= body.b ? angle_from_flat : half_pi - angle_from_flat;
}

// The start in the frame in which the motion goes forwards.
struct Start {
    double angle;  // from the nearest flat position, signed: negative while the body sinks
    double direction;
    RollingForces forces;
};

// At a turning point the body falls back towards the flat position.
double direction_of(const RollingStart& from) {
    return from.omega != 0 ? std::copysign(1.0, from.omega) : -std::copysign(1.0, from.view.sin);
}

Start start_on_range(const RollingStart& from, const EnergyRange& range) {
    const FlatView& at = from.view;
    const double direction = direction_of(from);
    const double omega2 = from.omega * from.omega * at.long_axis / from.body.gravity;
    return {direction * std::atan2(at.sin, at.cos), direction,
            rolling_forces(range, at.sin * at.sin, at.cos * at.cos, omega2)};
}

ContactForce contact_force(const RollingForces& forces) { return {forces.normal, forces.friction}; }

double margin_at(const EnergyRange& range, double friction, double angle) {
    return law_margin(contact_force(rolling_forces_at_angle(range, angle)), friction);
}

// The angle from which on the law holds: that of the start; ahead of it, where it is within
// rounding of its end there, and what counts is where the motion goes; nothing where it is broken.
std::optional<double> holds_from(const EnergyRange& range, double friction, const Start& start) {
    constexpr double ahead = 1e-8;  // of the way: sqrt(epsilon), where rounding is overcome
    const ContactForce force = contact_force(start.forces);
    if (!at_the_limit(force, friction)) {
        return law_margin(force, friction) > 0 ? std::optional(start.angle) : std::nullopt;
    }
    const double top = rolling_forces(range, 1.0).angle;
    const double next =
        start.angle >= 0 ? start.angle + ahead * (top - start.angle) : start.angle * (1 - ahead);
    return margin_at(range, friction, std::abs(next)) > 0 ? std::optional(next) : std::nullopt;
}

// The zeros of the law about one that was found in its squared form, refined in the plain one: near
// the tip both forces may be small, and their squares know half their digits only. They lie between
// the angles given; where F vanishes, too, the law may hold at what was found and be broken on both
// sides.
void add_refined(std::vector<double>& angles, const EnergyRange& range, double friction,
                 double angle, double from, double to) {
    const auto holds = [&](double at) { return margin_at(range, friction, at) > 0; };
    const auto add_between = [&](double low, double high) {
        const bool rises = holds(high);
        const Bracket zero = bisect(low, high, [&](double at) { return holds(at) == rises; });
        angles.push_back(0.5 * (zero.low + zero.high));
    };
    double low = angle;
    double high = angle;
    const double scale = angle > 0 ? angle : to;
    for (double reach = epsilon; reach < 1; reach *= 4) {
        low = std::max(angle - reach * scale, from);
        high = std::min(angle + reach * scale, to);
        if (holds(low) != holds(high)) return add_between(low, high);
    }
    if (holds(low) == holds(angle)) return angles.push_back(angle);
    add_between(low, angle);
    add_between(angle, high);
}

// Where the law may be broken, as angles from the flat position, ascending: its zeros, and those of
// N, at which it is broken anyway.
template <int N>
std::vector<double> breaking_angles(const EnergyRange& range, const Bernstein<5>& contact,
                                    const Bernstein<N>& law, double friction) {
    const auto angle_at = [&](double x) { return rolling_forces(range, x).angle; };
    const std::vector<double> roots = roots_on_unit_interval(law);
    std::vector<double> angles;
    for (const double x : roots_on_unit_interval(contact)) angles.push_back(angle_at(x));
    for (std::size_t i = 0; i < roots.size(); ++i) {
        const double from = i == 0 ? 0.0 : 0.5 * (roots[i - 1] + roots[i]);
        const double to = i + 1 == roots.size() ? 1.0 : 0.5 * (roots[i] + roots[i + 1]);
        add_refined(angles, range, friction, angle_at(roots[i]), angle_at(from), angle_at(to));
    }
    std::sort(angles.begin(), angles.end());
    return angles;
}

// Adds the ends of the part about the start on which the law holds. Next to no friction will do
// where none is needed, flat and on the tip and wherever F vanishes: such a part may be narrower
// than the roots of the squared form can tell.
void add_ends_about(std::vector<double>& angles, double start, const EnergyRange& range,
                    double friction) {
    const auto holds = [&](double angle) { return margin_at(range, friction, angle) > 0; };
    const auto broken = [&](double angle) { return !holds(angle); };
    const auto above = std::upper_bound(angles.begin(), angles.end(), start);
    const double next = above != angles.end() ? *above : rolling_forces(range, 1.0).angle;
    const double last = above != angles.begin() ? above[-1] : 0.0;
    const double on_the_way_up = 0.5 * (start + next);
    const double on_the_way_down = 0.5 * (last + start);
    if (broken(on_the_way_up)) angles.push_back(bisect(start, on_the_way_up, broken).high);
    if (broken(on_the_way_down)) angles.push_back(bisect(on_the_way_down, start, holds).low);
    std::sort(angles.begin(), angles.end());
}

// How far the body turns until, behind the angle `from` on its way, the first of the angles
// (ascending, at least one) is met on one side or the other of the flat position, and which way it
// then moves; nothing where it never gets there: on the separatrix the tip is the end.
struct Turn {
    double angle;
    double heading;
};

std::optional<Turn> first_meeting(const EnergyRange& range, const Start& start, double from,
                                  const std::vector<double>& angles) {
    const double on = start.direction;
    const auto above = std::upper_bound(angles.begin(), angles.end(), std::abs(from));
    const bool rising = start.angle >= 0;
    if (!rising && above != angles.begin()) return Turn{on * (-above[-1] - start.angle), on};
    if (rising && above != angles.end()) return Turn{on * (*above - start.angle), on};
    if (!rising) return Turn{on * (angles.front() - start.angle), on};
    if (!range.libration && range.energy_gap == 0) return std::nullopt;
    // Over the top: the last angle, on the other side of the tip or back from the turning point.
    if (range.libration) return Turn{on * (angles.back() - start.angle), -on};
    return Turn{on * (pi - angles.back() - start.angle), on};
}

// The law holds where both polynomials are positive.
template <int N>
EndOfRolling end_under_law(const EnergyRange& range, const ForcePolynomials& polynomials,
                           const Polynomial<N>& law_polynomial, double friction, double theta,
                           const Start& start) {
    const Bernstein<5> contact = bernstein(polynomials.normal);
    const Bernstein<N> law = bernstein(law_polynomial);
    const Sign contact_sign = sign_on_unit_interval(contact);
    const Sign law_sign = sign_on_unit_interval(law);
    if (contact_sign == Sign::positive && law_sign == Sign::positive) return {Validity::valid};

    const bool broken = contact_sign == Sign::negative || law_sign == Sign::negative;
    EndOfRolling end{broken ? Validity::invalid : Validity::edge, theta, start.direction};
    const std::optional<double> from = holds_from(range, friction, start);
    if (!from) return end;
    std::vector<double> angles = breaking_angles(range, contact, law, friction);
    add_ends_about(angles, std::abs(*from), range, friction);
    if (angles.empty()) {  // on the edge: the least margin is where the law may be broken
        const ForceExtremes extremes = force_extremes(range, polynomials);
        angles.push_back(std::isinf(friction) ? extremes.least_normal.angle
                                              : extremes.most_friction.angle);
    }
    const std::optional<Turn> turn = first_meeting(range, start, *from, angles);
    if (!turn) return {end.validity};
    return {end.validity, theta + turn->angle, turn->heading};
}

// A body that stays where it is needs no friction. Nor does a circle, but a contact without any is
// one that slides.
std::optional<EndOfRolling> end_without_forces(const RollingStart& from, double friction) {
    if (from.rests) return EndOfRolling{Validity::valid};
    if (friction == 0) return EndOfRolling{Validity::invalid, from.theta, direction_of(from)};
    if (from.view.c2 == 0) return EndOfRolling{Validity::valid};
    return std::nullopt;
}

EndOfRolling end_of_rolling(const RollingStart& from, const EnergyRange& range,
                            const ForcePolynomials& polynomials, double friction) {
    if (const auto end = end_without_forces(from, friction)) return *end;
    const Start start = start_on_range(from, range);
    return std::isinf(friction)
               ? end_under_law(range, polynomials, polynomials.normal, friction, from.theta, start)
               : end_under_law(range, polynomials, grip_polynomial(polynomials, friction), friction,
                               from.theta, start);
}

}  // namespace

Polynomial<10> grip_polynomial(const ForcePolynomials& p, double friction) {
    const Polynomial<10> held = p.normal * p.normal;
    const Polynomial<10> needed = p.slope_square * p.friction * p.friction;
    if (friction > 1) return held - (1 / friction / friction) * needed;
    return friction * friction * held - needed;
}

EndOfRolling end_of_rolling(const RollingStart& from, double friction) {
    if (const auto end = end_without_forces(from, friction)) return *end;
    const EnergyRange range = energy_range(from);
    return end_of_rolling(from, range, force_polynomials(range), friction);
}

double time_of_end(const RollingFlow& flow, const EndOfRolling& end) {
    if (!end.angle) return infinity;
    if (*end.angle == flow.theta) return 0.0;
    // On a tip, with less than the smallest speed that there is in its units.
    if (flow.kind == MotionKind::rest) return infinity;
    return time_of_passing(flow, *end.angle, end.heading);
}

Certificate certify_rolling(const RollingStart& from, double mass, double friction) {
    const Body& body = from.body;
    const double weight = mass * body.gravity;
    if (from.view.c2 == 0 || from.rests) {
        const double angle = theta_of(body, std::atan2(std::abs(from.view.sin), from.view.cos));
        return {*end_without_forces(from, friction), weight, angle, 0.0, angle};
    }
    const EnergyRange range = energy_range(from);
    const ForcePolynomials polynomials = force_polynomials(range);
    const ForceExtremes extremes = force_extremes(range, polynomials);
    return {end_of_rolling(from, range, polynomials, friction),
            weight * extremes.least_normal.normal, theta_of(body, extremes.least_normal.angle),
            extremes.most_friction.needed(), theta_of(body, extremes.most_friction.angle)};
}

}  // namespace rolling_ellipse
