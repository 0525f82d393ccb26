// The start of rolling on level ground: what the proof and the motion both begin with.
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
    bool rests;  // in equilibrium, for ever
};

RollingStart rolling_start(const Body& body, double theta, double omega);

}  // namespace rolling_ellipse
