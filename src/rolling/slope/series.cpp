#include "rolling/slope/series.hpp"

namespace rolling_ellipse {

// Physics (18) with D h^2 = d0 + d1 sin^2 phi, u = h^2 and p = h h' = c2 sin phi cos phi:
//     omega' u (d0 + d1 sin^2 phi) = u h (g_along u - g_into p) - L^2 S^2 p omega^2
//     u' = 2 p omega,   p' = q omega,   q' = -4 p omega
// Near an equilibrium the first coefficient of g_along u - g_into p is a small difference, which
// the caller computes with all its digits (`drive`); the later coefficients do not cancel.
SlopeSeries slope_series(const SlopeConstants& body, double sin, double cos, double omega,
                         double drive) {
    SlopeSeries motion;
    auto& [angle, w, path, h] = motion;
    // Pairs of series that are multiplied at the same time.
    TwoSeries p_q, w_w;           // the rates of u and p
    TwoSeries u_u, inertia_h;     // the mass u D h^2, u h
    TwoSeries w_h;                // omega^2, h^2
    TwoSeries p_uh, load_drive;   // their products: the terms of omega and of gravity
    TwoSeries mass_h, turning_w;  // factors of omega' u D h^2 and of the path's rate h omega
    const double centrifugal = -body.long_axis2 * body.short_axis2;
    const double sin2 = square(sin);
    const double u0 = body.short_axis2 + body.c2 * sin2;
    const double h0 = std::sqrt(u0);
    const double over_2h0 = 0.5 / h0;
    const double inertia0 = body.d0 + body.d1 * sin2;
    const double inertia_per_u = body.d1 / body.c2;
    const double over_mass = 1 / (u0 * inertia0);
    angle[0] = path[0] = 0.0;
    w[0] = omega;
    double u = u0;
    p_q[0] = pair(body.c2 * sin * cos, body.c2 * (cos - sin) * (cos + sin));

    for (int k = 0; k <= long_order; ++k) {
        const Pair known_turns = inner(p_q, w_w, k);
        const Pair known_masses = inner(u_u, inertia_h, k);
        const Pair known_squares = self_product(w_h, k, 1);
        const Pair known_forces = inner(p_uh, load_drive, k);
        const Pair known_rates = inner(mass_h, turning_w, k);

        h[k] = k == 0 ? h0 : (u - known_squares[1]) * over_2h0;
        w_h[k] = pair(w[k], h[k]);
        u_u[k] = pair(u, u);
        inertia_h[k] = pair(k == 0 ? inertia0 : inertia_per_u * u, h[k]);
        const Pair masses = known_masses + outer(u_u, inertia_h, k);
        const double w2 = k == 0 ? square(omega) : known_squares[0] + 2 * omega * w[k];
        const double p = p_q[k][0];
        p_uh[k] = pair(p, masses[1]);
        if (k > 0) drive = body.gravity.along * u - body.gravity.into * p;
        load_drive[k] = pair(centrifugal * w2, drive);
        const Pair forces = known_forces + outer(p_uh, load_drive, k);
        mass_h[k] = pair(masses[0], h[k]);
        double rest = forces[0] + forces[1];
        if (k > 0) rest -= known_rates[0] + masses[0] * turning_w[0][0];
        turning_w[k] = pair(rest * over_mass, w[k]);
        if (k == long_order) break;

        w_w[k] = pair(w[k], w[k]);
        const Pair turns = (known_turns + outer(p_q, w_w, k)) * pair(over_next[k], over_next[k]);
        u = 2 * turns[0];
        p_q[k + 1] = pair(turns[1], -4 * turns[0]);
        const double rolled = k == 0 ? h0 * omega : known_rates[1] + (h0 * w[k] + h[k] * omega);
        angle[k + 1] = w[k] * over_next[k];
        path[k + 1] = rolled * over_next[k];
        w[k + 1] = turning_w[k][0] * over_next[k];
    }
    return motion;
}

}  // namespace rolling_ellipse
