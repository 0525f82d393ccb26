#include "contact/slide.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "contact/resisted_rolling.hpp"
#include "numerics/bisect.hpp"
#include "numerics/polynomial.hpp"
#include "proof/law.hpp"
#include "rolling/stepped/equation.hpp"

namespace rolling_ellipse {
namespace {

// The value of B, physics (50), below which the slower clock of physics (54) is used.
constexpr double small_response = 1e-2;
// The value of B, physics (50), below which B counts as 0.
constexpr double no_response = 1e-13;

// The point of a piece at a clock reading. Slip and energy are not updated: no sample needs them.
SlidePoint moved(const SlidePiece& piece, double clock) {
    const auto& [centre, kind, unit, reach, motion] = piece;
    const auto change = [clock](const LongSeries& series) { return value(series, clock); };
    const double lasts = kind == SlideClock::time ? clock : change(motion.time);
    return {centre.angle + change(motion.angle),
            centre.omega + change(motion.omega) / unit,
            centre.slip,
            centre.x_dot + change(motion.x_dot) / unit,
            centre.path + change(motion.path),
            centre.time + lasts * unit,
            centre.energy};
}

bool is_finite(const SlidePoint& point) {
    const DoubleDouble numbers[] = {point.angle, point.omega, point.x_dot, point.path, point.time};
    return std::all_of(std::begin(numbers), std::end(numbers),
                       [](const DoubleDouble& each) { return std::isfinite(double(each)); });
}

// Powers of the reach of a piece, limited to finite numbers: the reach of a circle may be huge,
// while its coefficients are 0.
LongSeries powers_of(double reach) {
    LongSeries powers{1.0};
    for (int k = 0; k < long_order; ++k) {
        powers[k + 1] = std::min(powers[k] * reach, std::numeric_limits<double>::max());
    }
    return powers;
}

// The first point, as a fraction of the reach, at which a series that must stay positive is
// provably negative. coefficient(k) returns a coefficient and the magnitude of the terms that were
// added to compute it.
template <class Coefficient>
std::optional<double> first_end(const LongSeries& powers, const Coefficient& coefficient) {
    Tracked least = coefficient(0);  // a lower bound of the series
    for (int k = 1; k <= long_order; ++k) {
        const auto [value, magnitude] = coefficient(k);
        least = least + Tracked{-std::abs(value) * powers[k], magnitude * powers[k]};
    }
    if (sign(least) == Sign::positive) return std::nullopt;
    Polynomial<long_order> shares;
    for (int k = 0; k <= long_order; ++k) {
        const auto [value, magnitude] = coefficient(k);
        shares.coefficients[k] = {value * powers[k], magnitude * powers[k]};
    }
    return first_negative(bernstein(shares));
}

// The geometry at an angle in double-double precision.
Geometry geometry(const Axes& axes, const DoubleDouble& angle) {
    const double sin = std::sin(angle.high);
    const double cos = std::cos(angle.high);
    constexpr double small = 0x1p-27;  // the sine of a smaller angle is the angle, the cosine 1
    const bool is_small = std::abs(angle.low) < small;  // angle.low reaches 1 after 1e16 radians
    const double rest_sin = is_small ? angle.low : std::sin(angle.low);
    const double rest_cos = is_small ? 1.0 : std::cos(angle.low);
    return geometry(axes, sin * rest_cos + cos * rest_sin, cos * rest_cos - sin * rest_sin);
}

// Height of the centre of a body on its tip, minus its current height.
double under_tip(const Axes& axes, const Geometry& at) {
    return under_tip(flat_view(axes, at.sin, at.cos), at.h);
}

double energy_of(const SlidingBody& body, const DoubleDouble& angle, double omega) {
    const Geometry at = geometry(body.axes, angle);
    return 0.5 * square(omega) * (body.gyration2 + square(at.dh)) -
           body.gravity.into * under_tip(body.axes, at);
}

// The contact force of a body that rolls with resistance.
ContactForce rolling_force(const SlidingBody& body, const Geometry& at, double omega) {
    const RollingEquation rolling({body.axes.a, body.axes.b, body.gyration2, 0.0}, body.gravity);
    return rolling.force(body.mass, at, omega, body.ahead);
}

ContactSample sample_at(const Slide& slide, const SlidePoint& point) {
    const double theta = double(slide.theta_base + point.angle);
    const double omega = double(point.omega);
    const Geometry at = geometry(slide.axes, theta);
    const double x = slide.x_base + double(point.path);
    if (slide.rolls_by) {
        SlidingBody body = slide.body;
        body.axes = slide.axes;
        return {without_slip(at, theta, omega, x, Mode::rolling), rolling_force(body, at, omega)};
    }
    return {on_ground(at, theta, omega, x, double(point.x_dot), Mode::sliding),
            sliding_force(slide.body, at, omega)};
}

class SlideIntegration {
  public:
    SlideIntegration(Slide& slide, const SlideBounds& bounds)
        : slide_(slide),
          last_(slide.last),
          bounds_(bounds),
          at_(geometry(slide.body.axes, slide.last.angle)) {
        const double b = response(slide.body, at_, last_.omega.high).b;
        if (may_jam() && b < small_response) {
            scaled_response_ = cancelled_response(slide_.body, at_, last_.angle);
        }
    }

