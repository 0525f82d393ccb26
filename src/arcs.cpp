#include "arcs.hpp"

#include <algorithm>

#include "numerics/bisect.hpp"
#include "rolling/slope_run_reader.hpp"

namespace rolling_ellipse {
namespace {

// Kind, period and marks of each law, in its own units and since its begin.

Arc arc(const RollingFlow& flow) {
    if (flow.kind == MotionKind::rest) return {ArcKind::still, 0.0, 0.0, infinity, {}};
    if (flow.kind == MotionKind::uniform) return {ArcKind::uniform, 0.0, 0.0, infinity, {}};
    const bool turns = flow.kind == MotionKind::rotation;
    const PhaseTime& phase = flow.phase;
    Arc found{turns ? ArcKind::turning : ArcKind::swinging, 0.0, 0.0, infinity, {}};
    found.marks.push_back(double(-flow.start_time));
    if (std::isinf(phase.half_turn.high)) return found;
    const int half_turns = turns ? 1 : 2;
    found.period = half_turns * double(phase.half_turn);
    found.marks.push_back(double(phase.quarter_turn - flow.start_time));
    for (int i = 1; i <= half_turns; ++i) {
        const DoubleDouble flat = phase.half_turn * double(i) - flow.start_time;
        found.marks.push_back(double(flat));
        found.marks.push_back(double(flat + phase.quarter_turn));
    }
    return found;
}

// The first times in a piece at which a quantity changes its sign, from one end to the other.
template <class Quantity>
void mark_change(const SlopePiece& piece, const Quantity& quantity, std::vector<double>& marks) {
    const bool before = quantity(0.0) < 0;
    if ((quantity(piece.lasts) < 0) == before) return;
    const auto changed = [&](double since) { return (quantity(since) < 0) != before; };
    marks.push_back(double(piece.from.time + bisect(0.0, piece.lasts, changed).high));
}

// Of a body that rocks on a slope: its turning points, the passages of the flat position and of the
// tip, and the places without angular acceleration.
Arc swing(const SlopeFlow& flow) {
    const double first = double(flow.turnings[0]);
    const double last = double(flow.turnings[1]);
    const double period = 2 * (last - first);
    std::vector<double> found{first, last};
    for (const SlopePiece& piece : flow.pieces) {
        mark_change(piece, [&](double t) { return acceleration_in(piece, t); }, found);
        for (const double offset : {-half_pi, 0.0, half_pi}) {
            const auto angle = [&](double t) { return angle_in(piece, t) - offset; };
            mark_change(piece, angle, found);
        }
    }
    Arc arc{ArcKind::swinging, 0.0, 0.0, period, {}};
    for (const double mark : found) {
        if (mark > last) continue;
        for (const double alike : {mark, 2 * first - mark, 2 * last - mark}) {
            for (const double time : {alike - period, alike, alike + period}) {
                if (time > 0 && time <= period) arc.marks.push_back(time);
            }
        }
    }
    return arc;
}

// On a slope: where its series meet, and parts of each half turn of a sum over many.
Arc arc(const SlopeFlow& flow) {
    if (flow.kind == MotionKind::rest) return {ArcKind::still, 0.0, 0.0, infinity, {}};
    if (flow.kind == MotionKind::libration) {
        Arc found = swing(flow);
        found.period *= flow.body.time;
        for (double& mark : found.marks) mark *= flow.body.time;
        return found;
    }
    Arc found{ArcKind::sloping, 0.0, 0.0, infinity, {}};
    const auto mark_run = [&](const SlopeRun& run, double half_turns) {
        constexpr double most_marked = 50'000;
        constexpr int parts = 16;
        double last = double(run.from.time);
        const double most = std::min(half_turns, most_marked);
        for (double n = 1; n <= most && last < flow.until; ++n) {
            const double next = double(run.from.time + time_of(run, n));
            for (int i = 1; i <= parts; ++i)
                found.marks.push_back(last + (next - last) * i / parts);
            last = next;
        }
    };
    if (flow.climb) mark_run(*flow.climb, flow.climbed);
    for (const SlopePiece& piece : flow.pieces) {
        const double begin = double(piece.from.time);
        found.marks.push_back(begin);
        if (flow.turnings.empty()) continue;
        const double turning = double(flow.turnings.front());
        if (begin < turning) found.marks.push_back(2 * turning - begin);
    }
    for (const DoubleDouble& turning : flow.turnings) found.marks.push_back(double(turning));
    if (flow.run) {
        const SlopePlace last = RunReader(*flow.run)({flow.until, 0.0});
        mark_run(*flow.run, (last.quarters - flow.run->from.quarters) / 2 + 1);
    }
    for (double& mark : found.marks) mark *= flow.body.time;
    return found;
}

template <class Steps>
Arc arc_of_steps(ArcKind kind, const Steps& steps) {
    Arc found{kind, 0.0, 0.0, infinity, {}};
    for (const auto& knot : steps.knots) found.marks.push_back(knot.t);
    return found;
}

Arc arc(const SteppedRolling& motion) { return arc_of_steps(ArcKind::rolling_steps, motion.steps); }

Arc arc(const SteppedMultipliers& motion) {
    return std::visit(
        [](const auto& steps) { return arc_of_steps(ArcKind::coordinate_steps, steps); },
        motion.steps);
}

Arc arc(const Slide& slide) {
    Arc found{ArcKind::sliding_steps, 0.0, 0.0, infinity, {}};
    for (const SlidePiece& piece : slide.pieces) found.marks.push_back(double(piece.centre.time));
    return found;
}

Arc arc(const Flight& flight) {
    const auto [into, along] = flight.gravity;
    std::vector<double> vertices{flight.start.z_dot / into};
    if (along != 0) vertices.push_back(-flight.start.x_dot / along);
    return {ArcKind::flight, 0.0, 0.0, infinity, vertices};
}

Arc arc(const Settling&) { return {ArcKind::settling, 0.0, 0.0, infinity, {}}; }
Arc arc(const Resting&) { return {ArcKind::still, 0.0, 0.0, infinity, {}}; }
Arc arc(const Jam&) { return {ArcKind::still, 0.0, 0.0, infinity, {}}; }

}  // namespace

std::vector<Arc> arcs(const Solution& solution) {
    const auto& [units, scene, segments, events] = solution.motion;
    const double last = solution.followed_until;
    std::vector<Arc> found;
    for (std::size_t i = 0; i < segments.size(); ++i) {
        const double begin = segments[i].begin * units.time;
        const double next =
            i + 1 == segments.size() ? infinity : segments[i + 1].begin * units.time;
        if (begin > last) break;
        Arc here = std::visit([](const auto& law) { return arc(itself(law)); }, segments[i].law);
        here.begin = begin;
        here.end = std::min(next, last);
        here.period *= units.time;
        for (double& mark : here.marks) mark = begin + mark * units.time;
        std::sort(here.marks.begin(), here.marks.end());
        const auto outside = [&](double t) { return !(t > here.begin && t < here.end); };
        here.marks.erase(std::remove_if(here.marks.begin(), here.marks.end(), outside),
                         here.marks.end());
        here.marks.erase(std::unique(here.marks.begin(), here.marks.end()), here.marks.end());
        found.push_back(std::move(here));
    }
    return found;
}

}  // namespace rolling_ellipse
