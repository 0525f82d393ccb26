#include "rolling/slope/runs/run.hpp"

#include <algorithm>
#include <cmath>

namespace rolling_ellipse {
namespace {

constexpr double least_levels = 4;      // W/w from which the sums below are used
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

// Sum up terms (W + j w)^(-1/2) until the level is high enough for the asymptotic formula.
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

// The sum over j = 0 ... n - 1.
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

struct Centre {
    double quarters;
    double angle;
    double grade_angle;  // imaginary part of the nearest singularity of the integrand
    double at() const { return quarters * half_pi + angle; }
};

// Widest part of a panel in v. Singularities are pi/2 or more away, five times half of that width.
constexpr double widest_part = 0.6;

// The angle from the centre of a panel at v, and its derivative.
struct Offset {
    double angle;
    double rate;
};

Offset offset_at(const RunPanel& panel, double v) {
    const double tan = panel.grade * std::sinh(v);
    return {panel.scale * std::atan(tan),
            panel.scale * std::sqrt(square(tan) + square(panel.grade)) / (1 + square(tan))};
}

// W at a place minus W at `from`, without the gain of whole half turns.
double gained(const SlopeRun& run, double quarters, double angle, const Geometry& here) {
    return run.body.gravity.along * (path_at(run.body, quarters, angle) - run.path) +
           run.body.gravity.into * fall(run.body, run.at, here).value;
}

class RunMaker {
  public:
    RunMaker(const SlopeBody& body, const SlopePlace& from, double energy, double half_turns)
        : run_{} {
        run_.body = body;
        run_.from = from;
        run_.turns = 2 * std::floor(from.quarters / 2);
        run_.heading = std::copysign(1.0, from.omega);
        run_.half_turns = half_turns;
        run_.energy = energy;
        run_.path = path_at(body, from.quarters - run_.turns, double(from.angle));
        run_.at = geometry(body, from);
        const double lost = run_.heading < 0 ? (half_turns - 1) * body.gain : 0.0;
        // W is least at the unstable equilibrium, or at the tip if there is no equilibrium.
        const double hill = body.equilibria ? body.equilibria->upright : 0.0;
        const Geometry top = geometry(body, 1.0, hill);
        const double curvature = body.gravity.along * top.dh - body.gravity.into * top.ddh;
        const double least =
            std::max(energy - lost + body.gravity.into * fall(body, run_.at, top).value,
                     least_levels * body.gain);
        const double flat = std::asinh(std::sqrt(body.series.d0 / body.series.d1));
        const double beside_hill =
            curvature > 0 ? std::min(std::sqrt(2 * least / curvature), 1.0) : 1.0;
        for (int i = -4; i <= 4; i += 2) {
            centres_.push_back({double(i), 0.0, flat});
            centres_.push_back({double(i + 1), hill, beside_hill});
        }
    }

    SlopeRun make() {
        const double here = (run_.from.quarters - run_.turns) * half_pi + double(run_.from.angle);
        const double low = run_.heading > 0 ? here : here - pi;
        const double high = run_.heading > 0 ? here + pi : here;
        for (std::size_t i = 0; i + 1 < centres_.size(); ++i) {
            const double gap = centres_[i + 1].at() - centres_[i].at();
            const double split = centres_[i].at() + gap / 2;
            add(centres_[i], gap, std::max(low, centres_[i].at()), std::min(high, split));
            add(centres_[i + 1], gap, std::max(low, split), std::min(high, centres_[i + 1].at()));
        }
        if (run_.heading > 0) {
            for (const double level : run_.nodes.level) {
                run_.first.push_back(first_rates(level, run_.body.gain));
            }
        }
        return std::move(run_);
    }

