#include "contact/settling.hpp"

#include <algorithm>
#include <cmath>

#include "scene/impact.hpp"
#include "scene/refuse.hpp"

namespace rolling_ellipse {
namespace {

// The largest ratio of a rebound to the last one with which bounces are summed: at most 1e5 of
// them.
constexpr double largest_ratio = 0.9999;

}  // namespace

double speed_of_fall(const Scene& scene) {
    return std::sqrt(scene.gravity * std::min(scene.a, scene.b));
}

double rest_speed(const Scene& scene, const Units& units, const Settings& settings) {
    constexpr double small = 1e-6;
    // Relative error of c and h', which are constant while bounces are summed.
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

// The bounces are summed under one c and h'. The relative error is the square of their duration by
// the time in which the body falls, or turns by b/a; it must stay below the rest speed by the speed
// of a fall.
bool settles(const Scene& scene, double omega, const Bounce& first, double rest_speed) {
    const auto [rebound, ratio, c] = first;
    if (rebound > rest_speed || c <= 0 || !(ratio < largest_ratio)) return false;
    const auto [least, most] = std::minmax(scene.a, scene.b);
    const double rate = std::max(std::sqrt(scene.gravity / least), std::abs(omega) * most / least);
    const double longest = std::sqrt(rest_speed / speed_of_fall(scene));
    return 2 * rebound * rate <= longest * c * (1 - ratio);
}

// Infinitely many bounces that shrink by a ratio take a finite time, physics (57). Such small ones
// take place at one angle, under the c of their beginning.
Settled settled(const Scene& scene, const State& start, const Bounce& first) {
    constexpr double negligible_share = 1e-12;  // of the first rebound: smaller ones add no digit
    const Geometry at = geometry(scene.axes(), start.theta);
    const GroundGravity gravity = scene.ground_gravity();
    State moving = start;
    double lasts = 0.0;
    double turned = 0.0;
    double moved = 0.0;
    double speed = first.rebound;
    while (speed > negligible_share * first.rebound) {
        const double hop = 2 * speed / first.c;
        const double gained = (gravity.along - at.dh * square(moving.omega)) * hop;  // slip
        // The centre moves with the slip and (h + h' turned) omega.
        const double velocity = moving.x_dot + at.dh * turned * moving.omega;
        moved += (velocity + 0.5 * gravity.along * hop) * hop;
        lasts += hop;
        turned += moving.omega * hop;
        moving.x_dot += gained;
        moving.z_dot = at.dh * moving.omega - speed;
        const auto [after, next] = collision(scene, moving, -speed);
        moving = after;
        if (!(next < largest_ratio * speed)) break;
        speed = std::max(next, 0.0);
    }
    const DoubleDouble angle = two_sum(start.theta, turned);
    const double theta = angle.high;
    const State end =
        in_contact(geometry(scene.axes(), theta), theta, zero_if_negligible(moving.omega),
                   start.x + moved, slip_beyond_rounding(moving, at), Mode::flight);
    return {lasts, end, angle};
}

}  // namespace rolling_ellipse
