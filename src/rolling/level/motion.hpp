// An exact rolling motion, computed from the change of its phase since the start, or from power
// series in time about one of its points. The bits are the same for one body or point (T = double)
// as for several side by side.
#pragma once

#include <array>

#include "numerics/series.hpp"
#include "rolling/level/flow.hpp"
#include "rolling/level/time.hpp"

namespace rolling_ellipse {
namespace {

// The values of a RollingStart, for one body or for one body in each lane.
template <class T>
struct PhaseStart {
    T long_axis, short_axis, c2;
    T sin, cos;  // sine and cosine of the angle from the flat position
    T gyration2, gravity;
    T theta, omega;
    T total, over_tip, over_flat;  // H, H - L and H - S
};

inline PhaseStart<double> phase_start(const RollingStart& from) {
    const FlatView& view = from.view;
    const EnergyHeight& height = from.height;
    return {view.long_axis, view.short_axis,     view.c2,           view.sin,
            view.cos,       from.body.gyration2, from.body.gravity, from.theta,
            from.omega,     height.total,        height.over_tip,   height.over_flat};
}

inline void set_lane(PhaseStart<Pack>& start, int lane, const PhaseStart<double>& from) {
    constexpr int count = sizeof from / sizeof(double);
    static_assert(sizeof start == count * sizeof(Pack));
    double numbers[count];
    Pack packs[count];
    __builtin_memcpy(numbers, &from, sizeof from);
    __builtin_memcpy(packs, &start, sizeof start);
    for (int i = 0; i < count; ++i) set_lane(packs[i], lane, numbers[i]);
    __builtin_memcpy(&start, packs, sizeof start);
}

// The constants of the energy integral, physics (28, 29); see rolling/level/flow.hpp.
template <class T>
inline PhaseIntegrand<T> phase_integrand(const PhaseStart<T>& at) {
    const auto rotates = (at.over_tip >= 0) & (at.omega != 0);
    const T s2 = at.short_axis * at.short_axis;
    const T l2 = at.long_axis * at.long_axis;
    const T flat2 = at.over_flat * (at.total + at.short_axis);    // H^2 - S^2
    const T tip2 = abs(at.over_tip) * (at.total + at.long_axis);  // |H^2 - L^2|
    const T unit = rotates ? flat2 : at.c2;
    PhaseIntegrand<T> integrand;
    integrand.short_axis = at.short_axis;
    integrand.c2 = at.c2;
    integrand.energy_height = at.total;
    integrand.amplitude2 = min<T>(flat2 / unit, filled<T>(1.0));
    integrand.scale2 = 1 / (2 * at.gravity * unit);
    integrand.kappa = min<T>(sqrt(tip2 / unit), filled<T>(1.0));
    integrand.d0 = s2 * (at.gyration2 + s2);
    integrand.d1 = at.c2 * (at.gyration2 + l2 + s2);
    integrand.rotates = rotates;
    return integrand;
}

// The factor scale sqrt(D (H + h)) at an angle phi, given sin phi: physics (28, 29).
template <class C, class T>
inline T shape_factor(const PhaseIntegrand<C>& integrand, T sin_phi) {
    const T sin2 = sin_phi * sin_phi;
    const T h2 = integrand.short_axis * integrand.short_axis + integrand.c2 * sin2;
    return sqrt(integrand.scale2 * (integrand.d0 + integrand.d1 * sin2) *
                (integrand.energy_height + sqrt(h2)) / h2);
}

// Sets the motion from a given start, except for the time and path of a quarter turn.
template <class T>
void set_motion(PhaseMotion<T>& motion, const PhaseStart<T>& at) {
    PhaseIntegrand<T>& integrand = motion.phase.integrand;
    PhaseMap<T>& map = motion.phase.map;
    integrand = phase_integrand(at);
    set_phase_map<T>(map, integrand.kappa,
                     sqrt(integrand.d0 / (integrand.d1 * integrand.amplitude2 + integrand.d0)));
    const auto rotates = integrand.rotates;
    const T factor = shape_factor(integrand, at.sin);
    const T one = filled<T>(1.0);
    motion.direction = rotates ? copysign(one, at.omega) : one;
    // Sine and cosine of the initial phase, times the amplitude; the cosine is negative on the way
    // back.
    const T sin = motion.direction * at.sin;
    const T cos = rotates ? at.cos : at.omega * factor;
    motion.amplitude = sqrt(sin * sin + cos * cos);
    // A body released from rest with sin > 0 is at its turning point and counts as being on the way
    // back.
    const auto rests_beyond = (cos == 0) & (sin > 0) & negated(rotates);
    motion.on_way_back = (cos < 0) | rests_beyond;
    motion.start_phase = {motion.on_way_back ? -sin : sin, abs(cos)};
    motion.start_place = place_of(map, motion.start_phase);
    const T graded = map.grade * cos;
    motion.start_slope = factor * map.speed * sqrt(graded * graded + sin * sin) / motion.amplitude;
    motion.phase.half_turn = {T{}, T{}};
    motion.phase.quarter_path = T{};
}

// Whether a move is so short that it does not need the time of a quarter. Since dt/dy falls no
// faster than e^(-2y), such a move covers less than 0.81 in y, whereas half a quarter is at least
// 0.86.
template <class T>
inline Mask<T> is_short(const PhaseMotion<T>& motion, T t) {
    constexpr double at_first_speed = 0.4;  // distance in y if dt/dy stayed constant
    return abs(t) < at_first_speed * motion.start_slope;
}

// Angle from the flat position and angular velocity at a point of a motion.
template <class T>
struct MotionPoint {
    T sin_phi;
    T cos_phi;
    T omega;
};

// The point of a motion at a given phase on the way up, computed from the energy integral, physics
// (30).
template <class C, class T>
inline MotionPoint<T> motion_point(const PhaseIntegrand<C>& integrand, C amplitude,
                                   const PhasePoint<T>& at) {
    const T sin_phi = integrand.rotates ? at.sin : amplitude * at.sin;
    const T factor = shape_factor(integrand, sin_phi);
    const T across = integrand.kappa * at.sin;
    const T root = sqrt(at.cos * at.cos + across * across);
    return {sin_phi, integrand.rotates ? at.cos : root,
            (integrand.rotates ? root : amplitude * at.cos) / factor};
}

// The sign, +1 or -1, by which angles and angular velocities differ from those on the way up.
template <class T>
inline T heading_of(const PhaseMotion<T>& motion) {
    const T libration = motion.on_way_back ? filled<T>(-1.0) : filled<T>(1.0);
    return motion.phase.integrand.rotates ? motion.direction : libration;
}

// The state at a time t, with x as the path from the start. Unless the move is short, `set_quarter`
// must have been called.
template <class T>
MotionSample<T> sample_at(const PhaseMotion<T>& motion, const PhaseStart<T>& from, T t) {
    const PhaseTime<T>& phase = motion.phase;
    const auto rotates = phase.integrand.rotates;
    const T factor = rotates ? filled<T>(1.0) : filled<T>(2.0);
    // Whole half turns of a rotation, or whole swings of a libration, are subtracted from the time.
    const TwoParts<T> turn = {factor * phase.half_turn.high, factor * phase.half_turn.low};
    const auto near = is_short(motion, t);
    const T turns = near ? T{} : nearest<T>(t / turn.high);
    const TwoParts<T> in_turns = two_product(turns, turn.high);
    const T rest = ((t - in_turns.high) - in_turns.low) - turns * turn.low;
    const T time = turns != 0 ? rest : t;
    const PhasePlace<T>& start = motion.start_place;
    T guess{};
    if (any(near)) guess = short_distance(phase, start, motion.start_slope, time);
    if (any(negated(near))) guess = near ? guess : rough_distance(phase, start, time);
    const auto [to, gain] = move(phase, start, guess, time);
    const T heading = heading_of(motion);
    const MotionPoint<T> now =
        motion_point(phase.integrand, motion.amplitude, phase_point(phase.map, to));

    const T sin_phi = heading * now.sin_phi;
    const T swung = angle_of<T>(sin_phi * from.cos - now.cos_phi * from.sin,
                                now.cos_phi * from.cos + sin_phi * from.sin);
    const TwoParts<T> whole = two_product(2 * turns, filled<T>(half_pi_exact.high));
    const TwoParts<T> whole_turns =
        quick_two_sum(whole.high, whole.low + 2 * turns * half_pi_exact.low);
    TwoParts<T> turned = whole_turns + gain.angle;
    const auto is_endless = rotates & negated(near) & (phase.half_turn.high == infinity);
    if (any(is_endless & (now.sin_phi > now.cos_phi))) {  // the body approaches the tip forever
        const PhasePoint<T>& first = motion.start_phase;
        const T rest = angle_of(now.cos_phi, now.sin_phi) + angle_of(first.sin, first.cos);
        turned = two_sum(filled<T>(half_pi_exact.high), -rest);
        turned.low = turned.low + half_pi_exact.low;
    }
    const TwoParts<T> rolled =
        TwoParts<T>{heading * turned.high, heading * turned.low} + from.theta;

    // In a libration, a point beyond a turning point is the mirror image of a point before it. The
    // path is integrated only up to that earlier point, since the path from there to the turning
    // point and back is 0.
    const auto turned_back = (now.omega < 0) & negated(rotates);
    T path = gain.path;
    if (any(turned_back)) {
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

template <class T, int order>
struct MotionSeries {
    std::array<T, order + 1> angle;
    std::array<T, order + 1> omega;
    std::array<T, order + 1> path;
};

// The constants of a motion's series; `time_unit` is in seconds.
inline SeriesConstants series_constants(const RollingStart& from,
                                        const PhaseIntegrand<double>& integrand, double time_unit) {
    const double length = from.view.long_axis;
    const double area = length * length;
    return {integrand.short_axis / length * (integrand.short_axis / length), integrand.c2 / area,
            from.body.gravity * (time_unit * time_unit) / length, integrand.d0 / (area * area),
            integrand.d1 / (area * area)};
}

// The series about a point, given its angular velocity and the sine and cosine of its angle from
// the flat position. They follow from physics (18). With this angle phi, u = h^2, q = sin^2 phi, p
// = sin phi cos phi and D h^2 = d0 + d1 q:
//     omega' u (d0 + d1 q) = -c2 p (g u h + S^2 omega^2),   q' = 2 p omega,   p' = (1 - 2 q) omega
template <int order, class T>
inline MotionSeries<T, order> motion_series(const SeriesConstants& body, T sin, T cos, T omega) {
    MotionSeries<T, order> motion;
    std::array<T, order + 1> q, p, u, h, inertia, mass, push, turning;
    auto& w = motion.omega;
    T over_2h{}, over_mass{};
    q[0] = sin * sin;
    p[0] = sin * cos;
    w[0] = omega;
    motion.angle[0] = motion.path[0] = T{};
#pragma GCC unroll 20
    for (int k = 0; k < order; ++k) {
        u[k] = body.c2 * q[k];
        inertia[k] = body.d1 * q[k];
        if (k == 0) {
            u[0] += body.short_axis2;
            inertia[0] += body.d0;
            h[0] = sqrt(u[0]);
            over_2h = 0.5 / h[0];
            over_mass = 1 / (u[0] * inertia[0]);
        } else {
            h[k] = (u[k] - self_product(h, k, 1)) * over_2h;
        }
        mass[k] = product(u, inertia, k);
        push[k] = body.gravity * product(u, h, k) + body.short_axis2 * self_product(w, k);
        const T force = -body.c2 * product(p, push, k);
        turning[k] = (force - terms(mass, turning, k, 1, k)) * over_mass;
        const T qw = product(q, w, k);
        const double next = 1.0 / (k + 1);
        q[k + 1] = 2 * next * product(p, w, k);
        p[k + 1] = next * (w[k] - 2 * qw);
        w[k + 1] = next * turning[k];
        motion.angle[k + 1] = next * w[k];
        motion.path[k + 1] = next * product(h, w, k);
    }
    return motion;
}

}  // namespace
}  // namespace rolling_ellipse
