// Exact rolling at many times, by Taylor series in time about points of the exact solution.
//
// The series cover the quarter turn (or quarter swing) that starts at the flat position; the motion
// at all other times is a copy or mirror image of this one. A further series about t = 0 keeps
// small changes accurate. The coefficients follow from the equation of motion by the rules for
// products, quotients and roots of series (A. Jorba, M. Zou, Experiment. Math. 14 (2005) 99).
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "rolling/level/motion.hpp"

namespace rolling_ellipse {
namespace {

// Largest number of pieces in a quarter turn. Most motions have 15 to 85; the separatrix needs over
// 200.
constexpr std::size_t most_pieces = 1000;

// Path from the flat position or from the tip, whichever is the origin of the angle in
// `quarter_view`, so that differences stay accurate near both.
double path_in_quarter(const FlatView& body, double sin, double cos) {
    const double s = std::abs(sin);
    const Axes lying = body.lying();
    const double path = s <= cos ? path_from_flat(lying, s, cos) : -path_from_tip(lying, cos, s);
    return std::copysign(1.0, sin) * path;
}

class TableMaker {
  public:
    explicit TableMaker(const RollingFlow& flow) : flow_(flow), kernel_(kernel()) {
        const PhaseIntegrand<double>& integrand = flow.phase.integrand;
        rotates_ = flow.kind == MotionKind::rotation;
        length_ = flow.from.view.long_axis;
        const double fastest = (rotates_ ? 1.0 : std::sqrt(integrand.amplitude2)) /
                               shape_factor<double>(integrand, 0.0);
        unit_ = std::min(0.5 / fastest, 0.5 * double(flow.phase.quarter_turn));
        body_ = series_constants(flow.from, flow.phase.integrand, unit_);
    }

    // The table of the motion; empty if no spacing of the points makes all series accurate.
    std::optional<FlowTable> make() {
        // Spacings in the coordinate y, in which all singularities are at a distance of pi/2 from
        // the real axis. The first one suffices for nearly all motions.
        for (const double spacing : {0.122, 0.1, 0.07, 0.05}) {
            place(spacing);
            if (places_.size() > most_pieces) break;
            if (!expand()) continue;
            add_times();
            add_paths();
            add_start();
            describe();
            return std::move(table_);
        }
        return std::nullopt;
    }

  private:
    // Sets the points about which the series are expanded, from the flat position to the end of the
    // quarter.
    void place(double spacing) {
        constexpr double wider = 1.5;  // factor of the spacing beyond a phase of 45 degrees
        // This far beyond 45 degrees, a body on the separatrix is on the tip to within rounding.
        constexpr double longest_rise = 38.0;
        const PhaseMap<double>& map = flow_.phase.map;
        const double middle = asinh(1 / map.grade);
        const double end = std::isinf(map.quarter) ? middle + longest_rise : map.quarter;
        const int up = static_cast<int>(std::ceil(middle / spacing));
        const int down = static_cast<int>(std::ceil((end - middle) / (wider * spacing)));
        places_.clear();
        const auto add = [&](double y) { places_.emplace_back().y = y; };
        for (int i = 0; i < up; ++i) add(middle * i / up);
        for (int i = 0; i < down; ++i) add(middle + (end - middle) * i / down);
        add(end);
    }

    std::size_t count() const { return places_.size(); }

    // Half the time to the previous and to the next point.
    double half_way_back(std::size_t i) { return 0.5 * places_[i == 0 ? 1 : i].time; }
    double half_way_on(std::size_t i) { return half_way_back(std::min(i + 1, count() - 1)); }

    // Computes the motion at all points and the series about them; returns false unless every
    // series is accurate halfway to both neighbouring points.
    bool expand() {
        const int n = static_cast<int>(count());
        kernel_.states(flow_.phase.integrand, flow_.phase.map, flow_.amplitude, places_.data(), n);
        for (std::size_t i = 0; i < count(); ++i) {
            places_[i].radius = std::max(half_way_back(i), half_way_on(i)) / unit_;
        }
        table_.pieces.resize(count());
        kernel_.series(body_, unit_, length_, places_.data(), n, table_.pieces.data());
        return std::all_of(places_.begin(), places_.end(),
                           [](const TablePlace& place) { return place.holds > 0; });
    }

    // Sets the times of the pieces since the flat position, summed from the nearer end of the
    // quarter.
    void add_times() {
        std::vector<FlowPiece>& pieces = table_.pieces;
        const DoubleDouble quarter = flow_.phase.quarter_turn;
        DoubleDouble time{};
        for (std::size_t i = 0; i < count(); ++i) {
            if (i > 0) time = time + places_[i].time;
            pieces[i].centre = time;
            pieces[i].quarters = places_[i].quarters;
        }
        if (std::isfinite(quarter.high)) {
            time = quarter;
            for (std::size_t i = count() - 1; double(time) > 0.5 * double(quarter); --i) {
                pieces[i].centre = time;
                time = time + -places_[i].time;
            }
        }
        double low = 0.0;
        for (std::size_t i = 0; i < count(); ++i) {
            pieces[i].low = low;
            pieces[i].high = low = double(pieces[i].centre) + half_way_on(i);
        }
    }

