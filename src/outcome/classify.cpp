#include "outcome/classify.hpp"

#include <algorithm>
#include <cmath>

#include "proof/certificate.hpp"

namespace rolling_ellipse {
namespace {

// A slip out of rolling never begins inside the Painleve region. Where |F| exceeds mu N > 0, with
// side s = -sign F and c = Gnn N + Gtn F in rolling too, physics (50), the response of sliding
// B = Gnn - mu s Gtn is positive: if s Gtn <= 0 as a sum of positive terms, else because of
// c <= N B with c > 0, which N > 0 implies (N D = c (k^2 + h^2) - omega^2 h h'^2 per mass). Where
// N <= 0 and c > 0, a body without slip finds a side on which B > 0. So `jams` is not returned.
// Nor does a body that rolls on level ground leave it before it slips: the same c is positive where
// N vanishes, so that with infinite friction, too, it goes on as a slide.

// The sign of the acceleration into the ground of a free body, c = g + h'' omega^2, physics (43),
// with h'' = rho - h.
Sign pressed_by_gravity(const Body& body, const Geometry& at, double omega) {
    const double omega2 = square(omega);
    return sign(
        {free_acceleration(at, body.gravity, omega), body.gravity + (at.rho + at.h) * omega2});
}

// The outcome for a body that rolls up to the top: it passes the tip or turns back, if rounding can
// tell.
Outcome at_the_top(const RollingStart& from) {
    const FlatView& at = from.view;
    const EnergyHeight& height = from.height;
    const double to_tip = at.c2 * square(at.cos) / (at.long_axis + at.short_axis);
    const Sign over = sign({height.over_tip, std::abs(height.over_tip) + to_tip});
    if (over == Sign::undecided) return Outcome::edge;
    return over == Sign::positive ? Outcome::rolls_over : Outcome::rocks;
}

// A law of rolling on the part of its range from x to the top.
template <int N>
Bernstein<N> from_place(const Polynomial<N>& law, double x) {
    const Bernstein<N> whole = bernstein(law);
    return x > 0 ? divided(whole, x).right : whole;
}

// P, Q and G of the forces on a part of their range. Q is raised to the degree of P.
struct ForcesOnPart {
    Bernstein<5> normal;
    Bernstein<5> friction;
    Bernstein<4> slope_square;
};

// The sign of mu^2 P^2 - G Q^2 = held P^2 - needed G Q^2, from the signs of sqrt(held) P +-
// sqrt(needed G) Q with a bound of G, which have a lower degree. Undecided where this is too
// coarse.
struct GripByBounds {
    double held;
    double needed;

    static constexpr int deepest = 2;
    static constexpr double rounding = 1 + 64 * epsilon;

    Sign operator()(const ForcesOnPart& part, int depth = 0) const {
        if (fails(part.normal.coefficients.front(), part.friction.coefficients.front(),
                  part.slope_square.coefficients.front()) ||
            fails(part.normal.coefficients.back(), part.friction.coefficients.back(),
                  part.slope_square.coefficients.back())) {
            return Sign::negative;
        }
        if (holds(part)) return Sign::positive;
        if (depth == deepest) return Sign::undecided;
        const Parts<5> normal = divided(part.normal);
        const Parts<5> friction = divided(part.friction);
        const Parts<4> slope_square = divided(part.slope_square);
        const Sign low = (*this)({normal.left, friction.left, slope_square.left}, depth + 1);
        if (low == Sign::negative) return low;
        const Sign high = (*this)({normal.right, friction.right, slope_square.right}, depth + 1);
        return high == Sign::negative || low == Sign::positive ? high : low;
    }

  private:
    // Is the sign negative at one place, provably?
    bool fails(Tracked normal, Tracked friction, Tracked slope_square) const {
        const double most = std::abs(normal.value) + margin(normal);
        const double least = std::abs(friction.value) - margin(friction);
        const double least_slope = slope_square.value - margin(slope_square);
        return least > 0 && least_slope > 0 &&
               rounding * held * square(most) < needed * least_slope * square(least);
    }

    // Is the sign positive on the whole part, provably?
    bool holds(const ForcesOnPart& part) const {
        double most_slope = 0.0;
        for (const Tracked c : part.slope_square.coefficients) {
            most_slope = std::max(most_slope, c.value + margin(c));
        }
        const double of_normal = std::sqrt(held);
        const double of_friction = rounding * std::sqrt(needed * most_slope);
        for (int i = 0; i <= 5; ++i) {
            const Tracked n = part.normal.coefficients[i];
            const Tracked f = part.friction.coefficients[i];
            if (!(of_normal * (n.value - margin(n)) >
                  of_friction * (std::abs(f.value) + margin(f)))) {
                return false;
            }
        }
        return true;
    }
};

// The sign of mu N - |F| from the place `start` up to the top.
Sign grip_sign(const ForcePolynomials& forces, const Bernstein<5>& normal, double friction,
               double start) {
    const bool large = friction > 1;
    const GripByBounds by_bounds{large ? 1.0 : square(friction),
                                 large ? 1 / friction / friction : 1.0};
    const Sign found = by_bounds({normal, from_place(forces.friction + Polynomial<5>{}, start),
                                  from_place(forces.slope_square, start)});
    if (found != Sign::undecided) return found;
    return sign_on_unit_interval(from_place(grip_polynomial(forces, friction), start));
}

}  // namespace

Outcome classify(const Body& body, double friction, double theta, double omega) {
    const RollingStart from = rolling_start(body, theta, omega);
    const FlatView& at = from.view;
    if (from.rests) return Outcome::rests;
    if (at.c2 == 0) return friction > 0 ? Outcome::rolls_over : Outcome::slips;

    // The angle is folded by half turns, which changes only signs of sin and cos. The functions h,
    // h'' and rho are even in both.
    const bool a_is_long = body.a >= body.b;
    const Geometry here =
        geometry(body.axes(), a_is_long ? at.sin : at.cos, a_is_long ? at.cos : at.sin);
    const Sign pressed = pressed_by_gravity(body, here, from.omega);
    if (pressed == Sign::negative) return Outcome::loses_contact;
    if (pressed == Sign::undecided) return Outcome::edge;
    if (friction == 0) return Outcome::slips;

    // A body that rises passes only the heights above its start. A body that falls, or starts at
    // the tip (to rounding), passes all heights before it is at the top.
    const EnergyRange range = energy_range(from);
    const ForcePolynomials forces = force_polynomials(range);
    const bool rises = at.sin * from.omega > 0 && at.cos > equal_ulps * epsilon;
    const double height = over_flat(at, here.h) / at.long_axis;
    const double start = rises ? std::min(height / range.width, 1.0) : 0.0;
    const bool grips_always = std::isinf(friction);
    const Bernstein<5> normal = from_place(forces.normal, start);
    const Sign contact = sign_on_unit_interval(normal);
    const Sign grip = grips_always || contact == Sign::negative
                          ? contact
                          : grip_sign(forces, normal, friction, start);
    if (grip == Sign::negative) return Outcome::slips;
    if (contact == Sign::undecided || grip == Sign::undecided) return Outcome::edge;
    return at_the_top(from);
}

}  // namespace rolling_ellipse
