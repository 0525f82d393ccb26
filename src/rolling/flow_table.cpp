#include "rolling/flow_table.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "numerics/vector_levels.hpp"
#include "rolling/motion_series.hpp"

namespace rolling_ellipse {
namespace {

// Motions have 5 to 50 pieces a quarter turn; on the separatrix there is no end of them.
constexpr std::size_t most_pieces = 400;

class TableMaker {
  public:
    explicit TableMaker(const RollingFlow& flow) : flow_(flow), table_{flow, 0.0, {}, {}} {
        const PhaseRate& rate = flow.phase.rate;
        const QuarterState flat = quarter_state(flow, PhasePoint{0.0, 1.0});
        length_ = flow.start.long_axis;
        unit_ = std::min(0.5 / flat.omega, 0.5 * double(flow.phase.quarter_turn));
        table_.time_unit = unit_;
        const double area = square(length_);
        body_ = {square(rate.short_axis / length_), rate.c2 / area,
                 flow.gravity * square(unit_) / length_, rate.d0 / square(area),
                 rate.d1 / square(area)};
    }

    FlowTable make(double span) {
        const FlatView& at = flow_.start;
        const MotionSeries start = motion_series(body_, at.sin, at.cos, flow_.omega * unit_);
        table_.start = piece(start, {0.0, 0.0}, {0.0, 0.0, 0.0});
        if (!(span <= table_.start.high)) {
            const auto [low, high] = quarter_range(span);
            fill(low, high);
        }
        return std::move(table_);
    }

  private:
    FlowPiece piece(const MotionSeries& series, DoubleDouble centre,
                    const QuarterPosition& position) const {
        const double radius =
            unit_ * std::min({reach(series.angle), reach(series.omega), reach(series.path)});
        FlowPiece found{centre,
                        double(centre) - radius,
                        double(centre) + radius,
                        position.quarters,
                        series.angle,
                        series.omega,
                        series.path};
        found.angle[0] = position.angle;
        found.path[0] = position.path;
        for (int k = 0; k <= series_order; ++k) found.omega[k] /= unit_;
        for (int k = 1; k <= series_order; ++k) found.path[k] *= length_;
        return found;
    }

    FlowPiece piece_about(DoubleDouble centre, const PhasePoint& phase) const {
        const QuarterState at = quarter_state(flow_, phase);
        return piece(motion_series(body_, at.sin, at.cos, at.omega * unit_), centre, at.position);
    }

    FlowPiece first_piece(double centre) const {
        return piece_about({centre, 0.0}, point_at_time(flow_.phase, {centre, 0.0}));
    }

    // About the time, or one next to it: that of the place where the piece before it ends.
    FlowPiece piece_after(const FlowPiece& before, double time) const {
        const DoubleDouble quarter = flow_.phase.quarter_turn;
        if (time >= quarter.high) return piece_about(quarter, {1.0, 0.0});
        const double z = (time - double(before.centre)) / unit_;
        const double angle = value(before.angle, z);
        const bool at_tip = before.quarters != 0;
        const double sin = at_tip ? std::cos(angle) : std::sin(angle);
        const double cos = at_tip ? -std::sin(angle) : std::cos(angle);
        if (!(cos > 0)) return piece_about(quarter, {1.0, 0.0});
        const PhasePoint phase = phase_of(flow_, sin, cos, std::max(value(before.omega, z), 0.0));
        return piece_about(time_since_flat(flow_.phase, phase), phase);
    }

    // Between which times since the flat position, both on the way up, is all of the motion?
    std::pair<double, double> quarter_range(double span) const {
        const double quarter = double(flow_.phase.quarter_turn);
        const double from = double(flow_.start_time);
        const double to = from + span;
        if (std::isinf(quarter)) {
            return {from < 0 && to > 0 ? 0.0 : std::min(std::abs(from), std::abs(to)),
                    std::max(std::abs(from), std::abs(to))};
        }
        if (span >= 2 * quarter) return {0.0, quarter};
        const auto folded = [&](double time) {
            return std::abs(std::remainder(time, 2 * quarter));
        };
        const auto passes = [&](double offset) {  // a multiple of the half turn after it
            return std::floor((to - offset) / (2 * quarter)) >
                   std::floor((from - offset) / (2 * quarter));
        };
        return {passes(0.0) ? 0.0 : std::min(folded(from), folded(to)),
                passes(quarter) ? quarter : std::max(folded(from), folded(to))};
    }

    void fill(double low, double high) {
        constexpr int most_tries =
            8;  // a piece that overlaps the last is one after its radius, shortened
        constexpr double shortened = 0.8;
        FlowPiece last = first_piece(low);
        if (!(last.high > low)) return;
        last.low = low;
        table_.pieces.push_back(last);
        while (last.high < high && table_.pieces.size() < most_pieces) {
            double radius = last.high - double(last.centre);
            FlowPiece next = piece_after(last, std::min(last.high + radius, high));
            for (int i = 0; i < most_tries && next.low > last.high; ++i) {
                radius = shortened * (next.high - double(next.centre));
                next = piece_after(last, std::min(last.high + radius, high));
            }
            if (next.low > last.high || !(next.high > last.high)) return;
            next.low = last.high;
            last = next;
            table_.pieces.push_back(last);
        }
    }

