#include "rolling/slope/runs/reader.hpp"

#include <algorithm>
#include <cmath>

namespace rolling_ellipse {
namespace {

// First guess of the number of half turns in a time, as if D and W were constant.
double guess(const SlopeRun& run, double time) {
    const double speed = run.mass / run.half_turn;  // sqrt(W)
    const double change = run.heading * run.body.gain * time / (4 * run.mass);
    return std::max(std::floor(time / run.mass * (speed + change)), 0.0);
}

// Legendre coefficients of the integrand of a part, from the times at its nodes.
PartSeries part_series(const double* times) {
    constexpr int n = part_order;
    std::array<double, n> nodes, before, now;
    for (int i = 0; i < n; ++i) {
        nodes[i] = node_of(part_rule(), i).place;
        before[i] = 1.0;
        now[i] = nodes[i];
    }
    PartSeries coefficients;
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
    return coefficients;
}

// The place in a part, -1 ... 1, at a time since its beginning: Newton's method with bisection.
double place_in_part(const PartSeries& coefficients, double time) {
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
        for (int k = 1; k < part_order; ++k) {
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

// The times of nodes [begin, end) in the half turn after the first `half_turns`; returns their sum.
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

}  // namespace

RunReader::RunReader(const SlopeRun& run)
    : run_(run),
      panel_times_(run.panels.size()),
      part_times_(run.part_nodes.weight.size() / part_order) {}

SlopePlace RunReader::operator()(DoubleDouble time) {
    const DoubleDouble since = time - run_.from.time;
    double rest = double(since - begin_);
    if (!is_well_within(rest)) rest = move_to(since);
    SlopePlace place = place_at(run_.heading < 0 ? lasts_ - rest : rest);
    place.time = time;
    return place;
}

// The current half turn is reused only well inside it, so that the answer does not depend on
// earlier calls.
bool RunReader::is_well_within(double rest) const {
    constexpr double margin = 1e-9;  // many times the rounding of a time
    return rest > margin * lasts_ && rest < (1 - margin) * lasts_;
}

// Make the half turn that contains a time since `from` the current one; returns the time in it.
double RunReader::move_to(DoubleDouble since) {
    constexpr int most_tries = 20;
    const double last = run_.half_turns - 1;
    half_turns_ = std::min(guess(run_, double(since)), last);
    double rest = 0.0;
    for (int i = 1;; ++i) {
        begin_ = time_of(run_, half_turns_);
        rest = double(since - begin_);
        lasts_ = times_of(run_, run_.nodes, 0, run_.nodes.weight.size(), half_turns_, nullptr);
        const double next = std::clamp(half_turns_ + std::floor(rest / lasts_), 0.0, last);
        if (next == half_turns_ || i == most_tries) break;
        half_turns_ = next;
    }
    std::fill(panel_times_.begin(), panel_times_.end(), unknown);
    std::fill(part_times_.begin(), part_times_.end(), unknown);
    part_ = part_times_.size();
    return rest;
}

double RunReader::panel_time(std::size_t i) {
    if (panel_times_[i] == unknown) {
        const RunPanel& panel = run_.panels[i];
        panel_times_[i] = times_of(run_, run_.nodes, panel.begin, panel.end, half_turns_, nullptr);
    }
    return panel_times_[i];
}

double RunReader::part_time(std::size_t part) {
    if (part_times_[part] == unknown) part_times_[part] = times_in(part, nullptr);
    return part_times_[part];
}

double RunReader::times_in(std::size_t part, double* times) const {
    const std::size_t begin = part * part_order;
    return times_of(run_, run_.part_nodes, begin, begin + part_order, half_turns_, times);
}

// The place at a time since the upper end of the half turn.
SlopePlace RunReader::place_at(double rest) {
    std::size_t i = 0;
    for (; i + 1 < run_.panels.size() && rest > panel_time(i); ++i) rest -= panel_time(i);
    const RunPanel& panel = run_.panels[i];
    int k = 0;
    for (; k + 1 < panel.parts && rest > part_time(panel.part + k); ++k) {
        rest -= part_time(panel.part + k);
    }
    const std::size_t part = panel.part + k;
    if (part != part_) {
        std::array<double, part_order> times;
        times_in(part, times.data());
        series_ = part_series(times.data());
        part_ = part;
    }
    const double x = place_in_part(series_, std::clamp(rest, 0.0, part_time(part)));
    const double v = panel.first + (panel.last - panel.first) * (k + 0.5 * (x + 1)) / panel.parts;
    return place_on(run_, panel, v, half_turns_);
}

}  // namespace rolling_ellipse
