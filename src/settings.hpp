// How a motion is to be computed, and the rules these choices must obey.
#pragma once

#include <functional>
#include <optional>
#include <string>

namespace rolling_ellipse {

enum class Model { automatic, rolling };

enum class Method { automatic, exact, dop853, dopri5, rk4, gauss, radau };

struct Settings {
    Model model;
    Method method;
    double rtol;
    double atol;
    std::optional<double> step;  // [s]; absent: chosen by error control
    std::optional<int> stages;   // of Gauss; absent: 4
    long max_steps;
};

// Called now and then during long work; throws to stop it.
using Checkpoint = std::function<void()>;

std::string name(Method method);

// Throws std::invalid_argument naming the argument, what was required and what came.
void validate(const Settings& settings, double t_end);

}  // namespace rolling_ellipse
