#include "rolling/slope/run.hpp"

#include <algorithm>
#include <cmath>

namespace rolling_ellipse {
namespace {

constexpr double least_levels = 4;      // W/w from which sums over half turns are used
constexpr double asymptotic_from = 14;  // W/w from which R(W) is right to 2e-17

// sqrt(w) R(W/w) of physics (60).
double remainder(double level, double gain) {
    const double ratio = gain / level;
    const double r2 = square(ratio);
    const double series =
        1.0 / 24 + r2 * (-1.0 / 384 +
                         r2 * (1.0 / 1024 + r2 * (-143.0 / 163840 + r2 * (0.00140508015951 -
                                                                          r2 * 0.00354755719503))));
    return ratio / std::sqrt(level) * series;
}

// Sums the terms (W + j w)^(-1/2), W = level, w = gain, up to the level of `asymptotic_from`.
FirstRates first_rates(double level, double gain) {
    FirstRates first{};
    while (level < asymptotic_from * gain) {
        first.sum += 1 / std::sqrt(level);
        level += gain;
        first.count += 1;
    }
    first.level = level;
    first.root = std::sqrt(level);
    first.remainder = remainder(level, gain);
    return first;
}

// The sum of (W + j w)^(-1/2) over j = 0 ... n - 1, W = level, w = gain.
double sum_of_rates(double level, const FirstRates& first, double gain, double n) {
    constexpr double few = 4;
    const double others = n - first.count;
    if (others < few) {
        double sum = 0.0;
        for (; n > 0; n -= 1, level += gain) sum += 1 / std::sqrt(level);
        return sum;
    }
    const double end = std::fma(others, gain, first.level);
    const double a = first.root;
    const double b = std::sqrt(end);
    const double ends = others * gain / (2 * a * b * (a + b));
    return first.sum + (2 * others / (a + b) + (ends + (first.remainder - remainder(end, gain))));
}

// Widest part of a panel in v. Singularities are pi/2 or more away, five times half of that width.
constexpr double widest_part = 0.6;

// The angle from the centre of a panel at its coordinate v, and the derivative by v.
struct Offset {
    double angle;
    double rate;
};

Offset offset_at(const RunPanel& panel, double v) {
    const double tan = panel.grade * std::sinh(v);
    return {panel.scale * std::atan(tan),
            panel.scale * std::sqrt(square(tan) + square(panel.grade)) / (1 + square(tan))};
}

// Append the nodes of a rule over an interval of v.
void add_nodes(const SlopeRun& run, const RunPanel& panel, double first, double last,
               const GaussRule& rule, RunNodes& nodes) {
    const double half = (last - first) / 2;
    for (int i = 0; i < rule.size; ++i) {
        const auto [node, weight] = node_of(rule, i);
        const auto [offset, rate] = offset_at(panel, first + half * (1 + node));
        const double angle = panel.angle + offset;
        const Geometry at = geometry(run.body, panel.quarters, angle);
        const double root = std::sqrt(0.5 * inertia_about_contact(run.body.gyration2, at));
        nodes.weight.push_back(weight * half * rate * root);
        nodes.level.push_back(level(run, panel.quarters, angle, at));
    }
}

// Centre of two panels: a flat position, or the place of the least W beside a tip.
struct Centre {
    double quarters;
    double angle;
    double grade_angle;  // about the imaginary part of the nearest singularity of dt/dphi
    double at() const { return quarters * half_pi + angle; }
};

// Append the panel from low to high, in a gap between two centres.
void add_panel(SlopeRun& run, const Centre& centre, double gap, double low, double high) {
    if (!(low < high)) return;
    const double scale = gap / half_pi;
    const double grade = std::tanh(centre.grade_angle / scale);
    const auto coordinate = [&](double at) {
        return std::asinh(std::tan((at - centre.at()) / scale) / grade);
    };
    RunPanel panel{centre.quarters, centre.angle, scale, grade, coordinate(low), coordinate(high)};
    const double width = panel.last - panel.first;
    const double whole = std::asinh(1 / grade);
    const auto mapped = [&](double v) { return (2 * v - panel.first - panel.last) / width; };
    const int least = nodes_needed(pi / width, {mapped(0.0), mapped(whole), mapped(-whole)});
    panel.begin = run.nodes.weight.size();
    add_nodes(run, panel, panel.first, panel.last, gauss_rule(least + least / 4), run.nodes);
    panel.end = run.nodes.weight.size();
    for (std::size_t i = panel.begin; i < panel.end; ++i) {
        run.mass += run.nodes.weight[i];
        run.half_turn += run.nodes.weight[i] / std::sqrt(run.nodes.level[i]);
    }
    panel.part = run.part_nodes.weight.size() / part_order;
    panel.parts = static_cast<int>(std::ceil(width / widest_part));
    for (int i = 0; i < panel.parts; ++i) {
        add_nodes(run, panel, panel.first + width * i / panel.parts,
                  panel.first + width * (i + 1) / panel.parts, part_rule(), run.part_nodes);
    }
    run.panels.push_back(panel);
}

}  // namespace

double may_run(const SlopeBody& body, double energy, const Geometry& at, double omega) {
    // The height of the tip over the centre, as a product exact for nearly round bodies, too.
    const double to_tip = body.c2 * square(at.cos) / (at.h + body.long_axis);
    const double above = energy - body.gravity.into * to_tip;
    const double levels = above / body.gain - least_levels;
    if (!(levels >= 0)) return 0.0;
    return omega > 0 ? most_half_turns : std::min(std::floor(levels), most_half_turns);
}

SlopeRun slope_run(const SlopeBody& body, const SlopePlace& from, double energy,
                   double half_turns) {
    SlopeRun run{};
    run.body = body;
    run.from = from;
    run.turns = 2 * std::floor(from.quarters / 2);
    run.heading = std::copysign(1.0, from.omega);
    run.half_turns = half_turns;
    run.energy = energy;
    run.path = path_at(body, from.quarters - run.turns, double(from.angle));
    run.at = geometry(body, from);

    // Uphill W falls by the gain in each half turn. In a half turn it is least at the unstable
    // equilibrium, or at the tip if there is none.
    const double lost = run.heading < 0 ? (half_turns - 1) * body.gain : 0.0;
    const double hill = body.equilibria ? body.equilibria->upright : 0.0;
    const Geometry top = geometry(body, 1.0, hill);
    const double curvature = body.gravity.along * top.dh - body.gravity.into * top.ddh;
    const double least = std::max(energy - lost + body.gravity.into * fall(body, run.at, top).value,
                                  least_levels * body.gain);
    const double flat = std::asinh(std::sqrt(body.d0 / body.d1));
    const double beside_hill =
        curvature > 0 ? std::min(std::sqrt(2 * least / curvature), 1.0) : 1.0;

    const double here = (from.quarters - run.turns) * half_pi + double(from.angle);
    const double low = run.heading > 0 ? here : here - pi;
    const double high = run.heading > 0 ? here + pi : here;
    const auto centre = [&](int quarters) {
        return quarters % 2 == 0 ? Centre{double(quarters), 0.0, flat}
                                 : Centre{double(quarters), hill, beside_hill};
    };
    for (int i = -4; i < 5; ++i) {
        const Centre left = centre(i);
        const Centre right = centre(i + 1);
        const double gap = right.at() - left.at();
        const double split = left.at() + gap / 2;
        add_panel(run, left, gap, std::max(low, left.at()), std::min(high, split));
        add_panel(run, right, gap, std::max(low, split), std::min(high, right.at()));
    }
    if (run.heading > 0) {
        for (const double level : run.nodes.level) {
            run.first.push_back(first_rates(level, body.gain));
        }
    }
    return run;
}

DoubleDouble time_of(const SlopeRun& run, double half_turns) {
    const double gain = run.body.gain;
    const double lowest = run.heading < 0 ? (half_turns - 1) * gain : 0.0;
    const auto& [weight, levels] = run.nodes;
    DoubleDouble sum{};
    for (std::size_t i = 0; i < weight.size(); ++i) {
        const double level = levels[i] - lowest;
        const FirstRates& first = run.heading < 0 ? first_rates(level, gain) : run.first[i];
        sum = sum + two_product(weight[i], sum_of_rates(level, first, gain, half_turns));
    }
    return sum;
}

double level(const SlopeRun& run, double quarters, double angle, const Geometry& here) {
    return run.energy + (run.body.gravity.along * (path_at(run.body, quarters, angle) - run.path) +
                         run.body.gravity.into * fall(run.body, run.at, here).value);
}

double omega_after(const SlopeRun& run, double half_turns, double level, const Geometry& here) {
    const double w = level + run.heading * half_turns * run.body.gain;
    return run.heading * std::sqrt(2 * w / inertia_about_contact(run.body.gyration2, here));
}

SlopePlace place_on(const SlopeRun& run, const RunPanel& panel, double v, double half_turns) {
    const double angle = panel.angle + offset_at(panel, v).angle;
    const Geometry at = geometry(run.body, panel.quarters, angle);
    const double turned = run.heading * 2 * half_turns;
    SlopePlace place{};
    place.quarters = run.turns + panel.quarters + turned;
    place.angle = {angle, 0.0};
    place.omega = omega_after(run, half_turns, level(run, panel.quarters, angle, at), at);
    place.path = run.from.path + (path_at(run.body, panel.quarters, angle) - run.path) +
                 two_product(turned, run.body.quarter_path);
    return place;
}

SlopePlace place_after(const SlopeRun& run, double half_turns) {
    const double turned = run.heading * 2 * half_turns;
    SlopePlace place = run.from;
    place.time = place.time + time_of(run, half_turns);
    place.quarters += turned;
    place.path = place.path + two_product(turned, run.body.quarter_path);
    place.omega = omega_after(run, half_turns, run.energy, run.at);
    return place;
}

}  // namespace rolling_ellipse
