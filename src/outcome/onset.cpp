#include "outcome/onset.hpp"

#include <algorithm>
#include <cmath>

#include "numerics/bisect.hpp"
#include "proof/certificate.hpp"

namespace rolling_ellipse {
namespace {

// A position of a rolling body: the angle and the height of the centre.
struct Position : ShapePlace {
    double angle;      // phi, the angle from the flat position
    double over_flat;  // h - S, height above the flat position
};

Position position(const Shape& shape, double sin2, double cos2) {
    const ShapePlace at = place_at(shape, sin2, cos2);
    return {at, std::atan2(std::sqrt(sin2), std::sqrt(cos2)),
            shape.c2 * sin2 / (at.h + shape.short_axis)};
}

// The energy H - S above the flat position, given omega^2 at a position: physics (26).
double energy_over_flat(const Position& at, double omega2) {
    return 0.5 * at.inertia() * omega2 + at.over_flat;
}

// The energies between which the friction law holds at a position.
struct Grip {
    double lower;
    double upper;
};

// The law for either sign of friction, physics (47), with rho h = S^2/h^2:
//     mu kh + side h |h'| > omega^2 (side |h'| (D - h rho) - mu normal_part).
Grip grip(const Shape& shape, const Position& at, double friction) {
    const double dh = std::sqrt(at.dh2);
    const double inertial = dh * (at.inertia() - square(shape.short_axis / at.h));
    double least = 0.0;
    double most = infinity;
    for (const double side : {-1.0, 1.0}) {
        const double at_rest = friction * at.kh + side * at.h * dh;
        const double slope = side * inertial - friction * at.normal_part;
        if (at_rest < 0) {
            least = slope < 0 ? at_rest / slope : infinity;
        } else if (slope > 0) {
            most = std::min(most, at_rest / slope);
        }
    }
    return {energy_over_flat(at, least), energy_over_flat(at, most)};
}

// A range of positions in terms of ln tan phi, since the forces vary on a scale of (b/a)^2 near the
// flat position and on a scale of 1/mu near the tip.
struct Scan {
    double first;
    double last;
    int steps;

    double step() const { return (last - first) / steps; }
};

constexpr Scan everywhere{-24.0, 20.0, 128};

Position position(const Shape& shape, double log_tan) {
    const double tan2 = std::exp(2 * log_tan);
    return position(shape, tan2 / (1 + tan2), 1 / (1 + tan2));
}

// The point within one step of `place` at which a function is least.
template <class Function>
double refined(double place, double step, const Function& f) {
    return golden_section(place - step, place + step,
                          [&](double left, double right) { return !(f(left) > f(right)); });
}

// The point at which a function is least.
template <class Function>
double least_place(const Scan& scan, const Function& f) {
    double best = scan.first;
    double least = f(best);
    for (int i = 1; i <= scan.steps; ++i) {
        const double here = scan.first + scan.step() * i;
        const double value = f(here);
        if (!(value < least)) continue;
        best = here;
        least = value;
    }
    return refined(best, scan.step(), f);
}

// A rolling body and its coefficient of friction, without a given energy.
struct Rolling {
    const Shape& shape;
    double friction;

    EnergyRange range(double energy) const {
        return energy_range(shape, energy, energy - shape.c2 / (1 + shape.short_axis));
    }

    // The sign, if it is proved, of the margins N and mu N - |F| over all heights that the motion
    // reaches.
    Sign law(const ForcePolynomials& forces) const {
        const Sign contact = sign_on_unit_interval(bernstein(forces.normal));
        if (contact == Sign::negative) return contact;
        const Sign held = sign_on_unit_interval(bernstein(grip_polynomial(forces, friction)));
        return held == Sign::positive ? contact : held;
    }

    bool is_valid(double energy) const {
        return law(force_polynomials(range(energy))) == Sign::positive;
    }

