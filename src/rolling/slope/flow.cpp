#include "rolling/slope/flow.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace rolling_ellipse {
namespace {

SlopePlace first_place(const SlopeBody& body, const FlatView& view, double omega) {
    const double s = body.side * view.sin;
    SlopePlace place{};
    place.omega = body.side * omega * body.time;
    if (std::abs(s) <= view.cos) {
        place.angle = {std::atan2(s, view.cos), 0.0};
    } else {
        place.quarters = std::copysign(1.0, s);
        place.angle = {-std::copysign(std::atan2(view.cos, std::abs(s)), s), 0.0};
    }
    return place;
}

const SlopePlace& first_of_pieces(const SlopeFlow& flow) { return flow.pieces.front().from; }

bool climbs_for_ever(const SlopeFlow& flow) {
    return flow.climb && flow.climb->half_turns == most_half_turns && !flow.pieces.empty();
}

// Whether the last piece has the first turning point. After it the next piece begins at the
// reversed start; the motion up to there mirrors the motion before.
bool has_turned(const SlopeFlow& flow) {
    return flow.turnings.size() == 1 &&
           double(flow.turnings.front() - flow.pieces.back().from.time) > 0;
}

DoubleDouble time_of_reversed_start(const SlopeFlow& flow) {
    return flow.turnings.front() * 2.0 - first_of_pieces(flow).time;
}

// Time at which the pieces end.
double known_until(const SlopeFlow& flow) {
    if (flow.pieces.empty()) return 0.0;
    return has_turned(flow) ? double(time_of_reversed_start(flow)) : flow.pieces.back().end();
}

// Whether the body has moved so little that only a series about the start keeps the digits of the
// way, where the motion begins with a sum.
bool is_short(const SlopeFlow& flow, double time) {
    constexpr double short_way = 0.1;  // [rad]
    const double speed = std::abs(flow.start.omega) + 0.5 * std::abs(flow.acceleration) * time;
    return (flow.climb || flow.pieces.empty()) && time * speed < short_way;
}

// The place at which the series begin: the start, or the end of the sum of a climb.
SlopePlace begin(SlopeFlow& flow) {
    const SlopePlace& start = flow.start;
    if (start.omega == 0) flow.turnings.push_back(start.time);
    if (start.omega >= 0) return start;
    const double n = may_run(flow.body, flow.energy.start, flow.energy.at, start);
    if (n < 1) return start;
    flow.climb = slope_run(flow.body, flow.energy, start, flow.energy.start, n);
    extend(*flow.climb, infinity);
    return place_after(*flow.climb, n);
}

SlopePlace circle_at(const SlopeFlow& flow, double t) {
    SlopePlace place = flow.start;
    const double turned = t * (flow.start.omega + 0.5 * flow.acceleration * t);
    place.time = {t, 0.0};
    place.angle = place.angle + two_product(t, flow.start.omega) +
                  two_product(0.5 * flow.acceleration * t, t);
    place.omega += flow.acceleration * t;
    place.path = {flow.body.long_axis * turned, 0.0};
    return place;
}

SlopePlace place_in_pieces(const std::vector<SlopePiece>& pieces, DoubleDouble time) {
    const double t = double(time);
    const auto later = std::upper_bound(
        pieces.begin(), pieces.end(), t,
        [](double at, const SlopePiece& piece) { return at < double(piece.from.time); });
    const SlopePiece& piece = later == pieces.begin() ? *later : later[-1];
    return place_in(piece, double(time - piece.from.time));
}

// The motion between the first turning point and the mirrored start is the motion before, reversed.
SlopePlace place_about_turning(const SlopeFlow& flow, DoubleDouble time) {
    if (flow.turnings.empty()) return place_in_pieces(flow.pieces, time);
    const DoubleDouble turning = flow.turnings.front();
    const DoubleDouble mirrored = turning * 2.0 - time;
    const bool is_mirrored =
        double(mirrored - turning) < 0 && double(mirrored - first_of_pieces(flow).time) > 0;
    SlopePlace place = place_in_pieces(flow.pieces, is_mirrored ? mirrored : time);
    if (is_mirrored) place.omega = -place.omega;
    return place;
}

// The begin of the next piece: the end of the last one. After a turning point it is the reversed
// start; series continued beside the rim of a well would miss that place.
SlopePlace next_place(const SlopeFlow& flow) {
    if (!has_turned(flow)) return place_after(flow.body, flow.energy, flow.pieces.back());
    SlopePlace place = first_of_pieces(flow);
    place.time = time_of_reversed_start(flow);
    place.omega = -place.omega;
    return place;
}

// The place in a rocking motion, which is symmetric about both of its turning points.
SlopePlace place_in_swing(const SlopeFlow& flow, double t) {
    const DoubleDouble first = flow.turnings[0];
    const DoubleDouble last = flow.turnings[1];
    const DoubleDouble half = last - first;
    const DoubleDouble since = -last + t;
    if (double(since) <= 0) return place_about_turning(flow, {t, 0.0});
    const double swings = std::floor(double(since) / double(half));
    const DoubleDouble rest = since - half * swings;
    const bool back = std::fmod(swings, 2.0) == 0;
    SlopePlace place = place_about_turning(flow, back ? last - rest : first + rest);
    if (back) place.omega = -place.omega;
    return place;
}

// Places of a moving body; the readers of its sums are kept for later times.
class SlopeReader {
  public:
    explicit SlopeReader(const SlopeFlow& flow) : flow_(flow) {}

