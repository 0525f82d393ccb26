// The end of rolling on a slope: the law of the contact along the motion.
//
// Per mass, N = g_into + z_ddot and F = x_ddot - g_along come from the same power series as the
// motion, so that the law first breaks at the first root of a polynomial. In a half turn of a run
// or climb, polynomials on its parts may give a faster proof that the law holds. Half turns need
// not be followed one by one: at each angle N and F are linear in W = D omega^2/2, physics (58),
// and the law holds on an interval of W. If it holds in two half turns, it holds in all between
// them.
#include <algorithm>
#include <cmath>
#include <vector>

#include "numerics/bisect.hpp"
#include "proof/slope.hpp"

namespace rolling_ellipse {
namespace {

constexpr int law_degree = long_order - 2;

// Error of a law's polynomial, relative to the sum of the magnitudes of its terms. The series of
// the motion end where their last terms are as small as a rounding error; the second derivative of
// the omitted terms reaches several thousand rounding errors.
constexpr double rounding = 1e-12;

}  // namespace

// The margin of the law for one direction of the friction force, as a polynomial in the fraction x
// of a piece.
struct LawWatch::Law {
    double side;
    double size;  // sum of the magnitudes of the terms of the law
    std::array<double, law_degree + 1> coefficients;

    Law(const SlopeBody& body, const SlopePiece& piece, double friction, double to_side)
        : side(to_side), size(law_size({body.gravity.into, body.gravity.along}, friction)) {
        const double normal = std::isinf(friction) ? 1.0 : friction;
        const double needed = std::isinf(friction) ? 0.0 : 1.0;
        const double z = piece.lasts / piece.unit;
        double power = 1 / square(piece.unit);
        for (int k = 0; k <= law_degree; ++k) {
            const double twice = (k + 2) * (k + 1) * power;
            double n = twice * piece.series.height[k + 2];
            double f = twice * piece.series.path[k + 2];
            if (k == 0) {
                n += body.gravity.into;
                f -= body.gravity.along;
            }
            coefficients[k] = normal * n - side * needed * f;
            size += std::abs(normal * n) + std::abs(needed * f);
            power *= z;
        }
    }

    double tolerance() const { return rounding * size; }

    // Whether the omitted terms are within the tolerance. Pieces are as long as the series of
    // angle, speed and path allow; for a nearly round body the law is much smaller than these
    // quantities and needs shorter pieces.
    bool is_resolved() const {
        return !(std::abs(coefficients[law_degree - 1]) + std::abs(coefficients[law_degree]) >
                 tolerance());
    }

    bool is_positive() const {
        double least = coefficients[0];
        for (int k = 1; k <= law_degree; ++k) least -= std::abs(coefficients[k]);
        return least > tolerance();
    }

