#include "flow.hpp"

#include <algorithm>
#include <cmath>

#include "quadrature.hpp"

namespace rolling_ellipse {
namespace {

// From here on e^-w squared is below rounding: the integrand at the tip is constant.
constexpr double constant_from = 20.0;

double square(double x) { return x * x; }

// The panel next to the end of a half (coordinate v from the end), or next to the split (w from it).
enum class Panel { end, slope };

double length(const Half& half, Panel panel) {
    return panel == Panel::end ? half.end_length : half.slope_length;
}

// Tangent of the offset from the end of the half: g sinh(v), with v = W - w on the slope.
double tangent(const Half& half, Panel panel, double v) {
    if (panel == Panel::end) return half.grade * std::sinh(v);
    if (v > constant_from) return std::exp(-v);
    return std::exp(-v) - half.slope_excess * std::sinh(v);
}

// d tangent/dv = g cosh(v), and its negative on the slope.
double tangent_slope(const Half& half, Panel panel, double tan) {
    const double slope = std::sqrt(square(tan) + square(half.grade));
    return panel == Panel::end ? slope : -slope;
}

double coordinate(const Half& half, Panel panel, double tan) {
    if (panel == Panel::end) return std::asinh(tan / half.grade);
    const double root = std::sqrt(square(tan) + square(half.grade));
    return -std::log((tan + root) / (2 + half.slope_excess));
}

double sin2_phase(const Half& half, double tan) {
    const double cos2 = 1 / (1 + square(tan));
    return half.at_tip ? cos2 : square(tan) * cos2;
}

// D (H + h) scale^2, the factor of the integrand that depends on the shape.
double shape_factor(const RollingFlow& flow, double sin2) {
    const double sin2_phi = flow.amplitude2 * sin2;
    const double h2 = square(flow.start.short_axis) + flow.start.c2 * sin2_phi;
    return flow.scale2 * (flow.d0 + flow.d1 * sin2_phi) * (flow.energy_height + std::sqrt(h2)) / h2;
}

// |dt/dv| where the tangent is `tan`.
double time_rate(const RollingFlow& flow, const Half& half, double tan) {
    const double tan2 = square(tan);
    double rate2 = shape_factor(flow, sin2_phase(half, tan)) / (1 + tan2);
    if (!half.at_tip) rate2 *= (tan2 + square(half.grade)) / (1 + square(flow.kappa) * tan2);
    return std::sqrt(rate2);
}

// Quadrature from the anchor of the panel (v = 0) to v. The integrand is singular at Im v = pi/2
// above the anchor, above the other end of the half, and, at the flat, where h = 0.
const GaussRule& rule_from_anchor(const RollingFlow& flow, const Half& half, Panel panel, double v) {
    const bool constant = panel == Panel::end && half.length >= 2 * constant_from;
    if (v == 0.0 || constant) return gauss_rule(2);
    const auto mapped = [v](double place) {
        return std::complex<double>(2 * place / v - 1, pi / v);
    };
    double zero_of_h = 0.0;
    if (!half.at_tip) {
        const double s2 = square(flow.start.short_axis);
        const double place = std::sqrt(s2 / (flow.start.c2 * flow.amplitude2 + s2)) / half.grade;
        zero_of_h = std::acosh(std::max(place, 1.0));
        if (panel == Panel::slope) zero_of_h = half.length - zero_of_h;
    }
    const double other_end = std::min(half.length, 2 * constant_from);
    return gauss_rule(nodes_needed({mapped(0.0), mapped(zero_of_h), mapped(other_end)}));
}

// Between two points of a panel: no singularity is closer than pi/2.
const GaussRule& rule_between(double v0, double v1) {
    const double distance = std::abs(v1 - v0);
    if (distance < 1e-5) return gauss_rule(2);
    return gauss_rule(nodes_needed({std::complex<double>(0.0, pi / distance)}));
}

DoubleDouble time_from_anchor(const RollingFlow& flow, const Half& half, Panel panel, double v) {
    const auto rate = [&](double at) { return time_rate(flow, half, tangent(half, panel, at)); };
    if (v > constant_from && panel == Panel::slope) {  // on the separatrix: the tip is never reached
        return time_from_anchor(flow, half, panel, constant_from) +
               (v - constant_from) * rate(constant_from);
    }
    return integrate(rule_from_anchor(flow, half, panel, v), 0.0, v, rate);
}

Half graded_half(const RollingFlow& flow, bool at_tip, double grade) {
    Half half{};
    half.at_tip = at_tip;
    half.grade = grade;
    half.slope_excess = square(grade) / (1 + std::sqrt(1 + square(grade)));
    half.length = grade == 0.0 ? infinity : std::asinh(1 / grade);
    half.slope_length = std::min(half.length / 2, constant_from);
    half.end_length = half.length - half.slope_length;
    half.slope_time = time_from_anchor(flow, half, Panel::slope, half.slope_length);
    half.end_time = grade == 0.0 ? DoubleDouble{infinity, 0.0}
                                 : time_from_anchor(flow, half, Panel::end, half.end_length);
    return half;
}

DoubleDouble quarter_time(const RollingFlow& flow) {
    return (flow.flat.end_time + flow.flat.slope_time) + (flow.tip.end_time + flow.tip.slope_time);
}

// Time since the flat position, for a phase between -pi/2 and pi/2 given by its sine and cosine.
DoubleDouble time_since_flat(const RollingFlow& flow, double sin, double cos) {
    const bool at_tip = std::abs(sin) > cos;
    const Half& half = at_tip ? flow.tip : flow.flat;
    const double tan = at_tip ? cos / std::abs(sin) : std::abs(sin) / cos;
    const bool near_end = half.grade > 0 && coordinate(half, Panel::end, tan) <= half.end_length;
    const Panel panel = near_end ? Panel::end : Panel::slope;
    const double v = std::max(coordinate(half, panel, tan), 0.0);
    // v is rounded: what it misses of the tangent is added by the slope.
    const double reached = tangent(half, panel, v);
    const double missed =
        (tan - reached) * time_rate(flow, half, reached) / tangent_slope(half, panel, reached);
    const DoubleDouble from_anchor = time_from_anchor(flow, half, panel, v) + missed;

    const DoubleDouble split = flow.flat.end_time + flow.flat.slope_time;
    DoubleDouble time;
    if (near_end) {
        time = at_tip ? quarter_time(flow) - from_anchor : from_anchor;
    } else {
        time = at_tip ? split + from_anchor : split - from_anchor;
    }
    return sin < 0 ? -time : time;
}

struct PhasePoint {
    double sin;
    double cos;
};

// The point of a panel that is `time` from its anchor: Newton's method on the time integral, which
// is extended by the last step only. The rest, below 1e-9 of v, is added to the offset itself.
PhasePoint point_in_panel(const RollingFlow& flow, const Half& half, Panel panel, double time) {
    constexpr double converged = 1e-9;
    constexpr int most_iterations = 60;
    const bool unbounded = half.grade == 0.0;
    const double limit = unbounded ? infinity : length(half, panel);
    const auto rate_at = [&](double v) { return time_rate(flow, half, tangent(half, panel, v)); };

    // At the tip time is nearly linear in v, at the flat in the tangent.
    const auto step = [&](double v, double rest) {
        const double tan = tangent(half, panel, v);
        const double rate = time_rate(flow, half, tan);
        if (half.at_tip) return v + rest / rate;
        const double target = tan + rest / rate * tangent_slope(half, panel, tan);
        return coordinate(half, panel, std::clamp(target, 0.0, 1.0));
    };

    double low = 0.0;
    double high = limit;
    double v = std::clamp(step(0.0, time), 0.0, limit);
    double rest = double(-time_from_anchor(flow, half, panel, v) + time);
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
        rest / time_rate(flow, half, tan) * tangent_slope(half, panel, tan) * square(cos);
    const PhasePoint offset{sin + cos * correction, cos - sin * correction};
    return half.at_tip ? PhasePoint{offset.cos, offset.sin} : offset;
}

// The inverse of time_since_flat, for |time| <= half_turn_time/2.
PhasePoint point_at_time(const RollingFlow& flow, DoubleDouble time) {
    const bool before = time.high < 0;
    if (before) time = -time;
    const DoubleDouble split = flow.flat.end_time + flow.flat.slope_time;
    PhasePoint point;
    if (double(time - split) < 0) {
        const double from_flat = double(time);
        point = from_flat <= double(flow.flat.end_time)
                    ? point_in_panel(flow, flow.flat, Panel::end, from_flat)
                    : point_in_panel(flow, flow.flat, Panel::slope, double(split - time));
    } else {
        const double from_split = double(time - split);
        const double to_tip = std::max(double(quarter_time(flow) - time), 0.0);
        point = flow.tip.grade == 0.0 || from_split <= double(flow.tip.slope_time)
                    ? point_in_panel(flow, flow.tip, Panel::slope, from_split)
                    : point_in_panel(flow, flow.tip, Panel::end, to_tip);
    }
    if (before) point.sin = -point.sin;
    return point;
}

QuarterPosition quarter_position(const FlatView& body, double sin, double cos) {
    const double s = std::abs(sin);
    if (s <= cos) {
        const double path = path_from_flat(body.long_axis, body.short_axis, s, cos);
        return {0.0, std::atan2(sin, cos), std::copysign(path, sin)};
    }
    const double path = path_from_tip(body.long_axis, body.short_axis, cos, s);
    return {std::copysign(1.0, sin), -std::copysign(std::atan2(cos, s), sin),
            -std::copysign(path, sin)};
}

struct MotionPoint {
    double sin_phi;
    double cos_phi;
    double omega;
};

// Angle and angular velocity at a phase: the energy integral read at the point itself.
MotionPoint motion_point(const RollingFlow& flow, const PhasePoint& phase) {
    const double factor = std::sqrt(shape_factor(flow, square(phase.sin)));
    const double root = std::hypot(phase.cos, flow.kappa * phase.sin);
    if (flow.kind == MotionKind::rotation) {
        return {flow.direction * phase.sin, phase.cos, flow.direction * root / factor};
    }
    const double amplitude = std::sqrt(flow.amplitude2);
    return {amplitude * phase.sin, root, amplitude * phase.cos / factor};
}

void set_rotation(RollingFlow& flow, const EnergyHeight& height) {
    const FlatView& at = flow.start;
    const double flat2 = height.over_flat * (height.total + at.short_axis);  // H^2 - S^2
    const double tip2 = height.over_tip * (height.total + at.long_axis);     // H^2 - L^2
    flow.kind = MotionKind::rotation;
    flow.direction = std::copysign(1.0, flow.omega);
    flow.amplitude2 = 1.0;
    flow.scale2 = 1 / flat2;
    flow.kappa = std::sqrt(tip2 / flat2);
}

void set_libration(RollingFlow& flow, const EnergyHeight& height) {
    const FlatView& at = flow.start;
    const double flat2 = height.over_flat * (height.total + at.short_axis);
    const double tip2 = -height.over_tip * (height.total + at.long_axis);
    flow.kind = MotionKind::libration;
    flow.direction = 1.0;
    flow.amplitude2 = std::min(flat2 / at.c2, 1.0);
    flow.scale2 = 1 / at.c2;
    flow.kappa = std::min(std::sqrt(tip2 / at.c2), 1.0);
}

// The start as a phase: sine and cosine, the cosine negative on the way back of a libration.
PhasePoint start_phase(const RollingFlow& flow) {
    const FlatView& at = flow.start;
    if (flow.kind == MotionKind::rotation) return {flow.direction * at.sin, at.cos};
    const double sin2 = square(at.sin);
    const double h2 = square(at.short_axis) + at.c2 * sin2;
    const double shape =
        flow.scale2 * (flow.d0 + flow.d1 * sin2) * (flow.energy_height + std::sqrt(h2)) / h2;
    const double cos = flow.omega * std::sqrt(shape);
    const double norm = std::hypot(at.sin, cos);
    return {at.sin / norm, cos / norm};
}

}  // namespace

EnergyHeight energy_height(const FlatView& at, double gyration2, double gravity, double omega) {
    const double h2 = square(at.short_axis) + at.c2 * square(at.sin);
    const double h = std::sqrt(h2);
    const double dh = at.c2 * at.sin * at.cos / h;
    const double kinetic = (gyration2 + h2 + square(dh)) * square(omega) / (2 * gravity);
    return {kinetic + h, kinetic - at.c2 * square(at.cos) / (at.long_axis + h),
            kinetic + at.c2 * square(at.sin) / (at.short_axis + h)};
}

RollingFlow rolling_flow(const Body& body, double theta, double omega, double x) {
    RollingFlow flow{};
    flow.theta = theta;
    flow.omega = omega;
    flow.x = x;
    flow.start = flat_view({body.a, body.b}, theta);
    const FlatView& at = flow.start;
    if (omega == 0 && is_equilibrium(geometry({body.a, body.b}, theta))) {
        flow.kind = MotionKind::rest;
        return flow;
    }
    if (at.c2 == 0) {
        flow.kind = MotionKind::uniform;
        return flow;
    }
    const EnergyHeight height = energy_height(at, body.gyration2, body.gravity, omega);
    flow.energy_height = height.total;
    height.over_tip >= 0 && omega != 0 ? set_rotation(flow, height) : set_libration(flow, height);
    flow.scale2 /= 2 * body.gravity;

    // D h^2 as a polynomial in sin^2 phi, and its zero as the grading at the flat.
    const double s2 = square(at.short_axis);
    const double l2 = square(at.long_axis);
    flow.d0 = s2 * (body.gyration2 + s2);
    flow.d1 = at.c2 * (body.gyration2 + l2 + s2);
    flow.flat = graded_half(flow, false,
                            std::sqrt(flow.d0 / (flow.d1 * flow.amplitude2 + flow.d0)));
    flow.tip = graded_half(flow, true, flow.kappa);
    flow.half_turn_time = quarter_time(flow) * 2.0;

    const PhasePoint start = start_phase(flow);
    flow.start_on_way_back = start.cos < 0;
    flow.start_time = time_since_flat(flow, flow.start_on_way_back ? -start.sin : start.sin,
                                      std::abs(start.cos));
    flow.start_position = quarter_position(at, at.sin, at.cos);
    flow.quarter_path = path_from_flat(at.long_axis, at.short_axis, 1.0, 0.0);
    return flow;
}

FlowSample sample(const RollingFlow& flow, double t) {
    if (flow.kind == MotionKind::rest || t == 0) return {flow.theta, flow.omega, flow.x};
    if (flow.kind == MotionKind::uniform) {
        const double turn = flow.omega * t;
        return {flow.theta + turn, flow.omega, flow.x + flow.start.long_axis * turn};
    }
    // Whole half turns first; t - n T is formed without rounding, T being a double-double.
    const DoubleDouble& period = flow.half_turn_time;
    double half_turns = 0.0;
    DoubleDouble time = flow.start_time + t;
    if (std::isfinite(period.high)) {
        half_turns = std::nearbyint(t / period.high);
        time = flow.start_time + two_sum(std::fma(-half_turns, period.high, t), 0.0) +
               two_product(-half_turns, period.low);
        while (double(time * 2.0 - period) > 0) {
            time = time - period;
            half_turns += 1;
        }
        while (double(time * 2.0 + period) < 0) {
            time = time + period;
            half_turns -= 1;
        }
    }
    PhasePoint phase = point_at_time(flow, time);
    const bool odd = std::fmod(half_turns, 2.0) != 0.0;
    const bool libration = flow.kind == MotionKind::libration;
    if (libration && odd != flow.start_on_way_back) phase = {-phase.sin, -phase.cos};
    const MotionPoint now = motion_point(flow, phase);

    const QuarterPosition& from = flow.start_position;
    const QuarterPosition to = quarter_position(flow.start, now.sin_phi, now.cos_phi);
    const double quarters =
        (libration ? 0.0 : 2 * flow.direction * half_turns) + (to.quarters - from.quarters);
    const DoubleDouble turned = half_pi_exact * quarters + (to.angle - from.angle);
    const double path = std::fma(quarters, flow.quarter_path, to.path - from.path);
    return {double(turned + flow.theta), now.omega, flow.x + path};
}

double period(const RollingFlow& flow) {
    if (flow.kind == MotionKind::rest) return infinity;
    if (flow.kind == MotionKind::uniform) return 2 * pi / std::abs(flow.omega);
    return 2 * double(flow.half_turn_time);
}

double time_of_passing(const RollingFlow& flow, double theta, double heading) {
    if (flow.kind == MotionKind::rest) return infinity;
    if (flow.kind == MotionKind::uniform) return (theta - flow.theta) / flow.omega;
    // The ellipse of the start, turned on by theta - flow.theta.
    const double turn = theta - flow.theta;
    const FlatView& at = flow.start;
    double sin = at.sin * std::cos(turn) + at.cos * std::sin(turn);
    double cos = at.cos * std::cos(turn) - at.sin * std::sin(turn);
    double half_turns = 0.0;
    bool on_way_back = false;
    if (flow.kind == MotionKind::rotation) {
        const double end_angle = std::atan2(at.sin, at.cos) + turn;
        half_turns = std::nearbyint(flow.direction * end_angle / pi);
        sin = flow.direction * (cos < 0 ? -sin : sin);
        cos = std::abs(cos);
    } else {
        sin = std::clamp(sin / std::sqrt(flow.amplitude2), -1.0, 1.0);
        cos = std::sqrt((1 - sin) * (1 + sin));
        on_way_back = heading < 0;
        if (on_way_back) sin = -sin;
        half_turns = double(on_way_back) - double(flow.start_on_way_back);
    }
    DoubleDouble time = time_since_flat(flow, sin, cos) - flow.start_time;
    if (half_turns != 0) time = time + flow.half_turn_time * half_turns;
    if (time.high < 0 && flow.kind == MotionKind::libration) time = time + flow.half_turn_time * 2.0;
    return std::max(double(time), 0.0);
}

}  // namespace rolling_ellipse
