// Points on the panels of a run or a swing, and the position in a part of a panel as a function of
// time, for several lanes at once.
#pragma once

#include "numerics/part.hpp"
#include "rolling/slope/run.hpp"
#include "scene/centre_of_rolling.hpp"

namespace rolling_ellipse {
namespace {

constexpr std::size_t usual_parts = 16;

// |tan phi| at the complex zeros of D near the flat position.
inline double grade_at_flat(const SlopeBody& body) {
    return std::sqrt(body.d0 / (body.d0 + body.d1));
}

// Positions of the ellipse. `sin` and `cos` are the sine and cosine of the angle from a flat
// position, both times a common factor, and `over` is the inverse square of this factor. `sin2` and
// `cos2` are squares without the factor; h is the height of the centre.
struct Positions {
    Pack sin;
    Pack cos;
    Pack over;
    Pack sin2;
    Pack cos2;
    Pack h2;
    Pack h;
};

[[gnu::always_inline]] inline Positions positions(const SlopeBody& body, Pack sin, Pack cos,
                                                  Pack over) {
    Positions at{sin, cos, over, sin * sin * over, cos * cos * over, {}, {}};
    at.h2 = body.short_axis2 + body.c2 * at.sin2;
    at.h = sqrt(at.h2);
    return at;
}

// Points on a part: the tangents of their angles from the centre of the panel, the derivatives of
// the tangents with respect to v, and the fall of the body's centre since the datum of the run.
struct PanelPlaces : Positions {
    Pack tan;
    Pack tan_rate;
    Pack fall;
};

// The points of a part at the positions x in -1 ... 1.
[[gnu::always_inline]] inline PanelPlaces places_at(const SlopeRun& run, const RunPart& part,
                                                    Pack x) {
    const RunPanel& panel = run.panels[part.panel];
    const Pack v = part.middle + part.half * x;
    const auto [sinh, falling] = hyperbolic(abs(v));
    PanelPlaces at;
    at.tan = copysign(panel.grade * sinh, v);
    at.tan_rate = panel.grade * (sinh + falling);
    static_cast<Positions&>(at) =
        positions(run.body, panel.sin + panel.cos * at.tan, panel.cos - panel.sin * at.tan,
                  1 / (1 + at.tan * at.tan));
    const Geometry& from = run.datum.at;
    const double sin2_from = square(from.sin);
    const Pack change =
        sin2_from + at.sin2 > 1.0 ? at.cos2 - square(from.cos) : sin2_from - at.sin2;
    at.fall = run.body.c2 / (from.h + at.h) * change;
    return at;
}

// The forces that `node_forces` returns, after W has grown by `gained`.
template <class PositionsAt>
[[gnu::always_inline]] inline PartForces forces_at(const SlopeBody& body, const RunPart& part,
                                                   double heading, double gained,
                                                   const PositionsAt& positions_at) {
    const double into = body.gravity.into;
    const double along = heading * body.gravity.along;
    const double a = body.long_axis;
    const double b = body.short_axis;
    PartForces forces;
    for (int i = 0; i < part_order; i += lanes) {
        const Positions at = positions_at(load(&part_rule().places[i]));
        const Pack over_h3 = 1 / (at.h * at.h2);
        const Pack dh = body.c2 * at.sin * at.cos * at.over / at.h;
        const Pack ddh =
            body.c2 * (b * at.cos2 - a * at.sin2) * (b * at.cos2 + a * at.sin2) * over_h3;
        const Pack w = body.c2 * (b * b * at.cos2 - a * a * at.sin2) * over_h3 * at.h;
        const Pack omega2 =
            2 * (load(&part.level[i]) + gained) / (body.gyration2 + at.h2 + dh * dh);
        const auto force =
            centre_of_rolling(body.gyration2, into, along, at.h, dh, ddh, w, omega2).force_per_mass;
        store(force.normal, &forces.normal[i]);
        store(force.along, &forces.friction[i]);
    }
    return forces;
}

// The polynomial through values at the nodes. Its Legendre coefficients fall by a factor of 5.4 per
// degree, while the power coefficients of P_k grow by a factor of only 2.4. The powers therefore
// hardly cancel.
ROLLING_ELLIPSE_WIDE inline PartPolynomial polynomial_through(const PartArray& values) {
    const PartRule& rule = part_rule();
    const PartArray powers = product(rule.powers, product(rule.legendre, values));
    PartPolynomial polynomial;
    polynomial.value[part_order] = polynomial.integral[0] = 0.0;
    for (int k = 0; k < part_order; ++k) {
        polynomial.value[k] = powers[k];
        polynomial.integral[k + 1] = powers[k] * over_next[k];
        polynomial.integral[0] +=
            k % 2 == 0 ? polynomial.integral[k + 1] : -polynomial.integral[k + 1];
    }
    return polynomial;
}

// The position in a part as a function of the elapsed fraction of its time: the cubic with the
// values and slopes of the inverse function at both ends.
inline std::array<double, 5> inverse_about(const PartPolynomial& time) {
    const double lasts = value(time.integral, 1.0);
    const double first = lasts / value(time.value, -1.0);
    const double last = lasts / value(time.value, 1.0);
    return {-1.0, first, 6 - 2 * first - last, -4 + first + last, 0.0};
}

inline PartReading reading_of(const RunPart& part, double half_turns, double lasts,
                              const PartArray& times) {
    PartReading reading{
        &part, half_turns, lasts, polynomial_through(times), polynomial_through(part.advance), {}};
    reading.about_place = inverse_about(reading.time);
    return reading;
}

// The positions in a part, -1 ... 1, at times since its start, by Newton's method.
[[gnu::always_inline]] inline Pack places_in_part(const PartReading& of, Pack times) {
    constexpr int most_steps = 8;       // four suffice even for a guess 0.2 away
    constexpr double converged = 1e-8;  // the next step would be about its square
    const Pack guess = value(of.about_place, times / of.lasts);
    Pack x = max(min(guess, pack(1.0)), pack(-1.0));
    Mask<Pack> moving = x == x;
    for (int i = 0; i < most_steps && any(moving); ++i) {
        const Pack step = (times - value(of.time.integral, x)) / value(of.time.value, x);
        x = moving ? x + step : x;
        moving = moving & (abs(step) >= converged);
    }
    return x;
}

// Points on a part: tangent of the angle from the panel's centre, path ahead, magnitude of omega.
struct PlacesOnPart {
    std::array<double, lanes> tan;
    std::array<double, lanes> ahead;
    std::array<double, lanes> speed;
};

}  // namespace
}  // namespace rolling_ellipse