    // 0, 1 and the points between them at which the margin crosses +tolerance or -tolerance.
    std::vector<double> divisions() const {
        std::vector<double> places{0.0, 1.0};
        for (const double level : {tolerance(), -tolerance()}) {
            Polynomial<law_degree> shifted;
            for (int k = 0; k <= law_degree; ++k) {
                shifted.coefficients[k] = tracked(coefficients[k]);
            }
            shifted.coefficients[0] = shifted.coefficients[0] - tracked(level);
            const std::vector<double> found = roots_on_unit_interval(bernstein(shifted));
            places.insert(places.end(), found.begin(), found.end());
        }
        std::sort(places.begin(), places.end());
        return places;
    }
};

Meeting LawWatch::meeting(const SlopePiece& piece, double share) const {
    const double since = share * piece.lasts;
    const SlopePlace place = place_in(piece, since);
    const double rate =
        place.omega != 0 ? place.omega : derivative(piece.series.omega, since / piece.unit);
    return {double(place.time) * flow_.body.time, sample_of(flow_, place).theta,
            flow_.body.side * std::copysign(1.0, rate)};
}

void LawWatch::break_at(const Meeting& meeting) {
    if (!met_.broken || meeting.time < met_.broken->time) met_.broken = meeting;
}

void LawWatch::examine(const SlopePiece& piece, const Law& law, Stretch& near) {
    const auto at = [&](double share) {
        const SlopePlace place = place_in(piece, share * piece.lasts);
        return law_margin(contact_force(flow_.body, place), friction_, law.side);
    };
    const std::vector<double> places = law.divisions();
    for (std::size_t i = 0; i + 1 < places.size(); ++i) {
        const double low = places[i];
        const double high = places[i + 1];
        if (low == high) continue;
        const double here = value(law.coefficients, 0.5 * (low + high));
        if (here > law.tolerance()) {
            if (!met_.touched) met_.touched = near.begin;
            near = {};
        } else if (here >= -law.tolerance()) {
            // The rounding error of the forces; the error of their polynomials is larger.
            const double fine = law_rounding * law.size;
            double least = at(low) < at(high) ? low : high;
            if (at(least) >= -fine) {
                const double inside =
                    golden_section(low, high, [&](double x, double y) { return at(x) < at(y); });
                if (at(inside) < at(least)) least = inside;
            }
            if (at(least) < -fine) {
                const double first = at(low) < 0 ? low : bisect_root(low, least, at).high;
                return break_at(meeting(piece, first));
            }
            if (at(least) > fine) {
                near = {};
            } else if (!near.open) {
                near = {true, {}};
                if (!at_start_ || i > 0) near.begin = meeting(piece, least);
            }
        } else {
            // Newton's method on the forces, starting at the root of the polynomial.
            double share = low;
            for (int j = 0; j < 2; ++j) {
                const double rate = derivative(law.coefficients, share);
                const double step = rate < 0 ? -at(share) / rate : 0.0;
                if (std::abs(step) < 1e-3) share = std::clamp(share + step, 0.0, 1.0);
            }
            return break_at(meeting(piece, share));
        }
    }
}

bool LawWatch::examine(const SlopePiece& piece) {
    if (std::isinf(piece.lasts)) return false;
    const int count = std::isinf(friction_) ? 1 : 2;  // under infinite friction only N > 0 remains
    std::optional<Law> laws[2];
    for (int i = 0; i < count; ++i) {
        laws[i].emplace(flow_.body, piece, friction_, i == 0 ? 1.0 : -1.0);
        if (!laws[i]->is_resolved()) return examine_parts(piece);
    }
    for (int i = 0; i < count; ++i) {
        if (near_[i].open || !laws[i]->is_positive()) examine(piece, *laws[i], near_[i]);
    }
    at_start_ = false;
    return met_.broken.has_value();
}

bool LawWatch::examine_parts(const SlopePiece& piece) {
    SlopePiece part = piece;
    part.lasts = 0.5 * piece.lasts;
    double seen = 0.0;
    while (!examine(part)) {
        seen += part.lasts;
        if (seen >= piece.lasts) return false;
        part = piece_from(flow_.body, place_in(piece, seen));
        part.lasts = std::min(part.lasts, piece.lasts - seen);
    }
    return true;
}

LawMeetings LawWatch::met() const {
    LawMeetings all = met_;
    for (const Stretch& near : near_) {
        if (!all.broken && !all.touched) all.touched = near.begin;
    }
    if (all.broken && all.touched && all.touched->time > all.broken->time) all.touched.reset();
    return all;
}

namespace {

// Whether the law provably holds on a part with the given forces. The margin at each node must
// exceed the largest possible change between a node and the points around it, which follows from
// |P_k'| <= k (k + 1)/2 on [-1, 1]. The omitted terms, which fall by a factor of at least 2 per
// degree, change the margin by less than 40 times the sum of the last two terms.
bool holds_on_part(const PartForces& forces, const GroundGravity& gravity, double friction) {
    constexpr double to_a_node = 0.077;  // largest distance of a point from the nearest node
    constexpr double resolved = 1e-8;
    static_assert(part_order == 20);
    const PartArray normal = legendre_coefficients(forces.normal);
    const PartArray tangential = legendre_coefficients(forces.friction);
    double size = law_size({gravity.into, gravity.along}, friction);
    double change = 0.0;
    double ends = 0.0;  // the last two terms
    double least = infinity;
    for (int k = 0; k < part_order; ++k) {
        const double term = law_size({normal[k], tangential[k]}, friction);
        size += term;
        change += 0.5 * k * (k + 1) * term;
        if (k >= part_order - 2) ends += term;
        least = std::min(least, law_margin({forces.normal[k], forces.friction[k]}, friction));
    }
    return ends <= resolved * size && least - to_a_node * change > rounding * size + 40 * ends;
}

// Where a run is at the limit of the law in the half turn after its first `half_turns` half turns.
// Power series follow the half turn only if its parts do not prove that the law holds.
LawMeetings law_in_half_turn(const SlopeFlow& flow, const SlopeRun& run, double friction,
                             double half_turns) {
    const bool holds = std::all_of(run.parts.begin(), run.parts.end(), [&](const RunPart& part) {
        return holds_on_part(node_forces(run, part, half_turns), run.body.gravity, friction);
    });
    if (holds) return {};
    const SlopePlace from = half_turns == 0 ? run.from : place_after(run, half_turns);
    const Datum start = datum_of(flow.body, from);
    SlopePlace place = from;
    place.path = {};
    LawWatch watch(flow, friction);
    const auto turned = [&] {
        return std::abs((place.quarters - from.quarters) * half_pi +
                        double(place.angle - from.angle));
    };
    while (turned() < pi) {
        const SlopePiece piece = piece_from(flow.body, place);
        if (watch.examine(piece)) break;
        place = place_after(flow.body, start, piece);
    }
    return watch.met();
}

// A first guess of the half turn in which the law breaks, from the nodes of the parts of a complete
// run. The forces at a node are linear in W, hence in the number of half turns.
double broken_about(const SlopeRun& run, double friction) {
    const double later =
        std::max(1.0, std::min(run.start.energy / run.body.gain, run.half_turns - 1));
    double least = infinity;
    for (const RunPart& part : run.parts) {
        const PartForces first = node_forces(run, part, 0.0);
        const PartForces last = node_forces(run, part, later);
        for (int i = 0; i < part_order; ++i) {
            for (const double side : {1.0, -1.0}) {
                const double margin =
                    law_margin({first.normal[i], first.friction[i]}, friction, side);
                const double lost =
                    margin - law_margin({last.normal[i], last.friction[i]}, friction, side);
                if (lost > 0) least = std::min(least, margin / lost * later);
            }
        }
    }
    return least;
}

// Combines the results for a stretch of a motion with those for a later stretch, or for a later
// part of the same stretch.
LawMeetings joined(const LawMeetings& met, const LawMeetings& later) {
    return {met.touched ? met.touched : later.touched, met.broken ? met.broken : later.broken};
}

// Where a run is at the limit of the law, at least up to the time `until` after its start. If the
// law breaks in a half turn, it breaks in all later ones, too. The search for the first of them
// takes growing steps from a guess, then bisects.
LawMeetings law_in_run(const SlopeFlow& flow, const SlopeRun& run, double friction, double until) {
    LawMeetings met = law_in_half_turn(flow, run, friction, 0.0);
    const double all = run.half_turns - 1;
    if (met.broken || run.known > until || all < 1) return met;
    double most = until < infinity ? std::clamp(about(run, until), 1.0, all) : all;
    RunTimes times(run);
    while (most < all && double(times(most + 1)) <= until) most = std::min(2 * most, all);
    LawMeetings later{};
    double holds = 0.0;
    double broken = most + 1;
    double next = std::clamp(std::ceil(broken_about(run, friction)), 1.0, most);
    for (double step = 1.0; broken - holds > 1; step *= 2) {
        const LawMeetings here = law_in_half_turn(flow, run, friction, next);
        if (here.broken || broken > most) later = here;
        (here.broken ? broken : holds) = next;
        next = here.broken ? broken - step : std::min(holds + step, most);
        if (!(holds < next && next < broken)) next = std::floor(0.5 * (holds + broken));
    }
    return joined(met, later);
}

Meeting start_of(const SlopeFlow& flow) {
    return {0.0, flow.theta, flow.omega == 0 ? flow.body.side : std::copysign(1.0, flow.omega)};
}

}  // namespace

// A circle and a body in equilibrium need the same friction at all times.
bool LawWatch::examine(const Even&) {
    if (std::isinf(friction_)) return false;
    const auto [into, along] = flow_.body.gravity;
    double needed = along / into;
    if (!flow_.rests) {
        const double k2 = flow_.body.gyration2;
        needed *= k2 / (k2 + square(flow_.body.long_axis));
    }
    const Sign margin = sign(tracked(friction_) - tracked(needed));
    if (margin == Sign::undecided) met_.touched = start_of(flow_);
    if (margin == Sign::negative) met_.broken = start_of(flow_);
    return met_.broken.has_value();
}

bool LawWatch::examine(Sum& sum) {
    const double until = sum.run.heading < 0 ? infinity : until_ - double(sum.run.from.time);
    extend(sum.run, until);
    met_ = joined(met(), law_in_run(flow_, sum.run, friction_, until));
    return met_.broken.has_value();
}

// Power series follow the motion only if the parts of the swing do not prove that the law holds.
bool LawWatch::examine(const Swing& swing) {
    const auto holds = [&](const WellSide& side) {
        return std::all_of(side.parts.begin(), side.parts.end(), [&](const RunPart& part) {
            return holds_on_part(node_forces(flow_.body, side, part), flow_.body.gravity,
                                 friction_);
        });
    };
    if (std::all_of(swing.sides.begin(), swing.sides.end(), holds)) return false;
    SlopeFlow followed = by_series(flow_);
    met_ = joined(met(), law_meetings(followed, friction_, until_ * flow_.body.time));
    return met_.broken.has_value();
}

LawMeetings law_meetings(SlopeFlow& flow, double friction, double until) {
    if (friction == 0) return {{}, start_of(flow)};
    const double last = until / flow.body.time;
    LawWatch watch(flow, friction, last);
    for (std::size_t i = 0; i < flow.stretches.size() || grow(flow); ++i) {
        auto& [begin, end, law] = flow.stretches[i];
        if (begin > last) break;
        if (std::visit([&](auto& stretch) { return watch.examine(stretch); }, law)) break;
    }
    return watch.met();
}

EndOfRolling end_of_rolling(const LawMeetings& met) {
    const auto& first = met.touched ? met.touched : met.broken;
    if (!first) return {Validity::valid};
    return {met.touched ? Validity::edge : Validity::invalid, first->theta, first->heading,
            first->time};
}

}  // namespace rolling_ellipse
