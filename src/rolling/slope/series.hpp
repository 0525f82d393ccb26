// Rolling on a slope as power series in time about a place of the motion.
#pragma once

#include "numerics/long_series.hpp"
#include "scene/scene.hpp"

namespace rolling_ellipse {

// The constants of the series, with time in a unit of its own.
struct SlopeConstants {
    double short_axis2;
    double long_axis2;
    double c2;
    GroundGravity gravity;  // along a slope that falls to growing angles
    double d0;              // D h^2 = d0 + d1 sin^2 phi, physics (28)
    double d1;
};

struct SlopeSeries {
    LongSeries angle;
    LongSeries omega;
    LongSeries path;
    LongSeries height;
};

// The series from the sine and cosine of the angle from the flat position, the angular velocity and
// h times the moment of gravity there.
SlopeSeries slope_series(const SlopeConstants& body, double sin, double cos, double omega,
                         double drive);

}  // namespace rolling_ellipse
