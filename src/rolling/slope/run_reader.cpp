#include <algorithm>
#include <cmath>

#include "rolling/slope/part.hpp"

namespace rolling_ellipse {
namespace {

// The place in a part, -1 ... 1, at a time since its beginning: Newton's method with bisection.
// The first guess takes the rate as linear.
double place_in_part(const PartArray& rates, double time) {
    constexpr int most_tries = 60;
    constexpr double converged = 1e-9;  // smaller steps are squared by Newton's method
    const double first = rates[0] - rates[1];
    const double root = std::sqrt(std::max(square(first) + 2 * rates[1] * time, 0.0));
    double x = std::clamp(2 * time / (first + root) - 1, -1.0, 1.0);
    double low = -1.0;
    double high = 1.0;
    for (int i = 0; i < most_tries; ++i) {
        const PartValue at = value_at(rates, x);
        const double rest = time - at.integral;
        (rest > 0 ? low : high) = x;
        double next = x + rest / at.value;
        if (!(next >= low && next <= high)) next = 0.5 * (low + high);
        const double moved = std::abs(next - x);
        x = next;
        if (moved < converged) break;
    }
    return x;
}

}  // namespace

RunReader::RunReader(const SlopeRun& run)
    : run_(run), times_(run), part_times_(run.parts.size()), part_(run.parts.size()) {}

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
    begin_ = times_(half_turns);
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
        rates_ = product(part_rule().coefficients, node_times(run_, part, half_turns_));
        part_ = i;
    }
    const double x = place_in_part(rates_, std::clamp(rest, 0.0, part_times_[i]));
    const RunPanel& panel = run_.panels[part.panel];
    return place_on(run_, panel, part.middle + part.half * x, half_turns_);
}

}  // namespace rolling_ellipse
