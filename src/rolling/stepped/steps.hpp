// Rolling by numerical integration, with the state available at any time.
#pragma once

#include <stdexcept>

#include "integrator/explicit_tableaus.hpp"
#include "integrator/steps.hpp"
#include "rolling/level/flow.hpp"
#include "rolling/stepped/equation.hpp"
#include "scene/settings.hpp"

namespace rolling_ellipse {

// A rolling motion integrated in steps. The angle is stored as half turns and a remainder, so that
// it stays precise however far the body rolls.
struct SteppedRolling {
    RollingEquation equation;
    Axes axes;
    Settings settings;
    DoubleDouble theta_base;  // angle at which the half turns and the remainder are 0
    DoubleDouble x_base;      // x at theta_base
    double half_turn_path;    // path of the centre in a half turn
    Steps<2> steps;
};

// Calls action(tableau) with the tableau of an explicit method.
template <class Action>
auto with_tableau(Method method, const Action& action) {
    if (method == Method::rk4) return action(RungeKutta4{});
    if (method == Method::dopri5) return action(DormandPrince5{});
    if (method == Method::dop853) return action(DormandPrince853{});
    // Validation accepts no other method.
    throw std::logic_error("there is no integrator for the method '" + name(method) + "'");
}

Integration<SteppedRolling> integrate_rolling(const Scene& scene, const State& start,
                                              const Settings& settings, double t_end,
                                              const Checkpoint& checkpoint);

// The state at n times between the first and the last knot.
void sample(const SteppedRolling& motion, const double* times, std::size_t n, FlowSample* samples);

// Energies at points along a motion; `evaluations` is the number of evaluations of the equation
// that the integration took. The constraint residuals are set to 0.
std::vector<Invariants> invariants(const SteppedRolling& motion, long evaluations);

}  // namespace rolling_ellipse
