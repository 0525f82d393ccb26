#include <algorithm>
#include <array>
#include <cmath>

#include "rolling/slope/panel.hpp"

namespace rolling_ellipse {
namespace {

// The points at times since the start of the part.
ROLLING_ELLIPSE_WIDE void read_places(const SlopeRun& run, const PartReading& of,
                                      const std::array<double, lanes>& times,
                                      PlacesOnPart& places) {
    const RunPart& part = *of.part;
    const SlopeBody& body = run.body;
    const Pack x = places_in_part(of, load(times.data()));
    const PanelPlaces at = places_at(run, part, x);
    const Pack ahead = run.heading * (part.path + value(of.path.integral, x));
    const Pack energy =
        run.datum.energy + run.heading * of.half_turns * body.gain +
        (body.gravity.along * (ahead - run.heading * run.datum.path) + body.gravity.into * at.fall);
    store(at.tan, places.tan.data());
    store(ahead, places.ahead.data());
    store(at.h * sqrt(2 * energy / (body.d0 + body.d1 * at.sin2)), places.speed.data());
}

}  // namespace

RunReader::RunReader(const SlopeRun& run)
    : run_(run), run_times_(run), part_times_(run.parts.size()) {}

// Unused lanes repeat the first time.
std::size_t RunReader::operator()(const double* times, std::size_t n, SlopePlace* places) {
    static_assert(lanes == most);
    const auto time = [&](std::size_t i) { return times[i] / run_.body.time; };
    double rest = since_begin(time(0));
    if (!is_well_inside(rest)) {
        move_to(DoubleDouble{time(0), 0.0} - run_.from.time);
        rest = since_begin(time(0));
    }
    const std::size_t part = take_parts_off(rest);
    std::array<double, lanes> rests;
    rests.fill(rest);
    std::size_t count = 1;
    for (; count < std::min(n, most); ++count) {
        rest = since_begin(time(count));
        if (!is_well_inside(rest) || take_parts_off(rest) != part) break;
        rests[count] = rest;
    }
    read_part(part);
    PlacesOnPart on_part;
    read_places(run_, reading_, rests, on_part);
    const RunPanel& panel = run_.panels[reading_.part->panel];
    const double turned = run_.heading * 2 * half_turns_;
    const DoubleDouble path = two_product(turned, run_.body.quarter_path);
    for (std::size_t k = 0; k < count; ++k) {
        const double angle = panel.angle + std::atan(on_part.tan[k]);
        places[k] = {{time(k), 0.0},
                     run_.turns + run_.heading * panel.quarters + turned,
                     {run_.heading * angle, 0.0},
                     run_.heading * on_part.speed[k],
                     run_.from.path + on_part.ahead[k] + path};
    }
    return count;
}

// The time since the start of the current half turn.
double RunReader::since_begin(double time) const {
    return double(DoubleDouble{time, 0.0} - run_.from.time - begin_);
}

// Whether a time since the start of the half turn is so far from both ends that the result does not
// depend on earlier calls.
bool RunReader::is_well_inside(double since) const {
    constexpr double margin = 1e-9;  // fraction of a half turn, far above rounding
    return since > margin * lasts_ && since < (1 - margin) * lasts_;
}

// Subtracts the durations of the preceding parts from a time in the half turn; returns the part
// that contains it.
std::size_t RunReader::take_parts_off(double& since) const {
    std::size_t i = 0;
    for (; i + 1 < part_times_.size() && since > part_times_[i]; ++i) since -= part_times_[i];
    since = std::clamp(since, 0.0, part_times_[i]);
    return i;
}

// Moves to the half turn that contains a time after `from`.
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
    reading_.part = nullptr;
}

void RunReader::set_half_turn(double half_turns) {
    half_turns_ = half_turns;
    begin_ = run_times_(half_turns);
    lasts_ = 0.0;
    for (std::size_t i = 0; i < run_.parts.size(); ++i) {
        const RunPart& part = run_.parts[i];
        part_times_[i] =
            half_turns == 0 ? part.lasts : integral(node_times(part, run_.gained(half_turns)));
        lasts_ += part_times_[i];
    }
}

void RunReader::read_part(std::size_t i) {
    const RunPart& part = run_.parts[i];
    if (reading_.part == &part) return;
    reading_ =
        reading_of(part, half_turns_, part_times_[i], node_times(part, run_.gained(half_turns_)));
}

}  // namespace rolling_ellipse
