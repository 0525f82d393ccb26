#include "rolling/flow.hpp"

#include <algorithm>
#include <cmath>

#include "numerics/quadrature.hpp"
#include "scene/refuse.hpp"

namespace rolling_ellipse {
namespace {

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
    double quarters;  // quarter turns of the whole turns made, to be added to sin_phi and cos_phi
};

// Angle and angular velocity at a phase, on the way up: physics (30), the energy integral at the
// point itself.
MotionPoint motion_point(const RollingFlow& flow, const PhasePoint& at) {
    const double sin_phi = flow.amplitude * at.sin;
    const double factor = shape_factor(flow.phase.rate, sin_phi);
    const double root = std::hypot(at.cos, flow.phase.rate.kappa * at.sin);
    if (flow.kind == MotionKind::rotation) return {sin_phi, at.cos, root / factor, 0.0};
    return {sin_phi, root, flow.amplitude * at.cos / factor, 0.0};
}

MotionPoint point_after(const RollingFlow& flow, double t) {
    const auto [time, half_turns] = phase_instant(flow, t);
    const double heading = heading_after(flow, half_turns);
    MotionPoint point = motion_point(flow, point_at_time(flow.phase, time));
    point.sin_phi *= heading;
    point.omega *= heading;
    if (flow.kind == MotionKind::rotation) point.quarters = 2 * heading * half_turns;
    return point;
}

// The path of the centre, the integral of h omega over time, for a move over which the difference
// of two paths would cancel: full relative accuracy. Such a move is short beside its distance from
// the flat position and the tip, so that eight Gauss nodes are more than enough.
double short_path(const RollingFlow& flow, double t) {
    const auto velocity = [&](double at) {
        const MotionPoint point = point_after(flow, at);
        const double h =
            std::hypot(flow.start.long_axis * point.sin_phi, flow.start.short_axis * point.cos_phi);
        return h * point.omega;
    };
    return double(integrate(gauss_rule(8), 0.0, t, velocity));
}

// The constants of the energy integral, physics (28, 29); see rolling/phase_time.hpp.
PhaseRate phase_rate(const RollingStart& from, MotionKind kind) {
    const Body& body = from.body;
    const FlatView& at = from.view;
    const EnergyHeight& height = from.height;
    const double s2 = square(at.short_axis);
    const double l2 = square(at.long_axis);
    const double flat2 = height.over_flat * (height.total + at.short_axis);         // H^2 - S^2
    const double tip2 = std::abs(height.over_tip) * (height.total + at.long_axis);  // |H^2 - L^2|
    const double unit = kind == MotionKind::rotation ? flat2 : at.c2;
    PhaseRate rate{};
    rate.short_axis = at.short_axis;
    rate.c2 = at.c2;
    rate.energy_height = height.total;
    rate.amplitude2 = std::min(flat2 / unit, 1.0);
    rate.scale2 = 1 / (2 * body.gravity * unit);
    rate.kappa = std::min(std::sqrt(tip2 / unit), 1.0);
    rate.d0 = s2 * (body.gyration2 + s2);
    rate.d1 = at.c2 * (body.gyration2 + l2 + s2);
    return rate;
}

// The start as a phase, times the amplitude; the cosine is negative on the way back of a libration.
PhasePoint start_phase(const RollingFlow& flow) {
    const FlatView& at = flow.start;
    if (flow.kind == MotionKind::rotation) return {flow.direction * at.sin, at.cos};
    return {at.sin, flow.omega * shape_factor(flow.phase.rate, at.sin)};
}

}  // namespace

RollingFlow rolling_flow(const RollingStart& from, double x) {
    RollingFlow flow{};
    flow.theta = from.theta;
    flow.omega = from.omega;
    flow.x = x;
    flow.gravity = from.body.gravity;
    flow.start = from.view;
    const FlatView& at = flow.start;
    if (from.rests) {
        flow.kind = MotionKind::rest;
        return flow;
    }
    if (at.c2 == 0) {
        flow.kind = MotionKind::uniform;
        return flow;
    }
    const bool rotates = from.height.over_tip >= 0 && from.omega != 0;
    flow.kind = rotates ? MotionKind::rotation : MotionKind::libration;
    flow.direction = rotates ? std::copysign(1.0, from.omega) : 1.0;
    flow.phase = phase_time(phase_rate(from, flow.kind));

    const PhasePoint start = start_phase(flow);
    flow.amplitude = std::hypot(start.sin, start.cos);
    flow.start_on_way_back = start.cos < 0;
    flow.start_time = time_since_flat(
        flow.phase, {flow.start_on_way_back ? -start.sin : start.sin, std::abs(start.cos)});
    flow.start_position = quarter_position(at, at.sin, at.cos);
    flow.quarter_path = path_from_flat(at.long_axis, at.short_axis, 1.0, 0.0);
    return flow;
}

