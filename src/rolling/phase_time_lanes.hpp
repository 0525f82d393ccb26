// Time as a function of the phase, and its inverse, for several bodies side by side: the integrals
// and the names of rolling/phase_time.hpp.
#pragma once

#include "numerics/gauss_legendre.hpp"
#include "numerics/lanes.hpp"

namespace rolling_ellipse {
namespace {

constexpr int most_lane_nodes = 32;

// (dt/dv)^2 of one half in tau = tan^2, physics (28, 29, 31), with h^2 = N/q and d0 + d1 sin^2 phi
// = W/q, q = 1 + tau:
//     scale^2 W (H + h) E/(N q K);   N, W, E, K linear in tau.
struct HalfRate {
    Pack scale2;
    Pack energy_height;
    Pack n0, n1;
    Pack w0, w1;
    Pack e0, e1;
    Pack k1;  // K = 1 + k1 tau
};

inline Pack time_rate(const HalfRate& of, Pack tan) {
    const Pack tau = tan * tan;
    const Pack q = 1 + tau;
    const Pack n = of.n0 + of.n1 * tau;
    const Pack k = 1 + of.k1 * tau;
    const Pack nq = n * q;
    const Pack inverse = 1 / (nq * k);
    const Pack h = sqrt(nq) * (inverse * (n * k));
    const Pack squared = (of.scale2 * (of.w0 + of.w1 * tau)) * ((of.e0 + of.e1 * tau) * inverse) *
                         (of.energy_height + h);
    return sqrt(squared);
}

// A panel: tan = falling e^-v + rising sinh(v) over its length.
struct LanePanel {
    Pack falling;
    Pack rising;
    Pack length;
};

inline Pack tangent(const LanePanel& panel, Pack v) {
    const Hyperbolic of = hyperbolic(v);
    return panel.falling * of.falling + panel.rising * of.sinh;
}

// The rates at the nodes -x and +x of the whole panel, in the order of the rule.
struct PanelRates {
    Pack below[most_lane_nodes / 2];
    Pack above[most_lane_nodes / 2];
};

// Time from the anchor of the panel to v, by a rule of an even number of nodes.
inline PackPair time_from_anchor(const GaussRule& rule, const HalfRate& rate,
                                 const LanePanel& panel, Pack v, PanelRates& rates) {
    const Pack half = 0.5 * v;
    PackPair sum{};
    for (int i = 0; i < rule.size / 2; ++i) {
        const Pack offset = half * rule.nodes[i];
        rates.below[i] = time_rate(rate, tangent(panel, half - offset));
        rates.above[i] = time_rate(rate, tangent(panel, half + offset));
        const PackPair next =
            two_sum(sum.high, rule.weights[i] * (rates.below[i] + rates.above[i]));
        sum = {next.high, sum.low + next.low};
    }
    const PackPair whole = two_product(sum.high, half);
    return quick_two_sum(whole.high, whole.low + sum.low * half);
}

struct LaneHalf {
    Pack grade;
    HalfRate rate;
    LanePanel end;
    LanePanel rise;
    PackPair end_time;
    PackPair rise_time;
    PanelRates end_rates;
    PanelRates rise_rates;
};

inline void integrate_half(const GaussRule& rule, LaneHalf& half) {
    const Pack root = sqrt(1 + half.grade * half.grade);
    const Pack length = log((1 + root) / half.grade);  // W, sinh W = 1/g
    const Pack neck = 0.5 * length;
    half.end = {Pack{}, half.grade, length - neck};
    half.rise = {pack(1.0), -(half.grade * half.grade) / (1 + root), neck};
    half.end_time = time_from_anchor(rule, half.rate, half.end, half.end.length, half.end_rates);
    half.rise_time =
        time_from_anchor(rule, half.rate, half.rise, half.rise.length, half.rise_rates);
}

struct LanePhase {
    LaneHalf flat;
    LaneHalf tip;
    PackPair split;
    PackPair quarter_turn;
    PackPair half_turn;
};

inline LanePanel select(Mask mask, const LanePanel& x, const LanePanel& y) {
    return {mask ? x.falling : y.falling, mask ? x.rising : y.rising, mask ? x.length : y.length};
}

inline HalfRate rate_of(const LanePhase& phase, Mask at_tip) {
    const HalfRate& x = phase.tip.rate;
    const HalfRate& y = phase.flat.rate;
    return {x.scale2,
            x.energy_height,
            at_tip ? x.n0 : y.n0,
            at_tip ? x.n1 : y.n1,
            at_tip ? x.w0 : y.w0,
            at_tip ? x.w1 : y.w1,
            at_tip ? x.e0 : y.e0,
            at_tip ? x.e1 : y.e1,
            at_tip ? x.k1 : y.k1};
}

// d tangent/dv: physics (31); negative on the rise.
inline Pack tangent_rate(Pack grade, Mask near_end, Pack tan) {
    const Pack slope = sqrt(tan * tan + grade * grade);
    return near_end ? slope : -slope;
}

// Time since the flat position at a phase of sine and cosine >= 0.
inline PackPair time_since_flat(const GaussRule& rule, const LanePhase& phase, Pack sin, Pack cos) {
    const Mask at_tip = sin > cos;
    const Pack tan = (at_tip ? cos : sin) / (at_tip ? sin : cos);
    const Pack grade = at_tip ? phase.tip.grade : phase.flat.grade;
    const LanePanel end = select(at_tip, phase.tip.end, phase.flat.end);
    const LanePanel rise = select(at_tip, phase.tip.rise, phase.flat.rise);
    const Pack from_end = log((tan + sqrt(tan * tan + grade * grade)) / grade);
    const Mask near_end = from_end <= end.length;
    const LanePanel panel = select(near_end, end, rise);
    const Pack v = max(near_end ? from_end : (end.length + rise.length) - from_end, Pack{});
    const HalfRate rate = rate_of(phase, at_tip);
    // v is rounded: what it misses of the tangent is added by the rate.
    const Pack reached = tangent(panel, v);
    const Pack missed =
        (tan - reached) * time_rate(rate, reached) / tangent_rate(grade, near_end, reached);
    PackPair from_anchor = {missed, Pack{}};
    if (any(v > 0)) {
        PanelRates unused;
        from_anchor = time_from_anchor(rule, rate, panel, v, unused) + missed;
    }
    const PackPair anchor =
        select(near_end, select(at_tip, phase.quarter_turn, PackPair{}), phase.split);
    const Mask later = near_end != at_tip;
    return anchor + select(later, from_anchor, -from_anchor);
}

// c_k = sum over the nodes x_i of w_i f(x_i) P_k(x_i)/2, half of it: f = sum (2k + 1) c_k P_k.
struct LegendreTable {
    static constexpr int most_terms = 22;
    int terms;
    double weighted[most_terms][most_lane_nodes / 2];
};

// Enough for a first guess to 1e-6: f has some rho^-n at hand where the rule has rho^-2n = 1e-17.
constexpr int legendre_terms(int nodes) { return nodes / 2 + 6 < nodes ? nodes / 2 + 6 : nodes; }

constexpr LegendreTable legendre_table(const GaussRule& rule) {
    LegendreTable table{};
    table.terms = legendre_terms(rule.size);
    for (int i = 0; i < rule.size / 2; ++i) {
        double below = 0.0;
        double p = 1.0;
        for (int k = 0; k < table.terms; ++k) {
            table.weighted[k][i] = 0.5 * rule.weights[i] * p;
            const double next = ((2 * k + 1) * rule.nodes[i] * p - k * below) / (k + 1);
            below = p;
            p = next;
        }
    }
    return table;
}

// The panel coordinate, from -1 at the anchor to 1, at which the integral of the rates is `time`,
// in units of half the panel's length, to about 1e-6.
inline Pack first_guess(const LegendreTable& table, int half_size, const PanelRates& rates,
                        Pack time) {
    Pack c[LegendreTable::most_terms + 1];
    Pack sums[most_lane_nodes / 2];
    Pack differences[most_lane_nodes / 2];
    for (int i = 0; i < half_size; ++i) {
        sums[i] = rates.above[i] + rates.below[i];
        differences[i] = rates.above[i] - rates.below[i];
    }
    for (int k = 0; k < table.terms; ++k) {
        const Pack* const values = k % 2 == 0 ? sums : differences;
        Pack sum{};
        for (int i = 0; i < half_size; ++i) sum += table.weighted[k][i] * values[i];
        c[k] = sum;
    }
    constexpr int iterations = 5;
    Pack x = max(min(time / c[0] - 1, pack(1.0)), pack(-1.0));
    for (int step = 0; step < iterations; ++step) {
        Pack below = pack(1.0);  // P_k
        Pack p = x;              // P_k+1
        Pack integral = c[0] * (1 + x);
        Pack rate = c[0];
        for (int k = 1; k < table.terms; ++k) {
            const Pack next = x * p * ((2 * k + 1.0) / (k + 1)) - below * (k / (k + 1.0));
            integral += c[k] * (next - below);
            rate += (2 * k + 1.0) * c[k] * p;
            below = p;
            p = next;
        }
        x = max(min(x - (integral - time) / rate, pack(1.0)), pack(-1.0));
    }
    return x;
}

struct LanePoint {
    Pack sin;
    Pack cos;
    Mask found;
};

// The inverse of time_since_flat, for 0 <= time <= quarter_turn.
inline LanePoint point_at_time(const GaussRule& rule, const LegendreTable& table,
                               const LanePhase& phase, PackPair time) {
    const Pack from_split = rounded(time - phase.split);
    const Mask at_tip = from_split >= 0;
    const PackPair end_time = select(at_tip, phase.tip.end_time, phase.flat.end_time);
    const Pack to_end = at_tip ? max(rounded(phase.quarter_turn - time), Pack{}) : rounded(time);
    const Mask near_end =
        at_tip ? from_split > rounded(phase.tip.rise_time) : to_end <= rounded(end_time);
    const Pack from_anchor = near_end ? to_end : abs(from_split);

    const Pack grade = at_tip ? phase.tip.grade : phase.flat.grade;
    const HalfRate rate = rate_of(phase, at_tip);
    const LanePanel panel = select(near_end, select(at_tip, phase.tip.end, phase.flat.end),
                                   select(at_tip, phase.tip.rise, phase.flat.rise));
    PanelRates rates;
    const int half_size = rule.size / 2;
    for (int i = 0; i < half_size; ++i) {
        rates.below[i] =
            near_end ? (at_tip ? phase.tip.end_rates.below[i] : phase.flat.end_rates.below[i])
                     : (at_tip ? phase.tip.rise_rates.below[i] : phase.flat.rise_rates.below[i]);
        rates.above[i] =
            near_end ? (at_tip ? phase.tip.end_rates.above[i] : phase.flat.end_rates.above[i])
                     : (at_tip ? phase.tip.rise_rates.above[i] : phase.flat.rise_rates.above[i]);
    }

    // Beside the anchor the series has no relative accuracy, and the rate there is enough.
    constexpr double small = 1e-3;
    const Pack half_length = 0.5 * panel.length;
    const Pack guess =
        half_length * (1 + first_guess(table, half_size, rates, from_anchor / half_length));
    const Pack linear = from_anchor / time_rate(rate, panel.falling);
    Pack v = linear < small ? linear : guess;

    // Newton's method on the integral itself, then on what the step has missed of it.
    const PackPair reached = time_from_anchor(rule, rate, panel, v, rates);
    const Pack rest = (from_anchor - reached.high) - reached.low;
    const Pack slope = time_rate(rate, tangent(panel, v));
    const Pack next = v + rest / slope;
    const Pack moved = next - v;
    const Pack left = rest - moved * time_rate(rate, tangent(panel, v + 0.5 * moved));
    constexpr double converged = 1e-5;
    const Mask found = abs(moved) <= converged;

    const Pack tan = tangent(panel, next);
    const Pack cos2 = 1 / (1 + tan * tan);
    const Pack cos = sqrt(cos2);
    const Pack sin = tan * cos;
    const Pack correction = left / slope * tangent_rate(grade, near_end, tan) * cos2;
    const Pack offset_sin = sin + cos * correction;
    const Pack offset_cos = cos - sin * correction;
    return {at_tip ? offset_cos : offset_sin, at_tip ? offset_sin : offset_cos, found};
}

}  // namespace
}  // namespace rolling_ellipse
