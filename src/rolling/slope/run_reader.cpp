#include <algorithm>
#include <cmath>
#include <numeric>

#include "rolling/slope/run.hpp"

namespace rolling_ellipse {
namespace {

// First guess of the number of half turns in a time, as if W grew evenly with their number.
double guess(const SlopeRun& run, double time) {
    const double speed = run.mass / run.half_turn;  // a mean of sqrt(W)
    const double change = run.heading * run.body.gain * time / (4 * run.mass);
    return std::max(std::floor(time / run.mass * (speed + change)), 0.0);
}

// Legendre coefficients of the integrand of a part, from the times at its nodes.
PartArray legendre_coefficients(const PartArray& times) {
    PartArray nodes, before, coefficients;
    for (int i = 0; i < part_order; ++i) nodes[i] = node_of(part_rule(), i).place;
    before.fill(1.0);
    PartArray now = nodes;
    for (int k = 0; k < part_order; ++k) {
        const double up = (2 * k + 3.0) / (k + 2);
        const double down = (k + 1.0) / (k + 2);
        double sum = 0.0;
        for (int i = 0; i < part_order; ++i) {
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
double place_in_part(const PartArray& coefficients, double time) {
    constexpr int most_tries = 60;
    constexpr double converged = 1e-9;  // smaller steps are squared by Newton's method
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

}  // namespace

RunReader::RunReader(const SlopeRun& run)
    : run_(run),
      panel_times_(run.panels.size()),
      part_times_(run.part_nodes.weight.size() / part_order) {}

// The current half turn is reused only well inside it, so that the answer does not depend on
// earlier calls.
SlopePlace RunReader::operator()(DoubleDouble time) {
    constexpr double margin = 1e-9;  // share of a half turn, many times a rounding
    const DoubleDouble since = time - run_.from.time;
    double rest = double(since - begin_);
    if (!(rest > margin * lasts_ && rest < (1 - margin) * lasts_)) {
        move_to(since);
        rest = double(since - begin_);
    }
    SlopePlace place = place_at(run_.heading < 0 ? lasts_ - rest : rest);
    place.time = time;
    return place;
}

// Make the half turn that contains a time since `from` the current one.
void RunReader::move_to(DoubleDouble since) {
    constexpr int most_tries = 20;
    const double last = run_.half_turns - 1;
    double half_turns = std::min(guess(run_, double(since)), last);
    for (int i = 0; i < most_tries; ++i) {
        set_half_turn(half_turns);
        half_turns += std::floor(double(since - begin_) / lasts_);
        half_turns = std::clamp(half_turns, 0.0, last);
        if (half_turns == half_turns_) break;
    }
    std::fill(part_times_.begin(), part_times_.end(), -1.0);
    part_ = part_times_.size();
}

void RunReader::set_half_turn(double half_turns) {
    half_turns_ = half_turns;
    begin_ = time_of(run_, half_turns);
    lasts_ = 0.0;
    for (std::size_t k = 0; k < run_.panels.size(); ++k) {
        panel_times_[k] = 0.0;
        for (std::size_t i = run_.panels[k].begin; i < run_.panels[k].end; ++i) {
            const double time = node_time(run_.nodes, i);
            panel_times_[k] += time;
            lasts_ += time;
        }
    }
}

// Weight of a node in an integral over the current half turn.
double RunReader::node_time(const RunNodes& nodes, std::size_t i) const {
    return nodes.weight[i] /
           std::sqrt(nodes.level[i] + run_.heading * half_turns_ * run_.body.gain);
}

PartArray RunReader::node_times(std::size_t part) const {
    PartArray times;
    for (int i = 0; i < part_order; ++i) {
        times[i] = node_time(run_.part_nodes, part * part_order + i);
    }
    return times;
}

double RunReader::part_time(std::size_t part) {
    if (part_times_[part] < 0) {
        const PartArray times = node_times(part);
        part_times_[part] = std::accumulate(times.begin(), times.end(), 0.0);
    }
    return part_times_[part];
}

// The place at a time since the upper end of the half turn.
SlopePlace RunReader::place_at(double rest) {
    std::size_t i = 0;
    for (; i + 1 < run_.panels.size() && rest > panel_times_[i]; ++i) rest -= panel_times_[i];
    const RunPanel& panel = run_.panels[i];
    int k = 0;
    for (; k + 1 < panel.parts && rest > part_time(panel.part + k); ++k) {
        rest -= part_time(panel.part + k);
    }
    const std::size_t part = panel.part + k;
    if (part != part_) {
        coefficients_ = legendre_coefficients(node_times(part));
        part_ = part;
    }
    const double x = place_in_part(coefficients_, std::clamp(rest, 0.0, part_time(part)));
    const double v = panel.first + (panel.last - panel.first) * (k + 0.5 * (x + 1)) / panel.parts;
    return place_on(run_, panel, v, half_turns_);
}

}  // namespace rolling_ellipse
