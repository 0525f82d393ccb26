#include "rolling/slope_run.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "numerics/quadrature.hpp"

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

// The sum of (W + j w)^(-1/2) over j = 0 ... n - 1.
double sum_of_rates(double level, double gain, double n) {
    double sum = 0.0;
    while (n > 0 && (level < asymptotic_from * gain || n < 4)) {
        sum += 1 / std::sqrt(level);
        level += gain;
        n -= 1;
    }
    if (n == 0) return sum;
    const double end = std::fma(n, gain, level);
    const double a = std::sqrt(level);
    const double b = std::sqrt(end);
    const double ends = n * gain / (2 * a * b * (a + b));
    return sum + (2 * n / (a + b) + (ends + (remainder(level, gain) - remainder(end, gain))));
}

struct Centre {
    double quarters;
    double angle;
    double grade_angle;  // how far beside it the integrand is singular
    double at() const { return quarters * half_pi + angle; }
};

// Where W is least: physics (58) with h' = h tan(slope), beyond the well; the tip if there is none.
double hill_angle(const SlopeBody& body) {
    const double incline = body.gravity.along / body.gravity.into;
    const double both = 2 * body.long_axis * body.short_axis * incline;
    const double root = (body.c2 - both) * (body.c2 + both);
    if (root <= 0) return 0.0;
    return -std::atan2(2 * square(body.long_axis) * incline, body.c2 + std::sqrt(root));
}

// The nodes of a rule, ascending.
struct Node {
    double place;
    double weight;
};

Node node_of(const GaussRule& rule, int i) {
    const bool left = i < rule.size / 2;
    const int from_middle = left ? (rule.size + 1) / 2 - 1 - i : i - rule.size / 2;
    return {left ? -rule.nodes[from_middle] : rule.nodes[from_middle], rule.weights[from_middle]};
}

// The rule of the parts, whose integrand is met by a polynomial through its nodes: no singularity
// is closer than pi/2, five times half of a part.
const GaussRule& part_rule = gauss_rule(16);
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