    // Adds a piece. If the slide stops there, returns the reason.
    std::optional<SlideStop> step() {
        const SlidePoint& from = last_;
        const double unit = std::ldexp(1.0, -std::ilogb(rate()));
        SlidingBody body = slide_.body;
        body.gravity = {body.gravity.into * square(unit), body.gravity.along * square(unit)};
        SlideCentre centre{at_.sin,
                           at_.cos,
                           double(from.omega) * unit,
                           double(from.slip) * unit,
                           double(from.x_dot) * unit,
                           scaled_response_,
                           {}};
        if (slide_.rolls_by) centre.torque = cancelled_moment(body, at_, from.angle);
        if (may_jam() && !scaled_response_) {
            centre.response = cancelled_response(slide_.body, at_, from.angle);
        }
        SlideSeries series = slide_.rolls_by ? rolling_series(body, centre, rolling_forces_)
                                             : slide_series(body, centre, clock());
        auto& [angle, omega, x_dot, path, time] = series.motion;
        // Largest reach of a piece in its unit of time: 1 + 15 times the time slid so far. This
        // limit matters for circles, whose series never lose accuracy. The series of h omega and of
        // the pressure bound the reach, too: for a nearly round body, their relative changes exceed
        // those of angle and speed.
        const double most = 1 + 15 * from.time.high / unit;
        reach_ = std::min(reach({&angle, &omega, &series.rolled, &series.pressure}), most);
        find_end(body, series);
        omega[0] = series.slip[0] = series.response[0] = x_dot[0] = 0.0;
        SlidePiece& piece = slide_.pieces.emplace_back();  // in place, since it is large
        piece.centre = from;
        piece.clock = clock();
        piece.unit = unit;
        piece.reach = reach_;
        piece.motion = series.motion;
        if (end_ == End::law) {
            refine_law_end(piece);
            reach_ = piece.reach;
        }
        SlidePoint next = moved(piece, reach_);
        // Rates beyond about 1e100 overflow despite the choice of the unit.
        if (!is_finite(next)) {
            slide_.pieces.pop_back();
            return SlideStop::no_progress;
        }
        const double work = value(series.work, reach_) / square(unit);
        next.energy = next.energy + work;
        worked_ += std::abs(work);
        next.slip = next.slip + value(series.slip, reach_) / unit;
        if (scaled_response_) *scaled_response_ += value(series.response, reach_);
        last_ = next;
        at_ = geometry(slide_.body.axes, last_.angle);
        keep_energy();
        keep_slip();
        return end_ ? end() : std::nullopt;
    }

  private:
    // Computes omega from the energy where the body slows down on its way to the tip. There the
    // series carry the rounding errors of the earlier, fast motion. The rounding errors of the
    // energy, which is measured from the tip, are smaller unless friction has done much work, which
    // adds rounding errors of its own. The energy does not include the work of rolling resistance,
    // physics (66).
    void keep_energy() {
        if (slide_.body.ahead != 0) return;
        constexpr double small = 0.25;      // relative to the largest kinetic energy
        constexpr double rounding = 1e-12;  // a larger relative change is not due to rounding
        const double fallen = slide_.body.gravity.into * under_tip(slide_.body.axes, at_);
        const double kinetic = double(last_.energy + fallen);
        most_kinetic_ = std::max(most_kinetic_, kinetic);
        if (!(kinetic > 0 && kinetic + fallen < small * most_kinetic_)) return;
        if (square(worked_) > 4 * kinetic * most_kinetic_) return;
        const double inertia = slide_.body.gyration2 + square(at_.dh);
        const double omega = std::copysign(std::sqrt(2 * kinetic / inertia), last_.omega.high);
        const double change = (omega - last_.omega.high) - last_.omega.low;
        if (!(std::abs(change) < rounding * std::abs(omega))) return;
        last_.omega = {omega, 0.0};
        last_.slip = last_.slip + -at_.h * change;
    }

