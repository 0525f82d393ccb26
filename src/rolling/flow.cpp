#include "rolling/flow.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "rolling/motion_series.hpp"
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
};

// Angle and angular velocity at a phase, on the way up: physics (30), the energy integral at the
// point itself.
MotionPoint motion_point(const RollingMotion& motion, const PhasePoint& at) {
    const double sin_phi = motion.amplitude * at.sin;
    const double factor = shape_factor(motion.phase.rate, sin_phi);
    const double root = std::sqrt(square(at.cos) + square(motion.phase.rate.kappa * at.sin));
    if (motion.kind == MotionKind::rotation) return {sin_phi, at.cos, root / factor};
    return {sin_phi, root, motion.amplitude * at.cos / factor};
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
    rate.rotates = kind == MotionKind::rotation;
    return rate;
}

// The start as a phase, times the amplitude; the cosine is negative on the way back of a libration.
PhasePoint start_phase(const RollingMotion& motion) {
    const FlatView& at = motion.start;
    if (motion.kind == MotionKind::rotation) return {motion.direction * at.sin, at.cos};
    return {at.sin, motion.omega * shape_factor(motion.phase.rate, at.sin)};
}

bool is_still_or_uniform(const RollingMotion& motion) {
    return motion.kind == MotionKind::rest || motion.kind == MotionKind::uniform;
}

// What is left of a time without whole turns, or swings, and these.
struct Reduced {
    double time;
    double turns;
};
Reduced reduced(const DoubleDouble& turn, double t) {
    if (std::isinf(turn.high)) return {t, 0.0};
    const double turns = std::nearbyint(t / turn.high);
    return {std::fma(-turns, turn.high, t) - turns * turn.low, turns};
}

}  // namespace

RollingMotion rolling_motion(const RollingStart& from, double x) {
    RollingMotion motion{};
    motion.theta = from.theta;
    motion.omega = from.omega;
    motion.x = x;
    motion.gravity = from.body.gravity;
    motion.start = from.view;
    if (from.rests) {
        motion.kind = MotionKind::rest;
        return motion;
    }
    if (from.view.c2 == 0) {
        motion.kind = MotionKind::uniform;
        return motion;
    }
    const bool rotates = from.height.over_tip >= 0 && from.omega != 0;
    motion.kind = rotates ? MotionKind::rotation : MotionKind::libration;
    motion.direction = rotates ? std::copysign(1.0, from.omega) : 1.0;
    motion.phase = phase_time(phase_rate(from, motion.kind));

    const PhasePoint start = start_phase(motion);
    motion.amplitude = std::sqrt(square(start.sin) + square(start.cos));
    // At rest it goes back from either side in the same way.
    motion.start_on_way_back = start.cos < 0 || (!rotates && start.cos == 0 && start.sin > 0);
    motion.start_phase = {motion.start_on_way_back ? -start.sin : start.sin, std::abs(start.cos)};
    motion.start_place = place_of(motion.phase.map, motion.start_phase);
    return motion;
}

RollingFlow rolling_flow(const RollingStart& from, double x) {
    RollingFlow flow{rolling_motion(from, x), {}, {}, 0.0};
    if (is_still_or_uniform(flow)) return flow;
    const FlatView& at = flow.start;
    flow.start_time = time_since_flat(flow.phase, flow.start_phase);
    flow.start_position = quarter_position(at, at.sin, at.cos);
    flow.quarter_path = path_from_flat(at.long_axis, at.short_axis, 1.0, 0.0);
    return flow;
}

double heading(const RollingMotion& motion) {
    if (motion.kind == MotionKind::rotation) return motion.direction;
    return motion.start_on_way_back ? -1.0 : 1.0;
}

QuarterPosition position_at(const RollingFlow& flow, const PhasePoint& phase) {
    const MotionPoint at = motion_point(flow, phase);
    return quarter_position(flow.start, at.sin_phi, at.cos_phi);
}

namespace {

// A move so short that one power series knows it: it keeps the digits of what has changed.
std::optional<FlowSample> short_move(const RollingMotion& motion, double t) {
    const auto [unit, short_axis, c2, sin, cos] = motion.start;
    if (!may_be_short(t, motion.omega, motion.gravity, short_axis)) return std::nullopt;
    const double unit2 = square(unit);
    const SeriesConstants body{
        square(short_axis) / unit2, c2 / unit2, motion.gravity * square(t) / unit,
        motion.phase.rate.d0 / square(unit2), motion.phase.rate.d1 / square(unit2)};
    const MotionSeries series = motion_series(body, sin, cos, motion.omega * t);
    if (!(std::min(reach(series.angle), reach(series.omega)) >= 1)) return std::nullopt;
    Series gain = series.omega;
    gain[0] = 0.0;
    return FlowSample{motion.theta + value(series.angle, 1.0), motion.omega + value(gain, 1.0) / t,
                      motion.x + unit * value(series.path, 1.0)};
}

}  // namespace

