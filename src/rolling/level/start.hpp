// The start of rolling on level ground, for the proof and for the motion.
#pragma once

#include "scene/scene.hpp"

namespace rolling_ellipse {

// A body in units of its long semi-axis.
struct Shape {
    double short_axis;
    double gyration2;
    double c2;  // 1 - short_axis^2
};

Shape shape(const Body& body, const FlatView& view);

// A place of a body in rolling, by the squares of the sine and cosine of its angle from the flat
// position, with the parts of D = kh + h'^2 and of N = (kh + omega^2 normal_part)/D, physics (16,
// 23).
struct ShapePlace {
    double h2;
    double h;
    double dh2;
    double kh;  // k^2 + h^2
    double normal_part;

    double inertia() const { return kh + dh2; }
};

ShapePlace place_at(const Shape& shape, double sin2, double cos2);
ShapePlace place_at(const Shape& shape, double h2, double sin2, double cos2);

// The height H = E/(m g) of the energy [m], and how far it is over the tip (H - L, negative in
// libration) and over the flat position (H - S), by forms that do not cancel: physics (26).
struct EnergyHeight {
    double total;
    double over_tip;
    double over_flat;
};

struct RollingStart {
    Body body;
    double theta;
    double omega;
    FlatView view;
    EnergyHeight height;
    bool rests;  // in equilibrium for all times
};

RollingStart rolling_start(const Body& body, double theta, double omega);

}  // namespace rolling_ellipse
