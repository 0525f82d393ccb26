// Time as a function of the phase of an exact rolling motion, and its inverse, from integrals of
// the rates of rolling/level/rates.hpp.
//
// dt/dy is even about the flat position and about the tip or turning point, and analytic for
// |Im y| < pi/2. Therefore, the trapezoidal rule gives the time of a quarter with an error that
// falls like exp(-pi^2/step) (L. N. Trefethen, J. A. C. Weideman, SIAM Rev. 56 (2014) 385). A part
// of a quarter is integrated from its start by Gauss-Legendre quadrature, so that a short interval
// has the same relative accuracy as a long one.
#pragma once

#include <array>
#include <iterator>

#include "numerics/gauss_legendre.hpp"
#include "rolling/level/rates.hpp"

namespace rolling_ellipse {
namespace {

// Adds a term to a sum; `low` collects the rounding errors.
template <class T>
inline void add(TwoParts<T>& sum, T term) {
    const TwoParts<T> next = two_sum(sum.high, term);
    sum = {next.high, sum.low + next.low};
}

constexpr double longest_panel = 6.0;
constexpr int most_pairs = most_places / 2;

// The longest intervals on which the tabulated rules have full double precision, in units of twice
// the distance to the nearest complex singularity. The error falls like rho^(-2n). Here rho is the
// sum of the semi-axes, in units of half the interval, of the ellipse whose foci are the ends of
// the interval and whose minor semi-axis is that distance (L. N. Trefethen, SIAM Rev. 50 (2008) 67,
// theorem 4.5): rho = exp(asinh(1/length)).
constexpr std::array<double, std::size(gauss_rules)> longest_lengths = [] {
    constexpr double log_accuracy = 38.0;  // -ln(3e-17), for a relative error of 3e-17
    std::array<double, std::size(gauss_rules)> lengths{};
    for (std::size_t i = 0; i < lengths.size(); ++i) {
        const double x = log_accuracy / (2 * gauss_rules[i].size);
        double sinh = x;
        double term = x;
        for (int k = 2; k < 60; k += 2) sinh += term *= x * x / (k * (k + 1));
        lengths[i] = 1 / sinh;
    }
    return lengths;
}();

// Gauss-Legendre rules as pairs of nodes -x and +x, one rule in each lane. Shorter rules are padded
// with zeros.
template <class T>
struct NodePairs {
    int count;
    T nodes[most_pairs];
    T weights[most_pairs];
};

// Sets the smallest rule with full double precision for panels of this length, or the largest rule
// if none is precise enough.
template <class T>
inline void set_rules(NodePairs<T>& pairs, T length) {
    T index{};
    for (std::size_t i = 0; i + 1 < longest_lengths.size(); ++i) {
        const auto is_longer = length > longest_lengths[i];
        if (!any(is_longer)) break;
        index = is_longer ? index + 1 : index;
    }
    pairs.count = (gauss_rules[static_cast<int>(largest(index))].size + 1) / 2;
    for (int lane = 0; lane < lanes_of<T>; ++lane) {
        const GaussRule& rule = gauss_rules[static_cast<int>(lane_of(index, lane))];
        for (int i = 0; i < pairs.count; ++i) {
            const double weight = rule.weights[i];
            set_lane(pairs.nodes[i], lane, rule.nodes[i]);
            set_lane(pairs.weights[i], lane, rule.nodes[i] == 0 ? 0.5 * weight : weight);
        }
    }
}

// Time, angle and path over an interval of y, and the rates at the end of the interval.
template <class T>
struct Integral {
    PhaseIncrement<T> sum;
    PhaseIncrement<T> end;
};

// Integrates from one offset to another, panel by panel.
template <class T>
Integral<T> integral_by_panels(const PhaseTime<T>& phase, T quarters, T begin, T end) {
    const T panels = 1 + rounded_down<T>(abs<T>(end - begin) / longest_panel);
    const T half = 0.5 * (end - begin) / panels;
    NodePairs<T> pairs;
    set_rules<T>(pairs, abs(half) * (2 / pi));
    const int count = pairs.count;
    T offsets[most_places];
    PhaseRates<T> rates;
    TwoParts<T> time{}, angle{}, path{};
    const int most_panels = static_cast<int>(largest(panels));
    for (int panel = 0; panel < most_panels; ++panel) {
        const auto is_inside = panels > panel;
        const T middle = is_inside ? begin + (2 * panel + 1) * half : end;
        for (int i = 0; i < count; ++i) {
            offsets[2 * i] = middle - half * pairs.nodes[i];
            offsets[2 * i + 1] = middle + half * pairs.nodes[i];
        }
        offsets[2 * count] = end;
        phase_rates(phase.integrand, phase.map, quarters, offsets, 2 * count + 1, rates);
        for (int i = 0; i < count; ++i) {
            const T weight = is_inside ? pairs.weights[i] : T{};
            add<T>(time, weight * (rates.time[2 * i] + rates.time[2 * i + 1]));
            add<T>(angle, weight * (rates.angle[2 * i] + rates.angle[2 * i + 1]));
            add<T>(path, weight * (rates.path[2 * i] + rates.path[2 * i + 1]));
        }
    }
    return {{half * (time.high + time.low), half * (angle.high + angle.low),
             half * (path.high + path.low)},
            {rates.time[2 * count], rates.angle[2 * count], rates.path[2 * count]}};
}

// Integrates from one offset to another. None of the motions has a tail.
inline Integral<Pack> integral_between(const PhaseTime<Pack>& phase, Pack quarters, Pack begin,
                                       Pack end) {
    return integral_by_panels<Pack>(phase, quarters, begin, end);
}

// Integrates from one offset to another. Near the separatrix, the body is on the tip to within
// rounding over a long interval of y, where only the time changes, at a constant rate.
inline Integral<double> integral_between(const PhaseTime<double>& phase, double quarters,
                                         double begin, double end) {
    constexpr double long_interval = 12.0;
    const PhaseMap<double>& map = phase.map;
    const double edge = 2 * (map.steps * map.step);
    if (map.quarter <= edge || abs(end - begin) <= long_interval) {
        return integral_by_panels(phase, quarters, begin, end);
    }
    // Only the time grows where `from` <= |offset| <= `to`.
    const double from = quarters == 0 ? edge : 0.0;
    const double to = quarters == 0 ? 2 * map.quarter - edge : map.quarter - edge;
    for (const double limit : {-to, -from, from, to}) {
        if (limit == 0 || !(limit > min(begin, end) && limit < max(begin, end))) continue;
        const Integral<double> first = integral_between(phase, quarters, begin, limit);
        const Integral<double> second = integral_between(phase, quarters, limit, end);
        return {{first.sum.time + second.sum.time, first.sum.angle + second.sum.angle,
                 first.sum.path + second.sum.path},
                second.end};
    }
    const double middle = abs(0.5 * (begin + end));
    if (!(middle >= from && middle <= to)) return integral_by_panels(phase, quarters, begin, end);
    const PhaseIncrement<double> slope = integral_by_panels(phase, quarters, end, end).end;
    return {{(end - begin) * slope.time, 0.0, 0.0}, slope};
}

// dt/dy, and the time since the start of a step, from a cubic for dt/dy and from its integral.
template <class T>
struct Cubic {
    T slope;
    T time;
};

template <class T>
inline Cubic<T> in_step(const PhaseTime<T>& phase, T i, T s) {
    const T before = element(phase.slope, i);
    const T f0 = element(phase.slope + 1, i);
    const T f1 = element(phase.slope + 2, i);
    const T after = element(phase.slope + 3, i);
    const T m0 = 0.5 * (f1 - before);
    const T m1 = 0.5 * (after - f0);
    const T p2 = 3 * (f1 - f0) - 2 * m0 - m1;
    const T p3 = m0 + m1 - 2 * (f1 - f0);
    return {f0 + s * (m0 + s * (p2 + s * p3)),
            phase.map.step * s * (f0 + s * (m0 / 2 + s * (p2 / 3 + s * p3 / 4)))};
}

// dt/dy and the time since the flat position at 0 <= y <= Y, accurate to a few digits.
template <class T>
inline Cubic<T> rough_time(const PhaseTime<T>& phase, T y) {
    const PhaseMap<T>& map = phase.map;
    const T end = map.steps * map.step;
    const T last = map.steps;
    const T steps = y / map.step;
    const auto is_beyond = y >= end;
    const T i = is_beyond ? last - 1 : min<T>(rounded_down(steps), last - 1);
    const Cubic<T> at = in_step<T>(phase, i, steps - i);
    const T slope = element(phase.slope + 1, last);
    return {is_beyond ? slope : at.slope, is_beyond ? element(phase.time, last) + (y - end) * slope
                                                    : element(phase.time, i) + at.time};
}

// The point y at a time since the flat position, accurate to a few digits.
template <class T>
inline T rough_place(const PhaseTime<T>& phase, T time) {
    const PhaseMap<T>& map = phase.map;
    const T last = map.steps;
    T i{};
    for (int k = 1; k < phase.most_steps; ++k) {
        const auto is_later = (time >= phase.time[k]) & (last > k);
        if (!any(is_later)) break;
        i = is_later ? i + 1 : i;
    }
    const T begin = element(phase.time, i);
    const T end = element(phase.time + 1, i);
    const T s = (time - begin) / (end - begin);
    const Cubic<T> at = in_step<T>(phase, i, s);
    const T over = time - element(phase.time, last);
    return over >= 0 ? map.steps * map.step + over / element(phase.slope + 1, last)
                     : map.step * (i + s) + (time - begin - at.time) / at.slope;
}

// The distance in y covered in a given time, accurate to a few digits.
template <class T>
inline T rough_distance(const PhaseTime<T>& phase, const PhasePlace<T>& from, T time) {
    const T quarter = phase.map.quarter;
    const T y = (from.quarters != 0 ? from.quarters * quarter : T{}) + from.offset;
    const Cubic<T> start = rough_time<T>(phase, abs(y));
    const T target = copysign(start.time, y) + time;
    const T half_turns = nearest<T>(target / phase.half_turn.high);
    const auto some = half_turns != 0;
    const T rest = target - (some ? half_turns * phase.half_turn.high : T{});
    const T place = copysign(rough_place<T>(phase, abs(rest)), rest);
    return abs(time) < phase.map.step * start.slope
               ? time / start.slope
               : place + (some ? 2 * half_turns * quarter : T{}) - y;
}

// Sets dt/dy at the steps, and the time and path of the quarter by the trapezoidal rule.
template <class T>
void set_quarter(PhaseTime<T>& phase) {
    const PhaseMap<T>& map = phase.map;
    const T n = map.steps;
    const int most = static_cast<int>(largest(n));
    T* const f = phase.slope + 1;
    TwoParts<T> sum{};
    T path{};
    T offsets[most_places];
    PhaseRates<T> rates;
    T beyond{};  // dt/dy at the tip
    if (any(map.has_tail)) {
        offsets[0] = T{};
        phase_rates(phase.integrand, map, filled<T>(1.0), offsets, 1, rates);
        beyond = rates.time[0];
    }
    for (int first = 0; first <= most; first += most_places) {
        const int count = most - first < most_places ? most - first + 1 : most_places;
        for (int i = 0; i < count; ++i) offsets[i] = min<T>(filled<T>(first + i), n) * map.step;
        phase_rates(phase.integrand, map, T{}, offsets, count, rates);
        for (int i = first; i < first + count; ++i) {
            const auto is_end = i == 0 ? n > -1 : n == i;
            const T weight = is_end ? filled<T>(0.5) : n > i ? filled<T>(1.0) : T{};
            // dt/dy is even about the end of the quarter
            f[i] = n < i ? f[i - 2] : rates.time[i - first];
            add<T>(sum, weight * (rates.time[i - first] - beyond));
            path += weight * rates.path[i - first];
        }
    }
    f[-1] = f[1];
    f[most + 1] = f[most - 1];
    phase.quarter_path = path * map.step;
    const TwoParts<T> whole = two_product(sum.high, map.step);
    phase.quarter_turn = quick_two_sum(whole.high, whole.low + sum.low * map.step);
    if (any(map.has_tail)) {
        const TwoParts<T> tail = two_product(map.quarter, beyond);
        phase.quarter_turn = (phase.quarter_turn + tail.high) + tail.low;
        if (any(map.quarter == infinity)) phase.quarter_turn = {map.quarter, T{}};
    }
    phase.half_turn = {2 * phase.quarter_turn.high, 2 * phase.quarter_turn.low};
    // The time from the flat position to each step: dt/dy is interpolated by a cubic through four
    // neighbouring steps, and the cubic is integrated exactly.
    phase.time[0] = T{};
    for (int i = 0; i < most; ++i) {
        phase.time[i + 1] = phase.time[i] + map.step * (13.0 / 24 * (f[i] + f[i + 1]) -
                                                        1.0 / 24 * (f[i - 1] + f[i + 2]));
    }
}

// The distance in y covered in a short time, accurate to a few digits, given dt/dy at the start. It
// is one step of Halley's method, with the time from Simpson's rule.
template <class T>
inline T short_distance(const PhaseTime<T>& phase, const PhasePlace<T>& from, T start, T time) {
    const auto slope_at = [&](T distance) {
        return phase_rate_at(phase.integrand, phase.map, from.quarters, from.offset + distance)
            .time;
    };
    const T first = time / start;
    const T middle = slope_at(0.5 * first);
    const T end = slope_at(first);
    const T missing = (6 * start - (start + 4 * middle + end)) / (6 * end);
    const T bend = (start - 4 * middle + 3 * end) / (2 * end);
    return first * (1 + missing * (1 - bend * missing));
}

// The point after a time of at most a full swing, and the angle and path up to this point.
template <class T>
struct PhaseMove {
    PhasePlace<T> to;
    PhaseIncrement<T> sum;
};

// Uses Newton's method: integrates up to a guess of the distance, then repeatedly extends the
// interval to make up the missing time. The last step is so small that its square is below
// rounding, or that it no longer moves the point.
template <class T>
PhaseMove<T> move(const PhaseTime<T>& phase, const PhasePlace<T>& from, T guess, T time) {
    constexpr double smallest_step = 3e-9;
    constexpr double largest_step = 0.5;
    constexpr int most_steps = 60;
    // Rounds a distance so that from.offset + distance is a double, and the integral ends exactly
    // at the point.
    const auto to_double = [&](T distance) { return (from.offset + distance) - from.offset; };
    T distance = to_double(guess);
    auto [sum, slope] = integral_between(phase, from.quarters, from.offset, from.offset + distance);
    auto open = time == time;
    for (int i = 0; i < most_steps; ++i) {
        const T missing = (time - sum.time) / slope.time;
        const T step = max<T>(min<T>(missing, filled<T>(largest_step)), filled<T>(-largest_step));
        const T begin = from.offset + distance;
        const T least =
            max<T>(smallest_step * min<T>(abs(distance), filled<T>(1.0)), epsilon * abs(begin));
        const auto is_last = open & (abs(step) <= least);
        sum.angle = is_last ? sum.angle + step * slope.angle : sum.angle;
        sum.path = is_last ? sum.path + step * slope.path : sum.path;
        open = open & (abs(step) > least);
        const T next = to_double(distance + step);
        const T after = open ? next : distance;
        distance = is_last ? distance + step : after;
        if (!any(open)) break;
        const Integral<T> more = integral_between(phase, from.quarters, begin, from.offset + after);
        sum.time = sum.time + more.sum.time;
        sum.angle = open ? sum.angle + more.sum.angle : sum.angle;
        sum.path = open ? sum.path + more.sum.path : sum.path;
        slope = more.end;
    }
    return {moved(phase.map, from, distance), sum};
}

}  // namespace
}  // namespace rolling_ellipse