    // Sets the paths of the pieces, measured from the flat position or, near the tip, from the tip.
    void add_paths() {
        std::vector<FlowPiece>& pieces = table_.pieces;
        const auto path = [&](std::size_t i) -> double& { return pieces[i].series.rows[0][2]; };
        for (std::size_t i = 1; i < count() && pieces[i].quarters == 0; ++i) {
            path(i) = path(i - 1) + places_[i].path;
        }
        const std::size_t last = count() - 1;
        if (pieces[last].quarters == 0) return;
        const PhaseMap<double>& map = flow_.phase.map;
        const bool has_tip = places_[last].y == map.quarter;
        const PhasePlace<double> end{has_tip ? 1.0 : 0.0, has_tip ? 0.0 : places_[last].y};
        const MotionPoint<double> tip =
            motion_point(flow_.phase.integrand, flow_.amplitude, phase_point(map, end));
        path(last) = path_in_quarter(flow_.from.view, tip.sin_phi, tip.cos_phi);
        for (std::size_t i = last; pieces[i - 1].quarters != 0; --i)
            path(i - 1) = path(i) - places_[i].path;
    }

    // Adds the series about t = 0, with the largest of several trial radii at which it is accurate.
    void add_start() {
        const FlatView& at_start = flow_.from.view;
        table_.reader.start_time = time_since_flat(flow_, flow_.start_phase);
        // The first radius is the length of the piece that contains the start.
        const double since = std::abs(double(table_.reader.start_time));
        const auto piece = std::find_if(table_.pieces.begin(), table_.pieces.end() - 1,
                                        [&](const FlowPiece& p) { return since < p.high; });
        constexpr int tries = 8;
        std::array<TablePlace, tries> same{};
        std::array<FlowPiece, tries> pieces;
        double radius = (piece->high - piece->low) / unit_;
        for (TablePlace& place : same) {
            place.sin = at_start.sin;
            place.cos = at_start.cos;
            place.omega = flow_.from.omega;
            place.radius = radius;
            radius *= 0.75;
        }
        kernel_.series(body_, unit_, length_, same.data(), tries, pieces.data());
        const auto first = std::find_if(same.begin(), same.end(),
                                        [](const TablePlace& place) { return place.holds > 0; });
        table_.reader.start = pieces[0].series;
        table_.reader.start_radius = first == same.end() ? 0.0 : unit_ * first->radius;
    }

    // Sets the values that a kernel needs to read the table.
    void describe() {
        FlowReader& reader = table_.reader;
        const std::vector<FlowPiece>& pieces = table_.pieces;
        reader.half = 1;
        while (2 * reader.half <= int(pieces.size()) - 1) reader.half *= 2;
        reader.pieces = pieces.data();
        // The remaining ends are infinite, so that all later times use the last piece.
        table_.ends.assign(2 * reader.half - 1, infinity);
        for (std::size_t i = 0; i + 1 < pieces.size(); ++i) table_.ends[i] = pieces[i].high;
        reader.ends = table_.ends.data();
        reader.last_end = pieces.back().high;
        reader.per_unit = 1 / unit_;
        const DoubleDouble half_turn = flow_.phase.half_turn;
        if (std::isfinite(half_turn.high)) {
            reader.half_turn = half_turn;
            reader.half_turns_per_time = 1 / half_turn.high;
        }
        reader.spin = heading_of<double>(flow_);
        reader.alternates = !rotates_;
        reader.quarters_per_half_turn = rotates_ ? 2 * flow_.direction : 0.0;
        const FlatView& view = flow_.from.view;
        const auto [quarters, angle] = quarter_view(view.sin, view.cos);
        reader.quarters = quarters;
        reader.angle = two_sum(flow_.from.theta, -angle.high);
        reader.path = path_in_quarter(view, view.sin, view.cos);
        reader.quarter_path = path_from_flat(view.lying(), 1.0, 0.0);
        reader.theta = flow_.from.theta;
        reader.x = flow_.x;
    }

    const RollingFlow& flow_;
    const Kernel& kernel_;
    FlowTable table_{};
    bool rotates_;
    double length_;
    double unit_;
    SeriesConstants body_;
    std::vector<TablePlace> places_;
};

}  // namespace

std::optional<FlowTable> flow_table(const RollingFlow& flow) { return TableMaker(flow).make(); }

FlowSampler::FlowSampler(const RollingFlow& flow, std::size_t expected) : flow_(flow) {
    if (flow.kind == MotionKind::rest || flow.kind == MotionKind::uniform) return;
    // No table is built for fewer times. A table pays off from ten samples on, but below this limit
    // a root search, whose calls have a few times each, always gets the same bits.
    constexpr std::size_t few = 40;
    if (expected >= few) table_ = flow_table(flow);
}

void FlowSampler::operator()(const double* times, std::size_t n, const FlowColumns& out) const {
    if (table_ && !kernel().read(table_->reader, times, n, out)) return;
    for (std::size_t i = 0; i < n; ++i) {
        if (!table_ || std::isnan(out.theta[i])) store(sample(flow_, times[i]), out, i);
    }
}

void FlowSampler::operator()(const double* times, std::size_t n, FlowSample* samples) const {
    std::vector<double> columns(3 * n);
    double* const first = columns.data();
    const FlowColumns found{first, first + n, first + 2 * n};
    (*this)(times, n, found);
    for (std::size_t i = 0; i < n; ++i) samples[i] = {found.theta[i], found.omega[i], found.x[i]};
}

}  // namespace rolling_ellipse