    // Computes the slip as x_dot - h omega where |x_dot| + |h omega| is smaller than the largest
    // slip since it was last computed this way. As a sum of changes, the slip would have the
    // rounding errors of its largest value.
    void keep_slip() {
        const double rolled = at_.h * double(last_.omega);
        const double size = std::abs(double(last_.x_dot)) + std::abs(rolled);
        if (size < most_slip_) last_.slip = last_.x_dot + -rolled;
        most_slip_ = std::min(size, std::max(most_slip_, std::abs(double(last_.slip))));
    }

    bool may_jam() const { return slide_.body.may_jam() && !slide_.rolls_by; }

    SlideClock clock() const { return scaled_response_ ? SlideClock::slowed : SlideClock::time; }

    // The rate that determines the unit of time: 1 + |omega| + the rate at which the force changes
    // B, if the latter is large. This unit keeps the powers of high rates in range.
    double rate() const {
        constexpr double stiff = 0x1p20;
        const double omega = double(last_.omega);
        if (slide_.rolls_by) return 1 + std::abs(omega);
        const auto [c, b] = response(slide_.body, at_, omega);
        double by_force = slowed_response_rate(slide_.body, at_, c);
        if (clock() == SlideClock::time) by_force /= b;
        return 1 + std::abs(omega) + (by_force > stiff && by_force < infinity ? by_force : 0.0);
    }

    enum class End { slip, pressure, response, recovery, rotation, law, bounds };

    // Shortens the reach to the first point where slip, rotation, pressure or B vanishes, the law
    // of rolling fails or a bound is reached.
    void find_end(const SlidingBody& body, const SlideSeries& series) {
        end_.reset();
        LongSeries powers = powers_of(reach_);
        const auto search = [&](End what, const auto& coefficient) {
            const auto share = first_end(powers, coefficient);
            if (!share) return;
            end_ = what;
            reach_ *= *share;
            powers = powers_of(reach_);
        };
        if (body.ahead != 0) {
            // A rotation that is only about to start has a speed of 0.
            const bool starts = series.motion.omega[0] == 0;
            search(End::rotation, [&](int k) -> Tracked {
                const double omega = series.motion.omega[k];
                const double turning = std::copysign(1.0, body.ahead) * omega;
                return {k == 1 && starts ? std::max(turning, 0.0) : turning, std::abs(omega)};
            });
        }
        if (slide_.rolls_by) {
            const double mu = *slide_.rolls_by;
            const double reach = reach_;
            for (const double side : {1.0, -1.0}) {
                search(End::law, [&, side](int k) { return rolling_margin(mu, side, k); });
                if (end_ == End::law && reach_ < reach) law_side_ = side;
                if (std::isinf(mu)) return;  // only N > 0 is required
            }
            return;
        }
        const auto search_response = [&](End what, double sign, double least) {
            const double least_v = least * body.gyration2;
            search(what, [&](int k) -> Tracked {
                const double v = series.response[k];
                const double v_at_least = least_v * series.height2[k];
                return {sign * (v - v_at_least), std::abs(v) + std::abs(v_at_least)};
            });
        };
        if (body.side != 0) {
            // A slip that follows rolling at the limit starts with a rate of 0 to within rounding.
            const bool starts = series.slip[0] == 0;
            search(End::slip, [&](int k) -> Tracked {
                const double slip = series.slip[k];
                const double change = body.side * slip;
                if (k == 0) return {change, std::abs(slip)};
                const double pulled = body.gravity.along * series.motion.time[k];
                return {k == 1 && starts ? std::max(change, 0.0) : change,
                        std::abs(slip) + 2 * std::abs(series.rolled[k]) + 2 * std::abs(pulled)};
            });
        }
        const double height = std::sqrt(series.height2[0]);
        const double cancelled = grazes_ ? 2 * body.gravity.into * series.height2[0] * height : 0.0;
        search(End::pressure, [&](int k) -> Tracked {
            const double c = series.pressure[k];
            return {c, 3 * std::abs(c) + (k == 0 ? cancelled : 0.0)};
        });
        if (clock() == SlideClock::slowed) {
            search_response(End::response, 1.0, no_response);
            search_response(End::recovery, -1.0, 2 * small_response);
        } else {
            search_response(End::response, 1.0, body.may_jam() ? small_response : 0.0);
        }
        if (bounds_.theta < infinity) {
            const double bound = bounds_.theta - double(slide_.theta_base);
            const double to_go = double(last_.angle + -bound);
            search(End::bounds,
                   [&](int k) { return tracked(k == 0 ? -to_go : -series.motion.angle[k]); });
            search(End::bounds, [&](int k) { return tracked(series.motion.omega[k]); });
        }
    }

