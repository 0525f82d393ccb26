// Rolling on a slope as power series in time about a place of the motion.
#pragma once

#include "numerics/series.hpp"
#include "scene/scene.hpp"

namespace rolling_ellipse {

// Constants of the equation of motion, with the angle phi from the flat position.
struct SlopeConstants {
    double short_axis2;
    double long_axis2;
    double c2;
    double d0;  // D h^2 = d0 + d1 sin^2 phi, physics (28)
    double d1;
    GroundGravity gravity;  // along > 0: the slope falls to growing angles
};

struct SlopeSeries {
    LongSeries angle;
    LongSeries omega;
    LongSeries path;
    LongSeries height;
};

// The series about a place, from the sine and cosine of phi, omega, and `drive`, h times the moment
// of gravity.
SlopeSeries slope_series(const SlopeConstants& body, double sin, double cos, double omega,
                         double drive);

}  // namespace rolling_ellipse