    const RollingFlow& flow_;
    FlowTable table_;
    double length_;
    double unit_;
    SeriesConstants body_;
};

// Times for which a piece holds, and what it says of them: theta = theta + angle(t - t0) and so on.
struct Stretch {
    double first;
    double last;
    const FlowPiece* piece;
    DoubleDouble zero;  // t0
    double scale;       // of t - t0, to the unit of the series
    double heading;     // of angle and path
    double spin;        // of omega
    DoubleDouble theta;
    double x;
};

// Several times side by side: the sums of one wait for each other, those of several do not.
constexpr std::size_t lanes = 8;
using Lanes = std::array<double, lanes>;

[[gnu::always_inline]] inline Lanes values(const Series& series, const Lanes& z) {
    Lanes sum;
    sum.fill(series[series_order]);
    for (int k = series_order - 1; k >= 0; --k) {
        for (std::size_t i = 0; i < lanes; ++i) sum[i] = sum[i] * z[i] + series[k];
    }
    return sum;
}

ROLLING_ELLIPSE_VECTOR_LEVELS
void sample(const Stretch& on, const double* times, std::size_t n, FlowSample* samples) {
    for (std::size_t begin = 0; begin < n; begin += lanes) {
        const std::size_t count = std::min(lanes, n - begin);
        Lanes z{};
        for (std::size_t i = 0; i < count; ++i) {
            z[i] = ((times[begin + i] - on.zero.high) - on.zero.low) * on.scale;
        }
        const Lanes angle = values(on.piece->angle, z);
        const Lanes omega = values(on.piece->omega, z);
        const Lanes path = values(on.piece->path, z);
        for (std::size_t i = 0; i < count; ++i) {
            samples[begin + i] = {on.theta.high + (on.theta.low + on.heading * angle[i]),
                                  on.spin * omega[i], on.x + on.heading * path[i]};
        }
    }
}

// The stretch that holds t; none where the table does not reach.
std::optional<Stretch> stretch_at(const FlowTable& table, double t) {
    const RollingFlow& flow = table.flow;
    const double per_unit = 1 / table.time_unit;
    if (t >= table.start.low && t <= table.start.high) {
        return Stretch{table.start.low,
                       table.start.high,
                       &table.start,
                       {0.0, 0.0},
                       per_unit,
                       1.0,
                       1.0,
                       {flow.theta, 0.0},
                       flow.x};
    }
    const auto [time, half_turns] = phase_instant(flow, t);
    const double side = time.high < 0 ? -1.0 : 1.0;
    const double since_flat = std::abs(double(time));
    const auto after =
        std::upper_bound(table.pieces.begin(), table.pieces.end(), since_flat,
                         [](double at, const FlowPiece& piece) { return at < piece.low; });
    if (after == table.pieces.begin() || since_flat > after[-1].high) return std::nullopt;
    const FlowPiece& piece = after[-1];

    const QuarterPosition& from = flow.start_position;
    const double spin = heading_after(flow, half_turns);
    const double heading = side * spin;
    const double turns = flow.kind == MotionKind::rotation ? 2 * spin * half_turns : 0.0;
    const double quarters = turns + (heading * piece.quarters - from.quarters);
    const double to_low = side * (piece.low - since_flat);
    const double to_high = side * (piece.high - since_flat);
    return Stretch{t + std::min(to_low, to_high),
                   t + std::max(to_low, to_high),
                   &piece,
                   (piece.centre * side - time) + t,
                   side * per_unit,
                   heading,
                   spin,
                   half_pi_exact * quarters + (-from.angle) + flow.theta,
                   flow.x + std::fma(quarters, flow.quarter_path, -from.path)};
}

}  // namespace

FlowTable flow_table(const RollingFlow& flow, double span) { return TableMaker(flow).make(span); }

void sample(const FlowTable& table, const double* times, std::size_t n, FlowSample* samples) {
    for (std::size_t i = 0; i < n;) {
        const std::optional<Stretch> on = stretch_at(table, times[i]);
        if (!on) {
            samples[i] = sample(table.flow, times[i]);
            ++i;
            continue;
        }
        std::size_t end = i + 1;
        while (end < n && times[end] >= on->first && times[end] <= on->last) ++end;
        sample(*on, times + i, end - i, samples + i);
        i = end;
    }
}

FlowSampler::FlowSampler(const RollingFlow& flow, double span, std::size_t expected) : flow_(flow) {
    if (flow.kind == MotionKind::rest || flow.kind == MotionKind::uniform) return;
    // Measured: a table costs as much as so many single times; that of a short move is small.
    const std::size_t few = span < double(flow.phase.quarter_turn) ? 8 : 40;
    if (expected >= few) table_ = flow_table(flow, span);
}

void FlowSampler::operator()(const double* times, std::size_t n, FlowSample* samples) const {
    if (table_) return sample(*table_, times, n, samples);
    for (std::size_t i = 0; i < n; ++i) samples[i] = sample(flow_, times[i]);
}

}  // namespace rolling_ellipse
