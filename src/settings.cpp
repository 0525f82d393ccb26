#include "settings.hpp"

#include <cmath>
#include <stdexcept>

#include "scene.hpp"

namespace rolling_ellipse {
namespace {

bool needs_step(Method method) {
    return method == Method::rk4 || method == Method::gauss || method == Method::radau;
}

void require_tolerance(const std::string& name, double value) {
    if (!(value >= 0 && std::isfinite(value))) {
        refuse(name, "a finite number of at least 0", value);
    }
}

void validate_step(const Settings& settings, double t_end) {
    const Method method = settings.method;
    if (!settings.step) {
        if (!needs_step(method)) return;
        throw std::invalid_argument("step must be given [s] for method '" + name(method) +
                                    "', got None");
    }
    const double step = *settings.step;
    if (method == Method::automatic || method == Method::exact) {
        refuse("step", "None for method '" + name(method) + "', which takes no fixed steps", step);
    }
    if (!(step > 0 && std::isfinite(step))) refuse("step", "a positive finite time [s]", step);
    if (step > t_end && t_end > 0) {
        refuse("step", "at most the time simulated, " + text(t_end) + " [s]", step);
    }
}

void validate_stages(const Settings& settings) {
    if (!settings.stages) return;
    const std::string came = ", got " + std::to_string(*settings.stages);
    if (settings.method != Method::gauss) {
        throw std::invalid_argument("stages must be None for method '" + name(settings.method) +
                                    "' ('gauss' has 2, 3 or 4)" + came);
    }
    if (*settings.stages < 2 || *settings.stages > 4) {
        throw std::invalid_argument("stages must be 2, 3 or 4" + came);
    }
}

}  // namespace

std::string name(Method method) {
    switch (method) {
        case Method::automatic:
            return "auto";
        case Method::exact:
            return "exact";
        case Method::dop853:
            return "dop853";
        case Method::dopri5:
            return "dopri5";
        case Method::rk4:
            return "rk4";
        case Method::gauss:
            return "gauss";
        case Method::radau:
            return "radau";
    }
    return {};
}

void validate(const Settings& settings, double t_end) {
    require_tolerance("rtol", settings.rtol);
    require_tolerance("atol", settings.atol);
    if (settings.rtol == 0 && settings.atol == 0) {
        throw std::invalid_argument("rtol and atol must not both be 0, got 0.0 and 0.0");
    }
    validate_step(settings, t_end);
    validate_stages(settings);
    if (settings.max_steps < 1) {
        throw std::invalid_argument("max_steps must be at least 1, got " +
                                    std::to_string(settings.max_steps));
    }
}

}  // namespace rolling_ellipse
