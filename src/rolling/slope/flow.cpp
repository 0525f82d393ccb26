#include "rolling/slope/flow.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace rolling_ellipse {
namespace {

// The `Sum` with which the motion starts; null if it starts with a series.
const Sum* first_sum(const SlopeFlow& flow) {
    return std::get_if<Sum>(&flow.stretches.front().law);
}

// The `Swing` of a body that rocks; null if the motion is computed from series, or is not known
// yet.
const Swing* swing_of(const SlopeFlow& flow) {
    return flow.stretches.empty() ? nullptr : std::get_if<Swing>(&flow.stretches.back().law);
}

// Whether the body turns by less than about `angle` within `time` of the start, estimated from its
// initial acceleration. Near the start, a `Sum` gives a less accurate path than series, and a
// `Swing` is slower.
bool is_near(const SlopeFlow& flow, double time, double angle) {
    const double speed = std::abs(flow.start.omega) + 0.5 * std::abs(flow.acceleration) * time;
    return time * speed < angle;
}
constexpr double near_in_sum = 0.1;    // [rad]
constexpr double near_in_swing = 0.2;  // [rad]; series are faster up to here

// --------------------------------------------------------------------------------- points

// Computes points of a motion, each from the stretch that contains its time.
class SlopeReader {
  public:
    explicit SlopeReader(const SlopeFlow& flow) : flow_(flow) {}

    // Computes the point at the first of n times [s] and, in a sum or a swing, points at the next
    // times side by side with it. Returns the number of points computed.
    std::size_t operator()(const double* times, std::size_t n, SlopePlace* places) {
        const auto time = [&](std::size_t i) { return times[i] / flow_.body.time; };
        const Swing* const swing = swing_of(flow_);
        const SlopeStretch* const first = flow_.stretches.data();
        const SlopeStretch& here = swing
                                       ? flow_.stretches.back()
                                       : stretch_at(first, first + flow_.stretches.size(), time(0));
        const Sum* const sum = std::get_if<Sum>(&here.law);
        const auto is_by_series = [&](double at) {
            return swing ? is_near(flow_, at, near_in_swing) : is_near_start(at);
        };
        if (!(sum || swing) || is_by_series(time(0))) {
            places[0] = place(here, {time(0), 0.0});
            return 1;
        }
        std::size_t count = 1;
        while (count < std::min(n, RunReader::most) && !is_by_series(time(count))) ++count;
        if (swing) {
            if (!swing_) swing_.emplace(flow_.body, *swing);
            return (*swing_)(times, count, places);
        }
        if (of_ != sum) run_.emplace(sum->run);
        of_ = sum;
        return (*run_)(times, count, places);
    }

  private:
    // The stretch that contains a time, among those from `first` up to `end`.
    static const SlopeStretch& stretch_at(const SlopeStretch* first, const SlopeStretch* end,
                                          double time) {
        const auto* const later = std::upper_bound(
            first, end, time, [](double at, const SlopeStretch& each) { return at < each.begin; });
        return later == first ? *first : later[-1];
    }

    SlopePlace place(const SlopeStretch& here, DoubleDouble time) {
        return std::visit([&](const auto& law) { return place(law, here, time); }, here.law);
    }

    // The point at a time in the series that precede a stretch; `side` is -1 to reverse the motion.
    SlopePlace place_before(const SlopeStretch& here, DoubleDouble time, double side) {
        const SlopeStretch* const first = flow_.stretches.data() + (first_sum(flow_) ? 1 : 0);
        SlopePlace found = place(stretch_at(first, &here, double(time)), time);
        found.omega *= side;
        return found;
    }

    SlopePlace place(const Even&, const SlopeStretch&, DoubleDouble time) {
        const double t = double(time);
        SlopePlace place = flow_.start;
        const double turned = t * (place.omega + 0.5 * flow_.acceleration * t);
        place.angle = place.angle + two_product(t, place.omega) +
                      two_product(0.5 * flow_.acceleration * t, t);
        place.omega += flow_.acceleration * t;
        place.path = {flow_.body.long_axis * turned, 0.0};
        return place;
    }

    SlopePlace place(const SlopePiece& piece, const SlopeStretch&, DoubleDouble time) {
        return place_in(piece, double(time - piece.from.time));
    }

    // Used for times near the start; all other points of sums are computed side by side.
    SlopePlace place(const Sum&, const SlopeStretch&, DoubleDouble time) {
        return place_in(*near_, double(time));
    }

    // Used for times near the start, where series are faster.
    SlopePlace place(const Swing&, const SlopeStretch&, DoubleDouble time) {
        if (!followed_) followed_ = by_series(flow_);
        const double t = double(time) * flow_.body.time;
        prepare(*followed_, t);
        SlopeReader read(*followed_);
        SlopePlace place;
        read(&t, 1, &place);
        return place;
    }