    // Coefficient k of the margin of the law of rolling, times h^3.
    Tracked rolling_margin(double mu, double side, int k) const {
        const auto& [normal, friction] = rolling_forces_;
        if (std::isinf(mu)) return normal[k];
        return tracked(mu) * normal[k] - tracked(side) * friction[k];
    }

    // Moves the end of a piece to the point at which the forces, computed from the state, break the
    // law. The series lose digits near the tip of a thin body and where the margin hardly falls.
    void refine_law_end(SlidePiece& piece) const {
        constexpr double rounding = 1e-6;  // a larger relative change is not due to rounding
        constexpr int corrections = 2;
        const double mu = *slide_.rolls_by;
        LongSeries margin;
        for (int k = 0; k <= long_order; ++k) margin[k] = rolling_margin(mu, law_side_, k).value;
        for (int i = 0; i < corrections; ++i) {
            const SlidePoint there = moved(piece, piece.reach);
            const Geometry at = geometry(slide_.body.axes, there.angle);
            const ContactForce force = rolling_force(slide_.body, at, double(there.omega));
            const double rest = law_margin(force, mu, law_side_) / slide_.body.mass;
            const double fall =
                derivative(margin, piece.reach) / (at.h * square(at.h * piece.unit));
            const double change = -rest / fall;
            if (!(fall < 0 && std::abs(change) < rounding * piece.reach)) return;
            piece.reach += change;
        }
    }

    std::optional<SlideStop> end() {
        if (*end_ == End::slip) return SlideStop::slip_vanishes;
        if (*end_ == End::law) return SlideStop::law_fails;
        if (*end_ == End::rotation) {
            last_.omega = {};
            if (slide_.rolls_by) last_.x_dot = {};
            last_.slip = last_.x_dot;
            return SlideStop::rotation_vanishes;
        }
        if (*end_ == End::bounds) return SlideStop::out_of_bounds;
        if (*end_ == End::pressure) {
            if (grazes_ || leaves()) return SlideStop::pressure_vanishes;
            grazes_ = true;
        } else if (*end_ == End::recovery) {
            scaled_response_.reset();
        } else {
            if (!slide_.body.may_jam()) return SlideStop::jams;
            if (clock() == SlideClock::slowed) return last_moment();
            scaled_response_ = cancelled_response(slide_.body, at_, last_.angle);
        }
        return std::nullopt;
    }

    // Whether c, now 0 to within rounding, will fall below 0: this happens only on the way to the
    // tip, where h'' is least.
    bool leaves() const {
        const Axes& axes = slide_.body.axes;
        const Geometry tip = axes.a > axes.b ? geometry(axes, 1.0, 0.0) : geometry(axes, 0.0, 1.0);
        const double omega = double(last_.omega);
        const double gravity = slide_.body.gravity.into;
        return free_acceleration(tip, gravity, omega) < 0 && !is_weightless(tip, gravity, omega) &&
               at_.dh * omega > 0;
    }

    // The end of a slide at B = 0, where N = c/B instantly stops the slip or the rotation, or jams
    // the body.
    SlideStop last_moment() {
        const double angle = double(last_.angle);
        const auto [stops, turns, omega, slip, x_dot, lasts] = rolling_ellipse::last_moment(
            slide_.body, angle, double(last_.omega), double(last_.slip));
        const DoubleDouble turned = {angle + double(last_.omega) * lasts, 0.0};
        last_ = {turned,
                 {omega, 0.0},
                 {slip, 0.0},
                 {x_dot, 0.0},
                 {double(last_.path) + double(last_.x_dot) * lasts, 0.0},
                 {double(last_.time) + lasts, 0.0},
                 {energy_of(slide_.body, turned, omega), 0.0}};
        slide_.pieces.push_back({last_, SlideClock::time, 1.0, 0.0, {}});
        if (turns) return SlideStop::rotation_vanishes;
        return stops ? SlideStop::slip_vanishes : SlideStop::jams;
    }

