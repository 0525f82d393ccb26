#include "contact/slide.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "geometry/half_turns.hpp"
#include "numerics/bernstein.hpp"
#include "numerics/bisect.hpp"

namespace rolling_ellipse {
namespace {

// The response B, physics (50), below which the slower clock is the better one, physics (54); and
// that which is none.
constexpr double small_response = 1e-2;
constexpr double no_response = 1e-13;

SlidePoint moved(const SlidePiece& piece, double clock) {
    const auto& [centre, kind, unit, reach, angle, omega, x_dot, path, time] = piece;
    const auto change = [clock](const LongSeries& series) { return value(series, clock); };
    const double lasts = kind == SlideClock::time ? clock : change(time);
    return {centre.angle + change(angle),        centre.omega + change(omega) / unit,
            centre.x_dot + change(x_dot) / unit, centre.path + change(path),
            centre.time + lasts * unit,          centre.energy};
}

// Of a circle all but the first coefficients vanish, and its reach has powers that are infinite.
double times_power(double coefficient, double power) {
    return coefficient == 0 ? 0.0 : coefficient * power;
}

// The first share of a reach at which a series that has to stay positive is negative, provably;
// each coefficient with the magnitude of what it was made from.
template <class Coefficient, class Magnitude>
std::optional<double> first_end(double reach, Coefficient coefficient, Magnitude magnitude) {
    double others = 0.0;
    double power = reach;
    for (int k = 1; k <= long_order; ++k) {
        others += times_power(magnitude(k), power);
        power *= reach;
    }
    if (coefficient(0) > others) return std::nullopt;
    Polynomial<long_order> margin;
    power = 1.0;
    for (int k = 0; k <= long_order; ++k) {
        margin.coefficients[k] = {times_power(coefficient(k), power),
                                  times_power(magnitude(k), power)};
        power *= reach;
    }
    return first_negative(bernstein(margin));
}

// The sine and cosine of an angle that has more digits than a double.
std::pair<double, double> sin_cos(const DoubleDouble& angle) {
    const double sin = std::sin(angle.high);
    const double cos = std::cos(angle.high);
    const double rest_sin = std::sin(angle.low);  // up to one, after 1e16 radians
    const double rest_cos = std::cos(angle.low);
    return {sin * rest_cos + cos * rest_sin, cos * rest_cos - sin * rest_sin};
}

// The height by which the centre is lower than over the tip.
double under_tip(const Axes& axes, const Geometry& at) {
    return under_tip(flat_view(axes, at.sin, at.cos), at.h);
}

double energy_of(const SlidingBody& body, const DoubleDouble& angle, double omega) {
    const auto [sin, cos] = sin_cos(angle);
    const Geometry at = geometry(body.axes, sin, cos);
    return 0.5 * square(omega) * (body.gyration2 + square(at.dh)) -
           body.gravity.into * under_tip(body.axes, at);
}

class Follower {
  public:
    Follower(Slide& slide, const SlideBounds& bounds)
        : slide_(slide),
          bounds_(bounds),
          angle_bound_(bounds.theta - static_cast<double>(slide.theta_base)) {
        const double b = response(slide.body, geometry_here(), slide.last.omega.high).b;
        if (slide.body.may_jam() && b < small_response) clock_ = SlideClock::slowed;
    }

