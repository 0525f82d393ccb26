// The multiplier model by numerical integration: coordinates and velocities at any time.
#pragma once

#include <variant>

#include "integrator/steps.hpp"
#include "multipliers/equations.hpp"
#include "scene/settings.hpp"

namespace rolling_ellipse {

// A start in coordinates. Its state has x = 0, and its angles are measured from `angle_base`.
struct CoordinateStart {
    CoordinateState state;
    double x;
    DoubleDouble angle_base;
    bool rests = false;  // the body rests forever
};

struct SteppedMultipliers {
    ConstrainedBody body;
    Settings settings;
    double specific_energy;   // initial energy per mass [J/kg]
    double x_base;            // x at the start, added to the integrated x
    DoubleDouble angle_base;  // angle that is added to the integrated angles
    // Steps of y = (q, q_dot); the index-2 system appends lambda per mass and the multipliers mu.
    std::variant<Steps<10>, Steps<17>> steps;
    double most_projected = 0.0;  // largest residual of a step before its projection
};

// The start of a rolling body, given its state, or a start from any coordinates and velocities.
CoordinateStart coordinate_start(const Scene& scene, const State& start);
CoordinateStart coordinate_start(const CoordinateState& state);

Integration<SteppedMultipliers> integrate_multipliers(const Scene& scene,
                                                      const CoordinateStart& start,
                                                      const Settings& settings, double t_end,
                                                      const Checkpoint& checkpoint);

// The state at n times between the first and the last knot.
void sample(const SteppedMultipliers& motion, const double* times, std::size_t n,
            CoordinateState* samples);

// Energies and constraint residuals at points along a motion, at about a twentieth of its cost.
// `evaluations` is the number of evaluations of f that the motion took.
std::vector<Invariants> invariants(const SteppedMultipliers& motion, long evaluations);

// Accelerations and multipliers of a state, with Baumgarte's feedback if the settings request it.
MultiplierSolution accelerations(const ConstrainedBody& body, const Settings& settings,
                                 const CoordinateState& state);

// The largest growth factor of a constraint error per step, above 1 if the error diverges; 0
// without feedback or without a fixed step.
//
// For small errors, the feedback is linear. Its rates s are the roots of s^2 + 2 alpha s + beta^2
// for the positions and -2 alpha for f1; a step of size dt multiplies each mode of the error by the
// stability function of the method at s dt (E. Hairer, G. Wanner, Solving Ordinary Differential
// Equations II, 2nd ed., Springer 1996, IV.2).
double feedback_growth(const Settings& settings);

}  // namespace rolling_ellipse
