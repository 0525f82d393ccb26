// How a motion is to be computed, and the rules these choices must obey.
#pragma once

#include <functional>
#include <optional>
#include <string>

namespace rolling_ellipse {

// Names, which are in the order of the values, are in settings.cpp.
enum class Model { automatic, rolling, multipliers, contact };

enum class Method { automatic, exact, dop853, dopri5, rk4, gauss, radau };

// How the constraints of the multiplier model are kept: as an index-1 system, with Baumgarte's
// feedback, projected after each step, also onto the energy, or as the index-2 system of Gear,
// Gupta and Leimkuhler.
enum class Stabilization { none, baumgarte, projection, projection_energy, ggl };

struct Settings {
    Model model;
    Method method;
    double rtol;
    double atol;
    std::optional<double> step;  // [s]; absent: chosen by error control
    std::optional<int> stages;   // of Gauss; absent: 4
    Stabilization stabilization;
    double baumgarte_alpha;  // [1/s]
    double baumgarte_beta;   // [1/s]
    long max_steps;
    long max_events;
    std::optional<double> rest_speed;  // [m/s] under which bounces are summed; absent: by size
};

// Called now and then during long work; throws to stop it.
using Checkpoint = std::function<void()>;

std::string name(Model model);
std::string name(Method method);
std::string name(Stabilization stabilization);

// Throws std::logic_error: a method that no model may be asked for has come where integrators are
// chosen.
[[noreturn]] void no_integrator_for(Method method);

// Throws std::invalid_argument naming the argument, what was required and what came.
void validate(const Settings& settings, double t_end);

}  // namespace rolling_ellipse