    // Add a piece; what stops the slide, if anything does.
    std::optional<SlideStop> step() {
        const SlidePoint& from = slide_.last;
        const auto [sin, cos] = sin_cos(from.angle);
        const double unit =
            std::ldexp(1.0, -std::ilogb(rate(geometry(slide_.body.axes, sin, cos))));
        SlidingBody body = slide_.body;
        body.gravity = {body.gravity.into * square(unit), body.gravity.along * square(unit)};
        const SlideState start{0.0,
                               double(from.omega) * unit,
                               double(slide_.slip) * unit,
                               double(from.x_dot) * unit,
                               0.0,
                               0.0};
        SlideSeries series = slide_series(body, start, sin, cos, clock_);
        // What reaches for ever may grow with what there is. The path and the pressure vary by more
        // of themselves than angle and speed do where the body is nearly round.
        const double most = 1 + 15 * from.time.high / unit;
        reach_ = std::min({reach(series.angle), reach(series.omega), reach(series.rolled),
                           reach(series.pressure), most});
        if (!(reach_ > 0)) return SlideStop::no_progress;
        examine(body, series);
        series.omega[0] = series.slip[0] = series.x_dot[0] = 0.0;
        SlidePiece& piece = slide_.pieces.emplace_back();
        piece.centre = from;
        piece.clock = clock_;
        piece.unit = unit;
        piece.reach = reach_;
        piece.angle = series.angle;
        piece.omega = series.omega;
        piece.x_dot = series.x_dot;
        piece.path = series.path;
        piece.time = series.time;
        const SlidePoint next = moved(piece, reach_);
        if (!is_known(next)) {
            slide_.pieces.pop_back();
            return SlideStop::no_progress;
        }
        const bool stands_still = clock_ == SlideClock::time && next.time.high == from.time.high;
        slide_.last = next;
        slide_.last.energy = next.energy + value(series.work, reach_) / square(unit);
        slide_.slip = slide_.slip + value(series.slip, reach_) / unit;
        keep_energy();
        if (!end_) return stands_still ? std::optional(SlideStop::no_progress) : std::nullopt;
        return end();
    }

  private:
    Geometry geometry_here() const {
        const auto [sin, cos] = sin_cos(slide_.last.angle);
        return geometry(slide_.body.axes, sin, cos);
    }

    // Omega by the energy, where the body creeps over the tip. The series give it there with the
    // roundings of the fast motion before; the energy, counted from the tip, has fewer.
    void keep_energy() {
        constexpr double slow = 0.02;  // of the largest kinetic energy
        constexpr double near = 10;    // times the kinetic energy: g times the height under the tip
        constexpr double rounding = 1e-12;  // at most; a larger change would be none of rounding
        SlidePoint& last = slide_.last;
        const Geometry at = geometry_here();
        const double fallen = slide_.body.gravity.into * under_tip(slide_.body.axes, at);
        const double kinetic = double(last.energy + fallen);
        most_kinetic_ = std::max(most_kinetic_, kinetic);
        if (!(kinetic < slow * most_kinetic_ && fallen < near * kinetic)) return;
        const double inertia = slide_.body.gyration2 + square(at.dh);
        const double omega = std::copysign(std::sqrt(2 * kinetic / inertia), last.omega.high);
        const double change = (omega - last.omega.high) - last.omega.low;
        if (!(std::abs(change) < rounding * std::abs(omega))) return;
        last.omega = {omega, 0.0};
        slide_.slip = slide_.slip + -at.h * change;
    }

    // As fast as it turns, and as its response changes, where that is next to none: no power of the
    // rate is to leave the doubles.
    double rate(const Geometry& at) const {
        constexpr double stiff = 0x1p20;
        const double omega = double(slide_.last.omega);
        const auto [c, b] = response(slide_.body, at, omega);
        double by_force = slowed_response_rate(slide_.body, at, c);
        if (clock_ == SlideClock::time) by_force /= b;
        return 1 + std::abs(omega) + (by_force > stiff && by_force < infinity ? by_force : 0.0);
    }

    // Beyond some 1e100 powers of the rate leave the doubles all the same.
    static bool is_known(const SlidePoint& point) {
        return std::isfinite(double(point.angle)) && std::isfinite(double(point.omega)) &&
               std::isfinite(double(point.x_dot)) && std::isfinite(double(point.path)) &&
               std::isfinite(double(point.time));
    }

    enum class End { slip, pressure, response, recovery, theta, turning_back };

