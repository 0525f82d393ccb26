#include "rolling/slope_run.hpp"

#include <algorithm>
#include <cmath>

#include "numerics/quadrature.hpp"

namespace rolling_ellipse {
namespace {

constexpr double least_levels = 4;       // W/w from which the sums below are used
constexpr double asymptotic_from = 14;   // W/w from which R(W) is right to 2e-17
constexpr double most_half_turns = 1e15;

// sqrt(w) R(W/w) of physics (63).
double remainder(double level, double gain) {
    const double ratio = gain / level;
    const double r2 = square(ratio);
    const double series =
        1.0 / 24 +
        r2 * (-1.0 / 384 +
              r2 * (1.0 / 1024 +
                    r2 * (-143.0 / 163840 + r2 * (0.00140508015951 - r2 * 0.00354755719503))));
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

// Where W is least: physics (61) with h' = h tan(slope), beyond the well; the tip if there is none.
double hill_angle(const SlopeBody& body) {
    const double incline = body.gravity.along / body.gravity.into;
    const double both = 2 * body.long_axis * body.short_axis * incline;
    const double root = (body.c2 - both) * (body.c2 + both);
    if (root <= 0) return 0.0;
    return -std::atan2(2 * square(body.long_axis) * incline, body.c2 + std::sqrt(root));
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
        run_.height = geometry(body, from).h;
        const double lost = run_.heading < 0 ? (half_turns - 1) * body.gain : 0.0;
        const double hill = hill_angle(body);
        const Geometry top = geometry(body, 1.0, hill);
        const double curvature = body.gravity.along * top.dh - body.gravity.into * top.ddh;
        const double least = std::max(energy - lost - body.gravity.into * (top.h - run_.height),
                                      least_levels * body.gain);
        const double flat = std::asinh(std::sqrt(body.series.d0 / body.series.d1));
        const double beside_hill =
            curvature > 0 ? std::min(std::sqrt(2 * least / curvature), 1.0) : 1.0;
        for (int i = -2; i <= 4; i += 2) {
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
            add(centres_[i + 1], gap, std::max(low, split),
                std::min(high, centres_[i + 1].at()));
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
        RunPanel panel{centre.quarters, centre.angle, scale,          grade, coordinate(low),
                       coordinate(high), run_.place.size(), 0};
        const double width = panel.last - panel.first;
        const double whole = std::asinh(1 / grade);
        const auto mapped = [&](double v) { return (2 * v - panel.first - panel.last) / width; };
        const GaussRule& rule =
            gauss_rule(nodes_needed(pi / width, {mapped(0.0), mapped(whole), mapped(-whole)}));
        panel.size = rule.size;
        for (int i = 0; i < rule.size; ++i) {
            const int from_middle = i < rule.size / 2 ? (rule.size + 1) / 2 - 1 - i
                                                      : i - rule.size / 2;
            const double node = std::copysign(rule.nodes[from_middle], i < rule.size / 2 ? -1 : 1);
            add_node(panel, node, rule.weights[from_middle] * width / 2);
        }
        run_.panels.push_back(panel);
    }

    void add_node(const RunPanel& panel, double node, double weight);

    SlopeRun run_;
    std::vector<Centre> centres_;
};

// The angle from the centre of a panel at v, and its derivative.
struct Offset {
    double angle;
    double rate;
};

Offset offset_at(const RunPanel& panel, double node) {
    const double v = 0.5 * ((panel.first + panel.last) + node * (panel.last - panel.first));
    const double tan = panel.grade * std::sinh(v);
    return {panel.scale * std::atan(tan),
            panel.scale * std::sqrt(square(tan) + square(panel.grade)) / (1 + square(tan))};
}

// W less that at `from`.
double gained(const SlopeRun& run, double quarters, double angle, double height) {
    return run.body.gravity.along * (path_at(run.body, quarters, angle) - run.path) -
           run.body.gravity.into * (height - run.height);
}

void RunMaker::add_node(const RunPanel& panel, double node, double weight) {
    const auto [offset, rate] = offset_at(panel, node);
    const double angle = panel.angle + offset;
    const Geometry at = geometry(run_.body, panel.quarters, angle);
    const double root = std::sqrt(0.5 * inertia_about_contact(run_.body.gyration2, at));
    const double level = run_.energy + gained(run_, panel.quarters, angle, at.h);
    run_.place.push_back(node);
    run_.weight.push_back(weight * rate * root);
    run_.level.push_back(level);
    run_.mass += run_.weight.back();
    run_.half_turn += run_.weight.back() / std::sqrt(level);
}

// Half turns that take about so long: as if D and W were the same everywhere.
double guess(const SlopeRun& run, double time) {
    const double speed = run.mass / run.half_turn;  // sqrt(W)
    const double change = run.heading * run.body.gain * time / (4 * run.mass);
    return std::max(std::floor(time / run.mass * (speed + change)), 0.0);
}

// The place in a panel, -1 .. 1, at a time after its begin: the integrand by Legendre polynomials,
// from the times that belong to the nodes.
double place_in_panel(const double* nodes, const double* times, std::size_t n, double time) {
    constexpr std::size_t most = 128;
    double before[most], now[most], coefficients[most];
    for (std::size_t i = 0; i < n; ++i) {
        before[i] = 1.0;
        now[i] = nodes[i];
    }
    for (std::size_t k = 0; k < n; ++k) {
        double sum = 0.0;
        for (std::size_t i = 0; i < n; ++i) {
            sum += times[i] * before[i];
            const double next = ((2 * k + 3) * nodes[i] * now[i] - (k + 1) * before[i]) / (k + 2);
            before[i] = now[i];
            now[i] = next;
        }
        coefficients[k] = (k + 0.5) * sum;
    }
    double x = std::min(2 * time / (2 * coefficients[0]) - 1, 1.0);
    double low = -1.0;
    double high = 1.0;
    for (int i = 0; i < 40; ++i) {
        double p0 = 1.0, p1 = x, rate = coefficients[0], sum = coefficients[0] * (x + 1);
        for (std::size_t k = 1; k < n; ++k) {
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
        if (moved < 1e-9) break;  // Newton's method squares it
    }
    return x;
}

SlopePlace place_on(const SlopeRun& run, const RunPanel& panel, double node, double half_turns) {
    const double angle = panel.angle + offset_at(panel, node).angle;
    const Geometry at = geometry(run.body, panel.quarters, angle);
    const double w = run.energy + gained(run, panel.quarters, angle, at.h) +
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

}  // namespace

double may_run(const SlopeBody& body, double energy, double height, double omega) {
    const double above = energy - body.gravity.into * (body.long_axis - height);
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
    DoubleDouble sum{};
    for (std::size_t i = 0; i < run.weight.size(); ++i) {
        sum = sum + two_product(run.weight[i], sum_of_rates(run.level[i] - lowest, gain, half_turns));
    }
    return sum;
}

SlopePlace place_at(const SlopeRun& run, DoubleDouble time) {
    constexpr int most_tries = 20;
    std::vector<double> times(run.weight.size());
    const DoubleDouble since = time - run.from.time;
    double half_turns = guess(run, double(since));
    double rest = 0.0;
    double lasts = 0.0;
    for (int i = 0; i < most_tries; ++i) {
        rest = double(since - time_of(run, half_turns));
        lasts = 0.0;
        for (std::size_t j = 0; j < times.size(); ++j) {
            const double w = run.level[j] + run.heading * half_turns * run.body.gain;
            times[j] = run.weight[j] / std::sqrt(w);
            lasts += times[j];
        }
        const double over = std::floor(rest / lasts);
        if (over == 0 || half_turns + over < 0) break;
        half_turns += over;
    }
    if (run.heading < 0) rest = lasts - rest;
    for (const RunPanel& panel : run.panels) {
        double part = 0.0;
        for (std::size_t j = 0; j < panel.size; ++j) part += times[panel.begin + j];
        if (rest > part && &panel != &run.panels.back()) {
            rest -= part;
            continue;
        }
        const double node = place_in_panel(&run.place[panel.begin], &times[panel.begin], panel.size,
                                           std::clamp(rest, 0.0, part));
        SlopePlace place = place_on(run, panel, node, half_turns);
        place.time = time;
        return place;
    }
    return run.from;
}

SlopePlace place_after(const SlopeRun& run, double half_turns) {
    const Geometry at = geometry(run.body, run.from);
    const double turned = run.heading * 2 * half_turns;
    const double w = run.energy + run.heading * half_turns * run.body.gain;
    SlopePlace place = run.from;
    place.time = place.time + time_of(run, half_turns);
    place.quarters += turned;
    place.path = place.path + two_product(turned, run.body.quarter_path);
    place.omega =
        run.heading * std::sqrt(2 * w / inertia_about_contact(run.body.gyration2, at));
    return place;
}

}  // namespace rolling_ellipse
