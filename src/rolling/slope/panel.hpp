// Points on the panels of a run, in several lanes at once.
#pragma once

#include "numerics/part.hpp"
#include "rolling/slope/run.hpp"

namespace rolling_ellipse {
namespace {

// Points on a part: the tangents of their angles from the centre of the panel and the derivatives
// of these with respect to v; 1/(1 + tan^2); sines and cosines of their angles from a flat
// position, both times sqrt(1 + tan^2) and possibly -1; the squares of both without that factor;
// and the height of the centre, with its fall from the datum of the run.
struct PanelPlaces {
    Pack tan;
    Pack tan_rate;
    Pack over;
    Pack sin;
    Pack cos;
    Pack sin2;
    Pack cos2;
    Pack h2;
    Pack h;
    Pack fall;
};

// The points x in -1 ... 1 of a part.
[[gnu::always_inline]] inline PanelPlaces places_at(const SlopeRun& run, const RunPart& part,
                                                    Pack x) {
    const RunPanel& panel = run.panels[part.panel];
    const Pack v = part.middle + part.half * x;
    const auto [sinh, falling] = hyperbolic(abs(v));
    PanelPlaces at;
    at.tan = copysign(panel.grade * sinh, v);
    at.tan_rate = panel.grade * (sinh + falling);
    at.over = 1 / (1 + at.tan * at.tan);
    at.sin = panel.sin + panel.cos * at.tan;
    at.cos = panel.cos - panel.sin * at.tan;
    at.sin2 = at.sin * at.sin * at.over;
    at.cos2 = at.cos * at.cos * at.over;
    at.h2 = run.body.short_axis2 + run.body.c2 * at.sin2;
    at.h = sqrt(at.h2);
    const Geometry& from = run.datum.at;
    const double sin2_from = square(from.sin);
    const Pack change =
        sin2_from + at.sin2 > 1.0 ? at.cos2 - square(from.cos) : sin2_from - at.sin2;
    at.fall = run.body.c2 / (from.h + at.h) * change;
    return at;
}

}  // namespace
}  // namespace rolling_ellipse
