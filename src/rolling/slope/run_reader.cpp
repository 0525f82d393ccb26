#include <algorithm>
#include <cmath>

#include "rolling/slope/part.hpp"

namespace rolling_ellipse {
namespace {

// The place in a part, -1 ... 1, at a time since its beginning: Newton's method with bisection.
// The first guess takes the rate as linear.
double place_in_part(const PartPolynomial& of_time, double time) {
    constexpr int most_tries = 60;
    constexpr double converged = 1e-9;  // smaller steps are squared by Newton's method
    const double first = of_time.mean - of_time.slope;
    const double root = std::sqrt(std::max(square(first) + 2 * of_time.slope * time, 0.0));
    double x = std::clamp(2 * time / (first + root) - 1, -1.0, 1.0);
    double low = -1.0;
    double high = 1.0;
    for (int i = 0; i < most_tries; ++i) {
        const double rest = time - value(of_time.integral, x);
        (rest > 0 ? low : high) = x;
        double next = x + rest / value(of_time.value, x);
        if (!(next >= low && next <= high)) next = 0.5 * (low + high);
        const double moved = std::abs(next - x);
        x = next;
        if (moved < converged) break;
    }
    return x;
}

}  // namespace

RunReader::RunReader(const SlopeRun& run)
    : run_(run), run_times_(run), part_times_(run.parts.size()), part_(run.parts.size()) {}

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
    SlopePlace place = place_at(rest);
    place.time = time;
    return place;
}

// Make the half turn that contains a time since `from` the current one.
void RunReader::move_to(DoubleDouble since) {
    constexpr int most_tries = 20;
    const double last = run_.is_complete() ? run_.half_turns - 1 : 0.0;
    double half_turns = std::min(about(run_, double(since)), last);
    for (int i = 0; i < most_tries; ++i) {
        set_half_turn(half_turns);
        half_turns += std::floor(double(since - begin_) / lasts_);
        half_turns = std::clamp(half_turns, 0.0, last);
        if (half_turns == half_turns_) break;
    }
    part_ = part_times_.size();
}

void RunReader::set_half_turn(double half_turns) {
    half_turns_ = half_turns;
    begin_ = run_times_(half_turns);
    lasts_ = 0.0;
    for (std::size_t i = 0; i < run_.parts.size(); ++i) {
        const RunPart& part = run_.parts[i];
        part_times_[i] =
            half_turns == 0 ? part.lasts : integral(node_times(run_, part, half_turns));
        lasts_ += part_times_[i];
    }
}

// The place at a time since the begin of the half turn.
SlopePlace RunReader::place_at(double rest) {
    std::size_t i = 0;
    for (; i + 1 < part_times_.size() && rest > part_times_[i]; ++i) rest -= part_times_[i];
    const RunPart& part = run_.parts[i];
    if (i != part_) {
        time_ = polynomial_through(node_times(run_, part, half_turns_));
        path_ = polynomial_through(part.advance);
        part_ = i;
    }
    const double x = place_in_part(time_, std::clamp(rest, 0.0, part_times_[i]));
    const RunPanel& panel = run_.panels[part.panel];
    const SlopeBody& body = run_.body;
    const auto on_panel = rolling_ellipse::place_at(panel, part.middle + part.half * x);
    const Geometry here =
        geometry(Axes{body.long_axis, body.short_axis}, on_panel.sin, on_panel.cos);
    const double heading = run_.heading;
    const double ahead = heading * (part.path + value(path_.integral, x));
    const double energy = run_.energy + (body.gravity.along * ahead +
                                         body.gravity.into * fall(body, run_.at, here).value);
    const double turned = heading * 2 * half_turns_;
    SlopePlace place{};
    place.quarters = run_.turns + heading * panel.quarters + turned;
    place.angle = {heading * (panel.angle + std::atan(on_panel.tan)), 0.0};
    place.omega = heading * omega_at(body, energy + heading * half_turns_ * body.gain, here);
    place.path = run_.from.path + ahead + two_product(turned, body.quarter_path);
    return place;
}

}  // namespace rolling_ellipse
