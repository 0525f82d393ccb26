// An exact rolling motion by its phase, from its start on: of one body, T = double, or of several
// bodies side by side, with the same bits.
#pragma once

#include "rolling/level/start.hpp"
#include "rolling/level/time.hpp"

namespace rolling_ellipse {
namespace {

// The numbers of a RollingStart.
template <class T>
struct PhaseStart {
    T long_axis, short_axis, c2;
    T sin, cos;  // of the angle from the flat position
    T gyration2, gravity;
    T theta, omega;
    T total, over_tip, over_flat;  // heights of the energy
};

template <class T>
inline void set_lane(PhaseStart<T>& start, int lane, const RollingStart& from) {
    set_lane(start.long_axis, lane, from.view.long_axis);
    set_lane(start.short_axis, lane, from.view.short_axis);
    set_lane(start.c2, lane, from.view.c2);
    set_lane(start.sin, lane, from.view.sin);
    set_lane(start.cos, lane, from.view.cos);
    set_lane(start.gyration2, lane, from.body.gyration2);
    set_lane(start.gravity, lane, from.body.gravity);
    set_lane(start.theta, lane, from.theta);
    set_lane(start.omega, lane, from.omega);
    set_lane(start.total, lane, from.height.total);
    set_lane(start.over_tip, lane, from.height.over_tip);
    set_lane(start.over_flat, lane, from.height.over_flat);
}

inline PhaseStart<double> phase_start(const RollingStart& from) {
    PhaseStart<double> start;
    set_lane(start, 0, from);
    return start;
}

// The constants of the energy integral, physics (28, 29); see rolling/level/phase.hpp.
template <class T>
inline PhaseRate<T> phase_rate(const PhaseStart<T>& at) {
    const auto rotates = (at.over_tip >= 0) & (at.omega != 0);
    const T s2 = at.short_axis * at.short_axis;
    const T l2 = at.long_axis * at.long_axis;
    const T flat2 = at.over_flat * (at.total + at.short_axis);    // H^2 - S^2
    const T tip2 = abs(at.over_tip) * (at.total + at.long_axis);  // |H^2 - L^2|
    const T unit = rotates ? flat2 : at.c2;
    PhaseRate<T> rate;
    rate.short_axis = at.short_axis;
    rate.c2 = at.c2;
    rate.energy_height = at.total;
    rate.amplitude2 = min<T>(flat2 / unit, filled<T>(1.0));
    rate.scale2 = 1 / (2 * at.gravity * unit);
    rate.kappa = min<T>(sqrt(tip2 / unit), filled<T>(1.0));
    rate.d0 = s2 * (at.gyration2 + s2);
    rate.d1 = at.c2 * (at.gyration2 + l2 + s2);
    rate.rotates = rotates;
    return rate;
}

// The factor scale sqrt(D (H + h)) at an angle phi with this sine.
template <class C, class T>
inline T shape_factor(const PhaseRate<C>& rate, T sin_phi) {
    return sqrt(shape_factor2(rate, sin_phi * sin_phi));
}

// Sets the motion of a start.
template <class T>
void set_motion(PhaseMotion<T>& motion, const PhaseStart<T>& at) {
    set_phase_time(motion.phase, phase_rate(at));
    const auto rotates = motion.phase.rate.rotates;
    const T one = filled<T>(1.0);
    motion.direction = rotates ? copysign(one, at.omega) : one;
    // The start as a phase, times the amplitude; the cosine is negative on the way back.
    const T sin = motion.direction * at.sin;
    const T cos = rotates ? at.cos : at.omega * shape_factor(motion.phase.rate, at.sin);
    motion.amplitude = sqrt(sin * sin + cos * cos);
    // A body at rest on the upper side is at its turning point, on the way back.
    const auto rests_beyond = (cos == 0) & (sin > 0) & negated(rotates);
    motion.on_way_back = (cos < 0) | rests_beyond;
    motion.start_phase = {motion.on_way_back ? -sin : sin, abs(cos)};
    motion.start_place = place_of(motion.phase.map, motion.start_phase);
}

// Angle from the flat position and angular velocity at a point of a motion.
template <class T>
struct MotionPoint {
    T sin_phi;
    T cos_phi;
    T omega;
};

// The point of a motion at a phase, on the way up: physics (30), the energy integral at the point.
template <class C, class T>
inline MotionPoint<T> motion_point(const PhaseRate<C>& rate, C amplitude, const PhasePoint<T>& at) {
    const T sin_phi = rate.rotates ? at.sin : amplitude * at.sin;
    const T factor = shape_factor(rate, sin_phi);
    const T across = rate.kappa * at.sin;
    const T root = sqrt(at.cos * at.cos + across * across);
    return {sin_phi, rate.rotates ? at.cos : root,
            (rate.rotates ? root : amplitude * at.cos) / factor};
}

// Sign of the motion at its start, for angles and for omega: +1 or -1.
template <class T>
inline T heading_of(const PhaseMotion<T>& motion) {
    const T libration = motion.on_way_back ? filled<T>(-1.0) : filled<T>(1.0);
    return motion.phase.rate.rotates ? motion.direction : libration;
}

// The state at a time; x is the path since the start.
template <class T>
MotionSample<T> sample_at(const PhaseMotion<T>& motion, const PhaseStart<T>& from, T t) {
    const PhaseTime<T>& phase = motion.phase;
    const auto rotates = phase.rate.rotates;
    const T factor = rotates ? filled<T>(1.0) : filled<T>(2.0);
    // The time without whole turns, or swings.
    const TwoParts<T> turn = {factor * phase.half_turn.high, factor * phase.half_turn.low};
    const T turns = nearest<T>(t / turn.high);
    const TwoParts<T> in_turns = two_product(turns, turn.high);
    const T rest = ((t - in_turns.high) - in_turns.low) - turns * turn.low;
    const T time = turns != 0 ? rest : t;
    const auto [to, gain] = move(phase, motion.start_place, time);
    const T heading = heading_of(motion);
    const MotionPoint<T> now =
        motion_point(phase.rate, motion.amplitude, phase_point(phase.map, to));

    const T sin_phi = heading * now.sin_phi;
    const T swung = angle_of<T>(sin_phi * from.cos - now.cos_phi * from.sin,
                                now.cos_phi * from.cos + sin_phi * from.sin);
    const TwoParts<T> whole = two_product(2 * turns, filled<T>(half_pi_exact.high));
    const TwoParts<T> whole_turns =
        quick_two_sum(whole.high, whole.low + 2 * turns * half_pi_exact.low);
    TwoParts<T> turned = whole_turns + gain.angle;
    const auto creeps = (phase.half_turn.high > largest_finite) & (now.sin_phi > now.cos_phi);
    if (any(creeps & rotates)) {  // to the tip
        const PhasePoint<T>& start = motion.start_phase;
        const T rest = angle_of(now.cos_phi, now.sin_phi) + angle_of(start.sin, start.cos);
        const TwoParts<T> crept = two_sum(filled<T>(half_pi_exact.high), -rest);
        turned.high = creeps ? crept.high : turned.high;
        turned.low = creeps ? crept.low + half_pi_exact.low : turned.low;
    }
    const TwoParts<T> rolled =
        TwoParts<T>{heading * turned.high, heading * turned.low} + from.theta;

    // The place of a libration beyond a turning point is the mirror image before it. The path
    // between the places leaves out the way to the turning point and back, which cancels.
    const auto turned_back = (now.omega < 0) & negated(rotates);
    T path = gain.path;
    if (any(turned_back)) {
        const PhasePlace<T>& start = motion.start_place;
        const T side = copysign(filled<T>(1.0), to.quarters != 0 ? to.quarters : to.offset);
        const T distance = (2 * side - to.quarters - start.quarters) * phase.map.quarter -
                           (to.offset + start.offset);
        const T end = start.offset + (turned_back ? distance : T{});
        const T between = integral_between(phase, start.quarters, start.offset, end).sum.path;
        path = turned_back ? between : path;
    }
    const TwoParts<T> paths = two_product(2 * turns, phase.quarter_path);
    const TwoParts<T> sum = two_sum(paths.high, path);
    const T rolled_path = sum.high + (sum.low + paths.low);
    return {rotates ? rolled.high + rolled.low : from.theta + swung, heading * now.omega,
            heading * (rotates ? rolled_path : path)};
}

}  // namespace
}  // namespace rolling_ellipse
