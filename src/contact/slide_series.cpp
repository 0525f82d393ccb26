#include "contact/slide_series.hpp"

#include <cmath>

namespace rolling_ellipse {
SlideSeries slide_series(const SlidingBody& body, const SlideState& at, double sin, double cos,
                         SlideClock clock) {
    const auto [a, b] = body.axes;
    const double c2 = (a - b) * (a + b);
    const double k2 = body.gyration2;
    const double nu = body.normal_share;
    const double phi = body.friction_share;
    const bool slowed = clock == SlideClock::slowed;

    SlideSeries slide;
    auto& [angle, w, slip, path, rolled, time, pressure, response, u] = slide;
    // Side by side: what is multiplied at once.
    TwoSeries s_s, s_c;          // sin^2, sin cos
    TwoSeries w_below, w_above;  // omega^2, (a b - u)(a b + u)
    TwoSeries p_u, lever_h;      // p L, u h
    TwoSeries u_h, v_v;          // u V, h V
    TwoSeries l_h, c_w;          // L C, h omega
    TwoSeries loads, gains;      // (u V) omega', (h V) impulse'
    TwoSeries rate_c, w_h;       // dt/dtau omega, C h
    TwoSeries c_s, spread;       // cos angle', -sin angle'
    LongSeries h, bend, w2, rate, velocity, impulse;
    angle[0] = at.angle;
    w[0] = at.omega;
    path[0] = at.path;
    time[0] = at.time;
    impulse[0] = 0.0;
    s_s[0] = pair(sin, sin);
    s_c[0] = pair(sin, cos);
    c_s[0] = pair(cos, -sin);
    const double u0 = square(a * sin) + square(b * cos);  // nothing cancels for thin bodies,
    const double below0 = (a - b) * (b * square(cos) - a * square(sin));  // nor for circles
    const double h0 = std::sqrt(u0);
    const double over_2h0 = 0.5 / h0;
    const double per_clock = 1 / (k2 * u0 * u0);
    Pair over_loads{};

    for (int k = 0; k <= long_order; ++k) {
        const Pair known_squares = inner(s_s, s_c, k);
        const Pair known_bends = inner(w_below, w_above, k);
        const Pair known_weights = inner(p_u, lever_h, k);
        const Pair known_loads = inner(u_h, v_v, k);
        const Pair known_torques = inner(l_h, c_w, k);
        const Pair known_turns = inner(c_s, spread, k);
        const double known_turning = inner(bend, w2, k);
        const double known_h = inner(h, h, k);

        const Pair squares = known_squares + outer(s_s, s_c, k);
        const double varying = k == 0 ? 0.0 : c2 * squares[0];
        u[k] = k == 0 ? u0 : varying;
        h[k] = k == 0 ? h0 : (u[k] - known_h) * over_2h0;
        const double p = c2 * squares[1];
        const double lever = nu * p + phi * u[k];
        w_below[k] = pair(w[k], k == 0 ? below0 : -varying);
        w_above[k] = pair(w[k], k == 0 ? u0 + a * b : varying);
        p_u[k] = pair(p, u[k]);
        lever_h[k] = pair(lever, h[k]);
        u_h[k] = pair(u[k], h[k]);
        l_h[k] = pair(lever, h[k]);

        const Pair bends = known_bends + outer(w_below, w_above, k);
        w2[k] = bends[0];
        bend[k] = bends[1];
        const Pair weights = known_weights + outer(p_u, lever_h, k);
        response[k] = nu * k2 * u[k] + weights[0];
        v_v[k] = pair(response[k], response[k]);
        pressure[k] = body.gravity.into * weights[1] + (known_turning + outer(bend, w2, k));
        c_w[k] = pair(pressure[k], w[k]);
        const Pair torques = known_torques + outer(l_h, c_w, k);
        rolled[k] = torques[1];
        loads[k] = known_loads + outer(u_h, v_v, k);

        Pair gain = pair(-torques[0], phi * k2 * pressure[k]);
        if (slowed) {
            rate[k] = per_clock * loads[k][0];
            rate_c[k] = pair(rate[k], pressure[k]);
            w_h[k] = pair(w[k], h[k]);
            const Pair slow = inner(rate_c, w_h, k) + outer(rate_c, w_h, k);
            gain = pair(per_clock * gain[0], per_clock * phi * k2 * slow[1]);
            spread[k] = pair(slow[0], slow[0]);
        } else {
            if (k == 0) over_loads = pair(1 / loads[0][0], 1 / loads[0][1]);
            if (k > 0) gain = gain - inner(loads, gains, k) - loads[k] * gains[0];
            gain = gain * over_loads;
            gains[k] = gain;
            spread[k] = pair(w[k], w[k]);
        }
        slip[k] = k == 0 ? at.slip : impulse[k] + body.gravity.along * time[k] - rolled[k];
        velocity[k] = slip[k] + rolled[k];
        if (k == long_order) break;
        const Pair turns = (known_turns + outer(c_s, spread, k)) * pair(over_next[k], over_next[k]);
        s_s[k + 1] = pair(turns[0], turns[0]);
        s_c[k + 1] = turns;
        c_s[k + 1] = pair(turns[1], -turns[0]);
        angle[k + 1] = spread[k][0] * over_next[k];
        w[k + 1] = gain[0] * over_next[k];
        impulse[k + 1] = gain[1] * over_next[k];
        if (slowed) {
            path[k + 1] = (inner(rate, velocity, k) + outer(rate, velocity, k)) * over_next[k];
            time[k + 1] = rate[k] * over_next[k];
        } else {
            path[k + 1] = velocity[k] * over_next[k];
            time[k + 1] = k == 0 ? 1.0 : 0.0;
        }
    }
    return slide;
}

}  // namespace rolling_ellipse
