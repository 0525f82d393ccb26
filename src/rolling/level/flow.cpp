#include "rolling/level/flow.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "rolling/level/motion.hpp"

namespace rolling_ellipse {
namespace {

// The energy as a height [m] above the ground, above the tip and above the flat position, physics
// (26).
EnergyHeight energy_height(const FlatView& at, const Body& body, double omega) {
    const double h2 = square(at.short_axis) + at.c2 * square(at.sin);
    const double h = std::sqrt(h2);
    const double dh = at.c2 * at.sin * at.cos / h;
    const double kinetic = (body.gyration2 + h2 + square(dh)) * square(omega) / (2 * body.gravity);
    return {kinetic + h, kinetic - under_tip(at, h), kinetic + over_flat(at, h)};
}

// Whether the last two terms of a series, evaluated at 1, are at most half an ulp of the largest of
// its first three terms. The omitted terms are about a tenth of that.
bool is_complete(const Series& series) {
    constexpr double half_ulp = 1e-16;
    const double size = std::max({std::abs(series[0]), std::abs(series[1]), std::abs(series[2])});
    const double last =
        std::max(std::abs(series[series_order - 1]), std::abs(series[series_order]));
    return last <= half_ulp * size;
}

// The state after a short move, from a single power series, which keeps small changes accurate.
// Empty if the move is too long for one series, and in the cases that need none: a body at rest, a
// circle and t = 0.
std::optional<FlowSample> short_move(const RollingStart& from, double x, double t) {
    const auto [unit, short_axis, c2, sin, cos] = from.view;
    if (from.rests || c2 == 0 || t == 0 || !may_be_short(from, t)) return std::nullopt;
    const SeriesConstants body = series_constants(from, phase_integrand(phase_start(from)), t);
    const auto series = motion_series<series_order>(body, sin, cos, from.omega * t);
    if (!is_complete(series.angle) || !is_complete(series.omega)) return std::nullopt;
    Series gain = series.omega;
    gain[0] = 0.0;
    return FlowSample{from.theta + value(series.angle, 1.0), from.omega + value(gain, 1.0) / t,
                      x + unit * value(series.path, 1.0)};
}

// The state after a move for which `short_move` is empty.
FlowSample long_move(const RollingFlow& flow, double t) {
    const auto& [body, theta, omega, view, height, rests] = flow.from;
    if (flow.kind == MotionKind::rest || t == 0) return {theta, omega, flow.x};
    if (flow.kind == MotionKind::uniform) {
        const double turn = omega * t;
        return {theta + turn, omega, flow.x + view.long_axis * turn};
    }
    FlowSample moved = sample_at<double>(flow, phase_start(flow.from), t);
    moved.x += flow.x;
    return moved;
}

// A motion, complete except for the time and path of a quarter turn.
RollingFlow flow_of(const RollingStart& from, double x) {
    RollingFlow flow;
    flow.kind = from.rests ? MotionKind::rest : MotionKind::uniform;
    flow.from = from;
    flow.x = x;
    flow.start_slope = 0.0;
    if (from.rests || from.view.c2 == 0) return flow;
    set_motion(flow, phase_start(from));
    flow.kind = flow.phase.integrand.rotates ? MotionKind::rotation : MotionKind::libration;
    return flow;
}

void set_quarter(RollingFlow& flow) {
    if (flow.kind == MotionKind::rest || flow.kind == MotionKind::uniform) return;
    set_quarter(flow.phase);
    // In a map with a tail, the steps omit 1e-9 of the path of the quarter, which is therefore
    // recomputed.
    if (flow.phase.map.has_tail) {
        flow.phase.quarter_path = path_from_flat(flow.from.view.lying(), 1.0, 0.0);
    }
}

}  // namespace

RollingStart rolling_start(const Body& body, double theta, double omega) {
    omega = zero_if_negligible(omega);
    FlatView view = flat_view(body.axes(), theta);
    // On the tip, the sign of phi is chosen so that the body moves down. Motions to the two sides
    // are then exact mirror images.
    if (view.cos == 0 && omega != 0) view.sin = -std::copysign(1.0, omega);
    const bool rests = omega == 0 && is_equilibrium(geometry(body.axes(), theta));
    return {body, theta, omega, view, energy_height(view, body, omega), rests};
}

RollingFlow rolling_flow(const RollingStart& from, double x) {
    RollingFlow flow = flow_of(from, x);
    set_quarter(flow);
    return flow;
}

FlowSample sample(const RollingFlow& flow, double t) {
    if (const auto moved = short_move(flow.from, flow.x, t)) return *moved;
    return long_move(flow, t);
}

FlowSample sample_alone(const RollingStart& from, double t) {
    if (const auto moved = short_move(from, 0.0, t)) return *moved;
    RollingFlow flow = flow_of(from, 0.0);
    if (!is_short(flow, t)) {
        set_quarter(flow);
        validate_time(t, longest_time(flow));
    }
    return long_move(flow, t);
}

double longest_time(const RollingFlow& flow) { return 1e15 * (0.5 * period(flow)); }

void validate_time(double t, double longest, const std::string& name) {
    if (!std::isfinite(t)) refuse(name, "finite [s]", t);
    if (std::abs(t) > longest) {
        refuse(name, "at most 1e15 half turns or half swings, " + text(longest) + " [s]", t);
    }
}

double period(const RollingFlow& flow) {
    if (flow.kind == MotionKind::rest) return infinity;
    if (flow.kind == MotionKind::uniform) return 2 * pi / std::abs(flow.from.omega);
    return 2 * double(flow.phase.half_turn);
}

DoubleDouble time_since_flat(const RollingFlow& flow, const PhasePoint<double>& phase) {
    const PhasePlace<double> at = place_of(flow.phase.map, phase);
    const double time = integral_between(flow.phase, at.quarters, 0.0, at.offset).sum.time;
    if (at.quarters == 0) return {time, 0.0};
    return flow.phase.quarter_turn * at.quarters + time;
}

double time_of_passing(const RollingFlow& flow, double theta, double heading) {
    const double turn = theta - flow.from.theta;
    const FlatView& at = flow.from.view;
    double sin = at.sin * std::cos(turn) + at.cos * std::sin(turn);
    double cos = at.cos * std::cos(turn) - at.sin * std::sin(turn);
    double half_turns = 0.0;
    if (flow.kind == MotionKind::rotation) {
        const double end_angle = std::atan2(at.sin, at.cos) + turn;
        half_turns = std::nearbyint(flow.direction * end_angle / pi);
        sin = flow.direction * (cos < 0 ? -sin : sin);
        cos = std::abs(cos);
    } else {
        // amplitude^2 - sin^2 = cos^2 - kappa^2: the difference of the smaller numbers is more
        // accurate.
        const double amplitude = flow.amplitude;
        const double kappa = flow.phase.integrand.kappa;
        const double left = std::abs(sin) < cos ? (amplitude - sin) * (amplitude + sin)
                                                : (cos - kappa) * (cos + kappa);
        sin = std::clamp(sin / amplitude, -1.0, 1.0);
        cos = std::sqrt(std::max(left, 0.0)) / amplitude;
        const bool on_way_back = heading < 0;
        if (on_way_back) sin = -sin;
        half_turns = on_way_back == flow.on_way_back ? 0.0 : 1.0;
    }
    DoubleDouble time = time_since_flat(flow, {sin, cos}) - time_since_flat(flow, flow.start_phase);
    // An angle passed in the same direction just before the start is passed again one swing later.
    if (flow.kind == MotionKind::libration && half_turns == 0 && time.high < 0) half_turns = 2.0;
    if (half_turns != 0) {
        if (std::isinf(flow.phase.half_turn.high)) return infinity;
        time = time + flow.phase.half_turn * half_turns;
    }
    return std::max(double(time), 0.0);
}

}  // namespace rolling_ellipse
