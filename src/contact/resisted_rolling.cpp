#include "contact/resisted_rolling.hpp"

#include <cmath>

#include "numerics/wide.hpp"

namespace rolling_ellipse {

std::optional<double> cancelled_moment(const SlidingBody& body, const Geometry& at,
                                       const DoubleDouble& angle) {
    constexpr double little = 0x1p-4;  // below this fraction of its terms, a sum has lost digits
    const auto [into, along] = body.gravity;
    const double falling = at.h * along - (at.dh + body.ahead) * into;
    const double terms = std::abs(at.h * along) + (std::abs(at.dh) + std::abs(body.ahead)) * into;
    if (std::abs(falling) > little * terms) return {};
    const auto [u, p] = precise_height2(body.axes, angle);
    const DoubleDouble h = square_root(u);
    return double(u * along - (p + h * body.ahead) * into) / double(h);
}

ROLLING_ELLIPSE_WIDE SlideSeries rolling_series(const SlidingBody& body, const SlideCentre& centre,
                                                RollingForces3& forces) {
    const auto [a, b] = body.axes;
    const auto [into, along] = body.gravity;
    const double c2 = body.axes.c2();
    const double k2 = body.gyration2;
    const double d = body.ahead;

    SlideSeries found;
    auto& [motion, slip, rolled, pressure, response, u, work] = found;
    auto& [angle, w, x_dot, path, time] = motion;
    slip = response = work = time = LongSeries{};
    Factors curve, by_curve;  // (p, q, h, (a b - u)(a b + u)) times (omega, omega, h, omega^2)
    Factors arm, by_arm;      // (u, p, h, h) times (h, C + u^2 omega^2, C, p)
    Factors turn, by_turn;    // (u, W, u, h) times (u h, u omega', omega', omega)
    Factors force, by_force;  // (p, p, u) times (u omega', omega^2, h F/m)
    Factors squared;          // (omega, u, p) times itself
    const double u0 = square(a * centre.sin) + square(b * centre.cos);
    const double h0 = std::sqrt(u0);
    const double bend0 = (a - b) * (b * square(centre.cos) - a * square(centre.sin)) * (a * b + u0);
    const double over_2h0 = 0.5 / h0;
    const double ab2 = square(a * b);
    const double over_u0 = 1 / u0;
    double over_inertia = 0.0;
    double p = c2 * centre.sin * centre.cos;
    double q = c2 * ((centre.cos - centre.sin) * (centre.cos + centre.sin));
    u[0] = u0;
    w[0] = centre.omega;
    angle[0] = path[0] = 0.0;
    time[1] = 1.0;

    for (int k = 0; k <= long_order; ++k) {
        const Quad curves = inner(curve, by_curve, k);
        const Quad arms = inner(arm, by_arm, k);
        const Quad turns = inner(turn, by_turn, k);
        const Quad pushes = inner(force, by_force, k);
        const Quad squares = self_product(squared, k, 1);
        const ProductAt product{k};
        const auto square_of = [&](int lane, double last) {
            return k == 0 ? last * last : squares[lane] + 2 * (squared[0][lane] * last);
        };
        const double h = k == 0 ? h0 : (u[k] - curves[2]) * over_2h0;
        const double omega2 = square_of(0, w[k]);
        const double u2 = square_of(1, u[k]);
        const double bend = k == 0 ? bend0 : -u2;
        const double weight = product(arms, arm, by_arm, 0, u[k], h);
        const double c = into * weight + product(curves, curve, by_curve, 3, bend, omega2);
        const double load = into * weight + ab2 * omega2;
        const double falling = product(arms, arm, by_arm, 1, p, load);
        const double resisting = d * product(arms, arm, by_arm, 2, h, c);
        const double ahead = d * product(arms, arm, by_arm, 3, h, p);
        const double inertia = k2 * u[k] + u2 + square_of(2, p) + ahead;
        const double pulling = along * product(turns, turn, by_turn, 0, u[k], weight);
        double torque = pulling - falling - resisting;
        if (k == 0 && centre.torque) {
            torque = u2 * *centre.torque - (p * ab2 + d * h * bend) * omega2;
        }
        if (k == 0) over_inertia = 1 / inertia;
        // Coefficient k of a quotient, from coefficients k of its numerator and denominator and
        // from the inner terms of the product quotient * denominator.
        const auto quotient = [&](int lane, double numerator, double denominator, double over) {
            return (k == 0 ? numerator : numerator - turns[lane] - denominator * by_turn[0][lane]) *
                   over;
        };
        const double up = quotient(1, torque, inertia, over_inertia);
        const double turning = quotient(2, up, u[k], over_u0);
        rolled[k] = product(turns, turn, by_turn, 3, h, w[k]);
        x_dot[k] = rolled[k];
        pressure[k] = c;

        const double lift = product(pushes, force, by_force, 0, p, up);
        const double swing = product(pushes, force, by_force, 1, p, omega2);
        const double push = up + swing - along * h;
        const double friction = product(pushes, force, by_force, 2, u[k], push);
        forces.normal[k] = {c + lift, std::abs(c) + std::abs(lift)};
        forces.friction[k] = {friction, std::abs(friction) + u0 * (std::abs(up) + std::abs(swing) +
                                                                   std::abs(along * h))};
        if (k == long_order) break;

        const double over = over_next[k];
        const double p_rate = product(curves, curve, by_curve, 1, q, w[k]) * over;
        const double half_u_rate = product(curves, curve, by_curve, 0, p, w[k]) * over;
        curve[k] = Quad{p, q, h, bend};
        by_curve[k] = Quad{w[k], w[k], h, omega2};
        arm[k] = Quad{u[k], p, h, h};
        by_arm[k] = Quad{h, load, c, p};
        turn[k] = Quad{u[k], inertia, u[k], h};
        by_turn[k] = Quad{weight, up, turning, w[k]};
        force[k] = Quad{p, p, u[k], 0};
        by_force[k] = Quad{up, omega2, push, 0};
        squared[k] = Quad{w[k], u[k], p, 0};

        p = p_rate;
        q = -4 * half_u_rate;
        u[k + 1] = 2 * half_u_rate;
        angle[k + 1] = w[k] * over;
        w[k + 1] = turning * over;
        path[k + 1] = rolled[k] * over;
    }
    return found;
}

}  // namespace rolling_ellipse
