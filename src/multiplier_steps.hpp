// The multiplier model by numerical integration: coordinates and velocities at any time.
#pragma once

#include <variant>

#include "integrator/stepped.hpp"
#include "multipliers.hpp"
#include "settings.hpp"

namespace rolling_ellipse {

struct CoordinateState {
    Coordinates q;
    Coordinates q_dot;
    bool at_rest = false;  // for ever
};

struct SteppedMultipliers {
    ConstrainedBody body;
    Settings settings;
    double specific_energy;   // of the start [J/kg]
    DoubleDouble theta_base;  // angle at which half turns and rest are 0
    // (q, q_dot); of the index-2 system, then lambda per mass and the multipliers of the positions.
    std::variant<Steps<10>, Steps<17>> steps;

    Method method() const { return settings.method; }
};

// The state that meets the constraints where the body rolls.
CoordinateState coordinate_state(const Scene& scene, const State& start);

struct MultiplierIntegration {
    SteppedMultipliers motion;
    Ending ending;
    StepCounts counts;
};

MultiplierIntegration integrate_multipliers(const Scene& scene, const CoordinateState& start,
                                            const Settings& settings, double t_end,
                                            const Checkpoint& checkpoint);

// The state at n times between the first and the last knot.
void sample(const SteppedMultipliers& motion, const double* times, std::size_t n,
            CoordinateState* samples);

// Accelerations and multipliers of a state, with Baumgarte's feedback where it is asked for.
MultiplierSolution accelerations(const ConstrainedBody& body, const Settings& settings,
                                 const CoordinateState& state);

}  // namespace rolling_ellipse