// W less that at `from`.
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
        run_.energy = energy;
        run_.path = path_at(body, from.quarters - run_.turns, double(from.angle));
        run_.at = geometry(body, from);
        const double lost = run_.heading < 0 ? (half_turns - 1) * body.gain : 0.0;
        const double hill = hill_angle(body);
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
        panel.part = run_.part_nodes.weight.size() / part_rule.size;
        panel.parts = static_cast<int>(std::ceil(width / widest_part));
        for (int i = 0; i < panel.parts; ++i) {
            add_nodes(panel, panel.first + width * i / panel.parts,
                      panel.first + width * (i + 1) / panel.parts, part_rule, run_.part_nodes);
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

// Half turns that take about so long: as if D and W were the same everywhere.
double guess(const SlopeRun& run, double time) {
    const double speed = run.mass / run.half_turn;  // sqrt(W)
    const double change = run.heading * run.body.gain * time / (4 * run.mass);
    return std::max(std::floor(time / run.mass * (speed + change)), 0.0);
}

// The place in a part, -1 .. 1, at a time after its begin: the integrand by Legendre polynomials,
// from the times that belong to the nodes.
double place_in_part(const double* times, double time) {
    constexpr int n = 16;
    std::array<double, n> nodes, before, now, coefficients;
    for (int i = 0; i < n; ++i) {
        nodes[i] = node_of(part_rule, i).place;
        before[i] = 1.0;
        now[i] = nodes[i];
    }
    for (int k = 0; k < n; ++k) {
        const double up = (2 * k + 3.0) / (k + 2);
        const double down = (k + 1.0) / (k + 2);
        double sum = 0.0;
        for (int i = 0; i < n; ++i) {
            sum += times[i] * before[i];
            const double next = up * nodes[i] * now[i] - down * before[i];
            before[i] = now[i];
            now[i] = next;
        }
        coefficients[k] = (k + 0.5) * sum;
    }
    constexpr int most_tries = 60;
    constexpr double converged = 1e-9;  // Newton's method squares it
    double x = std::clamp(time / coefficients[0] - 1, -1.0, 1.0);
    double low = -1.0;
    double high = 1.0;
    for (int i = 0; i < most_tries; ++i) {
        double p0 = 1.0;
        double p1 = x;
        double rate = coefficients[0];
        double sum = coefficients[0] * (x + 1);
        for (int k = 1; k < n; ++k) {
            const double p2 = ((2 * k + 1) * x * p1 - k * p0) / (k + 1);
            rate += coefficients[k] * p1;
            sum += coefficients[k] * (p2 - p0) / (2 * k + 1);
            p0 = p1;
            p1 = p2;
        }
        const double rest = time - sum;
        (rest > 0 ? low : high) = x;
        double next = x + rest / rate;
        if (!(next >= low && next <= high)) next = 0.5 * (low + high);
        const double moved = std::abs(next - x);
        x = next;
        if (moved < converged) break;
    }
    return x;
}

// The times that belong to nodes, after so many half turns; returns their sum.
double times_of(const SlopeRun& run, const RunNodes& nodes, std::size_t begin, std::size_t end,
                double half_turns, double* times) {
    const double change = run.heading * half_turns * run.body.gain;
    double sum = 0.0;
    for (std::size_t i = begin; i < end; ++i) {
        const double time = nodes.weight[i] / std::sqrt(nodes.level[i] + change);
        if (times) *times++ = time;
        sum += time;
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

// The place at a time after the upper end of the half turn that follows n of them.
SlopePlace place_in_half_turn(const SlopeRun& run, double half_turns, double rest) {
    for (const RunPanel& panel : run.panels) {
        const double whole = times_of(run, run.nodes, panel.begin, panel.end, half_turns, nullptr);
        const bool is_last = &panel == &run.panels.back();
        if (rest > whole && !is_last) {
            rest -= whole;
            continue;
        }
        for (int i = 0; i < panel.parts; ++i) {
            std::array<double, 16> times{};
            const std::size_t begin = (panel.part + i) * times.size();
            const double part = times_of(run, run.part_nodes, begin, begin + times.size(),
                                         half_turns, times.data());
            if (rest > part && i + 1 < panel.parts) {
                rest -= part;
                continue;
            }
            const double x = place_in_part(times.data(), std::clamp(rest, 0.0, part));
            const double v =
                panel.first + (panel.last - panel.first) * (i + 0.5 * (x + 1)) / panel.parts;
            return place_on(run, panel, v, half_turns);
        }
    }
    return run.from;
}

}  // namespace

double may_run(const SlopeBody& body, double energy, const Geometry& at, double omega) {
    // As a product: the height of one that is nearly a circle would be a rounding.
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
    const auto& [weight, level] = run.nodes;
    DoubleDouble sum{};
    for (std::size_t i = 0; i < weight.size(); ++i) {
        sum = sum + two_product(weight[i], sum_of_rates(level[i] - lowest, gain, half_turns));
    }
    return sum;
}

SlopePlace place_at(const SlopeRun& run, DoubleDouble time) {
    constexpr int most_tries = 20;
    const DoubleDouble since = time - run.from.time;
    double half_turns = guess(run, double(since));
    double rest = 0.0;
    double lasts = 0.0;
    for (int i = 0; i < most_tries; ++i) {
        rest = double(since - time_of(run, half_turns));
        lasts = times_of(run, run.nodes, 0, run.nodes.weight.size(), half_turns, nullptr);
        const double over = std::floor(rest / lasts);
        if (over == 0 || half_turns + over < 0) break;
        half_turns += over;
    }
    SlopePlace place = place_in_half_turn(run, half_turns, run.heading < 0 ? lasts - rest : rest);
    place.time = time;
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