    // The position, as ln tan phi, that needs the most friction; empty unless the law is provably
    // broken.
    std::optional<double> broken_place(double energy) const {
        const EnergyRange heights = range(energy);
        const ForcePolynomials forces = force_polynomials(heights);
        if (law(forces) != Sign::negative) return {};
        const RollingForces most = force_extremes(heights, forces).most_friction;
        return std::clamp(std::log(most.sin / most.cos), everywhere.first, everywhere.last);
    }
};

// Relative rounding error of energies and of the polynomials of a motion.
constexpr double rounding = 16 * epsilon;
// Limit on the number of corrections of an extremum that the scan has missed; two usually suffice.
constexpr int most_corrections = 50;

// The least of the upper energies of all positions.
Onset upper_onset(const Rolling& body) {
    const auto upper_at = [&](double log_tan) {
        return grip(body.shape, position(body.shape, log_tan), body.friction).upper;
    };
    const auto onset_at = [&](double log_tan) {
        return Onset{upper_at(log_tan), position(body.shape, log_tan).angle};
    };
    Onset onset = onset_at(least_place(everywhere, upper_at));
    for (int i = 0; i < most_corrections; ++i) {
        const auto missed = body.broken_place(onset.value * (1 - rounding));
        if (!missed) break;
        const Onset better = onset_at(refined(*missed, everywhere.step(), upper_at));
        if (!(better.value < onset.value)) break;
        onset = better;
    }
    return onset;
}

// The window of a body that slips when released from rest at positions with h |h'| > mu (k^2 +
// h^2), which lie between the roots of a quadratic equation in y = h^2 - S^2, physics (48). The
// window ends at the largest lower energy of these positions.
std::optional<SlipWindow> window_of_rest(const Rolling& body) {
    const Shape& shape = body.shape;
    const double friction = body.friction;
    const double mu2 = square(friction);
    const double flat_inertia = shape.gyration2 + square(shape.short_axis);
    const double half = shape.c2 - 2 * mu2 * flat_inertia;
    const double discriminant = square(half) - 4 * (1 + mu2) * mu2 * square(flat_inertia);
    if (half <= 0 || discriminant < 0) return {};
    const double twice = half + std::sqrt(discriminant);
    const double first = 2 * mu2 * square(flat_inertia) / twice;
    const double last = twice / (2 * (1 + mu2));
    const auto at = [&](double y) {
        return position(shape, y / shape.c2, (shape.c2 - y) / shape.c2);
    };
    const auto place = [&](double y) {
        return std::clamp(0.5 * std::log(y / (shape.c2 - y)), everywhere.first, everywhere.last);
    };
    const Scan scan{place(first), place(last), 32};
    const auto minus_lower = [&](double log_tan) {
        const double inside = std::clamp(log_tan, scan.first, scan.last);
        return -grip(shape, position(shape, inside), friction).lower;
    };
    const Position lowest = at(first);
    SlipWindow window{{lowest.over_flat, lowest.angle}, at(last).over_flat};
    window.end = std::max(window.end, -minus_lower(least_place(scan, minus_lower)));
    for (int i = 0; i < most_corrections && window.end < infinity; ++i) {
        const auto missed = body.broken_place(window.end * (1 + rounding));
        if (!missed) break;
        const double better = -minus_lower(refined(*missed, scan.step(), minus_lower));
        if (!(better > window.end)) break;
        window.end = better;
    }
    return window;
}

}  // namespace

// The least energy at which contact is lost, H = h - r/p with r = normal_at_rest, p =
// normal_moving, lies at a root of h' p^2 - r' p + r p', where ' is d/dx.
Onset contact_loss(const Shape& shape) {
    const EnergyRange range = separatrix_range(shape);
    const ForcePolynomials p = force_polynomials(range);
    const Polynomial<4>& moving = p.normal_moving;
    std::vector<double> places = roots_on_unit_interval(
        bernstein(range.width * (moving * moving) - derivative(p.normal_at_rest) * moving +
                  p.normal_at_rest * derivative(moving)));
    places.push_back(1.0);
    Onset onset;
    for (const double x : places) {
        const double over_flat = range.width * x;
        const double under_tip = range.width * (1 - x);
        const double h = shape.short_axis + over_flat;
        const Position at = position(shape, over_flat * (h + shape.short_axis) / shape.c2,
                                     under_tip * (1 + h) / shape.c2);
        if (at.normal_part >= 0) continue;
        onset.lower_to(energy_over_flat(at, -at.kh / at.normal_part), at.angle);
    }
    return onset;
}

std::vector<SlipWindow> slip_windows(const Shape& shape, double friction) {
    if (friction == 0) return {{{0.0, 0.0}}};
    if (std::isinf(friction)) return {{contact_loss(shape)}};
    const Rolling body{shape, friction};
    const Onset upper = upper_onset(body);
    const std::optional<SlipWindow> rest = window_of_rest(body);
    if (!rest) return {{upper}};
    // Between the windows rolling is valid; a gap too narrow for a proof does not count.
    if (rest->end < upper.value && body.is_valid(0.5 * (rest->end + upper.value))) {
        return {*rest, {upper}};
    }
    return {{rest->start.value < upper.value ? rest->start : upper}};
}

}  // namespace rolling_ellipse
