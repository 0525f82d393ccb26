#include "proof/certificate.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "numerics/bisect.hpp"

namespace rolling_ellipse {
namespace {

double theta_of(const Body& body, double angle_from_flat) {
    return body.a >= body.b ? angle_from_flat : half_pi - angle_from_flat;
}

// Sign of omega after the start. From a turning point the body falls towards the flat position.
double direction_of(const RollingStart& from) {
    return from.omega != 0 ? std::copysign(1.0, from.omega) : -std::copysign(1.0, from.view.sin);
}

// The law on the quarter turn whose mirror images make up the motion. A position (`place`) is the
// angle from the flat position or, if the motion starts nearer the tip, minus the angle from the
// tip, which gives positions near the start full precision.
struct Quarter {
    const EnergyRange& range;
    double friction;
    bool from_tip;
    double direction;    // sign of omega after the start
    bool rises;          // whether the body moves towards the tip; true in the flat position
    ContactForce force;  // contact force at the start
    double start;        // position at the start

    Quarter(const RollingStart& from, const EnergyRange& energies, double mu)
        : range(energies),
          friction(mu),
          from_tip(std::abs(from.view.sin) > std::abs(from.view.cos)),
          direction(direction_of(from)),
          rises(direction * from.view.sin >= 0) {
        const FlatView& at = from.view;
        const double omega2 = from.omega * from.omega * at.long_axis / from.body.gravity;
        const RollingForces forces =
            rolling_forces(range, at.sin * at.sin, at.cos * at.cos, omega2);
        force = {forces.normal, forces.friction};
        start = place(forces);
    }

