#include "rolling/level/flow.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "rolling/level/motion.hpp"
#include "rolling/level/power_series.hpp"
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

bool is_still_or_uniform(const RollingMotion& motion) {
    return motion.kind == MotionKind::rest || motion.kind == MotionKind::uniform;
}

DoubleDouble time_since_flat(const PhaseTime<double>& phase, const PhasePoint<double>& point) {
    const Place<double> at = place_of(phase.map, point);
    const double time = way_between(phase, at.quarters, 0.0, at.offset).way.time;
    if (at.quarters == 0) return {time, 0.0};
    return phase.quarter_turn * at.quarters + time;
}

}  // namespace

RollingMotion rolling_motion(const RollingStart& from, double x) {
    RollingMotion motion;
    motion.theta = from.theta;
    motion.omega = from.omega;
    motion.x = x;
    motion.gravity = from.body.gravity;
    motion.start = from.view;
    motion.kind = from.rests ? MotionKind::rest : MotionKind::uniform;
    if (from.rests || from.view.c2 == 0) return motion;
    set_motion(motion, phase_start(from));
    motion.kind = motion.phase.rate.rotates ? MotionKind::rotation : MotionKind::libration;
    // The steps end 1e-9 of the path before the tip.
    if (motion.phase.map.has_tail) {
        const auto& [long_axis, short_axis, c2, sin, cos] = from.view;
        motion.phase.quarter_path = path_from_flat(long_axis, short_axis, 1.0, 0.0);
    }
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

double heading(const RollingMotion& motion) { return heading_of<double>(motion); }

QuarterPosition position_at(const RollingFlow& flow, const PhasePoint<double>& phase) {
    const MotionPoint<double> at = motion_point(flow.phase.rate, flow.amplitude, phase);
    return quarter_position(flow.start, at.sin_phi, at.cos_phi);
}

namespace {

// The radius within which a series is as good as a double, beside its own size there: the last
// terms are one rounding then, and what is left out, smaller by another tenth, is less.
double reach(const Series& series) {
    constexpr double rest = 1e-16;  // half an ulp
    double radius = 1.0;
    for (int i = 0; i < 3; ++i) {  // its size depends on the radius, by a small power of it
        const double size = std::max({std::abs(series[0]), std::abs(series[1]) * radius,
                                      std::abs(series[2]) * square(radius)});
        double least = infinity;
        for (const int k : {series_order - 1, series_order}) {
            const double last = std::abs(series[k]);
            if (last > 0) least = std::min(least, std::pow(rest * size / last, 1.0 / k));
        }
        radius = least;
    }
    return radius;
}

// A move so short that one power series knows it: it keeps the digits of what has changed.
std::optional<FlowSample> short_move(const RollingMotion& motion, double t) {
    const auto [unit, short_axis, c2, sin, cos] = motion.start;
    if (!may_be_short(t, motion.omega, motion.gravity, short_axis)) return std::nullopt;
    const double unit2 = square(unit);
    const SeriesConstants body{
        square(short_axis) / unit2, c2 / unit2, motion.gravity * square(t) / unit,
        motion.phase.rate.d0 / square(unit2), motion.phase.rate.d1 / square(unit2)};
    const auto series = motion_series<series_order>(body, sin, cos, motion.omega * t);
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
    PhaseStart<double> from{};
    from.theta = motion.theta;
    from.sin = motion.start.sin;
    from.cos = motion.start.cos;
    FlowSample moved = sample_at<double>(motion, from, t);
    moved.x += motion.x;
    return moved;
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
        half_turns = on_way_back == flow.on_way_back ? 0.0 : 1.0;
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
