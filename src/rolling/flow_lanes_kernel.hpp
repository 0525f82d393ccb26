// The states of several bodies side by side, each at its own time: what rolling/flow.cpp does for
// one. Included by one file for every vector level.
#pragma once

#include "geometry/path_lanes.hpp"
#include "rolling/flow_lanes.hpp"
#include "rolling/phase_time_lanes.hpp"

namespace rolling_ellipse {
namespace {

// As many bodies as there are lanes.
struct Bodies {
    PackAxes axes;
    Pack long_axis, short_axis;
    Pack gyration2, gravity;
    Pack theta, omega;
    Pack sin, cos;                    // of the angle from the flat position
    Pack total, over_tip, over_flat;  // heights of the energy
    Pack t;
};

// From `first` on; the last one fills lanes that are left.
inline Bodies gathered(const detail::LaneBodies& from, int first) {
    Bodies bodies;
    for (int lane = 0; lane < lanes; ++lane) {
        const int at = first + lane < from.count ? first + lane : from.count - 1;
        const RollingStart& start = from.starts[from.places[at]];
        bodies.long_axis[lane] = start.view.long_axis;
        bodies.short_axis[lane] = start.view.short_axis;
        bodies.axes.c2[lane] = start.view.c2;
        bodies.gyration2[lane] = start.body.gyration2;
        bodies.gravity[lane] = start.body.gravity;
        bodies.theta[lane] = start.theta;
        bodies.omega[lane] = start.omega;
        bodies.sin[lane] = start.view.sin;
        bodies.cos[lane] = start.view.cos;
        bodies.total[lane] = start.height.total;
        bodies.over_tip[lane] = start.height.over_tip;
        bodies.over_flat[lane] = start.height.over_flat;
        bodies.t[lane] = from.times[from.places[at]];
    }
    bodies.axes.long2 = bodies.long_axis * bodies.long_axis;
    bodies.axes.short2 = bodies.short_axis * bodies.short_axis;
    return bodies;
}

// scale sqrt(D (H + h)) where phi has this sine.
inline Pack shape_factor(const PackAxes& axes, Pack scale2, Pack energy_height, Pack d0, Pack d1,
                         Pack sin) {
    const Pack sin2 = sin * sin;
    const Pack h2 = axes.short2 + axes.c2 * sin2;
    return sqrt(scale2 * (d0 + d1 * sin2) * (energy_height + sqrt(h2)) / h2);
}

// The angle from the nearest flat position or tip, and the path there; which of them it is.
struct LanePosition {
    Pack quarters;
    Pack angle;
    Pack path;
};

inline LanePosition quarter_position(const PackAxes& axes, Pack sin, Pack cos) {
    const Pack s = abs(sin);
    const Mask near_tip = s > cos;
    const Pack over_sin = near_tip ? cos : s;
    const Pack over_cos = near_tip ? s : cos;
    const Pack side = copysign(pack(1.0), sin);
    const Pack sign = near_tip ? -side : side;
    return {near_tip ? side : Pack{}, sign * octant_angle(over_sin, over_cos),
            sign * path(axes, near_tip, over_sin, over_cos)};
}

struct LaneSamples {
    Pack theta;
    Pack omega;
    Pack x;
    Pack loss;
};

inline LaneSamples sample(const GaussRule& rule, const LegendreTable& table, const Bodies& of) {
    const PackAxes& axes = of.axes;
    const Mask rotates = (of.over_tip >= 0) & (of.omega != 0);
    const Pack one = pack(1.0);

    // physics (28, 29)
    const Pack flat2 = of.over_flat * (of.total + of.short_axis);    // H^2 - S^2
    const Pack tip2 = abs(of.over_tip) * (of.total + of.long_axis);  // |H^2 - L^2|
    const Pack inverse_unit = 1 / (rotates ? flat2 : axes.c2);
    const Pack scale2 = inverse_unit / (2 * of.gravity);
    const Pack amplitude2 = rotates ? one : min(flat2 / axes.c2, one);
    const Pack kappa2 = min(tip2 * inverse_unit, one);
    const Pack d0 = axes.short2 * (of.gyration2 + axes.short2);
    const Pack d1 = axes.c2 * (of.gyration2 + axes.long2 + axes.short2);

    LanePhase phase;
    const Pack h2_tip = axes.short2 + axes.c2 * amplitude2;
    const Pack d_tip = d0 + d1 * amplitude2;
    const Pack flat_grade2 = d0 / d_tip;
    phase.flat.grade = sqrt(flat_grade2);
    phase.flat.rate = {scale2, of.total, axes.short2, h2_tip, d0, d_tip, flat_grade2, one, kappa2};
    phase.tip.grade = sqrt(kappa2);
    phase.tip.rate = {scale2, of.total, h2_tip, axes.short2, d_tip, d0, one, Pack{}, Pack{}};
    integrate_half(rule, phase.flat);
    integrate_half(rule, phase.tip);
    phase.split = phase.flat.end_time + phase.flat.rise_time;
    phase.quarter_turn = phase.split + (phase.tip.end_time + phase.tip.rise_time);
    phase.half_turn = {2 * phase.quarter_turn.high, 2 * phase.quarter_turn.low};

    // The start as a phase, times the amplitude.
    const Pack direction = rotates ? copysign(one, of.omega) : one;
    const Pack start_sin = direction * of.sin;
    const Pack start_cos =
        rotates ? of.cos : of.omega * shape_factor(axes, scale2, of.total, d0, d1, of.sin);
    const Pack amplitude = sqrt(start_sin * start_sin + start_cos * start_cos);
    const Mask on_way_back = start_cos < 0;
    const PackPair from_flat = time_since_flat(rule, phase, abs(start_sin), abs(start_cos));
    const Mask before_flat = (start_sin < 0) != on_way_back;
    const PackPair start_time = select(before_flat, -from_flat, from_flat);

    // Whole half turns first: t - n T is formed without rounding.
    Pack half_turns = nearest(of.t / phase.half_turn.high);
    const PackPair whole = two_product(-half_turns, phase.half_turn.high);
    PackPair time = start_time + two_sum(of.t, whole.high) + whole.low +
                    two_product(-half_turns, phase.half_turn.low);
    const Mask over = rounded(PackPair{2 * time.high, 2 * time.low} - phase.half_turn) > 0;
    time = select(over, time - phase.half_turn, time);
    half_turns = over ? half_turns + 1 : half_turns;
    const Mask under = rounded(PackPair{2 * time.high, 2 * time.low} + phase.half_turn) < 0;
    time = select(under, time + phase.half_turn, time);
    half_turns = under ? half_turns - 1 : half_turns;
    const Mask odd = nearest(0.5 * half_turns) != 0.5 * half_turns;
    const Pack heading = rotates ? direction : ((odd == on_way_back) ? one : -one);

    const Mask before = time.high < 0;
    const LanePoint at = point_at_time(rule, table, phase, select(before, -time, time));
    const Pack at_sin = before ? -at.sin : at.sin;

    // physics (30), the energy integral at the point itself
    const Pack up_sin = (rotates ? one : amplitude) * at_sin;
    const Pack factor = shape_factor(axes, scale2, of.total, d0, d1, up_sin);
    const Pack root = sqrt(at.cos * at.cos + kappa2 * (at.sin * at.sin));
    const Pack omega = heading * ((rotates ? root : amplitude * at.cos) / factor);
    const LanePosition to = quarter_position(axes, heading * up_sin, rotates ? at.cos : root);
    LanePosition from{};
    if (any(of.sin != 0)) from = quarter_position(axes, of.sin, of.cos);

    const Pack turns = rotates ? 2 * heading * half_turns : Pack{};
    const Pack quarters = turns + (to.quarters - from.quarters);
    const Pack angle = to.angle - from.angle;
    const PackPair quarter_angle = two_product(pack(1.57079632679489655800e+00), quarters);
    const PackPair turned =
        quick_two_sum(quarter_angle.high,
                      quarter_angle.low + 6.12323399573676603587e-17 * quarters) +
        angle;
    const Pack difference = to.path - from.path;
    Pack x = difference;
    if (any(quarters != 0)) {
        const Pack quarter_path = path(axes, Mask{}, one, Pack{});
        const PackPair product = two_product(quarters, quarter_path);
        const PackPair sum = two_sum(product.high, difference);
        x = sum.high + (sum.low + product.low);
    }

    // Over a short time the difference of two paths may cancel. Times that are refused, and steps
    // that did not converge, are left to the way of one alone.
    const Mask is_short = abs(of.t) < 0.5 * phase.quarter_turn.high;
    const Pack loss = is_short ? abs(from.path) / abs(x) : Pack{};
    const Mask refused = abs(of.t) >= 0.999e15 * phase.half_turn.high;
    const Mask usable = at.found & (abs(omega) < 1e300) & ~refused;
    return {rounded(turned + of.theta), omega, x, usable ? loss : pack(infinity)};
}

constexpr LegendreTable legendre_tables[] = {
    legendre_table(detail::lane_rules[0].rule), legendre_table(detail::lane_rules[1].rule),
    legendre_table(detail::lane_rules[2].rule), legendre_table(detail::lane_rules[3].rule),
    legendre_table(detail::lane_rules[4].rule), legendre_table(detail::lane_rules[5].rule),
    legendre_table(detail::lane_rules[6].rule),
};

inline void sample(const detail::LaneBodies& bodies, FlowSample* samples, double* losses) {
    const GaussRule& rule = detail::lane_rules[bodies.rule].rule;
    for (int first = 0; first < bodies.count; first += lanes) {
        const LaneSamples now = sample(rule, legendre_tables[bodies.rule], gathered(bodies, first));
        for (int lane = 0; lane < lanes && first + lane < bodies.count; ++lane) {
            samples[bodies.places[first + lane]] = {now.theta[lane], now.omega[lane], now.x[lane]};
            losses[first + lane] = now.loss[lane];
        }
    }
}

}  // namespace
}  // namespace rolling_ellipse