FlowSample sample(const RollingMotion& motion, double t) {
    if (motion.kind == MotionKind::rest || t == 0) return {motion.theta, motion.omega, motion.x};
    if (motion.kind == MotionKind::uniform) {
        const double turn = motion.omega * t;
        return {motion.theta + turn, motion.omega, motion.x + motion.start.long_axis * turn};
    }
    if (const auto moved = short_move(motion, t)) return *moved;
    const bool rotates = motion.kind == MotionKind::rotation;
    const DoubleDouble& half_turn = motion.phase.half_turn;
    const auto [time, turns] = reduced(rotates ? half_turn : half_turn * 2.0, t);
    const PhaseMove made = move(motion.phase, motion.start_place, time);
    const double heading = rolling_ellipse::heading(motion);
    const MotionPoint now = motion_point(motion, phase_point(motion.phase.map, made.to));
    const double omega = heading * now.omega;
    if (!rotates) {
        const FlatView& from = motion.start;
        const double sin_phi = heading * now.sin_phi;
        const double turned = std::atan2(sin_phi * from.cos - now.cos_phi * from.sin,
                                         now.cos_phi * from.cos + sin_phi * from.sin);
        const bool turned_back = now.omega < 0;
        const double path =
            turned_back ? path_between(motion.phase, motion.start_place, made.to) : made.way.path;
        return {motion.theta + turned, omega, motion.x + heading * path};
    }
    DoubleDouble turned = half_pi_exact * (2 * turns) + made.way.angle;
    if (std::isinf(half_turn.high) && now.sin_phi > now.cos_phi) {  // it creeps to the tip
        const PhasePoint& from = motion.start_phase;
        turned = half_pi_exact +
                 -(std::atan2(now.cos_phi, now.sin_phi) + std::atan2(from.sin, from.cos));
    }
    return {double(turned * heading + motion.theta), omega,
            motion.x + heading * std::fma(2 * turns, motion.phase.quarter_path, made.way.path)};
}

double longest_time(const RollingMotion& motion) {
    if (motion.kind == MotionKind::rest) return infinity;
    if (motion.kind == MotionKind::uniform) return 1e15 * (pi / std::abs(motion.omega));
    return 1e15 * motion.phase.half_turn.high;
}

void validate_time(double t, double longest, const std::string& name) {
    if (!std::isfinite(t)) refuse(name, "finite [s]", t);
    if (std::abs(t) > longest) {
        refuse(name, "at most 1e15 half turns or swings, " + text(longest) + " [s]", t);
    }
}

double period(const RollingMotion& motion) {
    if (motion.kind == MotionKind::rest) return infinity;
    if (motion.kind == MotionKind::uniform) return 2 * pi / std::abs(motion.omega);
    return 2 * double(motion.phase.half_turn);
}

double time_of_passing(const RollingFlow& flow, double theta, double heading) {
    // The ellipse of the start, turned on by theta - flow.theta.
    const double turn = theta - flow.theta;
    const FlatView& at = flow.start;
    double sin = at.sin * std::cos(turn) + at.cos * std::sin(turn);
    double cos = at.cos * std::cos(turn) - at.sin * std::sin(turn);
    double half_turns = 0.0;
    if (flow.kind == MotionKind::rotation) {
        const double end_angle = std::atan2(at.sin, at.cos) + turn;
        half_turns = std::nearbyint(flow.direction * end_angle / pi);
        sin = flow.direction * (cos < 0 ? -sin : sin);
        cos = std::abs(cos);
    } else {
        // amplitude^2 - sin^2 = cos^2 - kappa^2: the smaller ones have the digits.
        const double amplitude = flow.amplitude;
        const double kappa = flow.phase.rate.kappa;
        const double left = std::abs(sin) < cos ? (amplitude - sin) * (amplitude + sin)
                                                : (cos - kappa) * (cos + kappa);
        sin = std::clamp(sin / amplitude, -1.0, 1.0);
        cos = std::sqrt(std::max(left, 0.0)) / amplitude;
        const bool on_way_back = heading < 0;
        if (on_way_back) sin = -sin;
        half_turns = on_way_back == flow.start_on_way_back ? 0.0 : 1.0;
    }
    DoubleDouble time = time_since_flat(flow.phase, {sin, cos}) - flow.start_time;
    // On the same way and behind the start: in the next swing.
    if (flow.kind == MotionKind::libration && half_turns == 0 && time.high < 0) half_turns = 2.0;
    if (half_turns != 0) {
        if (std::isinf(flow.phase.half_turn.high)) return infinity;
        time = time + flow.phase.half_turn * half_turns;
    }
    return std::max(double(time), 0.0);
}

}  // namespace rolling_ellipse
