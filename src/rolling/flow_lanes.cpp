#include "rolling/flow_lanes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "numerics/quadrature.hpp"
#include "rolling/motion_series.hpp"

namespace rolling_ellipse {
namespace {

constexpr std::size_t most_bodies = 512;  // of one kernel call
constexpr double largest_loss = 2.0;      // of digits of x, see LaneKernel: a bit

#ifdef ROLLING_ELLIPSE_HAS_LANES
detail::LaneKernel kernel(LaneLevel level) {
    switch (level) {
        case LaneLevel::avx512:
            return detail::sample_avx512;
        case LaneLevel::avx2:
            return detail::sample_avx2;
        case LaneLevel::sse2:
            return detail::sample_sse2;
        case LaneLevel::one_by_one:
            break;
    }
    return nullptr;
}
#else
detail::LaneKernel kernel(LaneLevel) { return nullptr; }
#endif

FlowSample sample_alone(const RollingStart& start, double t) {
    const RollingMotion motion = rolling_motion(start);
    validate_time(t, longest_time(motion));
    return sample(motion, t);
}

// The path of a move so short that a power series about the start reaches it; full relative
// accuracy.
std::optional<double> series_path(const RollingStart& start, double t) {
    const Shape body = shape(start.body, start.view);
    const double s2 = square(body.short_axis);
    const SeriesConstants constants{
        s2, body.c2, start.body.gravity * square(t) / start.view.long_axis,
        s2 * (body.gyration2 + s2), body.c2 * (body.gyration2 + 1 + s2)};
    const Series path =
        motion_series(constants, start.view.sin, start.view.cos, start.omega * t).path;
    const double whole = value(path, 1.0);
    const double last = std::abs(path[series_order - 1]) + std::abs(path[series_order]);
    if (!(last <= 0.25 * epsilon * std::abs(whole))) return std::nullopt;
    return start.view.long_axis * whole;
}

// No factor of the integrand leaves the range in which products of a few of them are doubles.
bool is_ordinary(const RollingStart& start) {
    const auto within = [](double value, double unit, double most) {
        return value <= most * unit && value * most >= unit;
    };
    const double length = start.view.long_axis;
    return within(length, 1.0, 1e10) && within(start.body.gravity, 1.0, 1e10) &&
           within(start.body.gyration2, square(length), 1e6) &&
           start.height.total <= 1e10 * length && start.height.over_flat >= 1e-100 * length;
}

// The rule that the panels of a motion ask for; -1 for motions that lanes do not take.
int rule_for(const RollingStart& start) {
    const FlatView& at = start.view;
    const EnergyHeight& height = start.height;
    if (start.rests || at.c2 == 0 || !is_ordinary(start)) return -1;
    // The squares of the grades as fractions, with the names of flow.cpp.
    const double flat2 = height.over_flat * (height.total + at.short_axis);
    const double tip2 = std::abs(height.over_tip) * (height.total + at.long_axis);
    const bool rotates = height.over_tip >= 0 && start.omega != 0;
    const double unit = rotates ? flat2 : at.c2;
    const double s2 = square(at.short_axis);
    const double d0 = s2 * (start.body.gyration2 + s2);
    const double d1 = at.c2 * (start.body.gyration2 + square(at.long_axis) + s2);
    const double d_tip = d0 + d1 * (rotates ? 1.0 : flat2 / unit);
    for (int rule = 0; rule < detail::lane_rule_count; ++rule) {
        const double least = detail::lane_rules[rule].least_grade2;
        if (d0 >= least * d_tip && tip2 >= least * unit) return rule;
    }
    return -1;
}

// Bodies by the rule that they need, so that those side by side in a kernel take as many steps.
class Sorter {
  public:
    Sorter(LaneLevel level, const RollingStart* starts, const double* times, FlowSample* samples)
        : kernel_(kernel(level)), starts_(starts), times_(times), samples_(samples) {}