    Slide& slide_;
    SlidePoint& last_;
    const SlideBounds& bounds_;
    Geometry at_;  // geometry at the last point
    double most_kinetic_ = 0.0;
    double most_slip_ = 0.0;
    double worked_ = 0.0;  // sum of the |work| of friction [energy per mass]
    // V, while the slower clock is used. It is a sum of changes that shrink along with V, so that V
    // stays accurate however close the body comes to B = 0 before it turns away.
    std::optional<double> scaled_response_;
    double reach_ = 0.0;
    std::optional<End> end_;
    RollingForces3 rolling_forces_;
    double law_side_ = 1.0;  // `side` of the friction limit at which rolling ends
    // True if c has vanished to within rounding and the body has stayed on the ground, as when a
    // slide starts near B = 0 under infinite friction. c then has the rounding errors of gravity
    // and h'' omega^2, too.
    bool grazes_ = false;
};

// The reading of the piece's clock at a time since the centre of the piece. It is limited to the
// reach, beyond which the slip may change sign, since the time of an event may be rounded up.
double clock_at(const SlidePiece& piece, double time) {
    time /= piece.unit;
    if (piece.clock == SlideClock::time) return std::min(time, piece.reach);
    return bisect(0.0, piece.reach,
                  [&](double clock) { return value(piece.motion.time, clock) >= time; })
        .high;
}

}  // namespace

Slide slide_from(const Scene& scene, const State& start, double side,
                 const std::optional<SlidePoint>& end_of_other, std::optional<double> rolls_by) {
    const Axes axes = scene.axes();
    const double slip = slip_velocity(start, geometry(axes, start.theta));
    const QuarterView angle = quarter_view({start.theta, 0.0});
    Scene seen = scene;
    if (is_odd(angle.quarters)) std::swap(seen.a, seen.b);
    const std::size_t usual_pieces = rolls_by ? 24 : 16;  // about twenty in half a swing
    const Geometry at = geometry(seen.axes(), angle.rest);
    SlidingBody body = sliding_body(seen, at, start.omega, side);
    if (rolls_by) {
        body.ahead = rolling_lever(seen, at, start.omega);
        body.is_held = false;
    }
    const double energy = energy_of(body, angle.rest, start.omega);
    Slide slide{
        body,
        axes,
        half_pi_exact * angle.quarters,
        start.x,
        {angle.rest, {start.omega, 0.0}, {slip, 0.0}, {start.x_dot, 0.0}, {}, {}, {energy, 0.0}},
        {},
        rolls_by};
    slide.pieces.reserve(usual_pieces);
    if (end_of_other) {
        slide.last.angle = slide.last.angle + end_of_other->angle.low;
        slide.last.omega = end_of_other->omega;
        slide.last.x_dot = end_of_other->x_dot;
        slide.last.energy = end_of_other->energy;
        slide.last.slip = end_of_other->slip;
    }
    if (rolls_by) slide.last.slip = {};
    return slide;
}

SlideStop slide_on(Slide& slide, const SlideBounds& bounds, const Checkpoint& checkpoint) {
    SlideIntegration integration(slide, bounds);
    do {
        checkpoint();
        if (static_cast<long>(slide.pieces.size()) >= bounds.most_pieces) {
            return SlideStop::too_many_pieces;
        }
        if (const auto stop = integration.step()) return *stop;
    } while (slide.last.time.high < bounds.t_end);
    return SlideStop::time_is_over;
}

State end_of(const Slide& slide) { return sample_at(slide, slide.last).state; }

DoubleDouble angle_at_end(const Slide& slide) { return slide.theta_base + slide.last.angle; }

DoubleDouble omega_without_slip(const Slide& slide) {
    const auto& [angle, omega, slip, x_dot, path, time, energy] = slide.last;
    double turning = std::abs(omega.high);
    double moving = std::abs(x_dot.high);
    for (const SlidePiece& piece : slide.pieces) {
        turning = std::max(turning, std::abs(piece.centre.omega.high));
        moving = std::max(moving, std::abs(piece.centre.x_dot.high));
    }
    const double h = geometry(slide.body.axes, angle).h;
    return moving < h * turning ? DoubleDouble{double(x_dot) / h, 0.0} : omega;
}

void sample(const Slide& slide, const double* times, std::size_t n, ContactSample* samples) {
    const auto first = slide.pieces.begin();
    for (std::size_t i = 0; i < n; ++i) {
        const auto later = std::upper_bound(
            first + 1, slide.pieces.end(), times[i],
            [](double t, const SlidePiece& piece) { return t < piece.centre.time.high; });
        const SlidePiece& piece = *(later - 1);
        const double since = (times[i] - piece.centre.time.high) - piece.centre.time.low;
        samples[i] = sample_at(slide, moved(piece, clock_at(piece, since)));
    }
}

}  // namespace rolling_ellipse