    // The place at a time that no sum has.
    SlopePlace operator()(double time) {
        if (flow_.kind == MotionKind::uniform) return circle_at(flow_, time);
        if (flow_.kind == MotionKind::libration) return place_in_swing(flow_, time);
        if (begins(time)) return place_in(*begin_, time);
        return place_about_turning(flow_, {time, 0.0});
    }

    // The reader of the sum that has a time; null if there is none.
    RunReader* sum_at(double time) {
        if (flow_.kind != MotionKind::rotation || begins(time)) return nullptr;
        if (flow_.climb && time < double(first_of_pieces(flow_).time)) {
            return reader(climb_, *flow_.climb);
        }
        return flow_.run && time > known_until(flow_) ? reader(run_, *flow_.run) : nullptr;
    }

  private:
    // Whether a series about the start serves a time where the motion begins with a sum.
    bool begins(double time) {
        if (!is_short(flow_, time)) return false;
        if (!begin_) begin_ = piece_from(flow_.body, flow_.start);
        return time < begin_->lasts;
    }

    static RunReader* reader(std::optional<RunReader>& known, const SlopeRun& run) {
        if (!known) known.emplace(run);
        return &*known;
    }

    const SlopeFlow& flow_;
    std::optional<SlopePiece> begin_;
    std::optional<RunReader> climb_;
    std::optional<RunReader> run_;
};

}  // namespace

SlopeFlow slope_flow(const Body& body, double slope, double theta, double omega, double x) {
    omega = zero_if_negligible(omega);
    SlopeFlow flow{};
    flow.theta = theta;
    flow.omega = omega;
    flow.x = x;
    flow.body = slope_body(body, slope);
    flow.start = first_place(flow.body, flat_view(body.axes(), theta), omega);
    flow.energy = energy_of(flow.body, flow.start);
    flow.acceleration = acceleration_at(flow.body, flow.energy.at, flow.start.omega);
    flow.kind = MotionKind::rotation;
    const bool balanced = is_equilibrium(geometry(body.axes(), theta), std::tan(slope));
    if (omega == 0 && balanced) flow.kind = MotionKind::rest;
    if (flow.body.c2 == 0) {
        const double radius = flow.body.long_axis;
        flow.acceleration =
            flow.body.gravity.along * radius / (flow.body.gyration2 + square(radius));
        const bool moves = omega != 0 || flow.acceleration > 0;  // may underflow to 0
        flow.kind = moves ? MotionKind::uniform : MotionKind::rest;
    }
    return flow;
}

