#include "rolling/level/start.hpp"

#include <cmath>

namespace rolling_ellipse {
namespace {

// physics (26)
EnergyHeight energy_height(const FlatView& at, const Body& body, double omega) {
    const double h2 = square(at.short_axis) + at.c2 * square(at.sin);
    const double h = std::sqrt(h2);
    const double dh = at.c2 * at.sin * at.cos / h;
    const double kinetic = (body.gyration2 + h2 + square(dh)) * square(omega) / (2 * body.gravity);
    return {kinetic + h, kinetic - at.c2 * square(at.cos) / (at.long_axis + h),
            kinetic + at.c2 * square(at.sin) / (at.short_axis + h)};
}

}  // namespace

Shape shape(const Body& body, const FlatView& view) {
    const double unit = view.long_axis;
    return {view.short_axis / unit, body.gyration2 / square(unit), view.c2 / square(unit)};
}

RollingStart rolling_start(const Body& body, double theta, double omega) {
    omega = zero_if_negligible(omega);
    FlatView view = flat_view(body.axes(), theta);
    // From the tip it goes down, with the same bits to either side.
    if (view.cos == 0 && omega != 0) view.sin = -std::copysign(1.0, omega);
    const bool rests = omega == 0 && is_equilibrium(geometry(body.axes(), theta));
    return {body, theta, omega, view, energy_height(view, body, omega), rests};
}

}  // namespace rolling_ellipse
