#include "rolling/phase_time.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/ellipse.hpp"
#include "numerics/quadrature.hpp"

namespace rolling_ellipse {
namespace {

// scale^2 D (H + h), the square of the factor that depends on the shape: physics (28, 29).
double shape_factor2(const PhaseRate& rate, double sin2_phi) {
    const double h2 = square(rate.short_axis) + rate.c2 * sin2_phi;
    return rate.scale2 * (rate.d0 + rate.d1 * sin2_phi) * (rate.energy_height + std::sqrt(h2)) / h2;
}

// A way, and the rates at its end.
struct WayTo {
    PhaseWay way;
    PhaseWay end;
};

// From one offset to another, by as many panels as it takes.
WayTo way_by_panels(const PhaseTime& phase, int quarters, double begin, double end) {
    constexpr double longest_panel = 6.0;
    constexpr int pairs = phase_lanes / 2;
    const int panels = 1 + static_cast<int>(std::abs(end - begin) / longest_panel);
    const double half = 0.5 * (end - begin) / panels;
    const GaussRule& rule = rule_for_length(2 * std::abs(half) / pi);
    const int count = (rule.size + 1) / 2;
    PhaseWays rates{};  // in the end, the last of them is that of the end
    WayTo found{};
    DoubleDouble time{}, angle{}, path{};
    const auto add = [](DoubleDouble& sum, double term) {
        const DoubleDouble next = two_sum(sum.high, term);
        sum = {next.high, sum.low + next.low};
    };
    for (int panel = 0; panel < panels; ++panel) {
        const double middle = begin + (2 * panel + 1) * half;
        for (int first = 0; first <= count; first += pairs) {
            // Two nodes beside the middle, with one weight; after the last ones the end.
            PhaseLanes offsets;
            std::array<double, pairs> weights{};
            offsets.fill(end);
            for (int i = 0; i < std::min(pairs, count - first); ++i) {
                const double node = rule.nodes[first + i];
                weights[i] = node == 0 ? 0.5 * rule.weights[first + i] : rule.weights[first + i];
                offsets[i] = middle - half * node;
                offsets[pairs + i] = middle + half * node;
            }
            if (first == count && panel + 1 < panels) break;
            rates = phase_rates(phase.rate, phase.map, quarters, offsets);
            for (int i = 0; i < pairs; ++i) {
                add(time, weights[i] * (rates.time[i] + rates.time[pairs + i]));
                add(angle, weights[i] * (rates.angle[i] + rates.angle[pairs + i]));
                add(path, weights[i] * (rates.path[i] + rates.path[pairs + i]));
            }
        }
    }
    found.way = {half * double(time), half * double(angle), half * double(path)};
    found.end = {rates.time[phase_lanes - 1], rates.angle[phase_lanes - 1],
                 rates.path[phase_lanes - 1]};
    return found;
}

double end_of_steps(const PhaseMap& map) { return map.steps * map.step; }

// From one offset to another. Around a tip that is far enough nothing but time goes on, at one
// rate: for minutes near the separatrix, and for ever on it.
WayTo way_between(const PhaseTime& phase, int quarters, double begin, double end) {
    constexpr double long_way = 12.0;
    const PhaseMap& map = phase.map;
    const double edge = 2 * end_of_steps(map);
    if (map.quarter <= edge || std::abs(end - begin) <= long_way) {
        return way_by_panels(phase, quarters, begin, end);
    }
    // Where that begins and ends, in size of the offset.
    const double from = quarters == 0 ? edge : 0.0;
    const double to = quarters == 0 ? 2 * map.quarter - edge : map.quarter - edge;
    for (const double limit : {-to, -from, from, to}) {
        if (limit == 0 || !(limit > std::min(begin, end) && limit < std::max(begin, end))) continue;
        const WayTo first = way_between(phase, quarters, begin, limit);
        const WayTo second = way_between(phase, quarters, limit, end);
        return {{first.way.time + second.way.time, first.way.angle + second.way.angle,
                 first.way.path + second.way.path},
                second.end};
    }
    const double middle = std::abs(0.5 * (begin + end));
    if (!(middle >= from && middle <= to)) return way_by_panels(phase, quarters, begin, end);
    const PhaseWay slope = way_by_panels(phase, quarters, end, end).end;
    return {{(end - begin) * slope.time, 0.0, 0.0}, slope};
}

// A cubic for dt/dy in the step after y_i, and its integral.
struct Step {
    double slope;
    double time;
};
Step in_step(const PhaseTime& phase, int i, double s) {
    const double* f = &phase.slope[i + 1];
    const double m0 = 0.5 * (f[1] - f[-1]);
    const double m1 = 0.5 * (f[2] - f[0]);
    const double p2 = 3 * (f[1] - f[0]) - 2 * m0 - m1;
    const double p3 = m0 + m1 - 2 * (f[1] - f[0]);
    return {f[0] + s * (m0 + s * (p2 + s * p3)),
            phase.map.step * s * (f[0] + s * (m0 / 2 + s * (p2 / 3 + s * p3 / 4)))};
}

// To a few digits: the time since the flat, for 0 <= y <= Y, dt/dy, and the place at a time.
Step rough_time(const PhaseTime& phase, double y) {
    const PhaseMap& map = phase.map;
    const double end = end_of_steps(map);
    if (y >= end) {
        const double slope = phase.slope[map.steps + 1];
        return {slope, phase.time[map.steps] + (y - end) * slope};
    }
    const int i = std::min(static_cast<int>(y / map.step), map.steps - 1);
    const Step at = in_step(phase, i, y / map.step - i);
    return {at.slope, phase.time[i] + at.time};
}

double rough_place(const PhaseTime& phase, double time) {
    const PhaseMap& map = phase.map;
    const double* const times = phase.time.data();
    const double over = time - times[map.steps];
    if (over >= 0) return end_of_steps(map) + over / phase.slope[map.steps + 1];
    const int i = static_cast<int>(std::upper_bound(times, times + map.steps, time) - times) - 1;
    const double s = (time - times[i]) / (times[i + 1] - times[i]);
    const Step at = in_step(phase, i, s);
    return map.step * (i + s) + (time - times[i] - at.time) / at.slope;
}

// To a few digits, how far in y a time reaches.
double rough_distance(const PhaseTime& phase, const Place& from, double time) {
    const double quarter = phase.map.quarter;
    const double y = from.quarters == 0 ? from.offset : from.quarters * quarter + from.offset;
    const Step start = rough_time(phase, std::abs(y));
    if (std::abs(time) < phase.map.step * start.slope) return time / start.slope;
    const double target = std::copysign(start.time, y) + time;
    if (std::isinf(quarter)) return std::copysign(rough_place(phase, std::abs(target)), target) - y;
    const double half_turn = phase.half_turn.high;
    const double half_turns = std::nearbyint(target / half_turn);
    const double rest = target - half_turns * half_turn;
    return std::copysign(rough_place(phase, std::abs(rest)), rest) + 2 * half_turns * quarter - y;
}

// dt/dy at the steps: the quarter by the trapezoidal rule.
void integrate_quarter(PhaseTime& phase) {
    const PhaseMap& map = phase.map;
    const int n = map.steps;
    double* const f = &phase.slope[1];
    DoubleDouble sum{};
    double beyond = 0.0;  // what is left of dt/dy at the tip
    if (map.has_tail) {
        beyond = phase_rates(phase.rate, map, 1, PhaseLanes{}).time[0];
    }
    for (int first = 0; first <= n; first += int(phase_lanes)) {
        PhaseLanes offsets;
        for (int i = 0; i < int(phase_lanes); ++i) offsets[i] = (first + i) * map.step;
        const PhaseWays rates = phase_rates(phase.rate, map, 0, offsets);
        for (int i = first; i < std::min(first + int(phase_lanes), n + 1); ++i) {
            const double weight = i == 0 || i == n ? 0.5 : 1.0;
            f[i] = rates.time[i - first];
            const DoubleDouble added = two_sum(sum.high, weight * (f[i] - beyond));
            sum = {added.high, sum.low + added.low};
            phase.quarter_path += weight * rates.path[i - first];
        }
    }
    phase.quarter_path *= map.step;
    f[-1] = f[1];
    f[n + 1] = f[n - 1];
    if (map.has_tail) {
        phase.quarter_turn = sum * map.step + two_product(map.quarter, beyond);
        // The steps end 1e-9 of the path before the tip.
        const double short_axis = phase.rate.short_axis;
        const double long_axis = std::sqrt(square(short_axis) + phase.rate.c2);
        phase.quarter_path = path_from_flat(long_axis, short_axis, 1.0, 0.0);
    } else {
        phase.quarter_turn = sum * map.step;
    }
    phase.time[0] = 0.0;
    for (int i = 0; i < n; ++i) phase.time[i + 1] = phase.time[i] + in_step(phase, i, 1.0).time;
}

}  // namespace

PhaseTime phase_time(const PhaseRate& rate) {
    PhaseTime phase{};
    phase.rate = rate;
    phase.map = phase_map(rate.kappa, std::sqrt(rate.d0 / (rate.d1 * rate.amplitude2 + rate.d0)));
    integrate_quarter(phase);
    if (std::isinf(phase.map.quarter)) phase.quarter_turn = {infinity, 0.0};
    phase.half_turn = phase.quarter_turn * 2.0;
    if (std::isinf(phase.map.quarter)) phase.half_turn = {infinity, 0.0};
    return phase;
}

double shape_factor(const PhaseRate& rate, double sin_phi) {
    return std::sqrt(shape_factor2(rate, square(sin_phi)));
}

DoubleDouble time_since_flat(const PhaseTime& phase, const PhasePoint& point) {
    const Place at = place_of(phase.map, point);
    const double time = way_between(phase, at.quarters, 0.0, at.offset).way.time;
    if (at.quarters == 0) return {time, 0.0};
    return phase.quarter_turn * double(at.quarters) + time;
}

// Newton's method: the way is integrated to a first guess, and extended by what is missing. The
// last step is so small that its square is below rounding, or the place does not show it.
PhaseMove move(const PhaseTime& phase, const Place& from, double time) {
    constexpr double smallest_step = 3e-9;
    constexpr double largest_step = 0.5;
    constexpr int most_steps = 60;
    // To places that are doubles themselves, so that the way and the place it leads to agree.
    const auto to_double = [&](double distance) { return (from.offset + distance) - from.offset; };
    double distance = to_double(rough_distance(phase, from, time));
    auto [way, slope] = way_between(phase, from.quarters, from.offset, from.offset + distance);
    for (int i = 0; i < most_steps; ++i) {
        const double step = std::clamp((time - way.time) / slope.time, -largest_step, largest_step);
        const double begin = from.offset + distance;
        const double least =
            std::max(smallest_step * std::min(std::abs(distance), 1.0), epsilon * std::abs(begin));
        if (std::abs(step) <= least) {
            distance += step;
            way.angle += step * slope.angle;
            way.path += step * slope.path;
            break;
        }
        distance = to_double(distance + step);
        const WayTo more = way_between(phase, from.quarters, begin, from.offset + distance);
        way.time += more.way.time;
        way.angle += more.way.angle;
        way.path += more.way.path;
        slope = more.end;
    }
    way.time = time;
    return {moved(phase.map, from, distance), way};
}

// The place beyond a turning point is that as far before it.
double path_between(const PhaseTime& phase, const Place& from, const Place& to) {
    const double side = to.quarters == 0 ? std::copysign(1.0, to.offset) : to.quarters < 0 ? -1 : 1;
    const double distance =
        (2 * side - to.quarters - from.quarters) * phase.map.quarter - (to.offset + from.offset);
    return way_between(phase, from.quarters, from.offset, from.offset + distance).way.path;
}

}  // namespace rolling_ellipse
