#include "contact/slide_series.hpp"

#include <cmath>

namespace rolling_ellipse {
namespace {

constexpr int order = series_order;

// The coefficient k of n/d, from those before.
double quotient(double n, const Series& d, const Series& q, int k) {
    return (n - terms(d, q, k, 1, k)) / d[0];
}

}  // namespace

SlideSeries slide_series(const SlidingBody& body, const SlideState& at, double sin, double cos,
                         SlideClock clock) {
    const auto [a, b] = body.axes;
    const double c2 = (a - b) * (a + b);
    const double k2 = body.gyration2;
    const double nu = body.normal_share;
    const double phi = body.friction_share;
    const bool slowed = clock == SlideClock::slowed;
    SlideSeries slide{};
    auto& [angle, w, slip, path, rolled, time, pressure, response, u] = slide;
    Series s{sin}, c{cos}, s2{}, p{}, h{}, uh{}, w2{}, below{}, above{}, bend{}, lever{}, inertia{};
    Series rate{}, turning{}, grip{}, spread{}, pull{}, impulse{}, velocity{};
    angle[0] = at.angle;
    w[0] = at.omega;
    path[0] = at.path;
    time[0] = at.time;
    double per_clock = 1.0;
    for (int k = 0; k <= order; ++k) {
        s2[k] = self_product(s, k);
        u[k] = c2 * s2[k];
        below[k] = -u[k];
        above[k] = u[k];
        if (k == 0) {
            // Nothing cancels for thin bodies, nor, in a b - u, for nearly circular ones.
            u[0] = square(a * sin) + square(b * cos);
            below[0] = (a - b) * (b * square(cos) - a * square(sin));
            above[0] = u[0] + a * b;
            h[0] = std::sqrt(u[0]);
            per_clock = 1 / (k2 * u[0] * u[0]);
        } else {
            h[k] = (u[k] - self_product(h, k, 1)) / (2 * h[0]);
        }
        p[k] = c2 * product(s, c, k);
        lever[k] = nu * p[k] + phi * u[k];
        response[k] = nu * k2 * u[k] + product(p, lever, k);
        w2[k] = self_product(w, k);
        uh[k] = product(u, h, k);
        bend[k] = product(below, above, k);
        pressure[k] = body.gravity.into * uh[k] + product(bend, w2, k);
        inertia[k] = product(u, response, k);
        const double torque = -product(lever, pressure, k);
        if (slowed) {
            rate[k] = per_clock * inertia[k];
            turning[k] = per_clock * torque;
            spread[k] = product(rate, w, k);
            pull[k] = per_clock * phi * k2 * product(pressure, h, k);
        } else {
            turning[k] = quotient(torque, inertia, turning, k);
            spread[k] = w[k];
            grip[k] = product(h, response, k);
            pull[k] = quotient(phi * k2 * pressure[k], grip, pull, k);
        }
        rolled[k] = product(h, w, k);
        slip[k] = k == 0 ? at.slip : impulse[k] + body.gravity.along * time[k] - rolled[k];
        velocity[k] = slip[k] + rolled[k];
        if (k == order) break;
        const double next = 1.0 / (k + 1);
        s[k + 1] = product(c, spread, k) * next;
        c[k + 1] = -product(s, spread, k) * next;
        angle[k + 1] = spread[k] * next;
        w[k + 1] = turning[k] * next;
        impulse[k + 1] = pull[k] * next;
        path[k + 1] = (slowed ? product(rate, velocity, k) : velocity[k]) * next;
        time[k + 1] = slowed ? rate[k] * next : k == 0 ? 1.0 : 0.0;
    }
    return slide;
}

}  // namespace rolling_ellipse
