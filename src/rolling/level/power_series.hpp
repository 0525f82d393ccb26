// Exact rolling on level ground as power series in time about a place of the motion: about one
// place, T = double, or about several side by side.
#pragma once

#include <array>

#include "numerics/lanes.hpp"
#include "numerics/series.hpp"
#include "rolling/level/flow.hpp"

namespace rolling_ellipse {

template <class T, int order>
struct MotionSeries {
    std::array<T, order + 1> angle;
    std::array<T, order + 1> omega;
    std::array<T, order + 1> path;
};

namespace {

// The constants of a motion, for time in this unit [s].
inline SeriesConstants series_constants(const RollingFlow& flow, double time_unit) {
    const PhaseRate<double>& rate = flow.phase.rate;
    const double length = flow.from.view.long_axis;
    const double area = length * length;
    return {rate.short_axis / length * (rate.short_axis / length), rate.c2 / area,
            flow.from.body.gravity * (time_unit * time_unit) / length, rate.d0 / (area * area),
            rate.d1 / (area * area)};
}

// The series about the place with this sine and cosine of the angle from the flat position and this
// angular velocity.
// Physics (18) with D h^2 = d0 + d1 q, u = h^2, q and p the square of the sine and the product of
// sine and cosine of the angle:
//     omega' u (d0 + d1 q) = -c2 p (g u h + S^2 omega^2),   q' = 2 p omega,   p' = (1 - 2 q) omega
template <int order, class T>
inline MotionSeries<T, order> motion_series(const SeriesConstants& body, T sin, T cos, T omega) {
    MotionSeries<T, order> motion;
    std::array<T, order + 1> q, p, u, h, inertia, mass, push, turning;
    auto& w = motion.omega;
    T over_2h{}, over_mass{};
    q[0] = sin * sin;
    p[0] = sin * cos;
    w[0] = omega;
    motion.angle[0] = motion.path[0] = T{};
#pragma GCC unroll 20
    for (int k = 0; k < order; ++k) {
        u[k] = body.c2 * q[k];
        inertia[k] = body.d1 * q[k];
        if (k == 0) {
            u[0] += body.short_axis2;
            inertia[0] += body.d0;
            h[0] = sqrt(u[0]);
            over_2h = 0.5 / h[0];
            over_mass = 1 / (u[0] * inertia[0]);
        } else {
            h[k] = (u[k] - self_product(h, k, 1)) * over_2h;
        }
        mass[k] = product(u, inertia, k);
        push[k] = body.gravity * product(u, h, k) + body.short_axis2 * self_product(w, k);
        const T force = -body.c2 * product(p, push, k);
        turning[k] = (force - terms(mass, turning, k, 1, k)) * over_mass;
        const T qw = product(q, w, k);
        const double next = 1.0 / (k + 1);
        q[k + 1] = 2 * next * product(p, w, k);
        p[k + 1] = next * (w[k] - 2 * qw);
        w[k + 1] = next * turning[k];
        motion.angle[k + 1] = next * w[k];
        motion.path[k + 1] = next * product(h, w, k);
    }
    return motion;
}

}  // namespace
}  // namespace rolling_ellipse