  private:
    void add(const Centre& centre, double gap, double low, double high) {
        if (!(low < high)) return;
        const double scale = gap / half_pi;
        const double grade = std::tanh(centre.grade_angle / scale);
        const auto coordinate = [&](double at) {
            return std::asinh(std::tan((at - centre.at()) / scale) / grade);
        };
        RunPanel panel{};
        panel.quarters = centre.quarters;
        panel.angle = centre.angle;
        panel.scale = scale;
        panel.grade = grade;
        panel.first = coordinate(low);
        panel.last = coordinate(high);
        const double width = panel.last - panel.first;
        const double whole = std::asinh(1 / grade);
        const auto mapped = [&](double v) { return (2 * v - panel.first - panel.last) / width; };
        const int least = nodes_needed(pi / width, {mapped(0.0), mapped(whole), mapped(-whole)});
        panel.begin = run_.nodes.weight.size();
        add_nodes(panel, panel.first, panel.last, gauss_rule(least + least / 4), run_.nodes);
        panel.end = run_.nodes.weight.size();
        for (std::size_t i = panel.begin; i < panel.end; ++i) {
            run_.mass += run_.nodes.weight[i];
            run_.half_turn += run_.nodes.weight[i] / std::sqrt(run_.nodes.level[i]);
        }
        panel.part = run_.part_nodes.weight.size() / part_order;
        panel.parts = static_cast<int>(std::ceil(width / widest_part));
        for (int i = 0; i < panel.parts; ++i) {
            add_nodes(panel, panel.first + width * i / panel.parts,
                      panel.first + width * (i + 1) / panel.parts, part_rule(), run_.part_nodes);
        }
        run_.panels.push_back(panel);
    }

    void add_nodes(const RunPanel& panel, double first, double last, const GaussRule& rule,
                   RunNodes& nodes) const {
        const double half = (last - first) / 2;
        for (int i = 0; i < rule.size; ++i) {
            const auto [node, weight] = node_of(rule, i);
            const auto [offset, rate] = offset_at(panel, first + half * (1 + node));
            const double angle = panel.angle + offset;
            const Geometry at = geometry(run_.body, panel.quarters, angle);
            const double root = std::sqrt(0.5 * inertia_about_contact(run_.body.gyration2, at));
            nodes.weight.push_back(weight * half * rate * root);
            nodes.level.push_back(run_.energy + gained(run_, panel.quarters, angle, at));
        }
    }

    SlopeRun run_;
    std::vector<Centre> centres_;
};

}  // namespace

double may_run(const SlopeBody& body, double energy, const Geometry& at, double omega) {
    // The height of the tip as a product, exact for nearly round bodies, too.
    const double to_tip = body.c2 * square(at.cos) / (at.h + body.long_axis);
    const double above = energy - body.gravity.into * to_tip;
    const double levels = above / body.gain - least_levels;
    if (!(levels >= 0)) return 0.0;
    return omega > 0 ? most_half_turns : std::min(std::floor(levels), most_half_turns);
}

SlopeRun slope_run(const SlopeBody& body, const SlopePlace& from, double energy,
                   double half_turns) {
    return RunMaker(body, from, energy, half_turns).make();
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

SlopePlace place_on(const SlopeRun& run, const RunPanel& panel, double v, double half_turns) {
    const double angle = panel.angle + offset_at(panel, v).angle;
    const Geometry at = geometry(run.body, panel.quarters, angle);
    const double w = run.energy + gained(run, panel.quarters, angle, at) +
                     run.heading * half_turns * run.body.gain;
    const double inertia = inertia_about_contact(run.body.gyration2, at);
    const double turned = run.heading * 2 * half_turns;
    SlopePlace place{};
    place.quarters = run.turns + panel.quarters + turned;
    place.angle = {angle, 0.0};
    place.omega = run.heading * std::sqrt(2 * w / inertia);
    place.path = run.from.path + (path_at(run.body, panel.quarters, angle) - run.path) +
                 two_product(turned, run.body.quarter_path);
    return place;
}

SlopePlace place_after(const SlopeRun& run, double half_turns) {
    const Geometry at = geometry(run.body, run.from);
    const double turned = run.heading * 2 * half_turns;
    const double w = run.energy + run.heading * half_turns * run.body.gain;
    SlopePlace place = run.from;
    place.time = place.time + time_of(run, half_turns);
    place.quarters += turned;
    place.path = place.path + two_product(turned, run.body.quarter_path);
    place.omega = run.heading * std::sqrt(2 * w / inertia_about_contact(run.body.gyration2, at));
    return place;
}

}  // namespace rolling_ellipse