    SlopePlace place(const Mirror& mirror, const SlopeStretch& here, DoubleDouble time) {
        return place_before(here, mirror.turning * 2.0 - time, -1.0);
    }

    SlopePlace place(const Repeat& swing, const SlopeStretch& here, DoubleDouble time) {
        const DoubleDouble since = time - swing.last;
        const double swings = std::floor(double(since) / double(swing.lasts()));
        const DoubleDouble rest = since - swing.lasts() * swings;
        return std::fmod(swings, 2.0) == 0 ? place_before(here, swing.last - rest, -1.0)
                                           : place_before(here, swing.first + rest, 1.0);
    }

    // Whether the motion starts with a `Sum`, but a series about the start is used instead because
    // this time is so near the start.
    bool is_near_start(double time) {
        if (!first_sum(flow_) || !is_near(flow_, time, near_in_sum)) return false;
        if (!near_) near_ = piece_from(flow_.body, flow_.start);
        return time < near_->lasts;
    }

    const SlopeFlow& flow_;
    std::optional<SlopePiece> near_;
    const Sum* of_ = nullptr;  // the sum that was read last
    std::optional<RunReader> run_;
    std::optional<SwingReader> swing_;
    std::optional<SlopeFlow> followed_;
};

// --------------------------------------------------------------------------------- growth

// Appends the stretch that follows a turning point; the turning point itself belongs to the series.
// After the first turning point the motion is mirrored, and after the second it repeats. Further
// series would not lead back accurately to a start near the rim of a well.
void append_turning(SlopeFlow& flow, DoubleDouble turning) {
    const double begin = turning.low < 0 ? turning.high : std::nextafter(turning.high, infinity);
    if (flow.turning) {
        flow.stretches.emplace_back(begin, infinity, Repeat{*flow.turning, turning});
        return;
    }
    flow.turning = turning;
    const Sum* const climb = first_sum(flow);
    SlopePlace back = climb ? climb->end : flow.start;
    back.time = turning * 2.0 - back.time;
    back.omega = -back.omega;
    flow.stretches.emplace_back(begin, double(back.time), Mirror{turning, back});
}

void append_series(SlopeFlow& flow, const SlopePlace& from, const Geometry& here) {
    constexpr std::size_t usual_stretches = 16;
    flow.stretches.reserve(usual_stretches);
    const SlopePiece piece = piece_from(flow.body, from, here);
    flow.stretches.emplace_back(double(from.time), piece.end(), piece);
    const DoubleDouble turning = time_of_turning(piece);
    if (turning.high < infinity) append_turning(flow, turning);
}

void append_sum(SlopeFlow& flow, const SlopePlace& from, const Datum& here, double half_turns) {
    Sum sum{slope_run(flow.body, flow.datum, from, here, half_turns), {}};
    const bool climbs = from.omega < 0;
    extend(sum.run, climbs ? infinity : 0.0);
    if (climbs) sum.end = place_after(sum.run, half_turns);
    const bool for_good = half_turns == most_half_turns;
    const double end = for_good ? infinity : double(sum.end.time);
    flow.stretches.emplace_back(double(from.time), end, std::move(sum));
}

// Whether to try computing the motion as a swing, because it has not been tried and by this time
// the body may be far from its start.
bool may_swing(const SlopeFlow& flow, double until) {
    return !flow.by_series && !swing_of(flow) && !is_near(flow, until, near_in_swing);
}

// The point at the end of the last stretch.
SlopePlace next_place(const SlopeFlow& flow) {
    if (flow.stretches.empty()) return flow.start;
    const auto& law = flow.stretches.back().law;
    if (const auto* sum = std::get_if<Sum>(&law)) return sum->end;
    if (const auto* mirror = std::get_if<Mirror>(&law)) return mirror->end;
    return place_after(flow.body, flow.datum, std::get<SlopePiece>(law));
}

}  // namespace

SlopeFlow slope_flow(const Body& body, double slope, double theta, double omega, double x) {
    omega = zero_if_negligible(omega);
    SlopeFlow flow{};
    flow.theta = theta;
    flow.omega = omega;
    flow.x = x;
    flow.body = slope_body(body, slope);
    const FlatView view = flat_view(body.axes(), theta);
    const auto [quarters, angle] = quarter_view(flow.body.side * view.sin, view.cos);
    flow.start = {{}, quarters, angle, flow.body.side * omega * flow.body.time, {}};
    flow.datum = datum_of(flow.body, flow.start);
    flow.acceleration = acceleration_at(flow.body, flow.datum.at, flow.start.omega);
    const bool is_circle = flow.body.c2 == 0;
    if (is_circle) {
        const double radius = flow.body.long_axis;
        flow.acceleration =
            flow.body.gravity.along * radius / (flow.body.gyration2 + square(radius));
    }
    flow.rests =
        omega == 0 && (is_circle ? !(flow.acceleration > 0)  // the acceleration may underflow to 0
                                 : is_equilibrium(geometry(body.axes(), theta), std::tan(slope)));
    if (flow.rests) flow.acceleration = 0.0;
    if (omega == 0) flow.turning = flow.start.time;
    flow.by_series = flow.rests || is_circle;
    if (flow.by_series) flow.stretches.emplace_back(0.0, infinity, Even{});
    return flow;
}