    // Ends the piece where something comes to an end.
    void examine(const SlidingBody& body, const SlideSeries& series) {
        end_.reset();
        const auto look = [&](End what, auto coefficient, auto magnitude) {
            const auto place = first_end(reach_, coefficient, magnitude);
            if (!place) return;
            end_ = what;
            reach_ *= *place;
        };
        const auto look_at_response = [&](End what, double sign, double least) {
            const double least_v = least * body.gyration2;
            look(
                what,
                [&](int k) { return sign * (series.response[k] - least_v * series.height2[k]); },
                [&](int k) {
                    return std::abs(series.response[k]) + least_v * std::abs(series.height2[k]);
                });
        };
        if (body.side != 0) {
            // Where the limit of friction is passed slip starts without a rate, and what rounding
            // makes of that is none.
            const bool starts = series.slip[0] == 0;
            look(
                End::slip,
                [&](int k) {
                    const double rate = body.side * series.slip[k];
                    return k == 1 && starts ? std::max(rate, 0.0) : rate;
                },
                [&](int k) {
                    return k == 0 ? std::abs(series.slip[0])
                                  : std::abs(series.slip[k]) + 2 * std::abs(series.rolled[k]) +
                                        2 * std::abs(body.gravity.along * series.time[k]);
                });
        }
        const double cancelled =
            grazes_ ? 2 * body.gravity.into * series.height2[0] * std::sqrt(series.height2[0])
                    : 0.0;
        look(
            End::pressure, [&](int k) { return series.pressure[k]; },
            [&](int k) { return 3 * std::abs(series.pressure[k]) + (k == 0 ? cancelled : 0.0); });
        if (clock_ == SlideClock::slowed) {
            look_at_response(End::response, 1.0, no_response);
            look_at_response(End::recovery, -1.0, 2 * small_response);
        } else {
            look_at_response(End::response, 1.0, body.may_jam() ? small_response : 0.0);
        }
        if (angle_bound_ < infinity) {
            const double to_go = double(slide_.last.angle + -angle_bound_);
            const auto left = [&](int k) { return k == 0 ? -to_go : -series.angle[k]; };
            look(End::theta, left, [&](int k) { return std::abs(left(k)); });
        }
        if (!bounds_.may_turn_back) {
            look(
                End::turning_back, [&](int k) { return series.omega[k]; },
                [&](int k) { return std::abs(series.omega[k]); });
        }
    }

    std::optional<SlideStop> end() {
        switch (*end_) {
            case End::slip:
                return SlideStop::slip_vanishes;
            case End::pressure:
                if (grazes_ || leaves()) return SlideStop::pressure_vanishes;
                grazes_ = true;
                return std::nullopt;
            case End::theta:
                return SlideStop::passes_theta;
            case End::turning_back:
                return SlideStop::turns_back;
            case End::recovery:
                clock_ = SlideClock::time;
                return std::nullopt;
            case End::response:
                break;
        }
        if (!slide_.body.may_jam()) return SlideStop::jams;
        if (clock_ == SlideClock::slowed) return last_moment();
        clock_ = SlideClock::slowed;
        return std::nullopt;
    }

    // Whether c goes on to fall where it is its rounding: h'' is least on the tip, so that c < 0,
    // if at all, on the way there.
    bool leaves() const {
        const Axes& axes = slide_.body.axes;
        const Geometry tip = axes.a > axes.b ? geometry(axes, 1.0, 0.0) : geometry(axes, 0.0, 1.0);
        const double omega = double(slide_.last.omega);
        const double gravity = slide_.body.gravity.into;
        return free_acceleration(tip, gravity, omega) < 0 && !is_weightless(tip, gravity, omega) &&
               geometry_here().dh * omega > 0;
    }