    void add(std::size_t i) {
        const RollingStart& start = starts_[i];
        const bool finite = std::abs(times_[i]) <= std::numeric_limits<double>::max();
        if (times_[i] == 0) {
            samples_[i] = {start.theta, start.omega, 0.0};
            return;
        }
        // A short move is the small difference of two times, which its power series is not.
        const bool alone = !finite || may_be_short(times_[i], start.omega, start.body.gravity,
                                                   start.view.short_axis);
        const int rule = kernel_ != nullptr && !alone ? rule_for(start) : -1;
        if (rule < 0) {
            samples_[i] = sample_alone(start, times_[i]);
            return;
        }
        places_[rule][counts_[rule]++] = static_cast<std::uint32_t>(i);
        if (counts_[rule] == most_bodies) take(rule);
    }

    void finish() {
        for (int rule = 0; rule < detail::lane_rule_count; ++rule) take(rule);
    }

  private:
    void take(int rule) {
        std::array<double, most_bodies> losses;
        const detail::LaneBodies bodies{starts_, times_, places_[rule].data(),
                                        static_cast<int>(counts_[rule]), rule};
        if (bodies.count > 0) kernel_(bodies, samples_, losses.data());
        counts_[rule] = 0;
        for (int k = 0; k < bodies.count; ++k) {
            if (!(losses[k] <= largest_loss)) complete(bodies.places[k], losses[k], rule);
        }
    }

    // What a kernel left open, or so that digits of x are lost.
    void complete(std::size_t i, double loss, int rule) {
        std::optional<double> path;
        if (loss < infinity) {
            path = series_path(starts_[i], times_[i]);
            if (!path) path = path_over_time(starts_[i], times_[i], rule);
        }
        if (path) {
            samples_[i].x = *path;
        } else {
            samples_[i] = sample_alone(starts_[i], times_[i]);
        }
    }

    // The integral of h omega over time, for moves that stay on their side of 45 degrees: no place
    // of it is as far as the flat position or the tip, beside which the integrand has its
    // singularities. A path half as long as that to the tip may lead past a flat position.
    std::optional<double> path_over_time(RollingStart start, double t, int rule) const {
        constexpr int nodes = 16;
        const GaussRule& gauss = gauss_rule(nodes);
        start.theta = std::atan2(start.view.sin, start.view.cos);
        std::array<RollingStart, nodes> starts;
        std::array<double, nodes> times;
        std::array<std::uint32_t, nodes> places;
        for (int k = 0; k < nodes; ++k) {
            const double node = k < nodes / 2 ? -gauss.nodes[k] : gauss.nodes[k - nodes / 2];
            starts[k] = start;
            times[k] = 0.5 * t * (1 + node);
            places[k] = static_cast<std::uint32_t>(k);
        }
        std::array<FlowSample, nodes> samples;
        std::array<double, nodes> losses;
        kernel_({starts.data(), times.data(), places.data(), nodes, rule}, samples.data(),
                losses.data());
        const bool near_tip = std::abs(start.view.sin) > start.view.cos;
        double sum = 0.0;
        for (int k = 0; k < nodes; ++k) {
            const double sin = std::sin(samples[k].theta);
            const double cos = std::cos(samples[k].theta);
            if (losses[k] == infinity || (std::abs(sin) > std::abs(cos)) != near_tip) {
                return std::nullopt;
            }
            const double h =
                root_of_squares(start.view.long_axis * sin, start.view.short_axis * cos);
            sum += gauss.weights[k % (nodes / 2)] * (h * samples[k].omega);
        }
        return 0.5 * t * sum;
    }

    detail::LaneKernel kernel_;
    const RollingStart* starts_;
    const double* times_;
    FlowSample* samples_;
    std::array<std::array<std::uint32_t, most_bodies>, detail::lane_rule_count> places_;
    std::array<std::size_t, detail::lane_rule_count> counts_{};
};

}  // namespace

void sample(LaneLevel level, const RollingStart* starts, const double* times, std::size_t n,
            FlowSample* samples) {
    Sorter sorter(level, starts, times, samples);
    for (std::size_t i = 0; i < n; ++i) sorter.add(i);
    sorter.finish();
}

}  // namespace rolling_ellipse