PhaseInstant phase_instant(const RollingFlow& flow, double t) {
    // Whole half turns first; t - n T is formed without rounding, T being a double-double.
    const DoubleDouble& period = flow.phase.half_turn;
    double half_turns = 0.0;
    DoubleDouble time = flow.start_time + t;
    if (std::isfinite(period.high)) {
        half_turns = std::nearbyint(t / period.high);
        time = flow.start_time + std::fma(-half_turns, period.high, t) +
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
    return {time, half_turns};
}

double heading_after(const RollingFlow& flow, double half_turns) {
    if (flow.kind == MotionKind::rotation) return flow.direction;
    const bool odd = std::fmod(half_turns, 2.0) != 0.0;
    return odd == flow.start_on_way_back ? 1.0 : -1.0;
}

PhasePoint phase_of(const RollingFlow& flow, double sin, double cos, double omega) {
    if (flow.kind == MotionKind::rotation) return {sin, cos};
    const double adjacent = omega * shape_factor(flow.phase.rate, sin);
    const double size = std::hypot(sin, adjacent);
    return {sin / size, adjacent / size};
}

QuarterState quarter_state(const RollingFlow& flow, const PhasePoint& phase) {
    const MotionPoint at = motion_point(flow, phase);
    return {at.sin_phi, at.cos_phi, at.omega, quarter_position(flow.start, at.sin_phi, at.cos_phi)};
}

FlowSample sample(const RollingFlow& flow, double t) {
    if (flow.kind == MotionKind::rest || t == 0) return {flow.theta, flow.omega, flow.x};
    if (flow.kind == MotionKind::uniform) {
        const double turn = flow.omega * t;
        return {flow.theta + turn, flow.omega, flow.x + flow.start.long_axis * turn};
    }
    const MotionPoint now = point_after(flow, t);
    const QuarterPosition& from = flow.start_position;
    const QuarterPosition to = quarter_position(flow.start, now.sin_phi, now.cos_phi);
    const double quarters = now.quarters + (to.quarters - from.quarters);
    const DoubleDouble turned = half_pi_exact * quarters + (to.angle - from.angle);
    // Where the difference of two paths would lose more than two bits, over a short time.
    const bool short_move = quarters == 0 && std::abs(t) < double(flow.phase.quarter_turn) / 8 &&
                            std::abs(to.path - from.path) < std::abs(from.path) / 4;
    const double path = short_move ? short_path(flow, t)
                                   : std::fma(quarters, flow.quarter_path, to.path - from.path);
    return {double(turned + flow.theta), now.omega, flow.x + path};
}

double longest_time(const RollingFlow& flow) {
    if (flow.kind == MotionKind::rest) return infinity;
    if (flow.kind == MotionKind::uniform) return 1e15 * (pi / std::abs(flow.omega));
    return 1e15 * flow.phase.half_turn.high;
}

void validate_time(double t, double longest, const std::string& name) {
    if (!std::isfinite(t)) refuse(name, "finite [s]", t);
    if (std::abs(t) > longest) {
        refuse(name, "at most 1e15 half turns or swings, " + text(longest) + " [s]", t);
    }
}

double period(const RollingFlow& flow) {
    if (flow.kind == MotionKind::rest) return infinity;
    if (flow.kind == MotionKind::uniform) return 2 * pi / std::abs(flow.omega);
    return 2 * double(flow.phase.half_turn);
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
        sin = std::clamp(sin / flow.amplitude, -1.0, 1.0);
        cos = std::sqrt((1 - sin) * (1 + sin));
        on_way_back = heading < 0;
        if (on_way_back) sin = -sin;
        half_turns = double(on_way_back) - double(flow.start_on_way_back);
    }
    DoubleDouble time = time_since_flat(flow.phase, {sin, cos}) - flow.start_time;
    if (half_turns != 0) {
        if (std::isinf(flow.phase.half_turn.high)) return infinity;
        time = time + flow.phase.half_turn * half_turns;
    }
    if (time.high < 0 && flow.kind == MotionKind::libration)
        time = time + flow.phase.half_turn * 2.0;
    return std::max(double(time), 0.0);
}

}  // namespace rolling_ellipse
