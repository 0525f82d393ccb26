#include "outcome/classify.hpp"

#include <cmath>

#include "proof/certificate.hpp"

namespace rolling_ellipse {
namespace {

// A slip out of rolling never begins inside the Painleve region. Where |F| exceeds mu N > 0, with
// side s = -sign F and c = Gnn N + Gtn F in rolling too, physics (50), the response of sliding
// B = Gnn - mu s Gtn is positive: if s Gtn <= 0 as a sum of positive terms, else because of
// c <= N B with c > 0, which N > 0 implies (N D = c (k^2 + h^2) - omega^2 h h'^2 per mass). Where
// N <= 0 and c > 0, a body without slip finds a side on which B > 0. So `jams` is not returned.

// The acceleration of the gap into the ground of a free body, c = g + h'' omega^2, physics (43);
// h'' = rho - h.
Sign pressed_by_gravity(const Body& body, const Geometry& at, double omega) {
    const double omega2 = square(omega);
    return sign(
        {free_acceleration(at, body.gravity, omega), body.gravity + (at.rho + at.h) * omega2});
}

// Where the body passes the tip or turns back, as far as rounding can tell.
Outcome at_the_top(const RollingStart& from) {
    const FlatView& at = from.view;
    const EnergyHeight& height = from.height;
    const double to_tip = at.c2 * square(at.cos) / (at.long_axis + at.short_axis);
    const Sign over = sign({height.over_tip, std::abs(height.over_tip) + to_tip});
    if (over == Sign::undecided) return Outcome::edge;
    return over == Sign::positive ? Outcome::rolls_over : Outcome::rocks;
}

// The sign of a law of rolling from a place x of its range up to the top.
template <int N>
Sign sign_from(const Polynomial<N>& law, double x) {
    const Bernstein<N> whole = bernstein(law);
    return sign_on_unit_interval(x > 0 ? divided(whole, x).right : whole);
}

}  // namespace

Outcome classify(const Body& body, double friction, double theta, double omega) {
    const RollingStart from = rolling_start(body, theta, omega);
    const FlatView& at = from.view;
    if (from.rests) return Outcome::rests;
    if (at.c2 == 0) return Outcome::rolls_over;

    const Geometry here = geometry(body.axes(), theta);
    const Sign pressed = pressed_by_gravity(body, here, from.omega);
    if (pressed == Sign::negative) return Outcome::loses_contact;
    if (pressed == Sign::undecided) return Outcome::edge;

    // On its way up it meets the heights above the start only; on its way down, and from the very
    // tip, all of them, flat position and all, before it is at the top.
    const EnergyRange range = energy_range(from);
    const ForcePolynomials forces = force_polynomials(range);
    const bool rises = at.sin * from.omega > 0 && at.cos > 0;
    const double over_flat = at.c2 * square(at.sin) / (here.h + at.short_axis) / at.long_axis;
    const double start = rises ? std::min(over_flat / range.width, 1.0) : 0.0;
    const bool grips_always = std::isinf(friction);
    const Sign contact = sign_from(forces.normal, start);
    const Sign grip = grips_always ? contact : sign_from(grip_polynomial(forces, friction), start);
    if (contact == Sign::negative || grip == Sign::negative) {
        return grips_always ? Outcome::loses_contact : Outcome::slips;
    }
    if (contact == Sign::undecided || grip == Sign::undecided) return Outcome::edge;
    return at_the_top(from);
}

}  // namespace rolling_ellipse
