#include "contact/flight.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "numerics/bisect.hpp"
#include "numerics/series.hpp"
#include "scene/impact.hpp"

namespace rolling_ellipse {
namespace {

// Bounces are summed only up to this ratio of successive rebounds, which limits their number to
// 3e5.
constexpr double largest_ratio = 0.9999;

// sin(x) cos(x) - x and sin(x)^2 - x^2 for |x| <= 1/4, without cancellation, from power series in 4
// x^2.
struct BeyondSmall {
    double sine;
    double square;
};
BeyondSmall beyond_small(double x) {
    using Terms = std::array<double, 9>;
    static constexpr auto series = [] {
        std::array<Terms, 2> found{};
        double sine = 1.0;
        double squared = 1.0;
        for (int k = 1; k < 9; ++k) {
            found[0][k - 1] = sine;
            found[1][k - 1] = squared;
            sine /= -(2 * k + 2) * (2 * k + 3);
            squared /= -(2 * k + 3) * (2 * k + 4);
        }
        return found;
    }();
    const double y2 = square(2 * x);
    return {-x * y2 / 6 * value(series[0], y2), -square(x) * y2 / 12 * value(series[1], y2)};
}

// The growth of h as the body turns, given the sum of the initial and the final h, physics (55):
// h^2 - h0^2 = (a^2 - b^2) sin(2 theta0 + turned) sin(turned).
double rise(const Axes& axes, double theta, double turned, double sum) {
    return axes.c2() * std::sin(2 * theta + turned) * std::sin(turned) / sum;
}

// The gap between the body and the ground.
class Gap {
  public:
    explicit Gap(const Flight& flight)
        : flight_(flight), start_(geometry(flight.axes, flight.start.theta)) {}

    double height(double t) const {
        const State& s = flight_.start;
        return s.z + t * (s.z_dot - 0.5 * flight_.gravity.into * t);
    }

    // The gap, computed as its initial value plus its change, which is accurate even for hops far
    // lower than the body.
    double value(double t) const {
        const State& s = flight_.start;
        const double fallen = 0.5 * flight_.gravity.into * t;
        if (const auto rise = rise_over_tangent(t)) {
            return (s.z - start_.h) + (t * (flight_.gap_rate - fallen) - rise->height);
        }
        const double risen = rise(flight_.axes, s.theta, s.omega * t, at(t).h + start_.h);
        return (s.z - start_.h) + (t * (s.z_dot - fallen) - risen);
    }

    double rate(double t) const {
        const State& s = flight_.start;
        if (const auto small = rate_after_small_turn(t)) return *small;
        return s.z_dot - flight_.gravity.into * t - at(t).dh * s.omega;
    }

    // The time of a contact, one of the two neighbouring doubles between which the gap closes. At
    // this time the height of the centre is set to h. Always choosing the later time would raise
    // the body and add 1e-16 of its energy at each contact, so the time with the smaller gap is
    // chosen, with two exceptions: the later time is used if the body turns by more than 1e-8
    // between the two times, since the gap then bends by a rounding error or more, or if the
    // earlier time is the start of the flight.
    double closes(const Bracket& between) const {
        constexpr double small_turn = 1e-8;
        const auto [low, high] = between;
        if (low == 0 || std::abs(flight_.start.omega) * (high - low) > small_turn) return high;
        return std::abs(value(low)) < std::abs(value(high)) ? low : high;
    }

    // The first root after t of the parabola with the gap's value and first two derivatives at t.
    std::optional<RootGuess> root_about(double t) const {
        const double bend = flight_.gravity.into + at(t).ddh * square(flight_.start.omega);
        const double gap = value(t);
        const double approach = -rate(t);
        const double slope = -std::sqrt(square(approach) + 2 * gap * bend);
        if (!(slope < 0 && approach - slope > 0)) return std::nullopt;
        return RootGuess{t + 2 * gap / (approach - slope), slope};
    }

    std::optional<double> rate_after_small_turn(double t) const {
        const auto rise = rise_over_tangent(t);
        if (!rise) return std::nullopt;
        const double fallen = flight_.gravity.into * t;
        return (flight_.gap_rate - fallen) - rise->slope * flight_.start.omega;
    }

