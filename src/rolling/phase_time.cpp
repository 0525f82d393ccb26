#include "rolling/phase_time.hpp"

#include <algorithm>
#include <cmath>

#include "numerics/quadrature.hpp"

namespace rolling_ellipse {
namespace {

// From here on e^-w squared is below rounding: the integrand at the tip is constant.
constexpr double constant_from = 20.0;

// The panel next to the end of a half (coordinate v, from the end), or to the split (w, from
// there).
enum class Panel { end, rise };

double length(const Half& half, Panel panel) {
    return panel == Panel::end ? half.end_length : half.rise_length;
}

// Tangent of the offset from the end of the half: g sinh(v), with v = W - w on the rise;
// physics (31).
double tangent(const Half& half, Panel panel, double v) {
    if (panel == Panel::end) return half.grade * std::sinh(v);
    if (v > constant_from) return std::exp(-v);
    return std::exp(-v) - half.rise_excess * std::sinh(v);
}

// d tangent/dv = g cosh(v), and its negative on the rise.
double tangent_rate(const Half& half, Panel panel, double tan) {
    const double slope = std::sqrt(square(tan) + square(half.grade));
    return panel == Panel::end ? slope : -slope;
}

double coordinate(const Half& half, Panel panel, double tan) {
    if (panel == Panel::end) return std::asinh(tan / half.grade);
    const double root = std::sqrt(square(tan) + square(half.grade));
    return -std::log((tan + root) / (2 + half.rise_excess));
}

double sin2_phase(const Half& half, double tan) {
    const double cos2 = 1 / (1 + square(tan));
    return half.at_tip ? cos2 : square(tan) * cos2;
}

// scale^2 D (H + h), the square of the factor that depends on the shape: physics (28, 29).
double shape_factor2(const PhaseRate& rate, double sin2_phi) {
    const double h2 = square(rate.short_axis) + rate.c2 * sin2_phi;
    return rate.scale2 * (rate.d0 + rate.d1 * sin2_phi) * (rate.energy_height + std::sqrt(h2)) / h2;
}

// |dt/dv| where the tangent is `tan`: physics (31).
double time_rate(const PhaseRate& rate, const Half& half, double tan) {
    const double tan2 = square(tan);
    double squared = shape_factor2(rate, rate.amplitude2 * sin2_phase(half, tan)) / (1 + tan2);
    if (!half.at_tip) squared *= (tan2 + square(half.grade)) / (1 + square(rate.kappa) * tan2);
    return std::sqrt(squared);
}

// Quadrature from the anchor of the panel (v = 0) to v. The integrand is singular at Im v = pi/2
// above the anchor, above the other end of the half, and, at the flat, where h = 0.
const GaussRule& rule_from_anchor(const PhaseRate& rate, const Half& half, Panel panel, double v) {
    const bool constant = panel == Panel::end && half.length >= 2 * constant_from;
    if (v == 0.0 || constant) return gauss_rule(2);
    const auto mapped = [v](double place) { return 2 * place / v - 1; };
    double zero_of_h = 0.0;
    if (!half.at_tip) {
        const double s2 = square(rate.short_axis);
        const double place = std::sqrt(s2 / (rate.c2 * rate.amplitude2 + s2)) / half.grade;
        zero_of_h = std::acosh(std::max(place, 1.0));
        if (panel == Panel::rise) zero_of_h = half.length - zero_of_h;
    }
    const double other_end = std::min(half.length, 2 * constant_from);
    return gauss_rule(nodes_needed(pi / v, {mapped(0.0), mapped(zero_of_h), mapped(other_end)}));
}

// Between two points of a panel: no singularity is closer than pi/2.
const GaussRule& rule_between(double v0, double v1) {
    const double distance = std::abs(v1 - v0);
    if (distance < 1e-5) return gauss_rule(2);
    return gauss_rule(nodes_needed(pi / distance, {0.0}));
}

DoubleDouble time_from_anchor(const PhaseRate& rate, const Half& half, Panel panel, double v) {
    const auto rate_at = [&](double at) { return time_rate(rate, half, tangent(half, panel, at)); };
    if (panel == Panel::rise && v > constant_from) {  // on the separatrix: there is no end panel
        return time_from_anchor(rate, half, panel, constant_from) +
               (v - constant_from) * rate_at(constant_from);
    }
    return integrate(rule_from_anchor(rate, half, panel, v), 0.0, v, rate_at);
}

Half graded_half(const PhaseRate& rate, bool at_tip, double grade) {
    Half half{};
    half.at_tip = at_tip;
    half.grade = grade;
    half.rise_excess = square(grade) / (1 + std::sqrt(1 + square(grade)));
    half.length = grade == 0.0 ? infinity : std::asinh(1 / grade);
    half.rise_length = std::min(half.length / 2, constant_from);
    half.end_length = half.length - half.rise_length;
    half.rise_time = time_from_anchor(rate, half, Panel::rise, half.rise_length);
    half.end_time = grade == 0.0 ? DoubleDouble{infinity, 0.0}
                                 : time_from_anchor(rate, half, Panel::end, half.end_length);
    return half;
}

// The point of a panel that is `time` from its anchor: Newton's method on the time integral, which
// is extended by the last step only. The rest, below 1e-9 of v, is added to the offset itself.
PhasePoint point_in_panel(const PhaseRate& rate, const Half& half, Panel panel, double time) {
    constexpr double converged = 1e-9;
    constexpr int most_iterations = 60;
    const bool unbounded = half.grade == 0.0;
    const double limit = unbounded ? infinity : length(half, panel);
    const auto rate_at = [&](double v) { return time_rate(rate, half, tangent(half, panel, v)); };

    // At the tip time is nearly linear in v, at the flat in the tangent.
    const auto step = [&](double v, double rest) {
        const double tan = tangent(half, panel, v);
        const double slope = time_rate(rate, half, tan);
        if (half.at_tip) return v + rest / slope;
        const double target = tan + rest / slope * tangent_rate(half, panel, tan);
        return coordinate(half, panel, std::clamp(target, 0.0, 1.0));
    };

    double low = 0.0;
    double high = limit;
    double v = std::clamp(step(0.0, time), 0.0, limit);
    double rest = double(-time_from_anchor(rate, half, panel, v) + time);
    for (int i = 0; i < most_iterations; ++i) {
        if (std::abs(rest) <= converged * rate_at(v)) break;
        (rest > 0 ? low : high) = v;
        double next = step(v, rest);
        if (!(next >= low && next <= high)) next = 0.5 * (low + high);
        if (next == v) break;
        rest -= v > constant_from && unbounded
                    ? (next - v) * rate_at(v)
                    : double(integrate(rule_between(v, next), v, next, rate_at));
        v = next;
    }

    const double tan = tangent(half, panel, v);
    const double cos = 1 / std::sqrt(1 + square(tan));
    const double sin = tan * cos;
    const double correction =
        rest / time_rate(rate, half, tan) * tangent_rate(half, panel, tan) * square(cos);
    const PhasePoint offset{sin + cos * correction, cos - sin * correction};
    return half.at_tip ? PhasePoint{offset.cos, offset.sin} : offset;
}

}  // namespace

PhaseTime phase_time(const PhaseRate& rate) {
    PhaseTime phase{};
    phase.rate = rate;
    const double flat_grade = std::sqrt(rate.d0 / (rate.d1 * rate.amplitude2 + rate.d0));
    phase.flat = graded_half(rate, false, flat_grade);
    phase.tip = graded_half(rate, true, rate.kappa);
    phase.split = phase.flat.end_time + phase.flat.rise_time;
    if (phase.tip.grade == 0.0) {
        phase.quarter_turn = phase.half_turn = {infinity, 0.0};
        return phase;
    }
    phase.quarter_turn = phase.split + (phase.tip.end_time + phase.tip.rise_time);
    phase.half_turn = phase.quarter_turn * 2.0;
    return phase;
}

double shape_factor(const PhaseRate& rate, double sin_phi) {
    return std::sqrt(shape_factor2(rate, square(sin_phi)));
}

DoubleDouble time_since_flat(const PhaseTime& phase, const PhasePoint& point) {
    const double sin = std::abs(point.sin);
    const double cos = std::abs(point.cos);
    const bool at_tip = sin > cos;
    const Half& half = at_tip ? phase.tip : phase.flat;
    const double tan = at_tip ? cos / sin : sin / cos;
    const bool near_end = half.grade > 0 && coordinate(half, Panel::end, tan) <= half.end_length;
    const Panel panel = near_end ? Panel::end : Panel::rise;
    const double v = std::max(coordinate(half, panel, tan), 0.0);
    // v is rounded: what it misses of the tangent is added by the rate.
    const double reached = tangent(half, panel, v);
    const double missed =
        (tan - reached) * time_rate(phase.rate, half, reached) / tangent_rate(half, panel, reached);
    const DoubleDouble from_anchor = time_from_anchor(phase.rate, half, panel, v) + missed;

    DoubleDouble time;
    if (near_end) {
        time = at_tip ? phase.quarter_turn - from_anchor : from_anchor;
    } else {
        time = at_tip ? phase.split + from_anchor : phase.split - from_anchor;
    }
    return point.sin < 0 ? -time : time;
}

PhasePoint point_at_time(const PhaseTime& phase, DoubleDouble time) {
    const bool before = time.high < 0;
    if (before) time = -time;
    const double from_split = double(time - phase.split);
    const auto point = [&](const Half& half, Panel panel, double from_anchor) {
        return point_in_panel(phase.rate, half, panel, from_anchor);
    };
    PhasePoint found{};
    if (from_split < 0) {
        const double from_flat = double(time);
        found = from_flat <= double(phase.flat.end_time)
                    ? point(phase.flat, Panel::end, from_flat)
                    : point(phase.flat, Panel::rise, -from_split);
    } else if (phase.tip.grade == 0.0 || from_split <= double(phase.tip.rise_time)) {
        found = point(phase.tip, Panel::rise, from_split);
    } else {
        const double to_tip = std::max(double(phase.quarter_turn - time), 0.0);
        found = point(phase.tip, Panel::end, to_tip);
    }
    if (before) found.sin = -found.sin;
    return found;
}

}  // namespace rolling_ellipse
