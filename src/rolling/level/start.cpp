#include "rolling/level/start.hpp"

#include <cmath>

namespace rolling_ellipse {
namespace {

// The height of the energy, physics (26).
EnergyHeight energy_height(const FlatView& at, const Body& body, double omega) {
    const double h2 = square(at.short_axis) + at.c2 * square(at.sin);
    const double h = std::sqrt(h2);
    const double dh = at.c2 * at.sin * at.cos / h;
    const double kinetic = (body.gyration2 + h2 + square(dh)) * square(omega) / (2 * body.gravity);
    return {kinetic + h, kinetic - under_tip(at, h), kinetic + over_flat(at, h)};
}

}  // namespace

Shape shape(const Body& body, const FlatView& view) {
    const double unit = view.long_axis;
    return {view.short_axis / unit, body.gyration2 / square(unit), view.c2 / square(unit)};
}

ShapePlace place_at(const Shape& shape, double sin2, double cos2) {
    return place_at(shape, square(shape.short_axis) * cos2 + sin2, sin2, cos2);
}

ShapePlace place_at(const Shape& shape, double h2, double sin2, double cos2) {
    const double b = shape.short_axis;
    const double h = std::sqrt(h2);
    const double dh2 = square(shape.c2) * sin2 * cos2 / h2;
    const double ddh = shape.c2 * (b * cos2 - sin2) * (b * cos2 + sin2) / (h * h2);
    const double kh = shape.gyration2 + h2;
    return {h2, h, dh2, kh, ddh * kh - h * dh2};
}

RollingStart rolling_start(const Body& body, double theta, double omega) {
    omega = zero_if_negligible(omega);
    FlatView view = flat_view(body.axes(), theta);
    // A body that starts on the tip moves down, with the same bits to either side.
    if (view.cos == 0 && omega != 0) view.sin = -std::copysign(1.0, omega);
    const bool rests = omega == 0 && is_equilibrium(geometry(body.axes(), theta));
    return {body, theta, omega, view, energy_height(view, body, omega), rests};
}

}  // namespace rolling_ellipse
