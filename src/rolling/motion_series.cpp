#include "rolling/motion_series.hpp"

#include <algorithm>
#include <cmath>

#include "numerics/numbers.hpp"

namespace rolling_ellipse {
namespace {

constexpr int order = series_order;

}  // namespace

// Physics (18) with D h^2 = d0 + d1 s^2, u = h^2 and s, c the sine and cosine of the angle:
//     omega' u (d0 + d1 s^2) = -c2 s c (g u h + S^2 omega^2)
MotionSeries motion_series(const SeriesConstants& body, double sin, double cos, double omega) {
    Series s{sin}, c{cos}, w{omega}, s2{}, u{}, inertia{}, mass{}, sc{}, w2{}, uh{}, load{}, h{},
        turning{};
    MotionSeries motion{};
    for (int k = 0; k <= order; ++k) {
        s2[k] = self_product(s, k);
        u[k] = body.c2 * s2[k];
        inertia[k] = body.d1 * s2[k];
        if (k == 0) {
            u[0] += body.short_axis2;
            inertia[0] += body.d0;
            h[0] = std::sqrt(u[0]);
        } else {
            h[k] = (u[k] - self_product(h, k, 1)) / (2 * h[0]);
        }
        mass[k] = product(u, inertia, k);
        sc[k] = product(s, c, k);
        w2[k] = self_product(w, k);
        uh[k] = product(u, h, k);
        load[k] = body.short_axis2 * w2[k] + body.gravity * uh[k];
        const double force = -body.c2 * product(sc, load, k);
        const double known = terms(mass, turning, k, 1, k);
        turning[k] = (force - known) / mass[0];
        motion.omega[k] = w[k];
        if (k == order) break;
        const double next = 1.0 / (k + 1);
        s[k + 1] = product(c, w, k) * next;
        c[k + 1] = -product(s, w, k) * next;
        motion.angle[k + 1] = w[k] * next;
        motion.path[k + 1] = product(h, w, k) * next;
        w[k + 1] = turning[k] * next;
    }
    return motion;
}

double reach(const Series& series) {
    constexpr double rest = 1e-16;  // half an ulp
    double radius = 1.0;
    for (int i = 0; i < 3; ++i) {  // its size depends on the radius, by a small power of it
        const double size = std::max({std::abs(series[0]), std::abs(series[1]) * radius,
                                      std::abs(series[2]) * square(radius)});
        double least = infinity;
        for (const int k : {order - 1, order}) {
            const double last = std::abs(series[k]);
            if (last > 0) least = std::min(least, std::pow(rest * size / last, 1.0 / k));
        }
        radius = least;
    }
    return radius;
}

}  // namespace rolling_ellipse