    // B = 0: in a moment, N = c/B ends it.
    SlideStop last_moment() {
        const SlidePoint& last = slide_.last;
        const auto [stops, state] = rolling_ellipse::last_moment(
            slide_.body, {double(last.angle), double(last.omega), double(slide_.slip),
                          double(last.x_dot), double(last.path), double(last.time)});
        const DoubleDouble angle = {state.angle, 0.0};
        const double energy = energy_of(slide_.body, angle, state.omega);
        slide_.last = {angle,
                       {state.omega, 0.0},
                       {state.x_dot, 0.0},
                       {state.path, 0.0},
                       {state.time, 0.0},
                       {energy, 0.0}};
        slide_.slip = {state.slip, 0.0};
        slide_.pieces.push_back({slide_.last, SlideClock::time, 1.0, 0.0, {}, {}, {}, {}, {}});
        return stops ? SlideStop::slip_vanishes : SlideStop::jams;
    }

    Slide& slide_;
    const SlideBounds& bounds_;
    const double angle_bound_;
    double most_kinetic_ = 0.0;
    SlideClock clock_ = SlideClock::time;
    double reach_ = 0.0;
    std::optional<End> end_;
    // c has come to its rounding and does not vanish: beside B = 0 that is how friction without end
    // begins. From there on it counts as what is left of gravity and h'' omega^2.
    bool grazes_ = false;
};

// The clock of a piece at a time since its centre.
double clock_at(const SlidePiece& piece, double time) {
    time /= piece.unit;
    if (piece.clock == SlideClock::time) return time;
    return bisect(0.0, piece.reach, [&](double clock) { return value(piece.time, clock) >= time; })
        .high;
}

ContactSample sample_at(const Slide& slide, const SlidePoint& point) {
    const double theta = double(slide.theta_base + point.angle);
    const double omega = double(point.omega);
    const Geometry at = geometry(slide.axes, theta);
    const double x = slide.x_base + double(point.path);
    return {{theta, omega, x, at.h, double(point.x_dot), at.dh * omega, Mode::sliding},
            sliding_force(slide.body, at, omega)};
}

}  // namespace

Slide slide_from(const Scene& scene, const State& start, double side) {
    const Axes axes = scene.axes();
    const double slip = slip_velocity(start, geometry(axes, start.theta));
    const QuarterView angle = quarter_view({start.theta, 0.0});
    Scene seen = scene;
    if (angle.is_odd()) std::swap(seen.a, seen.b);
    constexpr std::size_t usual_pieces = 16;
    const SlidingBody body = sliding_body(seen, side);
    const double energy = energy_of(body, angle.rest, start.omega);
    Slide slide{
        body,
        axes,
        half_pi_exact * angle.quarters,
        start.x,
        {angle.rest, {start.omega, 0.0}, {start.x_dot, 0.0}, {0.0, 0.0}, {0.0, 0.0}, {energy, 0.0}},
        {slip, 0.0},
        {}};
    slide.pieces.reserve(usual_pieces);
    return slide;
}

void go_on_from(const SlidePoint& end, Slide& slide) {
    slide.last.angle = slide.last.angle + end.angle.low;
    slide.theta_base = slide.theta_base + -end.angle.low;
    slide.last.omega = end.omega;
    slide.last.x_dot = end.x_dot;
    slide.last.energy = end.energy;
    slide.slip = {0.0, 0.0};
}

SlideStop slide_on(Slide& slide, const SlideBounds& bounds, const Checkpoint& checkpoint) {
    Follower follower(slide, bounds);
    do {
        checkpoint();
        if (static_cast<long>(slide.pieces.size()) >= bounds.most_pieces) {
            return SlideStop::too_many_pieces;
        }
        if (const auto stop = follower.step()) return *stop;
    } while (slide.last.time.high < bounds.t_end);
    return SlideStop::time_is_over;
}

ContactSample end_of(const Slide& slide) { return sample_at(slide, slide.last); }

DoubleDouble angle_at_end(const Slide& slide) { return slide.theta_base + slide.last.angle; }

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
