// Rolling by numerical integration: the state at any time.
#pragma once

#include "integrator/steps.hpp"
#include "rolling/level/flow.hpp"
#include "rolling/stepped/equation.hpp"
#include "scene/settings.hpp"

namespace rolling_ellipse {

// The ellipse is the same after half a turn: its angle is integrated as half turns and a rest, so
// that it keeps its digits however far it rolls.
struct SteppedRolling {
    RollingEquation equation;
    Axes axes;
    Settings settings;
    DoubleDouble theta_base;  // angle at which half turns and rest are 0
    DoubleDouble x_base;      // x there
    double half_turn_path;
    Steps<2> steps;
};

// The motion that is to be integrated: its first knot.
SteppedRolling rolling_from(const Scene& scene, const State& start, const Settings& settings);

Integration<SteppedRolling> integrate_rolling(const Scene& scene, const State& start,
                                              const Settings& settings, double t_end,
                                              const Checkpoint& checkpoint);

// The state at n times between the first and the last knot.
void sample(const SteppedRolling& motion, const double* times, std::size_t n, FlowSample* samples);

// Energies along the motion, which has taken so many evaluations; no constraints can be missed.
std::vector<Invariants> invariants(const SteppedRolling& motion, long evaluations);

}  // namespace rolling_ellipse