bool grow(SlopeFlow& flow) {
    if (flow.kind != MotionKind::rotation || flow.run || climbs_for_ever(flow)) return false;
    const SlopePlace from = flow.pieces.empty() ? begin(flow) : next_place(flow);
    const Geometry here = geometry(flow.body, from);
    if (from.omega > 0) {
        const Tracked w = energy_at(flow.body, flow.energy, from, here);
        const double at_least = w.value - 8 * epsilon * w.magnitude;
        if (may_run(flow.body, at_least, here, from) > 0) {
            flow.run = slope_run(flow.body, flow.energy, from, w.value, most_half_turns);
            return false;
        }
    }
    constexpr std::size_t usual_pieces = 16;
    if (flow.pieces.empty()) flow.pieces.reserve(usual_pieces);
    flow.pieces.push_back(piece_from(flow.body, from, here));
    const DoubleDouble turning = time_of_turning(flow.pieces.back());
    if (turning.high < infinity) flow.turnings.push_back(turning);
    if (flow.turnings.size() == 2) flow.kind = MotionKind::libration;
    return true;
}

void prepare(SlopeFlow& flow, double t) {
    const double until = t / flow.body.time;
    if (flow.pieces.empty()) grow(flow);
    while (known_until(flow) <= until && grow(flow)) continue;
    if (flow.run) extend(*flow.run, double(-flow.run->from.time + until));
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

// Times of one sum beside each other are read together.
void sample(const SlopeFlow& flow, const double* times, std::size_t n, FlowSample* samples) {
    constexpr std::size_t most = 16;
    std::array<double, most> since;
    std::array<SlopePlace, most> places;
    SlopeReader read(flow);
    for (std::size_t i = 0; i < n;) {
        if (flow.kind == MotionKind::rest || times[i] == 0) {
            samples[i++] = {flow.theta, flow.omega, flow.x};
            continue;
        }
        since[0] = times[i] / flow.body.time;
        std::size_t count = 1;
        if (RunReader* const sum = read.sum_at(since[0])) {
            for (; count < most && i + count < n; ++count) {
                since[count] = times[i + count] / flow.body.time;
                if (read.sum_at(since[count]) != sum) break;
            }
            (*sum)(since.data(), count, places.data());
        } else {
            places[0] = read(since[0]);
        }
        for (std::size_t k = 0; k < count; ++k) samples[i++] = sample_of(flow, places[k]);
    }
}

double longest_time(const SlopeFlow& prepared, double t) {
    constexpr double most = most_half_turns;
    const double unit = prepared.body.time;
    if (prepared.kind == MotionKind::uniform) {
        const double speed = std::abs(prepared.start.omega);
        const double turned = most * pi;
        const double last = std::sqrt(square(speed) + 2 * prepared.acceleration * turned);
        return unit * (2 * turned / (speed + last));
    }
    if (prepared.kind == MotionKind::libration) {
        return unit * most * double(prepared.turnings[1] - prepared.turnings[0]);
    }
    if (climbs_for_ever(prepared)) return unit * double(first_of_pieces(prepared).time);
    if (!prepared.run || !prepared.run->is_complete()) return infinity;
    constexpr double far = 1e-3;
    if (about(*prepared.run, t / unit) < far * most) return infinity;
    return unit * double(prepared.run->from.time + RunTimes(*prepared.run)(most));
}

std::optional<double> period(const SlopeFlow& prepared) {
    if (prepared.kind == MotionKind::rest) return infinity;
    if (prepared.kind != MotionKind::libration) return std::nullopt;
    return prepared.body.time * double((prepared.turnings[1] - prepared.turnings[0]) * 2.0);
}

}  // namespace rolling_ellipse
