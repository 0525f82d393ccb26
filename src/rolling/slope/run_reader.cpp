#include <algorithm>
#include <cmath>

#include "rolling/slope/part.hpp"

namespace rolling_ellipse {
namespace {

// The polynomial through values at the nodes. The coefficients of the Legendre polynomials P_k fall
// by 6.4 from one to the next, and those of P_k itself rise by 2.4: so the powers cancel hardly.
ROLLING_ELLIPSE_WIDE PartPolynomial polynomial_through(const PartArray& values) {
    const PartRule& rule = part_rule();
    const PartArray powers = product(rule.powers, product(rule.legendre, values));
    PartPolynomial found{};
    for (int k = 0; k < part_order; ++k) {
        found.value[k] = powers[k];
        found.integral[k + 1] = powers[k] * (1.0 / (k + 1));
        found.integral[0] += k % 2 == 0 ? found.integral[k + 1] : -found.integral[k + 1];
    }
    return found;
}

// The place in a part by the share of its time: the cubic with the values and slopes of the inverse
// function at both ends.
std::array<double, 5> inverse_about(const PartPolynomial& time) {
    const double lasts = value(time.integral, 1.0);
    const double first = lasts / value(time.value, -1.0);
    const double last = lasts / value(time.value, 1.0);
    return {-1.0, first, 6 - 2 * first - last, -4 + first + last, 0.0};
}

// The place in a part, -1 ... 1, at a time since its beginning: Newton's method with bisection.
double place_in_part(const PartPolynomial& of_time, double guess, double time) {
    constexpr int most_tries = 60;
    constexpr double converged = 1e-8;  // smaller steps are squared by Newton's method
    double x = std::clamp(guess, -1.0, 1.0);
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

// As `fall` from the begin of a run.
double fallen(const SlopeRun& run, const PanelPlace<double>& at, double h) {
    const auto [sin, cos] = std::pair(run.at.sin, run.at.cos);
    const double sin2 = square(at.sin) * at.over;
    const double cos2 = square(at.cos) * at.over;
    const double change = square(sin) + sin2 > 1.0 ? cos2 - square(cos) : square(sin) - sin2;
    return run.body.c2 / (run.at.h + h) * change;
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
        about_place_ = inverse_about(time_);
        part_ = i;
    }
    rest = std::clamp(rest, 0.0, part_times_[i]);
    const double x = place_in_part(time_, value(about_place_, rest / part_times_[i]), rest);
    const RunPanel& panel = run_.panels[part.panel];
    const SlopeBody& body = run_.body;
    const auto at = rolling_ellipse::place_at(panel, part.middle + part.half * x);
    const double sin2 = square(at.sin) * at.over;
    const double h = std::sqrt(body.short_axis2 + body.c2 * sin2);
    const double heading = run_.heading;
    const double turned = heading * 2 * half_turns_;
    const double ahead = heading * (part.path + value(path_.integral, x));
    const double energy = run_.energy + heading * half_turns_ * body.gain +
                          (body.gravity.along * ahead + body.gravity.into * fallen(run_, at, h));
    SlopePlace place{};
    place.quarters = run_.turns + heading * panel.quarters + turned;
    place.angle = {heading * (panel.angle + std::atan(at.tan)), 0.0};
    place.omega = heading * h * std::sqrt(2 * energy / (body.d0 + body.d1 * sin2));
    place.path = run_.from.path + ahead + two_product(turned, body.quarter_path);
    return place;
}

}  // namespace rolling_ellipse