    // The time at which the centre falls to a height. If the centre starts downwards, this height
    // must not exceed its initial height.
    double falls_to(double height) const {
        const double drop = flight_.start.z - height;
        const double v = flight_.start.z_dot;
        const double root = std::sqrt(std::max(v * v + 2 * flight_.gravity.into * drop, 0.0));
        return v > 0 ? (v + root) / flight_.gravity.into : 2 * drop / (root - v);
    }

  private:
    Geometry at(double t) const {
        return geometry(flight_.axes, flight_.start.theta + flight_.start.omega * t);
    }

    // The rise of h above its tangent, h - (h0 + h0' phi), after a small turn phi, and the slope of
    // this rise, h' - h0'. Both follow from the difference between h^2 and the square of the
    // tangent. All terms are of order phi^2, and the first term, with the initial h'', is accurate
    // for every body.
    struct Rise {
        double height;
        double slope;
    };
    std::optional<Rise> rise_over_tangent(double t) const {
        constexpr double small_turn = 0.25;
        const double phi = flight_.start.omega * t;
        const double tangent = start_.h + start_.dh * phi;
        if (!(std::abs(phi) <= small_turn && tangent > 0)) return std::nullopt;
        const double c2 = flight_.axes.c2();
        const double sin_twice = 2 * start_.sin * start_.cos;
        const double cos_twice = (start_.cos - start_.sin) * (start_.cos + start_.sin);
        const auto [sine, squared] = beyond_small(phi);
        const double h = at(t).h;
        const double bend = start_.h * start_.ddh * phi;
        const double height =
            (bend * phi + c2 * (cos_twice * squared + sin_twice * sine)) / (h + tangent);
        const double gained = bend + c2 * (cos_twice * sine - sin_twice * square(std::sin(phi)));
        return Rise{height, (gained - start_.dh * height) / h};
    }

    const Flight& flight_;
    const Geometry start_;
};

// The second derivative of the gap, -(g cos(alpha) + h'' omega^2) with h'' = a^2 b^2/h^3 - h, is
// positive where h exceeds the only positive root of
//     h^4 - (g cos(alpha)/omega^2) h^3 - a^2 b^2,
// that is, around the tip, and negative elsewhere, physics (55). This divides time into intervals
// on which the gap is convex or concave, so that the first root in each is found with certainty.
class Curvature {
  public:
    explicit Curvature(const Flight& flight) {
        const double omega = std::abs(flight.start.omega);
        const FlatView view = flat_view(flight.axes, flight.start.theta);
        const double root =
            positive_root(flight.gravity.into / square(omega), view.short_axis * view.long_axis);
        if (omega == 0 || !(root < view.long_axis)) return;  // concave at all times
        const double turned = flight.start.omega > 0 ? view.sin : -view.sin;
        const double phi = std::atan2(turned, view.cos);  // from the flat position, grows with time
        const double tip_side = std::sqrt((root - view.short_axis) * (root + view.short_axis));
        const double flat_side = std::sqrt((view.long_axis - root) * (view.long_axis + root));
        const double edge = std::atan2(tip_side, flat_side);
        convex_ = std::abs(phi) > edge;
        concave_time_ = 2 * edge / omega;
        convex_time_ = 2 * (half_pi - edge) / omega;
        first_end_ = (!convex_ ? edge - phi : phi > 0 ? pi - edge - phi : -edge - phi) / omega;
    }

    struct Interval {
        double begin;
        double end;
        bool convex;
    };

    Interval first() const { return {0.0, first_end_, convex_}; }

    // The time in the middle of a convex interval, when the tip is lowest.
    double tip_time(const Interval& interval) const { return interval.end - convex_time_ / 2; }

    Interval after(const Interval& last) const {
        const bool convex = !last.convex;
        return {last.end, last.end + (convex ? convex_time_ : concave_time_), convex};
    }

