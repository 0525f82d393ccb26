#include "rolling/slope_series.hpp"

namespace rolling_ellipse {

// Physics (18) with D h^2 = d0 + d1 s^2, u = h^2 and s, c the sine and cosine of the angle:
//     omega' u (d0 + d1 s^2) = u h (g_along u - g_into c^2 s c) - c^2 L^2 S^2 s c omega^2
// where c^2 of the axes is `c2`. Near an equilibrium what drives is a small difference: it is
// formed first.
SlopeSeries slope_series(const SlopeConstants& body, double sin, double cos, double omega) {
    SlopeSeries motion;
    auto& [angle, omegas, path, h] = motion;
    // Side by side: what is multiplied at once.
    TwoSeries s_s, s_c;           // sin^2, sin cos
    TwoSeries u_u, inertia_h;     // the mass u D h^2, u h
    TwoSeries w_h;                // omega^2, h^2
    TwoSeries sc_uh, load_drive;  // what omega drives, what gravity drives
    TwoSeries mass_h, turning_w;  // that over the mass; the rate of the path
    TwoSeries c_s, w_w;           // the rates of sine and cosine
    s_s[0] = pair(sin, sin);
    s_c[0] = pair(sin, cos);
    c_s[0] = pair(cos, -sin);
    omegas[0] = omega;
    angle[0] = path[0] = 0.0;
    const double centrifugal = -body.c2 * body.long_axis2 * body.short_axis2;
    const double u0 = body.short_axis2 + body.c2 * square(sin);
    const double h0 = std::sqrt(u0);
    const double over_2h0 = 0.5 / h0;
    const double over_mass = 1 / (u0 * (body.d0 + body.d1 * square(sin)));

    for (int k = 0; k <= long_order; ++k) {
        const Pair known_squares = inner(s_s, s_c, k);
        const Pair known_masses = inner(u_u, inertia_h, k);
        const Pair known_own = self_product(w_h, k, 1);
        const Pair known_forces = inner(sc_uh, load_drive, k);
        const Pair known_rates = inner(mass_h, turning_w, k);
        const Pair known_turns = inner(c_s, w_w, k);

        const double w = omegas[k];
        const Pair squares = known_squares + outer(s_s, s_c, k);
        const double varying = body.c2 * squares[0];
        const double u = k == 0 ? u0 : varying;
        h[k] = k == 0 ? h0 : (u - known_own[1]) * over_2h0;
        w_h[k] = pair(w, h[k]);
        u_u[k] = pair(u, u);
        inertia_h[k] = pair(body.d1 * squares[0] + (k == 0 ? body.d0 : 0.0), h[k]);
        const Pair masses = known_masses + outer(u_u, inertia_h, k);
        const double w2 = k == 0 ? square(w) : known_own[0] + 2 * omega * w;
        sc_uh[k] = pair(squares[1], masses[1]);
        load_drive[k] = pair(centrifugal * w2,
                             body.gravity.along * u - body.gravity.into * body.c2 * squares[1]);
        const Pair forces = known_forces + outer(sc_uh, load_drive, k);
        mass_h[k] = pair(masses[0], h[k]);
        double rest = forces[0] + forces[1];
        if (k > 0) rest -= known_rates[0] + masses[0] * turning_w[0][0];
        turning_w[k] = pair(rest * over_mass, w);
        if (k == long_order) break;

        w_w[k] = pair(w, w);
        const Pair turns = (known_turns + outer(c_s, w_w, k)) * pair(over_next[k], over_next[k]);
        s_s[k + 1] = pair(turns[0], turns[0]);
        s_c[k + 1] = turns;
        c_s[k + 1] = pair(turns[1], -turns[0]);
        const double rolled = k == 0 ? h0 * w : known_rates[1] + (h0 * w + h[k] * omega);
        angle[k + 1] = w * over_next[k];
        path[k + 1] = rolled * over_next[k];
        omegas[k + 1] = turning_w[k][0] * over_next[k];
    }
    return motion;
}

}  // namespace rolling_ellipse