bool grow(SlopeFlow& flow, double until) {
    if (may_swing(flow, until)) {
        if (auto swing = swing_from(flow.body, flow.start)) {
            flow.stretches.emplace_back(0.0, infinity, *std::move(swing));
            return true;
        }
        flow.by_series = true;
    }
    if (!flow.stretches.empty() && flow.stretches.back().end == infinity) return false;
    if (flow.stretches.empty()) measure_quarter(flow.body);
    const SlopePlace from = next_place(flow);
    const Geometry here = geometry(flow.body, from);
    if (from.omega > 0 || flow.stretches.empty()) {
        const Tracked w = energy_at(flow.body, flow.datum, from, here);
        const double at_least = w.value - 8 * epsilon * w.magnitude;
        const double half_turns = may_run(flow.body, at_least, here, from);
        if (half_turns > 0) {
            append_sum(flow, from, {w.value, here}, half_turns);
            return true;
        }
    }
    append_series(flow, from, here);
    return true;
}

SlopeFlow by_series(const SlopeFlow& flow) {
    SlopeFlow followed{flow.theta, flow.omega, flow.x, flow.rests, flow.body, flow.acceleration,
                       flow.start, flow.datum, {},     {},         true};
    if (flow.start.omega == 0) followed.turning = flow.start.time;
    return followed;
}

void prepare(SlopeFlow& flow, double t) {
    const double until = t / flow.body.time;
    const auto is_short = [&] {
        return flow.stretches.empty() || flow.stretches.back().end <= until ||
               may_swing(flow, until);
    };
    while (is_short() && grow(flow, until)) continue;
    auto* const sum = std::get_if<Sum>(&flow.stretches.back().law);
    if (sum) extend(sum->run, double(-sum->run.from.time + until));
}

FlowSample sample_of(const SlopeFlow& flow, const SlopePlace& place) {
    const SlopeBody& body = flow.body;
    const DoubleDouble turned =
        half_pi_exact * (place.quarters - flow.start.quarters) + (place.angle - flow.start.angle);
    return {double(turned * body.side + flow.theta), body.side * place.omega / body.time,
            double(place.path * (body.side * body.length) + flow.x)};
}

FlowSample sample(const SlopeFlow& flow, double t) {
    FlowSample found;
    sample(flow, &t, 1, &found);
    return found;
}

void sample(const SlopeFlow& flow, const double* times, std::size_t n, FlowSample* samples) {
    std::array<SlopePlace, RunReader::most> places;
    SlopeReader read(flow);
    for (std::size_t i = 0; i < n;) {
        if (flow.rests || times[i] == 0) {
            samples[i++] = {flow.theta, flow.omega, flow.x};
            continue;
        }
        const std::size_t count = read(times + i, n - i, places.data());
        for (std::size_t k = 0; k < count; ++k) samples[i++] = sample_of(flow, places[k]);
    }
}

double longest_time(const SlopeFlow& prepared, double t) {
    constexpr double most = most_half_turns;
    const double unit = prepared.body.time;
    const auto& law = prepared.stretches.back().law;
    if (std::holds_alternative<Even>(law)) {
        const double speed = std::abs(prepared.start.omega);
        const double turned = most * pi;
        const double last = std::sqrt(square(speed) + 2 * prepared.acceleration * turned);
        return unit * (2 * turned / (speed + last));
    }
    if (const auto half = half_period(prepared)) return unit * most * double(*half);
    const Sum* const sum = std::get_if<Sum>(&law);
    if (!sum || sum->run.half_turns < most || !sum->run.is_complete()) return infinity;
    if (sum->run.heading < 0) return unit * double(sum->end.time);
    constexpr double far = 1e-3;
    if (about(sum->run, t / unit) < far * most) return infinity;
    return unit * double(sum->run.from.time + RunTimes(sum->run)(most));
}

std::optional<DoubleDouble> half_period(const SlopeFlow& prepared) {
    const auto& law = prepared.stretches.back().law;
    if (const Swing* const swing = swing_of(prepared)) return swing->lasts();
    if (const auto* const swing = std::get_if<Repeat>(&law)) return swing->lasts();
    return std::nullopt;
}

std::optional<double> period(const SlopeFlow& prepared) {
    if (prepared.rests) return infinity;
    const auto half = half_period(prepared);
    if (!half) return std::nullopt;
    return prepared.body.time * double(*half * 2.0);
}

}  // namespace rolling_ellipse