    double flat() const { return from_tip ? -half_pi : 0.0; }
    double tip() const { return from_tip ? 0.0 : half_pi; }
    double top() const { return place(rolling_forces(range, 1.0)); }
    double place(const RollingForces& at) const {
        return from_tip ? -at.angle_to_tip() : at.angle();
    }
    bool holds(double place) const {
        const double sin2 = square(std::sin(place));
        const double cos2 = square(std::cos(place));
        const RollingForces at =
            from_tip ? rolling_forces(range, cos2, sin2) : rolling_forces(range, sin2, cos2);
        return law_margin({at.normal, at.friction}, friction) > 0;
    }
};

// The position from which the law holds: the start or, if the law is at its limit at the start, a
// position just ahead; empty if the law is broken.
std::optional<double> holds_from(const Quarter& quarter) {
    constexpr double ahead = 1e-8;  // fraction of the angle to the flat position or the tip
    if (!at_the_limit(quarter.force, quarter.friction)) {
        const bool holds = law_margin(quarter.force, quarter.friction) > 0;
        return holds ? std::optional(quarter.start) : std::nullopt;
    }
    const double goal = quarter.rises ? quarter.top() : quarter.flat();
    const double next = quarter.start + ahead * (goal - quarter.start);
    return quarter.holds(next) ? std::optional(next) : std::nullopt;
}

// Appends the zeros of the law between `from` and `to` near `zero`, a zero of the squared form of
// the law. Near the tip N and F may be small, and squaring halves the number of accurate digits. If
// F vanishes at `zero`, the law may hold there and fail on both sides.
void add_refined(std::vector<double>& places, const Quarter& quarter, double zero, double from,
                 double to) {
    const auto holds = [&](double place) { return quarter.holds(place); };
    const auto add_between = [&](double low, double high) {
        const bool rises = holds(high);
        const Bracket zero = bisect(low, high, [&](double at) { return holds(at) == rises; });
        places.push_back(0.5 * (zero.low + zero.high));
    };
    double low = zero;
    double high = zero;
    const double scale = zero != 0 ? std::abs(zero) : half_pi;
    for (double reach = epsilon * scale; reach < half_pi; reach *= 4) {
        low = std::max(zero - reach, from);
        high = std::min(zero + reach, to);
        if (holds(low) != holds(high)) return add_between(low, high);
    }
    if (holds(low) == holds(zero)) return places.push_back(zero);
    add_between(low, zero);
    add_between(zero, high);
}

// The positions, ascending, beyond which the law may be broken: the zeros of N and of mu N - |F|.
// `law` is the polynomial mu^2 N^2 - F^2, whose zeros at a negative N do not count.
template <int N>
std::vector<double> breaking_places(const Quarter& quarter, const Bernstein<5>& contact,
                                    const Bernstein<N>& law) {
    constexpr double clearly_negative = 1e-3;  // fraction of the weight, far above rounding
    const auto place_at = [&](double x) { return quarter.place(rolling_forces(quarter.range, x)); };
    const std::vector<double> roots = roots_on_unit_interval(law);
    std::vector<double> places;
    for (const double x : roots_on_unit_interval(contact)) places.push_back(place_at(x));
    for (std::size_t i = 0; i < roots.size(); ++i) {
        const RollingForces forces = rolling_forces(quarter.range, roots[i]);
        if (forces.normal < -clearly_negative) continue;
        const double from = i == 0 ? 0.0 : 0.5 * (roots[i - 1] + roots[i]);
        const double to = i + 1 == roots.size() ? 1.0 : 0.5 * (roots[i] + roots[i + 1]);
        add_refined(places, quarter, quarter.place(forces), place_at(from), place_at(to));
    }
    std::sort(places.begin(), places.end());
    return places;
}

// Appends the ends of the interval around `start` on which the law holds. Where F vanishes, as in
// the flat position and on the tip, a tiny coefficient of friction suffices; the interval may then
// be too narrow for the roots of the squared form to resolve.
void add_ends_about(std::vector<double>& places, double start, const Quarter& quarter) {
    const auto holds = [&](double place) { return quarter.holds(place); };
    const auto broken = [&](double place) { return !holds(place); };
    const auto above = std::upper_bound(places.begin(), places.end(), start);
    const double next = above != places.end() ? *above : quarter.top();
    const double last = above != places.begin() ? above[-1] : quarter.flat();
    const double above_start = 0.5 * (start + next);
    const double below_start = 0.5 * (last + start);
    if (broken(above_start)) places.push_back(bisect(start, above_start, broken).high);
    if (broken(below_start)) places.push_back(bisect(below_start, start, holds).low);
    std::sort(places.begin(), places.end());
}

// The angle turned since the start, and the sign of omega at the end of the turn.
struct Turn {
    double angle;
    double heading;
};

// The turn to the first of the given positions after `from`. There is at least one position; the
// positions are ascending, and each also represents its mirror image on the other side of the flat
// position. Empty if the body reaches none of them, since on the separatrix it approaches the tip
// forever.
std::optional<Turn> first_meeting(const Quarter& quarter, double from,
                                  const std::vector<double>& places) {
    const double on = quarter.direction;
    const double start = quarter.start;
    const EnergyRange& range = quarter.range;
    const auto above = std::upper_bound(places.begin(), places.end(), from);
    const double flat = quarter.flat();
    const double tip = quarter.tip();
    if (!quarter.rises && above != places.begin()) return Turn{on * (start - above[-1]), on};
    if (quarter.rises && above != places.end()) return Turn{on * (*above - start), on};
    if (!quarter.rises) return Turn{on * ((start - flat) + (places.front() - flat)), on};
    if (!range.libration && range.energy_gap == 0) return std::nullopt;
    // The last position is reached again beyond the tip or after the turning point.
    if (range.libration) return Turn{on * (places.back() - start), -on};
    return Turn{on * ((tip - start) + (tip - places.back())), on};
}

// The end of rolling: the first position at which N or the polynomial of the law turns negative.
template <int N>
EndOfRolling end_under_law(const Quarter& quarter, const ForcePolynomials& polynomials,
                           const Polynomial<N>& law_polynomial, double theta) {
    const Bernstein<5> contact = bernstein(polynomials.normal);
    const Bernstein<N> law = bernstein(law_polynomial);
    const Sign contact_sign = sign_on_unit_interval(contact);
    const Sign law_sign = sign_on_unit_interval(law);
    if (contact_sign == Sign::positive && law_sign == Sign::positive) return {Validity::valid};

    const bool broken = contact_sign == Sign::negative || law_sign == Sign::negative;
    EndOfRolling end{broken ? Validity::invalid : Validity::edge, theta, quarter.direction};
    const std::optional<double> from = holds_from(quarter);
    if (!from) return end;
    std::vector<double> places = breaking_places(quarter, contact, law);
    add_ends_about(places, *from, quarter);
    if (places.empty()) {  // edge: the law may be broken where its margin is least
        const ForceExtremes extremes = force_extremes(quarter.range, polynomials);
        places.push_back(quarter.place(std::isinf(quarter.friction) ? extremes.least_normal
                                                                    : extremes.most_friction));
    }
    const std::optional<Turn> turn = first_meeting(quarter, *from, places);
    if (!turn) return {end.validity};
    return {end.validity, theta + turn->angle, turn->heading};
}

// The end of rolling for a body that needs no friction (at rest or a circle), or that has no
// friction and slides from the start; empty for all others.
std::optional<EndOfRolling> end_without_forces(const RollingStart& from, double friction) {
    if (from.rests) return EndOfRolling{Validity::valid};
    if (friction == 0) return EndOfRolling{Validity::invalid, from.theta, direction_of(from)};
    if (from.view.c2 == 0) return EndOfRolling{Validity::valid};
    return std::nullopt;
}

EndOfRolling end_of_rolling(const RollingStart& from, const EnergyRange& range,
                            const ForcePolynomials& polynomials, double friction) {
    if (const auto end = end_without_forces(from, friction)) return *end;
    const Quarter quarter(from, range, friction);
    if (std::isinf(friction)) {
        return end_under_law(quarter, polynomials, polynomials.normal, from.theta);
    }
    const Polynomial<10> law = grip_polynomial(polynomials, friction);
    return end_under_law(quarter, polynomials, law, from.theta);
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
    if (*end.angle == flow.from.theta) return 0.0;
    // The body stands on its tip, and its speed underflows in natural units.
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
            weight * extremes.least_normal.normal, theta_of(body, extremes.least_normal.angle()),
            extremes.most_friction.needed(), theta_of(body, extremes.most_friction.angle())};
}

}  // namespace rolling_ellipse