    // The interval that contains the later time t, shortened to start at t.
    Interval around(Interval interval, double t) const {
        if (t < interval.end) return {t, interval.end, interval.convex};
        const double period = convex_time_ + concave_time_;
        const double skipped = period * std::floor((t - interval.end) / period);
        interval = after({interval.begin, interval.end + skipped, interval.convex});
        while (!(t < interval.end)) {
            const Interval next = after(interval);
            if (!(interval.end < next.end)) return {t, t, next.convex};  // shorter than an ulp of t
            interval = next;
        }
        return {t, interval.end, interval.convex};
    }

  private:
    // The positive root of the quartic, by Newton's method from the right, where the quartic is
    // convex.
    static double positive_root(double load, double ab) {
        double h = load + std::sqrt(ab);
        for (;;) {
            const double next =
                h - (h * h * h * (h - load) - ab * ab) / (h * h * (4 * h - 3 * load));
            if (!(next < h)) return h;
            h = next;
        }
    }

    bool convex_ = false;
    double first_end_ = infinity;
    double concave_time_ = infinity;
    double convex_time_ = infinity;
};

double first_touch(const Flight& flight, const Gap& gap) {
    const Curvature curvature(flight);
    // Whether the flight starts on the ground without moving away from it.
    const bool leaves_slowly = gap.value(0.0) <= 0 && gap.rate(0.0) <= 0;
    const double tall = most_height(flight.axes);
    // The time by which the body must have touched the ground, however h is rounded.
    const double sure =
        gap.falls_to(std::min(flight.axes.a, flight.axes.b) * (1 - equal_ulps * epsilon));
    const auto value = [&](double t) { return gap.value(t); };
    const auto rate = [&](double t) { return gap.rate(t); };

    Curvature::Interval now = curvature.first();
    // A body that leaves the ground by acceleration alone does so in a convex interval of the gap.
    if (leaves_slowly && !now.convex) {
        now = curvature.after(now);
        // Unless that interval starts at once, the gap closes before it, and the body stays on the
        // ground.
        if (!(gap.value(now.begin) >= -equal_ulps * epsilon * tall)) return 0.0;
    }
    double before = leaves_slowly ? 0.0 : gap.rate(now.begin);  // rate of the gap at now.begin
    for (;;) {
        if (gap.height(now.begin) > tall) {
            now = curvature.around(now, gap.falls_to(tall));
            before = gap.rate(now.begin);
        }
        const double end = std::min(now.end, sure);
        const double after = gap.rate(end);
        if (now.convex) {
            if (before < 0) {
                const double lowest = after > 0 ? bisect_root(now.begin, end, rate).high : end;
                if (gap.value(lowest) <= 0)
                    return gap.closes(bisect_root(now.begin, lowest, value));
                // A tip directly below the centre touches the ground if the centre is no higher
                // than the long semi-axis, even if rounding leaves a positive gap for a
                // fast-spinning body.
                const double tip = curvature.tip_time(now);
                if (now.begin < tip && tip <= end && gap.height(tip) <= tall) return lowest;
            }
        } else if (after < 0 && gap.value(end) <= 0) {
            const double from = before > 0 ? bisect_root(now.begin, end, rate).high : now.begin;
            return gap.closes(bisect_root(from, end, value, gap.root_about(from)));
        }
        const Curvature::Interval next = curvature.after(now);
        // Whether the body spins so fast that an interval, or half a convex one, lasts less than an
        // ulp.
        const bool too_fast =
            !(now.end < next.end) || (next.convex && !(next.begin < curvature.tip_time(next)));
        if (too_fast || !(end < sure)) return end;
        before = after;
        now = next;
    }
}

}  // namespace

State state_at(const Flight& flight, double t) {
    const State& s = flight.start;
    return {s.theta + s.omega * t,
            s.omega,
            s.x + t * (s.x_dot + 0.5 * flight.gravity.along * t),
            s.z + t * (s.z_dot - 0.5 * flight.gravity.into * t),
            s.x_dot + flight.gravity.along * t,
            s.z_dot - flight.gravity.into * t,
            flight.mode};
}

State grazing(const Geometry& at, const State& free, Mode mode) {
    const auto& [theta, omega, x, z, x_dot, z_dot, flight] = free;
    return mode == Mode::sliding ? on_ground(at, theta, omega, x, x_dot, mode)
                                 : without_slip(at, theta, omega, x, mode);
}

double most_height(const Axes& axes) {
    return std::max(axes.a, axes.b) * (1 + equal_ulps * epsilon);
}

Landing touch_down(const Flight& flight) {
    const Gap gap(flight);
    const double after = first_touch(flight, gap);
    return {after, gap.rate_after_small_turn(after)};
}

double speed_of_fall(const Scene& scene) {
    return std::sqrt(scene.gravity * std::min(scene.a, scene.b));
}

double rest_speed(const Scene& scene, const Units& units, const Settings& settings) {
    constexpr double small = 1e-6;
    // Largest ratio of the rest speed to `speed_of_fall`; it bounds the relative error of the sum.
    constexpr double large = 1e-2;
    const double unit = speed_of_fall(scene);
    if (!settings.rest_speed) return small * unit;
    const double speed = *settings.rest_speed / units.speed();
    if (speed > large * unit) {
        refuse("rest_speed",
               "at most " + text(large * unit * units.speed()) +
                   " [m/s], a hundredth of sqrt(g min(a, b))",
               *settings.rest_speed);
    }
    return speed;
}

// Whether bounces may be summed with constant c and h'. The relative error is the square of their
// duration over sqrt(b/g) or, if that is shorter, over the time in which the body turns by b/a,
// with b the short semi-axis. It must not exceed the ratio of the rest speed to `speed_of_fall`.
bool settles(const Scene& scene, double omega, const Bounce& first, double rest_speed) {
    const auto [rebound, ratio, c] = first;
    if (rebound > rest_speed || c <= 0 || !(ratio < largest_ratio)) return false;
    const auto [least, most] = std::minmax(scene.a, scene.b);
    const double rate = std::max(std::sqrt(scene.gravity / least), std::abs(omega) * most / least);
    const double longest = std::sqrt(rest_speed / speed_of_fall(scene));
    return 2 * rebound * rate <= longest * c * (1 - ratio);
}

// Sums bounces whose rebounds shrink like a geometric series and which end after a finite time,
// physics (57). They are so small that c and h' keep their initial values.
Settling settling(const Scene& scene, const State& start, const Bounce& first) {
    constexpr double negligible_share = 1e-12;  // of the first rebound; slower ones are ignored
    const Geometry at = geometry(scene.axes(), start.theta);
    const GroundGravity gravity = scene.ground_gravity();
    State moving = start;
    double lasts = 0.0;
    double turned = 0.0;
    double moved = 0.0;
    double speed = first.rebound;
    while (speed > negligible_share * first.rebound) {
        const double hop = 2 * speed / first.c;
        const double gained = (gravity.along - at.dh * square(moving.omega)) * hop;  // slip gained
        // The velocity of the centre is the slip plus (h + h' turned) omega.
        const double velocity = moving.x_dot + at.dh * turned * moving.omega;
        moved += (velocity + 0.5 * gravity.along * hop) * hop;
        lasts += hop;
        turned += moving.omega * hop;
        moving.x_dot += gained;
        moving.z_dot = at.dh * moving.omega - speed;
        const Collision next = collision(scene, at, moving, -speed);
        moving = next.after;
        if (!(next.rebound < largest_ratio * speed)) break;
        speed = std::max(next.rebound, 0.0);
    }
    const DoubleDouble angle = two_sum(start.theta, turned);
    const double theta = angle.high;
    const double slip = slip_velocity(moving, at);
    const bool is_rounding = std::abs(slip) <= equal_ulps * epsilon * std::abs(moving.x_dot);
    const Geometry there = geometry(scene.axes(), theta);
    const double omega = zero_if_negligible(moving.omega);
    const double x_dot =
        is_rounding
            ? there.h * omega
            : moving.x_dot + rise(scene.axes(), start.theta, turned, there.h + at.h) * omega;
    const State end = on_ground(there, theta, omega, start.x + moved, x_dot, Mode::flight);
    return {scene.axes(), lasts, start, end, angle};
}

}  // namespace rolling_ellipse
