#include "proof/slope_end.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "numerics/bisect.hpp"
#include "proof/law.hpp"

namespace rolling_ellipse {
namespace {

constexpr int degree = long_order - 2;

// Beside the sum of the sizes of all terms. The series end where their last terms are a rounding,
// and the second derivative of what they leave out is up to some thousand of them.
constexpr double rounding = 1e-12;

// A law on 0 <= x <= 1, with the parts it is weighed from.
struct LawPolynomial {
    std::array<double, degree + 1> coefficients;
    double size = 0.0;  // the sum of the sizes of its terms
};

LawPolynomial law_polynomial(const SlopeBody& body, const SlopePiece& piece, double friction,
                             double side) {
    const double normal = std::isinf(friction) ? 1.0 : friction;
    const double needed = std::isinf(friction) ? 0.0 : 1.0;
    const double per_unit2 = 1 / square(piece.unit);
    const double z = piece.lasts / piece.unit;
    LawPolynomial law{};
    double power = per_unit2;
    for (int k = 0; k <= degree; ++k) {
        const double twice = (k + 2) * (k + 1) * power;
        double n = twice * piece.series.height[k + 2];
        double f = twice * piece.series.path[k + 2];
        if (k == 0) {
            n += body.gravity.into;
            f -= body.gravity.along;
            law.size = normal * body.gravity.into + needed * body.gravity.along;
        }
        law.coefficients[k] = normal * n - side * needed * f;
        law.size += std::abs(normal * n) + std::abs(needed * f);
        power *= z;
    }
    return law;
}

// Whether what the polynomial leaves out is within its rounding. Pieces are as long as angle, speed
// and path allow; the law of a nearly round body is so much less than those that it has to be
// looked at in shorter ones.
bool is_resolved(const LawPolynomial& law) {
    const double last = std::abs(law.coefficients[degree - 1]) + std::abs(law.coefficients[degree]);
    return !(last > rounding * law.size);
}

// The places at which the law passes a value.
void add_passages(const LawPolynomial& law, double of, std::vector<double>& places) {
    Polynomial<degree> shifted;
    for (int k = 0; k <= degree; ++k) shifted.coefficients[k] = tracked(law.coefficients[k]);
    shifted.coefficients[0] = shifted.coefficients[0] - tracked(of);
    const std::vector<double> found = roots_on_unit_interval(bernstein(shifted));
    places.insert(places.end(), found.begin(), found.end());
}

// A half turn by series, from any place of the motion.
LawMeetings law_in_half_turn(const SlopeFlow& flow, double friction, const SlopePlace& from) {
    const SlopeEnergy energy = energy_of(flow.body, from);
    SlopePlace place = from;
    place.path = {};
    LawWatch watch(flow, friction);
    const auto turned = [&] {
        return std::abs((place.quarters - from.quarters) * half_pi +
                        double(place.angle - from.angle));
    };
    while (turned() < pi) {
        SlopePiece piece = piece_from(flow.body, place);
        if (watch.look(piece)) break;
        place = place_after(flow.body, energy, piece);
    }
    return watch.met();
}

// About the first half turn of a run in which the law is broken, by a look at some places, denser
// near the flat of a thin body: the forces at a place are linear in omega^2, which is so in n.
double broken_about(const SlopeFlow& flow, const SlopeRun& run, double friction) {
    constexpr int looks = 64;
    const SlopeBody& body = flow.body;
    const SlopeEnergy energy = energy_of(body, run.from);
    const double start = path_at(body, 0.0, double(run.from.angle));
    double least = infinity;
    for (int i = 0; i < looks; ++i) {
        const double u = pi * (i + 0.5) / looks - half_pi;
        SlopePlace place{};
        place.angle = {std::atan2(body.short_axis * std::sin(u), body.long_axis * std::cos(u)),
                       0.0};
        const Geometry here = geometry(body, place);
        const double inertia = inertia_about_contact(body.gyration2, here);
        place.path = {path_at(body, 0.0, double(place.angle)) - start, 0.0};
        const double w = energy_at(body, energy, place, here).value;
        const double omega2 = 2 * w / inertia;
        const double gain = run.heading * 2 * body.gain / inertia;
        if (!(omega2 > 0)) continue;
        const ContactForce at_rest = contact_force(body, place);
        place.omega = std::sqrt(omega2);
        const ContactForce moving = contact_force(body, place);
        for (const double side : {1.0, -1.0}) {
            const double now = law_margin(moving, friction, side);
            const double change = (now - law_margin(at_rest, friction, side)) / omega2 * gain;
            if (change < 0) least = std::min(least, -now / change);
        }
    }
    return least;
}

// The first of the half turns 1 ... most of a run in which the law is broken, which it stays in all
// that follow.
LawMeetings law_in_run(const SlopeFlow& flow, const SlopeRun& run, double friction, double most) {
    LawMeetings met{};
    LawMeetings found{};
    const auto fails = [&](double n) {
        met = law_in_half_turn(flow, friction, place_after(run, n));
        if (met.broken) found = met;
        return met.broken.has_value();
    };
    double next = std::clamp(std::ceil(broken_about(flow, run, friction)), 1.0, most);
    double holds = 0.0;
    double step = 1.0;
    if (fails(next)) {
        while (next > step && fails(next - step)) {
            next -= step;
            step *= 2;
        }
        holds = std::max(next - step, 0.0);
    } else {
        do {
            if (next >= most) return met;
            holds = next;
            next = std::min(next + step, most);
            step *= 2;
        } while (!fails(next));
    }
    while (next - holds > 1) {
        const double middle = std::floor(0.5 * (holds + next));
        (fails(middle) ? next : holds) = middle;
    }
    return found;
}

Sign compare(double friction, double needed) {
    if (std::isinf(friction)) return Sign::positive;
    return sign(tracked(friction) - tracked(needed));
}

// A circle, and a body in equilibrium, need the same friction all the time.
LawMeetings law_of_constant_forces(const SlopeFlow& flow, double friction) {
    const auto [into, along] = flow.body.gravity;
    double needed = along / into;
    if (flow.kind == MotionKind::uniform) {
        const double k2 = flow.body.gyration2;
        needed *= k2 / (k2 + square(flow.body.long_axis));
    }
    const double heading = flow.omega == 0 ? flow.body.side : std::copysign(1.0, flow.omega);
    const Meeting here{0.0, flow.theta, heading};
    switch (compare(friction, needed)) {
        case Sign::positive:
            return {};
        case Sign::negative:
            return {{}, here};
        default:
            return {here, {}};
    }
}

void take_first_touch(LawMeetings& all, const LawMeetings& later) {
    if (!all.touched) all.touched = later.touched;
    all.broken = later.broken;
}

}  // namespace

LawWatch::LawWatch(const SlopeFlow& flow, double friction)
    : body_(flow.body),
      start_{flow.theta, flow.omega, flow.x},
      from_(flow.start),
      friction_(friction) {}

Meeting LawWatch::meeting(const SlopePiece& piece, double share) const {
    const SlopePlace place = place_in(piece, share * piece.lasts);
    const DoubleDouble turned =
        half_pi_exact * (place.quarters - from_.quarters) + (place.angle - from_.angle);
    const double rate =
        place.omega != 0 ? place.omega : acceleration_in(piece, share * piece.lasts);
    return {double(place.time) * body_.time, double(turned * body_.side + start_.theta),
            body_.side * std::copysign(1.0, rate)};
}

double LawWatch::margin(const SlopePiece& piece, double share, double side) const {
    const SlopePlace place = place_in(piece, share * piece.lasts);
    return law_margin(contact_force(body_, place), friction_, side);
}

template <class Law>
void LawWatch::examine(const SlopePiece& piece, const Law& law, double tolerance, double side,
                       Near& near) {
    std::vector<double> places{0.0, 1.0};
    add_passages(law, tolerance, places);
    add_passages(law, -tolerance, places);
    std::sort(places.begin(), places.end());
    for (std::size_t i = 0; i + 1 < places.size(); ++i) {
        if (places[i] == places[i + 1]) continue;
        const double here = value(law.coefficients, 0.5 * (places[i] + places[i + 1]));
        if (here > tolerance) {
            if (near.is && !near.from_start && !met_.touched) met_.touched = near.since;
            near = {};
        } else if (here >= -tolerance) {
            // The forces themselves know it better than the series of their polynomials.
            const double fine = law_rounding * law.size;
            const double low = places[i];
            const double high = places[i + 1];
            const auto at = [&](double share) { return margin(piece, share, side); };
            const double at_low = at(low);
            const double at_high = at(high);
            double least = at_low < at_high ? low : high;
            double at_least = std::min(at_low, at_high);
            if (at_least >= -fine) {
                const double inside =
                    golden_section(low, high, [&](double x, double y) { return at(x) < at(y); });
                const double at_inside = at(inside);
                if (at_inside < at_least) {
                    least = inside;
                    at_least = at_inside;
                }
            }
            if (at_least < -fine) {
                const double first = at_low < 0 ? low : bisect_root(low, least, at).high;
                const Meeting found = meeting(piece, first);
                if (!met_.broken || found.time < met_.broken->time) met_.broken = found;
                return;
            }
            if (at_least > fine) {
                near = {};
            } else if (!near.is) {
                near = {true, first_ && i == 0, meeting(piece, least)};
            }
        } else {
            // The root itself, by Newton's method on the forces: the series knows it nearly.
            double share = places[i];
            for (int j = 0; j < 2; ++j) {
                const double rate = derivative(law.coefficients, share);
                const double step = rate < 0 ? -margin(piece, share, side) / rate : 0.0;
                if (std::abs(step) < 1e-3) share = std::clamp(share + step, 0.0, 1.0);
            }
            const Meeting found = meeting(piece, share);
            if (!met_.broken || found.time < met_.broken->time) met_.broken = found;
            return;
        }
    }
}

bool LawWatch::look(const SlopePiece& piece) {
    const int laws = std::isinf(friction_) ? 1 : 2;
    if (std::isinf(piece.lasts)) return false;
    const double sides[] = {1.0, -1.0};
    LawPolynomial law[2];
    for (int i = 0; i < laws; ++i) {
        law[i] = law_polynomial(body_, piece, friction_, sides[i]);
        if (!is_resolved(law[i])) return look_at_parts(piece);
    }
    for (int i = 0; i < laws; ++i) {
        const double tolerance = rounding * law[i].size;
        double least = law[i].coefficients[0];
        for (int k = 1; k <= degree; ++k) least -= std::abs(law[i].coefficients[k]);
        if (least > tolerance && !near_[i].is) continue;
        examine(piece, law[i], tolerance, sides[i], near_[i]);
    }
    first_ = false;
    return met_.broken.has_value();
}

bool LawWatch::look_at_parts(const SlopePiece& piece) {
    SlopePiece part = piece;
    part.lasts = 0.5 * piece.lasts;
    double seen = 0.0;
    while (!look(part)) {
        seen += part.lasts;
        if (seen >= piece.lasts) return false;
        part = piece_from(body_, place_in(piece, seen));
        part.lasts = std::min(part.lasts, piece.lasts - seen);
    }
    return true;
}

LawMeetings LawWatch::met() const {
    LawMeetings all = met_;
    for (const Near& near : near_) {
        if (!all.broken && near.is && !near.from_start && !all.touched) all.touched = near.since;
    }
    if (all.broken && all.touched && all.touched->time > all.broken->time) all.touched.reset();
    return all;
}

LawMeetings law_meetings(SlopeFlow& flow, double friction, double until) {
    const double heading = flow.omega == 0 ? flow.body.side : std::copysign(1.0, flow.omega);
    if (friction == 0) return {{}, Meeting{0.0, flow.theta, heading}};
    if (flow.kind == MotionKind::rest || flow.kind == MotionKind::uniform) {
        return law_of_constant_forces(flow, friction);
    }
    if (flow.pieces.empty()) grow(flow);
    LawMeetings all{};
    if (flow.climb) {
        take_first_touch(all, law_in_half_turn(flow, friction, flow.start));
        if (all.broken) return all;
        take_first_touch(all, law_in_run(flow, *flow.climb, friction, flow.climbed - 1));
        if (all.broken) return all;
    }
    LawWatch watch(flow, friction);
    const double last = until / flow.body.time;
    for (std::size_t i = 0; i < flow.pieces.size() || grow(flow); ++i) {
        if (i == flow.pieces.size()) break;
        const SlopePiece& piece = flow.pieces[i];
        if (double(piece.from.time) > last || watch.look(piece) || std::isinf(piece.lasts)) break;
    }
    take_first_touch(all, watch.met());
    if (all.broken || !flow.run || double(flow.run->from.time) > last) return all;
    take_first_touch(all, law_in_run(flow, *flow.run, friction, most_half_turns));
    return all;
}

EndOfRolling end_of_rolling(const LawMeetings& met) {
    if (met.touched) return {Validity::edge, met.touched->theta, met.touched->heading};
    if (met.broken) return {Validity::invalid, met.broken->theta, met.broken->heading};
    return {Validity::valid};
}

}  // namespace rolling_ellipse
