// Exact rolling on level ground as power series in time about a place of the motion.
#pragma once

#include "numerics/series.hpp"

namespace rolling_ellipse {

// The constants of the series, with the long semi-axis as the unit of length and time in a unit of
// its own.
struct SeriesConstants {
    double short_axis2;
    double c2;
    double gravity;
    double d0;  // D h^2 = d0 + d1 sin^2 phi, physics (28)
    double d1;
};

struct MotionSeries {
    Series angle;
    Series omega;
    Series path;
};

// The series from the sine and cosine of the angle from the flat position and the angular velocity.
MotionSeries motion_series(const SeriesConstants& body, double sin, double cos, double omega);

// How far from its centre a series is as good as a double, beside its own size there: the last
// terms are one rounding then, and what is left out, smaller by another tenth, is less.
double reach(const Series& series);

}  // namespace rolling_ellipse
