#include "rolling/slope/run.hpp"

#include <algorithm>
#include <cmath>

#include "rolling/slope/panel.hpp"

namespace rolling_ellipse {
namespace {

constexpr double least_levels = 0.25;   // least W/w at which sums over half turns are used
constexpr double asymptotic_from = 14;  // W/w from which R(W/w) is accurate to 2e-17
constexpr double few = 4;               // fewer half turns than this are cheaper to add one by one
constexpr std::size_t most_begins = 1 + std::size_t(asymptotic_from + few);
constexpr std::size_t usual_panels = 12;

// The remainder R(W/w)/sqrt(w) of physics (60), from w/W and 1/sqrt(W).
[[gnu::always_inline]] inline Pack remainder(Pack ratio, Pack over_root) {
    return ratio * over_root *
           horner(ratio * ratio, -0.00354755719503, 0.00140508015951, -143.0 / 163840, 1.0 / 1024,
                  -1.0 / 384, 1.0 / 24);
}

// The sum of (W + j w)^(-1/2) over j = 0 ... n - 1 by the Euler-Maclaurin formula, with W = level
// and w = gain.
[[gnu::always_inline]] inline Pack sum_of_rates(Pack level, double gain, double n) {
    const Pack end = level + n * gain;
    const Pack a = sqrt(level);
    const Pack b = sqrt(end);
    const Pack over_a = 1 / a;
    const Pack over_b = 1 / b;
    const Pack over_sum = 1 / (a + b);
    const Pack ends = 0.5 * n * gain * (over_a * over_b * over_sum);
    return 2 * n * over_sum + (ends + (remainder(gain * (over_a * over_a), over_a) -
                                       remainder(gain * (over_b * over_b), over_b)));
}

// Widest part of a panel in v. Singularities are at least pi/2 away, so that the terms of the
// polynomial of a part fall by a factor of 5.4 per degree.
constexpr double widest_part = 1.2;

// Centre of two panels: a flat position, the point near a tip where W is least, or the middle of a
// wide gap between two such points.
struct Centre {
    double quarters;
    double angle;
    double grade;
    double at() const { return quarters * half_pi + angle; }
};

// Appends the part of the panel from low to high that lies in the first half turn of the run. The
// ends of the half turn are accurate even near a tip.
void add_panel(SlopeRun& run, const Centre& centre, double low, double high) {
    const double quarters = run.from.quarters - run.turns;
    const double angle = run.heading * double(run.from.angle);
    const double here = run.heading * quarters * half_pi + angle;
    if (!(std::max(low, here) < std::min(high, here + pi))) return;
    const auto end_of_half_turn = [&](double after) {
        return (run.heading * quarters + after - centre.quarters) * half_pi +
               (angle - centre.angle);
    };
    run.panels.push_back({centre.quarters, centre.angle, 0.0, 0.0, centre.grade,
                          low > here ? low - centre.at() : end_of_half_turn(0.0),
                          high < here + pi ? high - centre.at() : end_of_half_turn(2.0)});
}

// Completes a panel whose ends are still angles from the centre.
void open(RunPanel& panel) {
    const double s = std::sin(panel.angle);
    const double c = std::cos(panel.angle);
    const bool tip = is_odd(panel.quarters);
    panel.sin = tip ? c : s;
    panel.cos = tip ? -s : c;
    panel.first = std::asinh(std::tan(panel.first) / panel.grade);
    panel.last = std::asinh(std::tan(panel.last) / panel.grade);
}

// W at the tip, given W at `at`, without the gain along the slope. The rise of the centre up to the
// tip is computed as a product, which is accurate even for nearly round bodies.
double over_tip(const SlopeBody& body, double energy, const Geometry& at) {
    return energy - body.gravity.into * (body.c2 * square(at.cos) / (at.h + body.long_axis));
}

// The datum of a run: the point where it starts, or the nearest tip if W at the tip would be a
// small difference when computed from that point. W at the tip is then computed from the start of
// the motion, which is accurate even if the start is near another tip.
Datum datum_of(const SlopeRun& run, const Datum& start) {
    constexpr double small = 0.0625;  // fraction of W that is left at the tip
    const SlopeBody& body = run.body;
    const auto& [energy, at, path_to] = run.start;
    const double left = body.gain + std::abs(over_tip(body, energy, at));
    if (left > small * energy) return run.start;
    const bool is_ahead = run.heading * at.sin * at.cos >= 0;
    const double way = path_from_tip(body.lying(), std::abs(at.cos), std::abs(at.sin));
    const double path = is_ahead ? way : -way;
    const double since_start = double(run.from.path + run.heading * path);
    return {over_tip(body, start.energy, start.at) + body.gravity.along * since_start,
            geometry(body, 1.0, 0.0), path};
}

// Appends the next part. Its nodes are computed side by side.
ROLLING_ELLIPSE_WIDE void add_part(SlopeRun& run) {
    const RunPanel& panel = run.panels[run.next_panel];
    const double width = panel.last - panel.first;
    const int parts = std::max(1, static_cast<int>(std::ceil(width / widest_part)));
    RunPart& part = run.parts.emplace_back();
    part.panel = run.next_panel;
    part.half = 0.5 * width / parts;
    part.middle = panel.first + part.half * (2 * run.next_part + 1);
    if (++run.next_part == parts) {
        run.next_part = 0;
        ++run.next_panel;
    }
    const SlopeBody& body = run.body;
    const PartRule& rule = part_rule();
    PartArray falls;
    for (int i = 0; i < part_order; i += lanes) {
        const PanelPlaces at = places_at(run, part, load(&rule.places[i]));
        const Pack rate = part.half * at.tan_rate * at.over;
        store(at.h * rate, &part.advance[i]);
        store(rate * sqrt(0.5 * (body.d0 + body.d1 * at.sin2) / at.h2), &part.mass[i]);
        store(at.fall, &falls[i]);
    }
    part.path = run.path_ahead;
    const PartArray path = product(rule.integrals, part.advance);
    const double along = run.heading * body.gravity.along;
    for (int i = 0; i < part_order; ++i) {
        part.level[i] = run.datum.energy + (along * (run.path_ahead - run.datum.path + path[i]) +
                                            body.gravity.into * falls[i]);
    }
    part.lasts = integral(node_times(part, 0.0));
    run.path_ahead += integral(part.advance);
    run.mass += integral(part.mass);
    run.known += part.lasts;
}

}  // namespace

double may_run(const SlopeBody& body, double energy, const Geometry& at, const SlopePlace& from) {
    double least = over_tip(body, energy, at);
    if (least < -body.gain) return 0.0;  // half a turn downhill adds only this gain
    if (from.omega > 0) {
        // The path to the next unstable equilibrium is at least the angle to it times the short
        // semi-axis.
        const double hill = body.equilibria ? body.equilibria->upright : 0.0;
        const double ahead = (is_odd(from.quarters) ? hill : half_pi + hill) - double(from.angle);
        const double angle = ahead < 0 ? ahead + pi : ahead;
        least = std::min(energy, least + body.gravity.along * body.short_axis * angle);
    }
    const double levels = least / body.gain - least_levels;
    if (!(levels >= 0)) return 0.0;
    return from.omega > 0 ? most_half_turns : std::min(std::floor(levels), most_half_turns);
}

SlopeRun slope_run(const SlopeBody& body, const Datum& start, const SlopePlace& from,
                   const Datum& here, double half_turns) {
    SlopeRun run{};
    run.body = body;
    run.from = from;
    run.heading = std::copysign(1.0, from.omega);
    run.turns = run.heading * 2 * std::floor(run.heading * from.quarters / 2);
    run.half_turns = half_turns;
    run.start = here;
    run.datum = datum_of(run, start);
    run.panels.reserve(usual_panels);
    run.parts.reserve(usual_parts);

    // Uphill, W falls by the gain in each half turn. Within a half turn it is least at the unstable
    // equilibrium, or at the tip if there is none.
    const double lost = run.heading < 0 ? (half_turns - 1) * body.gain : 0.0;
    const double hill = body.equilibria ? body.equilibria->upright : 0.0;
    const Geometry top = geometry(body, 1.0, hill);
    const double curvature = body.gravity.along * top.dh - body.gravity.into * top.ddh;
    const double fallen = fall(body, run.datum.at, top).value;
    const double least =
        std::max(run.datum.energy - lost + body.gravity.into * fallen, least_levels * body.gain);
    // A grade approximates the tanh of the imaginary part of the nearest singularity of dt/dphi.
    const double at_flat = grade_at_flat(body);
    // The singularities near the flat position may be closer to the unstable equilibrium (the hill)
    // than those of the hill.
    const double to_flat = half_pi - std::abs(hill);
    const double from_hill = curvature > 0 ? std::min(std::sqrt(2 * least / curvature), 1.0) : 1.0;
    const double at_hill = std::tanh(std::min(from_hill, to_flat / 2));

    const auto centre = [&](int quarters) {
        return quarters % 2 == 0 ? Centre{double(quarters), 0.0, at_flat}
                                 : Centre{double(quarters), run.heading * hill, at_hill};
    };
    const auto add_between = [&](const Centre& left, const Centre& right) {
        const double split = left.at() + (right.at() - left.at()) / 2;
        add_panel(run, left, left.at(), split);
        add_panel(run, right, split, right.at());
    };
    constexpr double widest_gap = 2.0;  // in a wider gap, v would be too large
    for (int i = -3; i < 5; ++i) {
        const Centre left = centre(i);
        const Centre right = centre(i + 1);
        if (right.at() - left.at() <= widest_gap) {
            add_between(left, right);
        } else {
            const QuarterView at = quarter_view({left.at() + (right.at() - left.at()) / 2, 0.0});
            const Centre middle{at.quarters, double(at.rest), std::tanh(1.0)};
            add_between(left, middle);
            add_between(middle, right);
        }
    }
    return run;
}

void extend(SlopeRun& run, double since) {
    while (!run.is_complete() && !(run.known > since)) {
        if (run.next_part == 0) open(run.panels[run.next_panel]);
        add_part(run);
    }
}

ROLLING_ELLIPSE_WIDE PartArray node_times(const RunPart& part, double gained) {
    PartArray times;
    for (int i = 0; i < part_order; i += lanes) {
        store(load(&part.mass[i]) / sqrt(load(&part.level[i]) + gained), &times[i]);
    }
    return times;
}

double about(const SlopeRun& run, double since) {
    const double speed = run.mass / run.known;  // mean of sqrt(W)
    const double change = run.heading * run.body.gain * since / (4 * run.mass);
    return std::max(std::floor(since / run.mass * (speed + change)), 0.0);
}

void RunTimes::start() {
    begins_.reserve(most_begins);
    begins_.push_back({});
    for (const RunPart& part : run_.parts) {
        lowest_ = std::min(lowest_, *std::min_element(part.level.begin(), part.level.end()));
    }
}

// The terms with the least W (the first half turns downhill, the last ones uphill) are added one by
// one until the formula is accurate.
DoubleDouble RunTimes::operator()(double half_turns) {
    if (half_turns == 0) return {};
    if (begins_.empty()) start();
    const double gain = run_.body.gain;
    const double fallen = run_.heading < 0 ? half_turns - 1 : 0.0;
    const double missing = asymptotic_from - (lowest_ / gain - fallen);
    double first = std::clamp(std::ceil(missing), 0.0, half_turns);
    if (half_turns - first < few) first = half_turns;
    if (run_.heading < 0) begins_.resize(1);
    while (begins_.size() <= first) {
        const double j = double(begins_.size() - 1);
        DoubleDouble sum = begins_.back();
        for (const RunPart& part : run_.parts) {
            const double after = run_.heading < 0 ? fallen - j : j;
            sum = sum + (after == 0 ? part.lasts : integral(node_times(part, run_.gained(after))));
        }
        begins_.push_back(sum);
    }
    DoubleDouble sum = begins_[static_cast<std::size_t>(first)];
    if (first == half_turns) return sum;
    const PartArray& weights = part_rule().weights;
    PackPair sums{};
    for (const RunPart& part : run_.parts) {
        for (int i = 0; i < part_order; i += lanes) {
            const Pack from = load(&part.level[i]) + (first - fallen) * gain;
            const PackPair time = two_product(load(&weights[i]) * load(&part.mass[i]),
                                              sum_of_rates(from, gain, half_turns - first));
            const PackPair added = two_sum(sums.high, time.high);
            sums = {added.high, sums.low + (added.low + time.low)};
        }
    }
    for (int i = 0; i < lanes; ++i) {
        sum = sum + DoubleDouble{lane_of(sums.high, i), lane_of(sums.low, i)};
    }
    return sum;
}

// Computes N and F as `contact_force` does.
ROLLING_ELLIPSE_WIDE PartForces node_forces(const SlopeRun& run, const RunPart& part,
                                            double half_turns) {
    const auto positions_at = [&](Pack x) __attribute__((always_inline)) {
        return places_at(run, part, x);
    };
    return forces_at(run.body, part, run.heading, run.gained(half_turns), positions_at);
}

ROLLING_ELLIPSE_WIDE PartArray legendre_coefficients(const PartArray& at_nodes) {
    return product(part_rule().legendre, at_nodes);
}

SlopePlace place_after(const SlopeRun& run, double half_turns) {
    const double turned = run.heading * 2 * half_turns;
    SlopePlace place = run.from;
    place.time = place.time + RunTimes(run)(half_turns);
    place.quarters += turned;
    place.path = place.path + two_product(turned, run.body.quarter_path);
    place.omega = omega_at(run.body, run.start.energy + run.heading * half_turns * run.body.gain,
                           run.start.at) *
                  run.heading;
    return place;
}

}  // namespace rolling_ellipse
