// Rolling by numerical integration: the points between the steps, and from them the state at any
// time. What a step needs for its dense output is computed again when somebody looks into it.
#pragma once

#include <cstddef>
#include <vector>

#include "flow.hpp"
#include "rolling.hpp"
#include "settings.hpp"

namespace rolling_ellipse {

// The ellipse is the same after half a turn: its angle is integrated as half turns and a rest, so
// that it keeps its digits however far it rolls.
struct RollingKnot {
    double t;
    DoubleDouble theta;  // over the last half turn
    DoubleDouble omega;
    double half_turns;
};

struct SteppedRolling {
    RollingEquation equation;
    Axes axes;
    Method method;
    int stages;               // of Gauss
    double step;              // 0: chosen by error control
    DoubleDouble theta_base;  // angle at which half turns and rest are 0
    DoubleDouble x_base;      // x there
    double half_turn_path;
    std::vector<RollingKnot> knots;
};

struct RollingIntegration {
    SteppedRolling motion;
    Ending ending;
    StepCounts counts;
};

RollingIntegration integrate_rolling(const Scene& scene, const State& start,
                                     const Settings& settings, double t_end,
                                     const Checkpoint& checkpoint);

// The state at n times between the first and the last knot; quickest where they are sorted.
void sample(const SteppedRolling& motion, const double* times, std::size_t n, FlowSample* samples);

}  // namespace rolling_ellipse
